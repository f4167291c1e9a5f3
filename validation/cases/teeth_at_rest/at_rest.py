"""Shafts and loads along the faces at rest, and the same by other ways.

line        a rigid pinion on a bearing that gives way to tilting only, teeth as a line of springs over the face:
            f = b F L/k_b / (1 + k b^2/(12 k_b)),  K_Hbeta = 1 + k f/(2 F), while the whole face carries
overhung    models/overhung_pinion.toml; `positions_apart` finds its misalignment without Newton's method and without tangents:
            a root of f - f_0 - b c M(f; u) at each position u of the mesh cycle alone, f_0 and c of the structure with the
            load in the middle of the face
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import brentq

import rotorgear as rg
from rotorgear.analysis.static.along_faces import misalignments
from rotorgear.analysis.static.solve import equilibrate
from rotorgear.gears.loaded.mesh_cycle import loaded_cycle
from rotorgear.results.static import StaticResult
from rotorgear.system.system import System

_MODELS = Path(__file__).resolve().parents[3] / "models"
# Positions of the mesh cycle for the roots.
_POSITIONS = 16


def measure(quantity: str, mode: str) -> float:
    """A number of `mode`: line, overhung, or overhung alone, which is the pair with the misalignment found given to it."""
    if mode == "overhung alone":
        changed = overhung().with_("meshes.stage.misalignment", found("overhung").faces[0].misalignment_m)
        return 1e-6 * rg.mesh(changed, estimate=False).helix[0].largest_pressure_pa
    result = found(mode)
    face = result.faces[0]
    numbers = {
        "misalignment in um": 1e6 * face.misalignment_m,
        "face load factor": face.face_load_factor,
        "largest pressure in MPa": 1e-6 * (face.peak_pressure_pa or 0.0),
    }
    return float(numbers[quantity] or 0.0)


def overhung() -> rg.Model:
    """The model of the docs."""
    return rg.load(_MODELS / "overhung_pinion.toml")


def line() -> rg.Model:
    """A spur pinion of 24 teeth, module 4 mm, face 30 mm, 80 mm beside what holds it with 1e6 N m/rad; mesh 4e8 N/m; 200 N m."""
    gear: dict[str, Any] = {"kind": "spur", "normal_module": "4 mm", "width": "30 mm", "at": "100 mm"}
    section = {"length": "200 mm", "outer_diameter": "50 mm", "rigid": True}
    held = {"at": "20 mm", "fixed": ["x", "y", "z"]}
    return rg.Model(
        operation={"input_shaft": "one", "output_shaft": "two", "speed": "1000 rpm", "torque": "200 N m"},
        shafts={
            "one": {"position": ["0 mm", "0 mm"], "sections": [section]},
            "two": {"position": ["120 mm", "0 mm"], "sections": [section]},
        },
        gears={"pinion": {"shaft": "one", "teeth": 24, **gear}, "wheel": {"shaft": "two", "teeth": 36, **gear}},
        meshes={"pair": {"pinion": "pinion", "gear": "wheel", "stiffness": "4e8 N/m", "tilt": True}},
        supports={
            "bearing": {"shaft": "one", **held, "stiffness": {"tilt": "1e6 N m/rad"}},
            "wheel": {"shaft": "two", "at": "20 mm", "fixed": ["x", "y", "z", "tilt_x", "tilt_y"]},
        },
    )


@cache
def found(name: str) -> StaticResult:
    """Statics of the model of that name."""
    return rg.static(line() if name == "line" else overhung())


def positions_apart(model: rg.Model) -> np.ndarray:
    """Misalignment (p,) in m of the only mesh at each position by itself, from the pair alone and the tilt of its shafts."""
    apart = model.with_("meshes.stage.tilt", False)
    state = equilibrate(System(apart, state=apart.torque_flow().of_kind("static")), 0.0)
    tilt = state.lines.tilt
    # A couple along the face turns no shaft: the mesh force stays, and the structure tilts by c for each N m.
    c = float((tilt.T @ state.solver.solve(tilt))[0, 0])
    f_0 = float(misalignments(state)[0])
    mesh = model.layout.mesh("stage")

    def left_over(f: float, u: float) -> float:
        teeth = replace(mesh.teeth, misalignment=f)
        moment = loaded_cycle(teeth, float(state.force[0]), np.array([u]))[1].moment[0]
        return f - f_0 - mesh.width * c * moment

    positions = np.arange(_POSITIONS) / _POSITIONS
    return np.array([brentq(left_over, -1e-4, 2.0 * f_0, args=(u,), xtol=1e-10) for u in positions])


if __name__ == "__main__":
    each = 1e6 * positions_apart(overhung())
    print(f"each position by itself: {each.mean():.3f} um in the mean, {each.min():.3f} to {each.max():.3f} um")
    print(f"statics:                 {measure('misalignment in um', 'overhung'):.3f} um")
