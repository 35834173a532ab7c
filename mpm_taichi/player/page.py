"""The HTML file: template, header and blocks in one, with nothing left to fetch.

Whatever a user wrote is data there: the header is JSON in which no tag can begin, and the script
puts its words in as text.  The policy of the page lets no script run but the one whose hash it
names, and forbids every connection."""

import base64
import hashlib
import html
import json
import zlib
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from string import Template

from ..recording import Recording
from ..renderers import palette
from ..scene import dump_scene
from ..whole_files import write_text
from .about import about
from .film import Film

SCRIPTS = (
    "dom", "unpack", "film", "units", "camera", "painter", "ground", "legend", "chart", "log",
    "bases", "stages", "formula", "walk", "sketch", "page", "gestures", "controls", "main",
)  # fmt: skip

THEME = ("shadow", "background", "panel", "line", "missing", "faint_ink", "ink")

SHADES = 256
"""Colors of a map in the page."""


@dataclass(frozen=True)
class Player:
    """A page, and what it shows."""

    html: str
    frames: int
    particles: int
    checksum: str
    """CRC-32 of the quantized frames (`film.Film`), eight hexadecimal digits; the page has computed
    its own as `window.player.checksum` once `window.player.ready` is fulfilled."""

    def write(self, path: Path) -> None:
        """Atomic."""
        write_text(path, self.html)


def player(recording: Recording, every: int = 1) -> Player:
    """The page that plays every `every`-th frame of a recording."""
    film = Film(recording, every)
    blocks, node_blocks = list(film.blocks()), list(film.node_blocks())
    checksum = f"{film.checksum:08x}"
    header = film.header() | {
        "checksumWritten": checksum,
        "blocks": len(blocks),
        "nodeBlocks": len(node_blocks),
        "palette": colors(),
        "about": about(recording),
        "scene": dump_scene(recording.scene),
    }
    particles = base64.b64encode(zlib.compress(film.particle_bytes(), 9)).decode("ascii")
    text = page(header, particles, blocks, node_blocks)
    return Player(text, len(film.numbers), film.particles, checksum)


def page(header: dict, particles: str, blocks: list[str], node_blocks: list[str]) -> str:
    """The first frame stands before the script, so that it is seen while the others are read."""
    style, script = stylesheet(), "\n".join(template(f"{name}.js") for name in SCRIPTS)
    script = f'(() => {{\n"use strict";\n{script}}})();\n'
    policy = (
        f"default-src 'none'; script-src '{digest(script)}'; style-src '{digest(style)}'; "
        "base-uri 'none'; form-action 'none'"
    )
    first, *others = (data_element(f"block-{k}", block) for k, block in enumerate(blocks))
    others += (data_element(f"nodes-{k}", block) for k, block in enumerate(node_blocks))
    return Template(template("player.html")).substitute(
        policy=html.escape(policy),
        title=html.escape(header["title"]),
        style=style,
        script=script,
        header=json.dumps(header, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
        first_frame="\n".join([data_element("particles", particles), first]),
        other_frames="\n".join(others),
    )


def data_element(name: str, data: str) -> str:
    return f'<script type="text/plain" id="data-{name}">{data}</script>'


def template(name: str) -> str:
    return (files("mpm_taichi.player") / "template" / name).read_text(encoding="utf-8")


def digest(text: str) -> str:
    """As a content security policy names a script or style."""
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"


def stylesheet() -> str:
    """The theme of the pictures as variables, and the rules."""
    variables = (
        f"--{name.replace('_', '-')}: #{code(getattr(palette, name.upper()))};" for name in THEME
    )
    return f":root {{ {' '.join(variables)} }}\n{template('player.css')}"


def colors() -> dict[str, list[str]]:
    """The color maps and the colors of bodies, "rrggbb" each."""
    maps = {"sequential": palette.SEQUENTIAL, "diverging": palette.DIVERGING}
    shades = {name: table[:: len(table) // SHADES] for name, table in maps.items()}
    return {
        name: list(map(code, table))
        for name, table in (shades | {"bodies": palette.BODIES}).items()
    }


def code(color) -> str:
    return bytes(palette.eight_bit(color)).hex()
