"""One question about this computer, asked in a process of its own, since some answers are crashes.

    python -m mpm_taichi.probe cpu | cuda | vulkan | metal     which precisions does it compute in?
    python -m mpm_taichi.probe window                          does a window open?
    python -m mpm_taichi.probe libraries libX11.so.6 ...       which can be loaded?

Each answer is a line of JSON, printed as soon as it is known: a crash leaves those before."""

import ctypes
import json
import sys

COUNT = 100


def answer(**said) -> None:
    """After a new line: Taichi may have left the last one unfinished."""
    print(f"\n{json.dumps(said)}", flush=True)


def backend(device: str) -> None:
    """Sums whole numbers, exactly, in both precisions; then takes a logarithm, which some devices
    have in f32 alone."""
    import taichi as ti
    from taichi.lang import impl

    from . import runtime
    from .errors import InputError

    for precision in ("f32", "f64"):
        try:
            runtime.start(device, precision)
            if precision == "f32":
                answer(cache=impl.current_cfg().offline_cache_file_path)
            _compute(ti, precision)
        except (InputError, RuntimeError) as error:
            answer(precision=precision, fault=str(error).strip().splitlines()[-1])


def _compute(ti, precision):
    from .runtime import Template

    @ti.kernel
    def fill(x: Template):
        for k in x:
            x[k] = k

    @ti.kernel
    def logarithm(x: Template):
        for k in x:
            x[k] = ti.log(x[k] + 1)

    x = ti.field(float, COUNT)
    fill(x)
    if x.to_numpy().sum() != COUNT * (COUNT - 1) / 2:
        answer(precision=precision, fault="computes wrong numbers")
        return
    try:
        logarithm(x)
        answer(precision=precision, logarithm=True)
    except RuntimeError:
        answer(precision=precision, logarithm=False)


def window() -> None:
    """Draws a disk in a window of 64 x 64 pixels and closes it."""
    import taichi as ti

    from . import runtime

    runtime.start("cpu", "f32")
    x = ti.Vector.field(2, ti.f32, 1)
    x.fill(0.5)
    shown = ti.ui.Window("mpm_taichi doctor", (64, 64), vsync=False)
    shown.get_canvas().circles(x, radius=0.2, color=(1, 1, 1))
    shown.show()
    answer(window=True)


def libraries(names: list[str]) -> None:
    for name in names:
        try:
            ctypes.CDLL(name)
            answer(library=name, loads=True)
        except OSError:
            answer(library=name, loads=False)


def main(words: list[str]) -> None:
    question, *rest = words
    if question == "libraries":
        libraries(rest)
    elif question == "window":
        window()
    else:
        backend(question)


if __name__ == "__main__":
    main(sys.argv[1:])
