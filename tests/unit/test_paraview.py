"""Files for ParaView, read back by VTK, which is what ParaView reads with."""

import threading
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersTensor import vtkTensorPrincipalInvariants
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

from mpm_taichi import Simulation, cli, load_scene, vtk_files
from mpm_taichi.recorders import ParaView, Snapshots
from mpm_taichi.recorders.paraview import Series
from mpm_taichi.recording import Recording
from mpm_taichi.scene import dump_scene
from tests.command_line import SCENES, history

SCENE = SCENES / "two_disks_lattice.yaml"
CHANGES = (
    "time.end=0.004", "output.every=0.001", "output.images=none", "output.paraview={grid: true}",
    "bodies[0].velocity=[X,Y]", "bodies[1].shape.center=[0.7,0.5]",
)  # fmt: skip
WORDS = [word for change in CHANGES for word in ("--set", change)]
READERS = {".vtp": vtkXMLPolyDataReader, ".vti": vtkXMLImageDataReader}


def read(path: Path):
    """VTK's data set, its arrays by name, and its time."""
    reader = READERS[path.suffix]()
    assert reader.CanReadFile(str(path))
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    points, time = data.GetPointData(), data.GetFieldData().GetArray("TimeValue").GetValue(0)
    arrays = [points.GetArray(number) for number in range(points.GetNumberOfArrays())]
    return data, {array.GetName(): vtk_to_numpy(array) for array in arrays}, time


def places(data) -> np.ndarray:
    return np.array([data.GetPoint(number) for number in range(data.GetNumberOfPoints())])


def listed(path: Path) -> list[tuple[float, Path]]:
    """Times and files of a .pvd."""
    sets = ElementTree.parse(path).getroot().findall("Collection/DataSet")
    return [(float(each.attrib["timestep"]), path.parent / each.attrib["file"]) for each in sets]


@pytest.fixture(scope="module")
def run(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("paraview") / "run"
    assert cli.main([str(SCENE), "-q", "-o", str(folder), *WORDS]) == 0
    return folder


@pytest.fixture(scope="module")
def snapshots(run):
    return [now.snapshot for now in Simulation(load_scene(SCENE, CHANGES)).frames()]


def test_vtk_reads_what_the_run_was(run, snapshots):
    """Each array of each output is the Snapshot's to float32, under a name with its unit; a
    particle is a vertex cell, or ParaView would show nothing; 2D has z = 0 and F_zz = 1."""
    series = listed(run / "paraview" / "particles.pvd")
    assert [time for time, _ in series] == [now.time for now in snapshots]
    for (time, path), now in zip(series, snapshots, strict=True):
        data, arrays, said = read(path)
        assert said == time
        assert data.GetNumberOfVerts() == data.GetNumberOfPoints() == 416
        wanted = {
            "mass [kg]": now.mass, "pressure [Pa]": now.pressure,
            "von Mises stress [Pa]": now.von_mises_stress, "density [kg/m^3]": now.density,
            "elastic energy density [J/m^3]": now.energy_density,
            "volume ratio [-]": now.volume_ratio,
        }  # fmt: skip
        for name, values in wanted.items():
            assert arrays.pop(name) == pytest.approx(values, rel=6e-8, abs=1e-30), name
        for name, values, got in (
            ("position", now.position, places(data)),
            ("velocity", now.velocity, arrays.pop("velocity [m/s]")),
        ):
            assert got[:, :2] == pytest.approx(values, rel=6e-8, abs=1e-30), name
            assert not got[:, 2].any()
        F = arrays.pop("deformation gradient [-]").reshape(-1, 3, 3)
        assert F[:, :2, :2] == pytest.approx(now.deformation_gradient, rel=6e-8, abs=1e-30)
        assert (F[:, 2] == [0, 0, 1]).all()
        xx, yy, zz, xy, yz, xz = arrays.pop("Cauchy stress [Pa]").T
        sigma = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
        assert sigma == pytest.approx(now.cauchy_stress, rel=6e-8, abs=1e-30)
        assert arrays.pop("id").tolist() == list(range(416))
        assert arrays.pop("body").tolist() == [0] * 208 + [1] * 208
        assert not arrays


def test_the_grid_is_that_of_the_step_before_the_output(run, snapshots):
    """Hat functions add up to 1 and reproduce x, and nothing is near the border: nodal masses add
    up to that of the disks, their center is that of the particles before they moved with the last
    step, and nodal momenta add up to that of the particles, which only the nodes change; 1e-6 for
    sums in float32.  There is no grid at the start."""
    table = history(run)
    series = listed(run / "paraview" / "grid.pvd")
    assert [time for time, _ in series] == [now.time for now in snapshots[1:]]
    for (time, path), now in zip(series, snapshots[1:], strict=True):
        data, arrays, said = read(path)
        assert said == time
        assert data.GetDimensions() == (21, 21, 1)
        mass, velocity = arrays["mass [kg]"], arrays["velocity [m/s]"]
        assert mass.sum() == pytest.approx(now.mass.sum(), rel=1e-6)
        momentum = (mass[:, None] * velocity).sum(axis=0)[:2]
        assert momentum == pytest.approx(now.mass @ now.velocity, rel=1e-5)
        dt = table["time_step"][table["time"].tolist().index(time)]
        before = now.mass @ now.position - dt * momentum
        assert mass @ places(data)[:, :2] == pytest.approx(before, rel=1e-6)


def test_what_is_exported_is_what_the_run_would_have_written(run, tmp_path, capfd):
    """From the recorded particles: the same numbers, without what is not recorded.  Files that are
    there stay unless --overwrite is said."""
    live = [read(path)[1] for _, path in listed(run / "paraview" / "particles.pvd")]
    copy = tmp_path / "run"
    (copy / "snapshots").mkdir(parents=True)
    for path in (*run.glob("*.*"), *run.glob("snapshots/*")):
        (copy / path.relative_to(run)).write_bytes(path.read_bytes())
    assert cli.main(["export", str(copy), "--vtk"]) == 0
    assert "particles.pvd: 5 moments of 416 particles" in capfd.readouterr().out
    series = listed(copy / "paraview" / "particles.pvd")
    assert [time for time, _ in series] == Recording(run).times.tolist()
    for (_, path), of_run in zip(series, live, strict=True):
        _, arrays, _ = read(path)
        missing = of_run.keys() - arrays.keys()
        assert missing == {
            "Cauchy stress [Pa]", "deformation gradient [-]", "elastic energy density [J/m^3]",
            "volume ratio [-]",
        }  # fmt: skip
        for name, values in arrays.items():
            assert (values == of_run[name]).all(), name
    path = series[-1][1]
    path.write_text("mine")
    assert cli.main(["export", str(copy), "--vtk"]) == 2
    assert "holds such files already; add --overwrite" in capfd.readouterr().err
    assert path.read_text() == "mine"
    assert cli.main(["export", str(copy), "--vtk", "--overwrite"]) == 0
    assert read(path)[2] == 0.004


def test_three_dimensions(tmp_path, rng):
    """Tensors and vectors of random numbers come back bit by bit; nodes [i, j, k] lie where they
    should; names are escaped.  The principal values that VTK finds of six components are those of
    the symmetric tensor, which they would not be in another order; 1e-5 for its float32."""
    n = 7
    x, F = rng.random((n, 3), np.float32), rng.random((n, 3, 3), np.float32)
    sigma = F + F.transpose(0, 2, 1)
    columns = [
        vtk_files.tensor("F", F), vtk_files.vector('v "<&>"', 2 * x),
        vtk_files.symmetric_tensor("sigma", sigma),
    ]  # fmt: skip
    vtk_files.write_vtp(tmp_path / "a.vtp", 0.1, x, columns)
    data, arrays, time = read(tmp_path / "a.vtp")
    assert time == 0.1
    assert (places(data) == x).all()
    assert (arrays["F"] == F.reshape(n, 9)).all()
    assert (arrays['v "<&>"'] == 2 * x).all()
    principal = vtkTensorPrincipalInvariants()
    principal.SetInputData(data)
    principal.Update()
    found = principal.GetOutput().GetPointData()
    values = [vtk_to_numpy(found.GetArray(f"sigma - Sigma {number}")) for number in (3, 2, 1)]
    assert np.transpose(values) == pytest.approx(np.linalg.eigvalsh(sigma), abs=1e-5)
    shape = (2, 3, 4)
    i, j, k = np.indices(shape)
    number = (100 * i + 10 * j + k).T.ravel()
    vtk_files.write_vti(tmp_path / "a.vti", 0.1, shape, 0.5, [vtk_files.whole("n", number)])
    data, arrays, _ = read(tmp_path / "a.vti")
    assert (2 * places(data) @ [100, 10, 1] == arrays["n"]).all()


def test_the_series_is_valid_at_each_moment(tmp_path):
    """A reader that looks as often as it can, while 200 files are written, always finds XML, no
    fewer files than before, and each of them whole."""
    seen, ended = [0], threading.Event()

    def look():
        while not ended.is_set():
            found = listed(tmp_path / "p.pvd")
            seen.append(len(found))
            if found:
                assert read(found[-1][1])[0].GetNumberOfPoints() == 1000
        return True

    faults = []

    def watch():
        try:
            look()
        except Exception as fault:  # told by the test below
            faults.append(fault)

    series = Series(tmp_path, "p", ".vtp")
    series.begin([])
    watcher = threading.Thread(target=watch)
    watcher.start()
    x = np.zeros((1000, 3))
    for number in range(200):
        vtk_files.write_vtp(series.next_path, float(number), x, [])
        series.add(float(number))
    ended.set()
    watcher.join()
    assert not faults
    assert seen == sorted(seen)
    assert len(set(seen)) > 3  # it did look while files came
    assert len(listed(tmp_path / "p.pvd")) == 200


def test_a_recorder_goes_on_where_its_state_says(run, tmp_path):
    """The series is cut back, later files are removed, and what comes next has the next number."""
    for path in (run / "paraview").iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    simulation = Simulation(load_scene(SCENE, CHANGES))
    recorder = ParaView(tmp_path, simulation, True, {"count": 3})
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "grid.pvd", "grid_0001.vti", "grid_0002.vti", "particles.pvd",
        *(f"particles_000{number}.vtp" for number in range(3)),
    ]  # fmt: skip
    assert [time for time, _ in listed(tmp_path / "particles.pvd")] == [0, 0.001, 0.002]
    assert [time for time, _ in listed(tmp_path / "grid.pvd")] == [0.001, 0.002]
    recorder.record(simulation, is_output=True)
    assert recorder.state() == {"count": 4}
    assert listed(tmp_path / "particles.pvd")[3][1].name == "particles_0003.vtp"


def test_the_disk_space_is_foreseen(run):
    """To 10 %: the XML before few numbers is rounded up."""
    written = sum(path.stat().st_size for path in (run / "paraview").iterdir())
    foreseen = Recording(run).report["disk"]["paraview"]
    assert 0.9 * foreseen < written <= 1.02 * foreseen


def test_what_was_deleted_has_no_place(tmp_path):
    """Particles that left the domain have neither mass nor place: a recording has nan for their
    place and no kinetic energy, and files for ParaView, where one nan would hide all, leave them
    out; the others keep their id.  Also where none is left."""
    simulation = Simulation(load_scene(SCENE, CHANGES))
    (tmp_path / "run.json").write_text("{}")
    (tmp_path / "scene.yaml").write_text(dump_scene(simulation.scene))
    recorders = [
        Snapshots(tmp_path / "snapshots", simulation),
        ParaView(tmp_path / "paraview", simulation, False),
    ]
    whole = simulation.snapshot
    for remaining in ([3, 300], []):
        mass, volume = np.zeros(416), np.zeros(416)
        mass[remaining], volume[remaining] = 0.625, 1 / 1600
        vars(simulation)["_constant"] = {"mass": mass, "initial_volume": volume}
        vars(simulation)["snapshot"] = replace(whole, mass=mass, initial_volume=volume)
        for recorder in recorders:
            recorder.record(simulation, is_output=True)
    for number, count in enumerate((2, 0)):
        frame = Recording(tmp_path)[number]
        assert np.isnan(frame.position).all(axis=1).sum() == 416 - count
        assert np.count_nonzero(frame.kinetic_energy) == count
        data, arrays, _ = read(tmp_path / "paraview" / f"particles_{number:04d}.vtp")
        assert data.GetNumberOfVerts() == len(places(data)) == count
        if count:
            assert arrays["id"].tolist() == [3, 300]
            assert arrays["body"].tolist() == [0, 1]
            assert arrays["density [kg/m^3]"] == pytest.approx([1000, 1000])
            assert places(data)[:, :2] == pytest.approx(whole.position[[3, 300]], rel=6e-8)
    assert cli.main(["export", str(tmp_path), "--vtk", "--overwrite"]) == 0
    assert read(tmp_path / "paraview" / "particles_0000.vtp")[1]["id"].tolist() == [3, 300]
