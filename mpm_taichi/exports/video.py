"""The pictures of a run as MP4, GIF or WebP."""

import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError, RunError
from ..run_folder import read_report
from ..whole_files import beside

FASTEST_GIF = 50
"""Pictures a second: a GIF counts in hundredths of a second, and many programs refuse one."""

MP4 = (
    # yuv420p, which every player knows, wants even sizes; where a file does not say how its colors
    # are made of that (here as in high-definition television), players guess, and colors shift.
    "-an -c:v libx264 -preset medium -crf 18 -pix_fmt yuv420p -vf "
    "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=0x10131a,"
    "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int,"
    "setparams=range=tv:colorspace=bt709:color_primaries=bt709:color_trc=bt709 "
    "-movflags +faststart -f mp4"
)


def export_video(run: Path, file: Path, fps: float, overwrite: bool) -> None:
    """Write all pictures of a run into `file`, whose suffix says what it becomes; it appears
    whole, or not at all."""
    if file.exists() and not overwrite:
        raise InputError(f"{file}: is there already; name another file, or add --overwrite")
    if file.suffix == ".gif" and fps > FASTEST_GIF:
        raise InputError(f"--fps {fps:g}: a GIF has at most {FASTEST_GIF} pictures a second")
    paths = picture_paths(run)
    write = {".mp4": write_mp4, ".gif": write_gif, ".webp": write_webp}[file.suffix]
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with beside(file) as part:
            write(part, paths, fps)
    except OSError as error:
        raise InputError(f"{file}: cannot be written: {error}") from None
    size = file.stat().st_size / 1e6
    print(f"{file}: {len(paths)} pictures, {len(paths) / fps:.3g} s, {size:.3g} MB")


def picture_paths(run: Path) -> list[Path]:
    """frames/frame_*.png in their order."""
    read_report(run)
    numbers = {path: path.stem[len("frame_") :] for path in (run / "frames").glob("frame_*.png")}
    found = [path for path, number in numbers.items() if number.isdecimal()]
    if not found:
        raise InputError(
            f"{run}: the run made no pictures; run the scene again with\n  python -m mpm_taichi "
            f"run {run / 'scene.yaml'} --set 'output.images={{}}'"
        )
    return sorted(found, key=lambda path: int(numbers[path]))


def pictures(paths: list[Path]) -> Iterator[Any]:
    """As RGB images of Pillow, all of one size."""
    from PIL import Image

    first = None
    for path in paths:
        try:
            with Image.open(path) as image:
                picture = image.convert("RGB")
        except (OSError, SyntaxError, ValueError) as error:
            raise InputError(f"{path}: is no whole picture: {error}") from None
        first = first or picture.size
        if picture.size != first:
            raise InputError(
                f"{path}: is {picture.size[0]} x {picture.size[1]} pixels large, and "
                f"{paths[0].name} {first[0]} x {first[1]}: they make no video together"
            )
        yield picture


def write_mp4(part: Path, paths: list[Path], fps: float) -> None:
    """H.264 by the ffmpeg that the package imageio-ffmpeg brings along."""
    width, height = next(pictures(paths)).size
    source = f"-v error -y -f rawvideo -pix_fmt rgb24 -s {width}x{height} -r {fps:.6f} -i -"
    command = [ffmpeg(), *source.split(), *MP4.split(), f"file:{part}"]
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=said)
        assert process.stdin is not None
        try:
            for picture in pictures(paths):
                process.stdin.write(picture.tobytes())
            process.stdin.close()
        except BrokenPipeError:
            pass  # ffmpeg has ended, and says below why
        except BaseException:
            process.kill()
            raise
        if process.wait() != 0:
            said.seek(0)
            words = said.read().decode(errors="replace").strip()
            raise RunError(f"ffmpeg made no video: {words or f'exit code {process.returncode}'}")


def ffmpeg() -> str:
    """Path of the program."""
    try:
        import imageio_ffmpeg
    except ImportError:
        raise InputError('--mp4 needs ffmpeg: pip install "imageio-ffmpeg>=0.5"') from None
    try:
        return imageio_ffmpeg.get_ffmpeg_exe()
    except RuntimeError as error:
        raise InputError(f"--mp4 needs ffmpeg: {error}") from None


def write_gif(part: Path, paths: list[Path], fps: float) -> None:
    """One palette for all pictures, so that none of its colors flickers."""
    from PIL import Image

    chosen = [paths[k] for k in np.unique(np.linspace(0, len(paths) - 1, 5).astype(int))]
    sample = Image.fromarray(np.concatenate([np.asarray(picture) for picture in pictures(chosen)]))
    palette = sample.quantize(256, method=Image.Quantize.MEDIANCUT)
    quantized = (
        picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures(paths)
    )
    due = np.round(100 * np.arange(len(paths) + 1) / fps)  # right on average for any fps
    _save(part, "GIF", quantized, duration=(10 * np.diff(due)).astype(int).tolist())


def write_webp(part: Path, paths: list[Path], fps: float) -> None:
    """Each picture by itself (kmax): as changes to the one before, some edges would stay where they
    were, up to 35 of 255 in brightness.  The file is an eighth larger for it."""
    due = np.round(1000 * np.arange(len(paths) + 1) / fps)
    duration = np.diff(due).astype(int).tolist()
    _save(part, "WEBP", pictures(paths), duration=duration, quality=85, method=2, kmax=1)


def _save(part: Path, kind: str, images: Iterator[Any], **options) -> None:
    first = next(images)
    first.save(part, kind, save_all=True, append_images=images, loop=0, **options)
