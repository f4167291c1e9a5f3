"""Tilt stiffness of a mesh against two half-width meshes: natural frequencies of models/helical_pair.toml.

    python -m validation.benchmarks.two_half_meshes

A face of width b that carries evenly with the stiffness k resists a tilt with k b^2/12, as two meshes of k/2 do at
+-b/(2 sqrt 3) from its middle: the two points of Gauss's quadrature, exact for it. Here these two are put together by hand,
from the positions of the axes, the normal of the flanks in space, and each contact point as an arm from the node of its gear,
none of it by elements/gear_mesh.py; shafts, bearings and bodies are the model's. Printed are the frequencies without a tilt
stiffness, with the two half meshes, with `tilt = true`, the change by them, and `rotorgear modal` about the load.

Two meshes of the whole k in place of k/2 would give 2.47 %.
"""

from __future__ import annotations

import math

import numpy as np
import scipy.linalg as la

import rotorgear as rg
from rotorgear.system.assembly import assemble
from rotorgear.system.plan import Plan
from tests.paths import MODELS

ELEMENTS = 8
HIGHEST = 3300.0


def flank_row(model: rg.Model, z: float) -> np.ndarray:
    """Approach (12,) of the flanks at a place z of the face from the displacements of both gears, in x y z tx ty tz.

    A right-hand pinion that turns about +z pushes the wheel: its tooth's normal points along the line of action in the transverse
    plane, rotated by the base helix angle towards -z.
    """
    pinion = model.gears["pinion"]
    wheel = model.gears["wheel"]
    first, second = (np.array([*model.shafts[name].position, 0.0]) for name in ("input", "output"))
    m_n, beta, alpha_n = 0.003, math.radians(20.0), math.radians(20.0)
    alpha_t = math.atan(math.tan(alpha_n) / math.cos(beta))
    r_b1, r_b2 = (0.5 * g.teeth * m_n / math.cos(beta) * math.cos(alpha_t) for g in (pinion, wheel))
    beta_b = math.asin(math.sin(beta) * math.cos(alpha_n))
    centres = second - first
    distance = float(np.linalg.norm(centres))
    working = math.acos((r_b1 + r_b2) / distance)
    e = centres / distance
    across = np.array([-e[1], e[0], 0.0])
    sense = math.copysign(1.0, model.torque_flow(1).forces[0].torque_sense)
    n = math.cos(beta_b) * (sense * math.cos(working) * across + math.sin(working) * e)
    n[2] = -sense * math.sin(beta_b)
    pitch_point = first + r_b1 / math.cos(working) * e + np.array([0.0, 0.0, z])
    return np.concatenate([n, np.cross(pitch_point - first, n), -n, -np.cross(pitch_point - second, n)])


def frequencies(K: np.ndarray, M: np.ndarray) -> np.ndarray:
    """Natural frequencies in Hz, rising."""
    return np.sqrt(np.maximum(la.eigh(K, M, eigvals_only=True), 0.0)) / (2.0 * np.pi)


def main() -> None:
    model = rg.load(MODELS / "helical_pair.toml")
    k = 9.4e8
    width = 0.042
    assert model.meshes["stage"].stiffness == k
    system = rg.System(model, plan=Plan(ELEMENTS))
    M = system.mass.toarray()
    rest = [group for group in system.groups if not group.part.startswith("meshes.")]
    shafts = assemble(rest, system.dofs, lambda group: group.matrices.stiffness).toarray()
    (mesh,) = [group for group in system.groups if group.part.startswith("meshes.")]
    T = system.dofs.transform.toarray()[mesh.dofs[0][:12]]

    def half(z: float) -> np.ndarray:
        v = T.T @ flank_row(model, z)
        return 0.5 * k * np.outer(v, v)

    place = width / (2.0 * math.sqrt(3.0))
    one = frequencies(shafts + half(0.0) + half(0.0), M)
    two = frequencies(shafts + half(-place) + half(place), M)
    tilted = model.with_({"meshes.stage.tilt": True})
    felt = rg.System(tilted, plan=Plan(ELEMENTS))
    own = frequencies(felt.stiffness().toarray(), felt.mass.toarray())
    ours = frequencies(system.stiffness().toarray(), M)
    about = rg.modal(tilted, fmax=HIGHEST, elements=ELEMENTS).frequency_hz
    print("mode  one spring  two halves  tilt = true  change   about the load")
    for i, (a, b, c) in enumerate(zip(one, two, own, strict=False)):
        if a > HIGHEST:
            break
        under = f"{about[i]:11.3f}" if i < len(about) else ""
        print(
            f"{i + 1:4d}  {a:10.3f}  {b:10.3f}  {c:11.3f}  {100.0 * (b / a - 1.0) if a > 1.0 else 0.0:5.2f} %  {under}"
        )
    few = int(np.sum(one <= HIGHEST))
    changes = two[1:few] / one[1:few] - 1.0
    print(f"largest change below {HIGHEST:g} Hz: {100.0 * changes.max():.2f} %")
    print(f"one spring against the model's own: {np.abs(one[1:few] / ours[1:few] - 1.0).max():.1e}")
    print(f"two halves against tilt = true: {np.abs(two[1:few] / own[1:few] - 1.0).max():.1e}")


if __name__ == "__main__":
    main()
