"""Makes models/split_torque_casing.msh, the casing of the split-torque gearbox, with Gmsh (pip install gmsh).

    python validation/studies/split_torque_casing.py models/split_torque_casing.msh

rotorgear itself does not need Gmsh. No source shows this casing: it is a plain one that fits the layout. A welded box of 25 mm
plate with a wall between the stages, on four feet; bearings sit in bosses 30 mm wide whose bores lie on the axes of the shafts.
Lengths in mm. The file has linear tetrahedra, so that it is small; rotorgear raises their order.
"""

from __future__ import annotations

import sys

import gmsh

# Inside of the box, and its plates.
INSIDE = (-150.0, -385.0, -168.0, 750.0, 385.0, 381.0)
PLATE = 25.0
# The wall between the stages: its left face.
WALL = 89.0
# Seats: axis x y, middle along z, radius of the bore, and the z from which the boss grows out of its wall.
INPUT = (0.0, 0.0)
BRANCHES = {"branch_a": (112.7276401, 195.25), "branch_b": (112.7276401, -195.25)}
OUTPUT = (427.6220007, 0.0)
SEATS = {
    "input_left": (*INPUT, -153.0, 55.0, -184.0),
    "input_right": (*INPUT, 153.0, 55.0, WALL),
    "branch_a_left": (*BRANCHES["branch_a"], -105.0, 60.0, -184.0),
    "branch_a_right": (*BRANCHES["branch_a"], 365.0, 60.0, 397.0),
    "branch_b_left": (*BRANCHES["branch_b"], -105.0, 60.0, -184.0),
    "branch_b_right": (*BRANCHES["branch_b"], 365.0, 60.0, 397.0),
    "output_left": (*OUTPUT, 104.0, 90.0, WALL),
    "output_right": (*OUTPUT, 354.0, 90.0, 397.0),
}
SEAT_WIDTH = 30.0
BOSS = 22.0  # thickness of a boss around its bore
FEET = (90.0, 24.0, 140.0)  # along x, y and z
SIZE = 120.0  # of the elements


def make(path: str) -> None:
    """Draw the casing, mesh it and write the file."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    occ = gmsh.model.occ
    x0, y0, z0, x1, y1, z1 = INSIDE
    outer = occ.addBox(
        x0 - PLATE, y0 - PLATE, z0 - PLATE, x1 - x0 + 2 * PLATE, y1 - y0 + 2 * PLATE, z1 - z0 + 2 * PLATE
    )
    inner = occ.addBox(x0, y0, z0, x1 - x0, y1 - y0, z1 - z0)
    shell, _ = occ.cut([(3, outer)], [(3, inner)])
    added = [(3, occ.addBox(x0, y0, WALL, x1 - x0, y1 - y0, PLATE))]
    holes = [(3, occ.addCylinder(*axis, WALL - 10.0, 0.0, 0.0, PLATE + 20.0, 75.0)) for axis in BRANCHES.values()]
    for x, y, middle, radius, root in SEATS.values():
        end = middle + (0.5 * SEAT_WIDTH if middle > root else -0.5 * SEAT_WIDTH)
        added.append((3, occ.addCylinder(x, y, root, 0.0, 0.0, end - root, radius + BOSS)))
        # The seat itself, and a passage for the shaft through what is left of boss and wall.
        holes.append((3, occ.addCylinder(x, y, middle - 0.5 * SEAT_WIDTH, 0.0, 0.0, SEAT_WIDTH, radius)))
        holes.append(
            (3, occ.addCylinder(x, y, min(root, middle) - 40.0, 0.0, 0.0, abs(middle - root) + 80.0, radius - 6.0))
        )
    along, high, deep = FEET
    added += [
        (3, occ.addBox(x, y0 - PLATE - high, z, along, high, deep))
        for x in (x0 - PLATE, x1 + PLATE - along)
        for z in (z0 - PLATE, z1 + PLATE - deep)
    ]
    body, _ = occ.fuse(shell, added)
    body, _ = occ.cut(body, holes)
    occ.synchronize()
    assert len(body) == 1, "one body"
    faces = {name: [] for name in (*SEATS, "feet")}
    for _, face in gmsh.model.getEntities(2):
        a0, b0, c0, a1, b1, c1 = gmsh.model.getBoundingBox(2, face)
        if b1 < y0 - PLATE - high + 1.0:
            faces["feet"].append(face)
        for name, (x, y, middle, radius, _) in SEATS.items():
            is_bore = abs(c1 - c0 - SEAT_WIDTH) < 0.5 and abs(0.5 * (c0 + c1) - middle) < 0.5
            if (
                is_bore
                and abs(0.5 * (a0 + a1) - x) < 1.0
                and abs(0.5 * (b0 + b1) - y) < 1.0
                and a1 - a0 < 2 * radius + 1.0
            ):
                faces[name].append(face)
    for number, (name, found) in enumerate(faces.items(), 2):
        assert found, f"no face for {name}"
        gmsh.model.addPhysicalGroup(2, found, number, name)
    gmsh.model.addPhysicalGroup(3, [tag for _, tag in body], 1, "casing")
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.3 * SIZE)
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 10)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.model.mesh.generate(3)
    gmsh.write(path)
    gmsh.finalize()


if __name__ == "__main__":
    make(sys.argv[1])
