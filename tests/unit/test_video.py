"""Pictures of a run as MP4, GIF and WebP, read back by programs that know them."""

import builtins
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mpm_taichi import cli
from mpm_taichi.renderers import palette
from mpm_taichi.renderers.png import write_png

WIDTH, HEIGHT = 65, 43


@pytest.fixture
def run(tmp_path) -> Path:
    """A folder with run.json and twelve pictures of odd size, on which a square of a color of the
    map moves to the right."""
    folder = tmp_path / "run"
    (folder / "frames").mkdir(parents=True)
    (folder / "run.json").write_text("{}")
    for number in range(12):
        write_png(folder / "frames" / f"frame_{number:04d}.png", picture(number))
    return folder


def picture(number: int) -> np.ndarray:
    image = np.empty((HEIGHT, WIDTH, 3), np.uint8)
    image[:] = palette.eight_bit(palette.BACKGROUND)
    image[10:30, 4 * number : 4 * number + 16] = palette.eight_bit(palette.BODIES[1])
    return image


def frames_of(file: Path) -> list[np.ndarray]:
    if file.suffix == ".mp4":
        import imageio_ffmpeg

        reader = imageio_ffmpeg.read_frames(file)
        said = next(reader)
        assert "yuv420p(tv, bt709," in said["pix_fmt"]  # or players guess, each another matrix
        width, height = said["size"]
        return [np.frombuffer(frame, np.uint8).reshape(height, width, 3) for frame in reader]
    frames = []
    with Image.open(file) as movie:
        for number in range(getattr(movie, "n_frames", 1)):
            movie.seek(number)
            frames.append(np.asarray(movie.convert("RGB")))
    return frames


@pytest.mark.parametrize(("kind", "off"), [("mp4", 4), ("gif", 0), ("webp", 10)])
def test_a_video_shows_the_pictures(run, capfd, kind, off):
    """All twelve in their order.  Within a square and away from its edges, where a codec blurs,
    colors are those of the picture: in MP4 to 4 of 255, the rounding of YUV, in WebP, of quality
    85, to 10, in a GIF of so few colors exactly.  The odd size of an MP4 is made even by a line of
    background, not by a stretch."""
    assert cli.main(["export", str(run), f"--{kind}", "--fps", "30"]) == 0
    file = run / f"video.{kind}"
    assert f"{file}: 12 pictures, 0.4 s" in capfd.readouterr().out
    frames = frames_of(file)
    assert len(frames) == 12
    for number, frame in enumerate(frames):
        assert frame.shape == ((44, 66, 3) if kind == "mp4" else (HEIGHT, WIDTH, 3))
        inner = np.s_[14:26, 4 * number + 4 : 4 * number + 12]
        difference = frame[:HEIGHT, :WIDTH].astype(int) - picture(number)
        assert np.abs(difference[inner]).max() <= off
        assert np.abs(difference[36:]).max() <= off
    assert not list(run.glob("*.part"))


@pytest.mark.parametrize("kind", ["gif", "webp"])
def test_pictures_a_second(run, kind):
    """30 a second are 3.33 hundredths each, which a GIF cannot say: in the sum they are right to a
    hundredth."""
    assert cli.main(["export", str(run), f"--{kind}", "--fps", "30"]) == 0
    total = 0
    with Image.open(run / f"video.{kind}") as movie:
        for number in range(12):
            movie.seek(number)
            movie.load()
            total += movie.info["duration"]
    assert abs(total - 400) <= 10


def test_one_picture_is_a_video_too(run):
    """Of odd size, which by itself leaves an MP4 of 0 bytes."""
    for number in range(1, 12):
        (run / "frames" / f"frame_{number:04d}.png").unlink()
    for kind in ("mp4", "gif", "webp"):
        assert cli.main(["export", str(run), f"--{kind}"]) == 0
        assert len(frames_of(run / f"video.{kind}")) == 1


def test_nothing_is_overwritten_unasked(run, tmp_path, capfd):
    """The default file and one that is named; a folder that is not there yet is made."""
    file = tmp_path / "new" / "film.gif"
    assert cli.main(["export", str(run), "--gif", str(file)]) == 0
    file.write_bytes(b"mine")
    assert cli.main(["export", str(run), "--gif", str(file)]) == 2
    assert "is there already; name another file, or add --overwrite" in capfd.readouterr().err
    assert file.read_bytes() == b"mine"
    assert cli.main(["export", str(run), "--gif", str(file), "--overwrite"]) == 0
    assert len(frames_of(file)) == 12


def test_wrong_words(run, tmp_path, capfd):
    """Each a sentence and exit code 2."""
    for words, said in (
        ([run], "into what? --html, --mp4, --gif, --webp"),
        ([run, "--vtk", "--fps", "9"], "--fps: is for --mp4, --gif and --webp"),
        ([tmp_path, "--gif"], "has no run.json, so it is no run"),
        ([run, "--gif", "--fps", "51"], "a GIF has at most 50 pictures a second"),
    ):
        assert cli.main(["export", *map(str, words)]) == 2
        assert said in capfd.readouterr().err
    for words, said in (
        (["--mp4", run], "is no .mp4 file (the run comes first"),
        ([run, "--mp4", "a.avi"], "a.avi is no .mp4 file"),
        ([run, "--gif", "--fps", "0"], "must be above 0 and at most 240"),
    ):
        with pytest.raises(SystemExit) as refused:
            cli.main(["export", *map(str, words)])
        assert refused.value.code == 2
        assert said in capfd.readouterr().err


def test_pictures_that_make_no_video(run, capfd):
    """None at all, one cut off, one of another size: no file is left behind, and one that was there
    stays."""
    frames = run / "frames"
    path = frames / "frame_0007.png"
    (run / "video.gif").write_bytes(b"mine")
    for spoil, said in (
        (lambda: path.write_bytes(path.read_bytes()[:60]), "is no whole picture"),
        (lambda: write_png(path, picture(0)[:-1]), "is 65 x 42 pixels large"),
        (lambda: [each.unlink() for each in frames.iterdir()], "made no pictures; run the scene"),
    ):
        spoil()
        for kind in ("mp4", "gif"):
            assert cli.main(["export", str(run), f"--{kind}", "--overwrite"]) == 2
            assert said in capfd.readouterr().err
    assert sorted(each.name for each in run.iterdir()) == ["frames", "run.json", "video.gif"]
    assert (run / "video.gif").read_bytes() == b"mine"


def test_without_ffmpeg_the_command_that_installs_it_is_told(run, monkeypatch, capfd):
    real = builtins.__import__

    def missing(name, *rest):
        if name == "imageio_ffmpeg":
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", missing)
    assert cli.main(["export", str(run), "--mp4"]) == 2
    assert 'pip install "imageio-ffmpeg>=0.5"' in capfd.readouterr().err
    assert not (run / "video.mp4").exists()


def test_what_ffmpeg_says_is_told(run, monkeypatch, capfd):
    """Exit code 1, its words, and no file."""
    from mpm_taichi.exports import video

    monkeypatch.setattr(video, "MP4", "-c:v no_such_codec -f mp4")
    assert cli.main(["export", str(run), "--mp4"]) == 1
    assert "ffmpeg made no video: " in capfd.readouterr().err
    assert sorted(each.name for each in run.iterdir()) == ["frames", "run.json"]
