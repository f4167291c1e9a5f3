"""Files of meshes: sets by several ways, decks that meshio can't read, and errors that are sentences."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rotorgear.casings.elements import element
from rotorgear.casings.file_mesh import FileMesh
from rotorgear.casings.mesh_file import read_mesh
from rotorgear.casings.patches import by_set
from rotorgear.casings.solid_mesh import solid_mesh
from rotorgear.errors import AnalysisError
from tests.unit.casings.blocks import block, write_inp, write_msh

meshio = pytest.importorskip("meshio")


def low_faces(found: FileMesh) -> np.ndarray:
    """Quadratic triangles of the face z = 0."""
    cells = found.cells["tetra10"]
    faces = cells[:, element("tetra10").face_nodes].reshape(-1, 6)
    return np.asarray(faces[(np.abs(found.points[faces][:, :, 2]) < 1e-9).all(axis=1)])


def same_body(path: Path, found: FileMesh) -> FileMesh:
    """The mesh of a file, which has the points and the volume of a block."""
    read = read_mesh(path, "casings.b.mesh")
    assert len(read.points) == len(found.points)
    np.testing.assert_allclose(np.sort(read.points, axis=0), np.sort(found.points, axis=0), atol=1e-12)
    assert solid_mesh(read, 1.0, "casings.b.mesh").jacobian_low == pytest.approx(1.0)
    return read


def test_an_abaqus_deck_with_faces_of_plane_elements_and_several_blocks_of_nodes_is_read(tmp_path: Path) -> None:
    found = block()
    faces = low_faces(found)
    plane = "*ELEMENT, TYPE=CPS6, ELSET=base\n"
    plane += "".join(f"{900 + i}, " + ", ".join(str(n + 1) for n in face) + "\n" for i, face in enumerate(faces))
    plane += "*ELSET, ELSET=feet, GENERATE\n900, 901\n*NSET, NSET=both\nlow, high\n"
    path = write_inp(tmp_path / "block.inp", found, plane)
    head, _, rest = path.read_text().partition("\n10, ")
    path.write_text(f"{head}\n*NODE, NSET=later\n10, {rest}".replace("C3D10,", "C3D10M,"))
    read = same_body(path, found)
    assert len(read.sets["later"].nodes) == len(found.points) - 9
    assert len(read.sets["base"].faces[0]) == len(faces) == len(read.sets["feet"].faces[0])
    assert len(read.sets["both"].nodes) == 18


def test_gmsh_files_of_the_older_version_keep_their_physical_groups(tmp_path: Path) -> None:
    found = block()
    read = same_body(write_msh(tmp_path / "block.msh", found, low_faces(found)), found)
    assert len(read.sets["low"].nodes) == 9
    assert len(read.sets["low"].faces[0]) == 2


@pytest.mark.parametrize("ending", ["vtu", "vtk"])
def test_files_of_vtk_are_read_without_sets(tmp_path: Path, ending: str) -> None:
    found = block()
    meshio.write(tmp_path / f"block.{ending}", meshio.Mesh(found.points, [("tetra10", found.cells["tetra10"])]))
    assert same_body(tmp_path / f"block.{ending}", found).sets == {}


@pytest.mark.parametrize("ending", ["vtu", "vtk"])
def test_whole_numbers_of_points_and_cells_are_sets_of_vtk_files(tmp_path: Path, ending: str) -> None:
    found = block()
    faces = low_faces(found)
    cells = found.cells["tetra10"]
    mesh = meshio.Mesh(
        found.points,
        [("triangle6", faces), ("tetra10", cells)],
        point_data={"high": np.isin(np.arange(len(found.points)), found.sets["high"].nodes).astype(np.int32)},
        cell_data={"base-body": [np.zeros(len(faces), dtype=np.int32), np.ones(len(cells), dtype=np.int32)]},
    )
    # A temperature is no set.
    mesh.point_data["heat"] = np.linspace(0.0, 1.0, len(found.points))
    meshio.write(tmp_path / f"block.{ending}", mesh)
    read = same_body(tmp_path / f"block.{ending}", found)
    assert set(read.sets) == {"high", "base", "body", "base-body"}
    assert read.sets["high"].nodes.tolist() == sorted(found.sets["high"].nodes.tolist())
    assert len(read.sets["base"].faces[0]) == len(faces)


@pytest.mark.parametrize("kind", ["tetra10", "hexahedron20", "tetra", "hexahedron"])
def test_surfaces_of_abaqus_are_faces(tmp_path: Path, kind: str) -> None:
    found = block(kind=kind)
    # All faces of all elements, and those of them that are outside: the whole surface of the block.
    count = 4 if kind.startswith("tetra") else 6
    lines = "".join(f"body, S{face + 1}\n" for face in range(count))
    nodes = "*SURFACE, NAME=by_nodes, TYPE=NODE\nlow, 1.\n"
    path = write_inp(tmp_path / "block.inp", found, f"*SURFACE, NAME=skin, TYPE=ELEMENT\n{lines}{nodes}")
    read = same_body(path, found)
    assert read.sets["by_nodes"].nodes.tolist() == sorted(found.sets["low"].nodes.tolist())
    whole = solid_mesh(read, 1.0, "casings.b.mesh")
    area = 2.0 * (0.1 * 0.06 + 0.1 * 0.2 + 0.06 * 0.2)
    assert by_set(whole, "skin", "casings.b.seats.one").area == pytest.approx(area)
    # One face of one element.
    one = write_inp(tmp_path / "one.inp", found, "*SURFACE, NAME=one\n1, S2\n")
    assert len(read_mesh(one, "casings.b.mesh").sets["one"].faces[0]) == 1
    with pytest.raises(AnalysisError, match="the face S9"):
        read_mesh(write_inp(tmp_path / "bad.inp", found, "*SURFACE, NAME=one\n1, S9\n"), "casings.b.mesh")


def test_sets_of_nastran_decks_are_sets_of_nodes(tmp_path: Path) -> None:
    found = block()
    low = sorted(node + 1 for node in found.sets["low"].nodes.tolist())
    lines = ["SOL 103", f"SET 5 = {low[0]} THRU {low[2]},", " " + ", ".join(map(str, low[3:])), "BEGIN BULK"]
    lines += [f"GRID,{i + 1},,{x!r},{y!r},{z!r}" for i, (x, y, z) in enumerate(found.points.tolist())]
    for i, cell in enumerate(found.cells["tetra10"]):
        words = [str(n + 1) for n in cell]
        lines += [f"CTETRA,{i + 1},1," + ",".join(words[:6]) + ",+", "+," + ",".join(words[6:])]
    lines += ["SPC1,3,123456," + ",".join(map(str, low[:5])), "SET1,8,1,THRU,99999999"]
    (tmp_path / "block.bdf").write_text("\n".join([*lines, "ENDDATA"]))
    sets = same_body(tmp_path / "block.bdf", found).sets
    between = [node for node in range(low[0], low[2] + 1) if node not in low]
    assert [node + 1 for node in sets["set_5"].nodes.tolist()] == sorted({*low, *between})
    assert [node + 1 for node in sets["spc_3"].nodes.tolist()] == low[:5]
    assert len(sets["set_8"].nodes) == len(found.points)


def test_what_decks_put_on_a_body_beside_its_elements_is_named(tmp_path: Path) -> None:
    found = block()
    tie = "*TIE, NAME=t\na, b\n*COUPLING, REF NODE=1\n*KINEMATIC\n1, 6\n*NSET, NSET=feet, ELSET=body\n"
    deck = write_inp(tmp_path / "block.inp", found, tie)
    read = same_body(deck, found)
    assert [note.partition(";")[0] for note in read.notes] == ["Not read from the deck: TIE, COUPLING"]
    assert len(read.sets["feet"].nodes) == len(found.points)
    lines = [f"GRID,{i + 1},,{x!r},{y!r},{z!r}" for i, (x, y, z) in enumerate(found.points.tolist())]
    lines += [f"CTETRA,{i},1,{','.join(str(n + 1) for n in c[:4])}" for i, c in enumerate(found.cells["tetra10"], 1)]
    (tmp_path / "block.bdf").write_text("\n".join([*lines, "RBE2,90,1,123456,5,6", "CONM2,91,1,,2.5"]))
    (note,) = read_mesh(tmp_path / "block.bdf", "casings.b.mesh").notes
    assert note.startswith("Not read from the deck: 1 RBE2, 1 CONM2")


def test_med_files_keep_their_groups(tmp_path: Path) -> None:
    found = block()
    faces = low_faces(found)
    mesh = meshio.Mesh(
        found.points,
        [("triangle6", faces), ("tetra10", found.cells["tetra10"])],
        cell_data={"cell_tags": [np.full(len(faces), -3), np.full(len(found.cells["tetra10"]), -4)]},
    )
    mesh.cell_tags = {-3: ["low", "feet"], -4: ["body"]}
    meshio.write(tmp_path / "block.med", mesh)
    read = same_body(tmp_path / "block.med", found)
    assert len(read.sets["feet"].nodes) == len(read.sets["low"].nodes) == 9


@pytest.mark.parametrize("large", [False, True])
def test_a_nastran_deck_without_begin_bulk_is_read(tmp_path: Path, large: bool) -> None:
    found = block()
    lines = ["$ a mesher's deck"]
    for i, (x, y, z) in enumerate(found.points):
        if large:
            lines += [f"GRID*   {i + 1:<16d}{'':16}{x:<16.8g}{y:<16.8g}*G{i}", f"*G{i}".ljust(8) + f"{z:<16.8g}"]
        else:
            text = "".join(f"{value:.3e}".replace("e-0", "-").replace("e+0", "+").ljust(8) for value in (x, y, z))
            lines.append(f"GRID    {i + 1:<8d}{'':8}{text}")
    for i, cell in enumerate(found.cells["tetra10"]):
        words = [f"{n + 1:<8d}" for n in cell]
        lines += [f"CTETRA  {i + 1:<8d}{1:<8d}" + "".join(words[:6]) + "+", "+       " + "".join(words[6:])]
    lines += [
        f"CTRIA6,{900 + i},7," + ",".join(str(n + 1) for n in face[:6]) for i, face in enumerate(low_faces(found))
    ]
    path = tmp_path / "block.bdf"
    path.write_text("\n".join([*lines, "ENDDATA"]))
    assert len(same_body(path, found).sets["property_7"].nodes) == 9


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.inp", "*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=COH3D8\n1, 1\n", "elements of the type COH3D8"),
        ("a.inp", "*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n", "node 2 is named but not given"),
        ("a.inp", "*HEADING\n", "no *NODE"),
        ("a.msh", "no mesh", "can't be read"),
        ("a.xyz", "no mesh", "can't be read"),
        ("a.bdf", "CEND\n", "no GRID"),
        ("a.bdf", "GRID,1,,0.,0.,0.\nCBAR,9,2,1,2\n", "CBAR 9 is a beam or a shell"),
        ("a.bdf", "GRID,1,,0.,0.,0.\nINCLUDE 'rest.bdf'\n", "it includes another file"),
        ("a.inp", "*NODE, SYSTEM=C\n1, 0, 0, 0\n", "a coordinate system of their own"),
        ("a.inp", "*SYSTEM\n0, 0, 0\n*NODE\n1, 0, 0, 0\n", "a coordinate system of their own"),
    ],
)
def test_a_file_that_can_not_be_read_is_a_sentence(tmp_path: Path, name: str, text: str, words: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(AnalysisError, match=words.replace("*", r"\*")) as error:
        read_mesh(tmp_path / name, "casings.b.mesh")
    assert str(error.value).startswith("casings.b.mesh: ")
    assert "Export it as" in str(error.value)


def test_a_reader_that_ends_the_process_is_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def leaves(path: Path) -> None:
        print("Error: no such cell")
        raise SystemExit(1)

    monkeypatch.setattr(meshio, "read", leaves)
    (tmp_path / "a.vtu").write_text("")
    with pytest.raises(AnalysisError, match="no such cell"):
        read_mesh(tmp_path / "a.vtu", "casings.b.mesh")


def test_a_missing_file_is_told_with_the_nearest(tmp_path: Path) -> None:
    (tmp_path / "box.msh").write_text("")
    with pytest.raises(AnalysisError, match=r"Did you mean 'box\.msh'"):
        read_mesh(tmp_path / "bax.msh", "casings.b.mesh")
