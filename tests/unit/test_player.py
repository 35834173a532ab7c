"""The browser player without a browser: what is in the file."""

import base64
import hashlib
import html
import json
import re
import struct
import zlib

import numpy as np
import pytest

from mpm_taichi import cli
from mpm_taichi.player import player
from mpm_taichi.recording import Recording
from tests.recorded_run import turning_disk, write_run

SCENE = "two_disks_lattice"
FRAMES, PARTICLES = 40, 300


def text_of(page: str, name: str) -> str:
    """The text of the script element of an id."""
    found = re.search(rf'<script type="[^"]*" id="{name}">(.*?)</script>', page, re.DOTALL)
    assert found is not None, name
    return found[1]


def decoded(page: str) -> tuple[dict, list[np.ndarray]]:
    """The header, and the channels [frames, n] in whole numbers: number by number, as the docstring
    of `mpm_taichi/player/packing.py` says."""
    header = json.loads(text_of(page, "header"))
    n, dim = header["particles"], header["dimension"]
    packed = sum("step" in quantity for quantity in header["quantities"])
    kinds = [np.uint16] * dim + [np.uint8] * (dim + packed)
    kinds += [np.uint16] * 11 * bool(header["walk"])
    channels = [np.zeros((0, n), kind) for kind in kinds]
    for block in range(header["blocks"]):
        data = zlib.decompress(base64.b64decode(text_of(page, f"data-block-{block}")))
        width = n * sum(np.dtype(kind).itemsize for kind in kinds)
        frames, at = (len(data) - len(kinds)) // width, 0
        for c, kind in enumerate(kinds):
            size = np.dtype(kind).itemsize
            order, beside = data[at] % 4, data[at] // 4
            planes = np.frombuffer(data, np.uint8, size * frames * n, at + 1).astype(int)
            at += 1 + size * frames * n
            planes = planes.reshape(size, frames, n)
            zigzag = np.tensordot(256 ** np.arange(size), planes, 1)
            r = zigzag // 2 ^ -(zigzag % 2)
            for d in np.cumsum(r, axis=1) if beside else r:
                q, k = channels[c].astype(int), len(channels[c])
                last, older = (q[k - 1], q[max(k - 2, 0)]) if k else (np.zeros(n, int),) * 2
                q = d + (0, last, 2 * last - older)[order]
                channels[c] = np.concatenate([channels[c], (q % 256**size).astype(kind)[None]])
        assert at == len(data)
    return header, channels


@pytest.fixture
def recording(tmp_path, rng):
    """Noisy, so that no way of packing is the best throughout; a particle leaves the unit square,
    and one is deleted."""
    x = turning_disk(FRAMES, PARTICLES, rng, noise=1e-3)
    x[5:9, 7] = [-0.02, 1.03]
    x[20:, 11] = np.nan
    stress = np.abs(rng.standard_normal((FRAMES, PARTICLES))).cumsum(axis=0)
    scalars = {"pressure": -stress, "stress": stress, "density": np.full_like(stress, 1000.0)}
    return Recording(write_run(tmp_path / "run", SCENE, [], x, scalars))


def test_decoded_frames_are_what_was_recorded(recording):
    """The page holds each coordinate to half of 1 / 65534 of the domain (or of what the particles
    reach beyond it), each velocity component to half of 1 / 127 of the largest, each scalar to half
    of 1 / 255 of its range, and 1e-9 for rounding; 65535 is a deleted particle, of which nothing is
    said; the check sum is that of the decoded numbers."""
    film = player(recording)
    header, channels = decoded(film.html)
    assert {len(channel) for channel in channels} == {FRAMES}
    assert header["times"] == pytest.approx(recording.times)
    there = np.array([np.isfinite(frame.position[:, 0]) for frame in recording])
    assert ((channels[0] != 65535) == there).all() and not there[20:, 11].any()
    for axis in range(2):
        step, low = header["step"][axis], header["low"][axis]
        assert 1 / 65534 * (1 - 1e-9) < step < 1.06 / 65534
        x = np.array([frame.position[:, axis] for frame in recording], float)
        assert np.abs(low + step * channels[axis] - x)[there].max() <= 0.5 * step + 1e-9
        v = np.array([frame.velocity[:, axis] for frame in recording], float)
        error = header["velocityStep"] * (channels[2 + axis].astype(float) - 127) - v
        assert np.abs(error)[there].max() <= 0.5 * header["velocityStep"] + 1e-9
    fastest = max(np.abs(f.velocity[t]).max() for f, t in zip(recording, there, strict=True))
    assert header["velocityStep"] == pytest.approx(fastest / 127)
    packed = [quantity for quantity in header["quantities"] if "step" in quantity]
    assert [quantity["name"] for quantity in packed] == ["stress", "pressure", "density"]
    for quantity, channel in zip(packed, channels[4:], strict=True):
        values = np.array([frame.scalars[quantity["name"]] for frame in recording], float)
        error = quantity["low"] + quantity["step"] * channel.astype(float) - values
        assert np.abs(error)[there].max() <= 0.5 * quantity["step"] * (1 + 1e-9)
        assert quantity["step"] == pytest.approx((np.ptp(values[there]) or 1) / 255)
    crc = 0
    for k in range(FRAMES):
        for channel in channels:
            numbers = channel[k].tolist()
            kind = "H" if channel.dtype == np.uint16 else "B"
            crc = zlib.crc32(struct.pack(f"<{len(numbers)}{kind}", *numbers), crc)
    assert f"{crc:08x}" == film.checksum == header["checksumWritten"]


def test_what_stays_of_a_particle(recording):
    """Mass and half the edge of its cube in float32 and its body, particle after particle."""
    page = player(recording).html
    data = zlib.decompress(base64.b64decode(text_of(page, "data-particles")))
    n = PARTICLES
    assert np.frombuffer(data, "<f4", n).tolist() == recording.mass.tolist()
    edge = recording.initial_volume**0.5
    assert np.frombuffer(data, "<f4", n, 4 * n) == pytest.approx(0.5 * edge, rel=1e-7)
    assert np.frombuffer(data, "<u2", n, 8 * n).tolist() == recording.body.tolist()


def test_fewer_frames_only_where_asked(recording):
    """Every third frame, from the first on, with its time."""
    film = player(recording, every=3)
    header, channels = decoded(film.html)
    assert film.frames == len(channels[0]) == 14
    assert header["times"] == pytest.approx(recording.times[::3])
    assert header["steps"] == list(range(0, 400, 30))


def test_size_of_smooth_motion(tmp_path, rng):
    """Positions and velocities take 8 bytes of plain base64 a particle and frame.  Of a smooth
    motion, particles in random order and 0.03 rad between frames, at most 3 are left (2.7 seen), so
    that 10,000 particles and 300 frames with two scalars as smooth stay about 8 MB.  White noise,
    of which nothing can be spared, takes at most a hundredth more than 8."""
    frames, n = 60, 1000

    def bytes_of(name, x):
        page = player(Recording(write_run(tmp_path / name, SCENE, [], x, every=1e-3))).html
        blocks = json.loads(text_of(page, "header"))["blocks"]
        return sum(len(text_of(page, f"data-block-{k}")) for k in range(blocks)) / (frames * n)

    assert bytes_of("smooth", turning_disk(frames, n, rng)) < 3
    assert bytes_of("noise", rng.random((frames, n, 2))) < 1.01 * 8


def test_the_page_runs_its_own_script_and_no_other(tmp_path, rng):
    """Whatever a scene says stays text: no tag begins in it, in the head or in the data; the policy
    names the hashes of the one script and the one style, and allows no connection."""
    evil = "</script><script>evil()</script><!--"
    changes = [f'title="{evil}"', f'source="{evil}"', f'bodies[0].name="{evil}"']
    x = turning_disk(2, 10, rng)
    page = player(Recording(write_run(tmp_path / "run", SCENE, changes, x))).html
    assert "evil()</script>" not in page and evil not in page
    header = json.loads(text_of(page, "header"))
    assert header["title"] == header["bodies"][0] == evil
    assert "evil()" in header["scene"]
    title = re.search("<title>(.*)</title>", page)
    assert title is not None and html.unescape(title[1]) == evil
    policy = html.unescape(re.findall('Content-Security-Policy" content="(.*?)"', page)[0])
    assert policy.startswith("default-src 'none';")
    for tag in ("script", "style"):
        (text,) = re.findall(rf"<{tag}>(.*?)</{tag}>", page, re.DOTALL)
        sha = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert f"{tag}-src 'sha256-{sha}'" in policy
    assert not re.search(r"https?://|\bfetch\(|XMLHttpRequest|import\(|\bsrc=|\bhref=", page)


def test_export_command(tmp_path, rng, capsys, monkeypatch):
    """RUN/player.html, told with frames and size; never over a file that is there, unless asked;
    a file that mail does not take is told so, with what would help."""
    run = write_run(tmp_path / "run", SCENE, [], turning_disk(4, 10, rng))
    assert cli.main(["export", str(run), "--html"]) == 0
    assert "player.html: 4 frames of 10 particles, 0.0" in capsys.readouterr().out
    written = (run / "player.html").read_bytes()
    assert cli.main(["export", str(run), "--html", "--every", "3"]) == 2
    assert "player.html: is there already" in capsys.readouterr().err
    assert (run / "player.html").read_bytes() == written
    assert cli.main(["export", str(run), "--html", "--every", "3", "--overwrite"]) == 0
    assert "2 frames" in capsys.readouterr().out
    monkeypatch.setattr("mpm_taichi.exports.player.MAIL", 0.02)
    other = tmp_path / "sub" / "other.html"
    assert cli.main(["export", str(run), "--html", str(other)]) == 0
    assert re.search(
        r"more than the 0.02 MB that mail takes; with --every \d", capsys.readouterr().out
    )
    assert other.read_bytes() == written
    assert cli.main(["export", str(run), "--mp4", "--every", "3"]) == 2
    assert "--every: is for --html" in capsys.readouterr().err


def test_a_run_without_history_or_motion_has_a_page_too(tmp_path):
    """One frame of one particle at rest, and a history of which nothing is written yet."""
    run = write_run(tmp_path / "run", SCENE, ["title=''"], np.full((1, 1, 2), 0.5))
    (run / "history.csv").write_text("")
    header, channels = decoded(player(Recording(run)).html)
    assert header["title"] == "run" and header["history"] is None
    assert [channel.tolist() for channel in channels] == [
        [[32767]],
        [[32767]],
        [[127]],
        [[127]],
    ] + 3 * [[[0]]]
    low, high = header["quantities"][1]["shown"]
    assert low == 0 < high
