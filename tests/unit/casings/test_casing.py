"""What a user meets: keys, mistakes in sentences with exit code 2, the command, and bodies that are kept."""

from __future__ import annotations

import json
import subprocess
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.casings.assembly import Elastic
from rotorgear.casings.casing import forget
from rotorgear.casings.fe_body import finite_element_body
from rotorgear.casings.file_mesh import FileMesh, NamedSet
from rotorgear.casings.reduced_body import ReducedBody
from rotorgear.casings.settings import CasingSettings
from tests.paths import ROOT
from tests.unit.casings.blocks import block, write_inp

pytest.importorskip("meshio")
MODEL = """
[casings.box]
mesh = "box.inp"
unit = "m"
material = "steel"
held = ["low"]
seats = { left = "high" }
damping_ratio = 0.01

[shafts.rotor]
position = ["50 mm", "30 mm"]
start = "200 mm"
sections = [{ length = "100 mm", outer_diameter = "20 mm" }]

[bearings.left]
shaft = "rotor"
at = "start"
stiffness = { radial = "1e8 N/m", axial = "1e8 N/m" }
casing = "box"
"""

SPRINGS = '{ x = "1e8 N/m", y = "1e8 N/m", axial = "1e8 N/m", tilt = "1e5 N m/rad", torsion = "1e5 N m/rad" }'


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROTORGEAR_CACHE", str(tmp_path / "cache"))
    forget()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_inp(tmp_path / "box.inp", block((0.1, 0.06, 0.2), (2, 1, 2)))
    return tmp_path


def problem(folder: Path, old: str, new: str) -> str:
    assert old in MODEL
    with pytest.raises(rg.RotorgearError) as error:
        rg.casing(rg.loads(MODEL.replace(old, new), folder=folder), modes=2)
    return str(error.value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('unit = "m"\n', "", "casings.box.unit: missing"),
        ('material = "steel"\n', "", "casings.box.material: missing"),
        ('material = "steel"', 'material = "stel"', "did you mean 'steel'?"),
        ('material = "steel"', "density = 7850", "casings.box.youngs_modulus: missing"),
        ('unit = "m"', 'unit = "mm"', "casings.box.unit: the mesh measures 0.1 mm x 0.06 mm x 0.2 mm"),
        ('unit = "m"', 'unit = "m"\nmass = "3 kg"', "casings.box.mass: the mesh has 9.42 kg, and 3 kg are stated"),
        ('unit = "m"', 'unit = "cm"\nmass = "9.4 kg"\nmounts = {}', "unit"),
        ('"box.inp"', '"bx.inp"', "Did you mean 'box.inp'"),
        ('held = ["low"]', 'held = ["lw"]', "casings.box.held[0]: the mesh has no set 'lw' (did you mean 'low'?)"),
        ('held = ["low"]', 'held = ["high"]', "casings.box.seats.left: nodes of this seat are held"),
        (
            'held = ["low"]',
            'mounts = { low = { x = "1e8 N/m" } }',
            "a mechanism: displacement along y; displacement along z",
        ),
        ('{ left = "high" }', '{ left = "hig" }', "casings.box.seats.left: the mesh has no set 'hig'"),
        ('{ left = "high" }', '{ lft = "high" }', "did you mean 'left'?"),
        ('{ left = "high" }', "{ left = { radius = 1 } }", "casings.box.seats.left.axis: missing"),
        (
            '{ left = "high" }',
            "{ left = { axis = 'z', center = [0, 0], from = 0, to = 1, radius = 0.03 } }",
            "no face of the mesh lies on this cylinder (radius 30 mm)",
        ),
        ('casing = "box"', 'casing = "bx"', "did you mean 'box'?"),
        ('held = ["low"]', f'held = ["low"]\nmounts = {{ low = {SPRINGS} }}', "all its nodes are held (low)"),
        ('unit = "m"', 'unit = "m"\nsplits = 9', "casings.box.splits: got 9, expected at most 4"),
        ('"box.inp"', '"."', "is a folder"),
        ('casing = "box"', 'casing = "box"\npedestal = { stiffness = { x = 1e8 } }', "casing and pedestal"),
    ],
)
def test_a_mistake_is_one_sentence_with_its_address(folder: Path, old: str, new: str, words: str) -> None:
    assert words in problem(folder, old, new)


def test_bodies_that_do_not_hang_together_and_sets_that_hold_too_little_are_named(folder: Path) -> None:
    one = block((0.1, 0.06, 0.2), (1, 1, 2))
    n = len(one.points)
    sets = {**one.sets, "edge": NamedSet(one.sets["low"].nodes[one.points[one.sets["low"].nodes, 0] < 1e-9])}
    sets["nowhere"] = NamedSet(np.array([2 * n]))
    cells = {"tetra10": np.vstack([one.cells["tetra10"], one.cells["tetra10"] + n])}
    points = np.vstack([one.points, one.points + np.array([0.5, 0.0, 0.0]), [[9.0, 9.0, 9.0]]])
    write_inp(folder / "box.inp", FileMesh(points, cells, sets))
    said = problem(folder, "damping_ratio", "damping_ratio")
    assert (
        "2 bodies that do not hang together: 12 elements about (50 mm, 30 mm, 100 mm); 12 elements about (550 mm"
        in said
    )

    write_inp(
        folder / "box.inp",
        FileMesh(points[[*range(n), 2 * n]], one.cells, {**sets, "nowhere": NamedSet(np.array([n]))}),
    )
    assert "a mechanism: rotation about y" in problem(folder, '["low"]', '["edge"]')
    assert "the set 'nowhere' touches no node" in problem(folder, '{ left = "high" }', '{ left = "nowhere" }')


def beside(first: FileMesh, offset: tuple[float, float, float], *, low: float) -> FileMesh:
    """A block with a copy of itself that is moved; nodes at one place are one."""
    cells = first.cells["tetra10"]
    both = np.vstack([first.points, first.points + offset])
    _, known, number = np.unique(np.round(both, 9), axis=0, return_index=True, return_inverse=True)
    points = both[known]
    sets = {"low": points[:, 2] < low, "high": np.abs(points[:, 2] - points[:, 2].max()) < 1e-9}
    return FileMesh(
        points,
        {"tetra10": number.ravel()[np.vstack([cells, cells + len(first.points)])]},
        {name: NamedSet(np.flatnonzero(chosen)) for name, chosen in sets.items()},
    )


def test_the_products_of_inertia_of_a_symmetric_body_are_zeros_without_a_sign(folder: Path) -> None:
    facts = dict(rg.casing(rg.loads(MODEL, folder=folder), modes=2).casings["box"].facts())
    assert facts["inertia xy yz zx"] == "0 0 0 kg m^2"


def test_parts_that_share_an_edge_or_a_node_are_hinges(folder: Path) -> None:
    one = block((0.1, 0.06, 0.1), (2, 1, 1))
    for offset in ((0.1, 0.0, 0.1), (0.1, 0.06, 0.1)):
        write_inp(folder / "box.inp", beside(one, offset, low=1e-9))
        said = problem(folder, "damping_ratio", "damping_ratio")
        assert "turn there like hinges: 12 elements about (50 mm, 30 mm, 50 mm); 12 elements about (150 mm" in said
    # Held on both sides of an edge, or with a face in common, nothing turns.
    for offset, low in (((0.1, 0.0, 0.1), 0.11), ((0.05, 0.0, 0.1), 1e-9)):
        write_inp(folder / "box.inp", beside(one, offset, low=low))
        assert rg.casing(rg.loads(MODEL, folder=folder), modes=2).casings["box"].held_frequency_hz[0] > 100.0


def test_memory_grows_with_the_held_nodes_and_not_with_their_square(folder: Path) -> None:
    path = write_inp(folder / "plate.inp", block((0.4, 0.4, 0.02), (16, 16, 1), "hexahedron20"))
    plate = CasingSettings("plate", (("mesh", path),), 1.0, Elastic(206e9, 0.3, 7850.0), held=("low",))
    finite_element_body(plate)  # what is imported and kept on the way counts for nothing
    tracemalloc.start()
    body = finite_element_body(plate)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 8 * (3 * len(body.held)) ** 2


def test_the_command_writes_the_names_of_the_design_and_ends_with_2_where_the_mesh_is_wrong(folder: Path) -> None:
    (folder / "model.toml").write_text(MODEL)
    command = [sys.executable, "-m", "rotorgear", "casing", "model.toml", "--modes", "3", "--json", "out.json"]
    environment = {
        "PYTHONPATH": str(ROOT),
        "PATH": "",
        "ROTORGEAR_CACHE": str(folder / "cache"),
        "OMP_NUM_THREADS": "1",
    }
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    box = json.loads((folder / "out.json").read_text())["casings"]["box"]
    assert box["mass_kg"] == pytest.approx(7850 * 0.1 * 0.06 * 0.2)
    assert box["centre_m"] == pytest.approx([0.05, 0.03, 0.1])
    assert np.shape(box["inertia_kg_m2"]) == (3, 3)
    assert len(box["free_frequency_hz"]) == len(box["held_frequency_hz"]) == len(box["held_mesh_error"]) == 3
    assert min(box["free_frequency_hz"]) > 1000.0
    assert np.shape(box["seats"][0]["stiffness"]) == (6, 6)
    assert "held" in done.stdout

    (folder / "model.toml").write_text(MODEL.replace('"low"', '"feet"'))
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.strip().count("\n") == 0
    assert "no set 'feet'" in done.stderr


def test_a_body_is_kept_by_its_mesh_and_keys_and_a_damaged_file_is_made_anew(folder: Path) -> None:
    def body(**changes: str) -> ReducedBody:
        """The casing of a new model in a process that remembers nothing."""
        forget()
        model = rg.loads(MODEL, folder=folder)
        return (model.with_(changes) if changes else model).layout.casing("box")

    first = body()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rotorgear.casings.casing.reduce", None)  # it comes from the disk
        again = body()
    assert again is not first
    np.testing.assert_array_equal(first.stiffness, again.stiffness)
    np.testing.assert_array_equal(first.surface.basis, again.surface.basis)  # type: ignore[union-attr]
    assert again.seats == first.seats == ("left",)

    kept = next((folder / "cache").glob("ReducedBody_*.npz"))
    content = bytearray(kept.read_bytes())
    place = content.index(first.mass.tobytes())
    content[place : place + 8] = np.float64(1.0).tobytes()
    kept.write_bytes(content)
    assert body().mass[0, 0] == first.mass[0, 0]
    body(**{"casings.box.connection": "rigid"})
    write_inp(folder / "box.inp", block((0.1, 0.06, 0.2), (1, 1, 2)))
    body()
    assert len(list((folder / "cache").glob("ReducedBody_*.npz"))) == 3


def test_a_seat_may_be_a_bore_of_its_place(folder: Path) -> None:
    """Four bricks round a square hole, whose corners lie on a circle about its axis."""
    angles = np.arange(8) * np.pi / 4.0
    ring = np.array([[np.cos(a), np.sin(a)] for a in angles])
    points = np.array([[*(r * xy), z] for z in (0.0, 0.05, 0.1) for r in (0.04, 0.08) for xy in ring])
    cells = []
    for layer in range(2):
        for i in range(8):
            j = (i + 1) % 8
            low = [16 * layer + i, 16 * layer + 8 + i, 16 * layer + 8 + j, 16 * layer + j]
            cells.append([*low, *(node + 16 for node in low)])
    write_inp(folder / "box.inp", FileMesh(points, {"hexahedron": np.array(cells)}, {"low": NamedSet(np.arange(16))}))
    place = "{ left = { axis = 'z', center = [0, 0], from = '50 mm', to = '100 mm', radius = '40 mm' } }"
    body = rg.loads(MODEL.replace('{ left = "high" }', place), folder=folder).layout.casing("box")
    np.testing.assert_allclose(body.seat_points, [[0.0, 0.0, 0.075]])


SPRINGS = "radial = '1e8 N/m', axial = '2e8 N/m', tilt = '1e5 N m/rad', torsion = '1e5 N m/rad'"


@pytest.mark.parametrize(
    "stands",
    [
        'held = ["low"]',
        'held = ["foot", "low"]',
        f"mounts = {{ low = {{ {SPRINGS} }}, foot = {{ {SPRINGS} }} }}",
        f'held = ["foot"]\nmounts = {{ low = {{ {SPRINGS} }} }}',
    ],
)
def test_held_sets_and_mounts_carry_together_what_bearings_and_weight_put_on_a_casing(
    folder: Path, stands: str
) -> None:
    mesh = block((0.1, 0.06, 0.2), (2, 1, 2))
    low = mesh.sets["low"].nodes
    mesh.sets["foot"] = NamedSet(low[mesh.points[low, 0] < 0.051])
    write_inp(folder / "box.inp", mesh)
    text = "operation = { input_shaft = 'rotor', gravity = ['1 m/s^2', '-9.81 m/s^2', '0.5 m/s^2'] }\n"
    text += MODEL.replace('held = ["low"]', stands).replace(
        'axial = "1e8 N/m"', 'axial = "1e8 N/m", tilt = "1e5 N m/rad"'
    )
    found = rg.static(rg.loads(text, folder=folder))
    assert len(found.casing_ground_force) == stands.count("low") + stands.count("foot")
    total = sum(found.casing_ground_force.values())
    np.testing.assert_allclose(total, found.casing_force["box"], rtol=1e-6, atol=1e-6 * np.abs(total).max())
    # What the bearing puts on its seat is the opposite of its force on the shaft, at the point of the seat.
    on_seat = found.casing_seat_force["box.left"]
    np.testing.assert_allclose(on_seat[:3], -found.bearing_force["left"][:3], rtol=1e-12)
    assert "box.low" in found.text()
