"""How long a picture takes: 1920 x 1080 pixels, 100,000 particles, in 2D and 3D, drawn and written.

    python benchmarks/pictures.py            # a minute, most of it compilation

prints milliseconds for each number of threads: the least of the repeats, CPU time of all threads
and wall time, of drawing and of writing the PNG file.  Where others use the cores too the wall time
says little, and CPU time over the cores is what a quiet computer would need at least."""

import argparse
import tempfile
from pathlib import Path

import numpy as np
from stopwatch import spent

from mpm_taichi import runtime
from mpm_taichi.renderers import Frame, draw, write_png

SCREENS = {2: ((2.243, 1.0), 1793), 3: ((2.5, 0.45, 1.0), 1795)}
"""Domain [m] and size [pixels] for a picture of 1920 x 1080 pixels."""

COUNT = 100_000


def frame_of(dim: int) -> Frame:
    """A block that fills most of the domain, jittered, with speeds that vary smoothly."""
    size = np.array(SCREENS[dim][0])
    low, high = 0.1 * size, 0.9 * size
    low[1], high[1] = 0.0, 0.6 * size[1]
    spacing = (np.prod(high - low) / COUNT) ** (1 / dim)
    axes = [np.arange(a, b, spacing) for a, b in zip(low, high, strict=True)]
    x = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, dim)
    x += 0.2 * spacing * np.random.default_rng(1).uniform(-1, 1, x.shape)
    return Frame(
        position=x,
        radius=np.full(len(x), spacing / 2),
        body=np.zeros(len(x), int),
        body_names=["block"],
        time=0.5,
        domain_size=SCREENS[dim][0],
        cells=tuple((40 * size).astype(int).tolist()),
        title="A block of particles",
        quantity="speed",
        value=np.linalg.norm(x - size / 2, axis=1),
    )


def measured(work) -> tuple[float, float]:
    """CPU and wall time [ms]."""
    took = spent(work)
    return 1e3 * took.cpu, 1e3 * took.wall


def time_of(frame: Frame, size: int, repeats: int) -> list[float]:
    """Drawing and writing, CPU and wall time of each, the least of the repeats."""
    with tempfile.TemporaryDirectory() as folder:
        path, picture = Path(folder) / "a.png", draw(frame, size=size)
        drawn = [measured(lambda: draw(frame, size=size)) for _ in range(repeats)]
        written = [measured(lambda: write_png(path, picture)) for _ in range(repeats)]
    return [*np.min(drawn, axis=0), *np.min(written, axis=0)]


def main() -> None:
    parser = argparse.ArgumentParser(description="how long a picture takes")
    parser.add_argument("--repeats", type=int, default=20)
    options = parser.parse_args()
    print("dim  particles  pixels       threads  draw: CPU  wall  write: CPU  wall   CPU of both")
    for threads in (1, 2):
        runtime.start("cpu", "f64", threads=threads)
        for dim, (_, size) in SCREENS.items():
            frame = frame_of(dim)
            height, width, _ = draw(frame, size=size).shape
            cpu, wall, write_cpu, write_wall = time_of(frame, size, options.repeats)
            print(
                f"{dim}D {len(frame.position):11} {width:6} x {height:4} {threads:8} {cpu:10.0f} "
                f"{wall:5.0f} {write_cpu:11.0f} {write_wall:5.0f} {cpu + write_cpu:13.0f} ms"
            )


if __name__ == "__main__":
    main()
