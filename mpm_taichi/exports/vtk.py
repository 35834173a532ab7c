"""The recorded particles of a run as the files that `output.paraview` writes."""

from pathlib import Path

from ..errors import InputError
from ..recorders.paraview import Series, particle_columns, visible
from ..recording import Recording
from ..vtk_files import write_vtp


def export_vtk(run: Path, overwrite: bool) -> None:
    """RUN/paraview/particles.pvd.  What a snapshot does not have, stress tensor and deformation
    gradient, the files do not have either."""
    recording = Recording(run)
    folder = run / "paraview"
    if not overwrite and any(folder.glob("particles*")):
        raise InputError(f"{folder}: holds such files already; add --overwrite to replace them")
    try:
        folder.mkdir(exist_ok=True)
        series = Series(folder, "particles", ".vtp")
        series.begin([])
        for frame in recording:
            there = visible(frame.position)
            columns = particle_columns(there, recording.body, frame, frame.scalars)
            write_vtp(series.next_path, frame.time, frame.position[there], columns)
            series.add(frame.time)
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {error}") from None
    print(
        f"{folder / 'particles.pvd'}: {len(recording)} moments of {len(recording.body)} particles"
    )
