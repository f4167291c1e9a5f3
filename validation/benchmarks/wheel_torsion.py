"""A shaft with a web wheel in torsion against 3D elements: python -m validation.benchmarks.wheel_torsion [NAME ...]

The wheel of `models/web_wheel.toml` and others on their shaft, whose one end is held; the pinion is held too, so that the mesh is
a spring k r_b^2 on the rotation of the root circle. The reference is a thin wedge of shaft and wheel in one piece, quadratic
hexahedra with 27 nodes from `rotorgear/casings`, whose two cuts move round the axis only: its lowest modes are those in torsion.
Teeth are a ring up to the reference circle, as in the mass of the model.

Each wheel is looked at twice. `rigid`: the stretch of shaft within the hub is rigid in both models, so that what differs is what
the rotor model makes of web, hub and rim. `elastic`: in 3D the hub then stiffens the shaft that it is grown together with, and a
gear at one place of a shaft does not.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import eigsh

import rotorgear as rg
from rotorgear.casings.assembly import Elastic, assemble
from rotorgear.casings.elements import element
from rotorgear.casings.solid_mesh import SolidMesh
from tests.paths import ROOT

# Angle of the wedge, radius of the bore that keeps elements off the axis, and largest side of an element.
WEDGE = 0.08
CORE = 2e-3
SIDE = 4e-3
MODES = 2
LOW = 2000.0  # the search begins below this frequency in Hz

# What is changed in the file: the wheel's blank, or its shaft.
LONG = [{"length": "80 mm", "outer_diameter": "70 mm"}, {"length": "240 mm", "outer_diameter": "70 mm"}]
CASES: dict[str, dict[str, object]] = {
    "as in the file": {},
    "web of 3.2 mm": {"gears.wheel.body.web_thickness": "3.2 mm"},
    "web flush with an end": {"gears.wheel.body.web_position": "12.8 mm"},
    "rim of 18 mm, web of 10 mm": {
        "gears.wheel.body.rim_thickness": "18 mm",
        "gears.wheel.body.web_thickness": "10 mm",
    },
    "long shaft": {"shafts.output.sections": LONG},
    "long shaft, web of 3.2 mm": {"shafts.output.sections": LONG, "gears.wheel.body.web_thickness": "3.2 mm"},
    "long shaft, flush web": {"shafts.output.sections": LONG, "gears.wheel.body.web_position": "12.8 mm"},
}
Rectangle = tuple[float, float, float, float]


def held_model(changes: dict[str, object]) -> rg.Model:
    """In torsion, the pinion's shaft and one end of the wheel's shaft held."""
    held = {"shaft": "input", "fixed": ["torsion"]}
    supports = {place: {**held, "at": place} for place in ("start", "end")}
    supports["pinion"] = {**held, "at": "90 mm"}
    supports["wheel"] = {"shaft": "output", "at": "end", "fixed": ["torsion"]}
    file = rg.load(ROOT / "models" / "web_wheel.toml")
    return file.with_({"motions": ["torsion"], "gears.pinion.width": "32 mm", "supports": supports, **changes})


def program_hz(model: rg.Model) -> np.ndarray:
    """Lowest frequencies (MODES,) of the rotor model."""
    return np.asarray(rg.modal(model, modes=MODES).frequency_hz)


def rigid_in_hub(model: rg.Model) -> rg.Model:
    """The model with a shaft that is rigid within the hub."""
    wheel = model.layout.gear("wheel")
    half = 0.5 * wheel.blank.hub_width
    low = wheel.places[0][1] - half
    sections = []
    start = float(model.shafts["output"].start)
    for section in model.shafts["output"].sections:
        end = start + section.length
        places = [start, *(place for place in (low, low + 2.0 * half) if start < place < end), end]
        for a, b in pairwise(places):
            stiff = {"rigid": True} if low - 1e-9 < a and b < low + 2.0 * half + 1e-9 else {}
            sections.append({"length": b - a, "outer_diameter": section.outer_diameter, **stiff})
        start = end
    return model.with_({"shafts.output.sections": sections})


def reference_hz(model: rg.Model, *, rigid: bool, side: float = SIDE) -> np.ndarray:
    """The same of the wedge; rigid: whether the shaft within the hub is."""
    wheel = model.layout.gear("wheel")
    material = wheel.material
    assert wheel.geometry is not None
    root = 0.5 * wheel.geometry.root_diameter
    mesh, rectangles = _wedge(model, side)
    matrices = assemble(mesh, Elastic(material.youngs_modulus, material.nu, material.density))

    # Polar components (radial, clockwise, axial); on the cuts the clockwise one is left.
    x, y, z = mesh.points.T
    angle = np.arctan2(y, x)
    radius = np.hypot(x, y)
    turn = np.zeros((len(x), 3, 3))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(angle)
    turn[:, 1, 0] = np.sin(angle)
    turn[:, 0, 1] = -np.sin(angle)
    turn[:, 2, 2] = 1.0
    n = np.arange(len(x))
    T = sp.bsr_array((turn, n, np.arange(len(x) + 1)))
    free = np.ones((len(x), 3), bool)
    free[np.abs(np.abs(angle) - 0.5 * WEDGE) < 1e-9] = (False, True, False)
    free[z > max(z) - 1e-9] = False  # the held end of the shaft
    T = sp.csc_array(T)
    if rigid:
        # There all nodes turn with one at the surface.
        inner = wheel.blank.bore_radius + 1e-9
        inside = np.flatnonzero(
            (radius < inner) & (np.abs(z - wheel.places[0][1]) < 0.5 * wheel.blank.hub_width + 1e-9)
        )
        master = inside[np.argmax(radius[inside])]
        free[inside] = False
        free[master, 1] = True
        follow = sp.eye_array(3 * len(x), format="lil")
        follow[3 * inside + 1, 3 * inside + 1] = 0.0
        follow[3 * inside + 1, 3 * master + 1] = radius[inside] / radius[master]
        T = sp.csc_array(T @ follow)
    T = T[:, np.flatnonzero(free)]
    K = sp.csc_array(T.T @ matrices.stiffness @ T)
    M = sp.csc_array(T.T @ sp.kron(matrices.mass, sp.eye_array(3)) @ T)

    # The mesh holds the mean rotation of the root circle over the face.
    force = next(iter(model.torque_flow().forces))
    spring = force.contact.stiffness * wheel.geometry.base_radius**2 * WEDGE / (2.0 * math.pi)
    low, high = rectangles[-1][2:]
    on_circle = np.flatnonzero(
        (np.abs(radius - root) < 1e-9) & (np.abs(angle) < 1e-9) & (z > low - 1e-9) & (z < high + 1e-9)
    )
    on_circle = on_circle[np.argsort(z[on_circle])]
    mean = np.zeros((len(x), 3))
    mean[on_circle, 1] = _line_weights(z[on_circle]) / (high - low) / root
    row = sp.csc_array(mean.reshape(1, -1)[:, free.ravel()])
    found = eigsh(
        K + spring * (row.T @ row), MODES, M, sigma=(2.0 * math.pi * LOW) ** 2, which="LM", return_eigenvectors=False
    )
    return np.sort(np.sqrt(found)) / (2.0 * math.pi)


def _wedge(model: rg.Model, side: float) -> tuple[SolidMesh, list[Rectangle]]:
    """Mesh of the wedge, and the rectangles (radii, places along the axis) of its section; the rim comes last."""
    wheel = model.layout.gear("wheel")
    assert wheel.geometry is not None
    place = wheel.places[0][1]
    blank = wheel.blank
    half = 0.5 * float(wheel.part.width or 0.0)
    root = 0.5 * wheel.geometry.root_diameter
    rectangles: list[Rectangle] = []
    start = float(model.shafts["output"].start)
    for section in model.shafts["output"].sections:
        end = start + section.length
        rectangles.append((CORE, 0.5 * section.outer_diameter, start, end))
        start = end
    web = place + blank.web_position
    hub = 0.5 * blank.hub_width
    rectangles.append((blank.bore_radius, blank.hub_radius, place - hub, place + hub))
    rectangles.append(
        (blank.hub_radius, blank.rim_radius, web - 0.5 * blank.web_thickness, web + 0.5 * blank.web_thickness)
    )
    rectangles.append((blank.rim_radius, 0.5 * wheel.geometry.reference_diameter, place - half, place + half))
    r = _lines([*(end for one in rectangles for end in one[:2]), root], side)
    z = _lines([*(end for one in rectangles for end in one[2:]), place], side)

    # Three by three by three nodes on a lattice twice as fine; those of no cell are left out.
    i, j = np.meshgrid(np.arange(len(r) - 1), np.arange(len(z) - 1), indexing="ij")
    middle = (0.5 * (r[i] + r[i + 1]), 0.5 * (z[j] + z[j + 1]))
    inside = np.zeros(i.shape, bool)
    for inner, outer, low, high in rectangles:
        inside |= (middle[0] > inner) & (middle[0] < outer) & (middle[1] > low) & (middle[1] < high)
    corner = np.stack([i[inside], np.zeros(inside.sum(), int), j[inside]], -1)
    step = np.rint(2.0 * element("hexahedron27").nodes).astype(int)
    lattice = 2 * corner[:, None, :] + step
    used, cells = np.unique(lattice.reshape(-1, 3), axis=0, return_inverse=True)
    rr = _with_middles(r)[used[:, 0]]
    angle = 0.5 * WEDGE * (used[:, 1] - 1)
    points = np.stack([rr * np.cos(angle), rr * np.sin(angle), _with_middles(z)[used[:, 2]]], -1)
    return SolidMesh(points, cells.reshape(-1, 27), "hexahedron27", {}), rectangles


def _lines(ends: Sequence[float], side: float) -> np.ndarray:
    """Lines through all ends, no farther apart than `side` and two elements at least between them."""
    ends = np.unique(np.round(ends, 9))
    found = [ends[:1]]
    for low, high in pairwise(ends):
        found.append(np.linspace(low, high, max(2, math.ceil((high - low) / side)) + 1)[1:])
    return np.concatenate(found)


def _with_middles(lines: np.ndarray) -> np.ndarray:
    return np.sort(np.concatenate([lines, 0.5 * (lines[1:] + lines[:-1])]))


def _line_weights(z: np.ndarray) -> np.ndarray:
    """Integrals of quadratic shape functions along a rising line of nodes (2 e + 1,)."""
    weight = np.zeros(len(z))
    for k in range(0, len(z) - 1, 2):
        weight[k : k + 3] += (z[k + 2] - z[k]) * np.array([1.0, 4.0, 1.0]) / 6.0
    return weight


def main(names: Sequence[str]) -> None:
    """Print frequencies of both models."""
    print(f"{'wheel':28}{'in the hub':12}{'3D elements, Hz':>18}{'rotor model, Hz':>18}  difference")
    for name, changes in CASES.items():
        if names and name not in names:
            continue
        for rigid in (True, False):
            model = rigid_in_hub(held_model(changes)) if rigid else held_model(changes)
            ours = program_hz(model)
            truth = reference_hz(model, rigid=rigid)
            apart = " ".join(f"{100.0 * (a / b - 1.0):+6.2f}%" for a, b in zip(ours, truth, strict=True))
            print(f"{name:28}{'rigid' if rigid else 'elastic':12}{_words(truth)}{_words(ours)}  {apart}", flush=True)


def _words(values: np.ndarray) -> str:
    return f"{'  '.join(f'{value:6.0f}' for value in values):>18}"


if __name__ == "__main__":
    main(sys.argv[1:])
