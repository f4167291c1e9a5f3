"""How the loaded teeth of a helix carry along their face, mean of the mesh cycle: force, moment, tangents, load per width.

At each position u the contact answers to a change of approach and tilt with d(F, M) = T(u) d(delta, tilt), a spring k at the
place e and one against tilt, k_t, about it (`stiffness/face_load.py`). Under a load that is the same at all positions the
deflections of the cycle are averaged,

    delta = <F/k + ...>:    1/k = <1/k(u)>,    e = <e(u)>,    k_t = <k_t(u)>,

which is what statics meets. Small motions about the load meet the mean of T(u) itself.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from rotorgear.gears.loaded.helix_cycles import helix_cycle
from rotorgear.gears.loaded.mesh_cycle import MeshCycle
from rotorgear.gears.stiffness.face_load import FaceLoad, FaceSpring
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair

# Positions of a mesh period, as many as the stiffness of a model takes.
_POSITIONS = 64
# Places along the face at which the load per width is told; a coarser contact line has fewer slices.
_PLACES = 32


@lru_cache(maxsize=64)  # equal helices, and every analysis about the same state, ask for the same faces
def loaded_face(teeth: ToothPair, force: float, positions: int = _POSITIONS) -> FaceLoad:
    """Solve the loaded contact over the mesh cycle for the misalignment of a pair.

    Args:
        teeth: one helix, along the path of contact; its `misalignment` is that of the state.
        force: mean force (N) along the flank normal.
        positions: in a mesh period.

    Raises:
        AnalysisError: teeth that can't be made, meshed or brought into contact.
        ConvergenceError: a position has no solution to the tolerance.
        MissingExtraError: scikit-fem is needed and not installed.
    """
    cosine = float(np.cos(teeth.pair.base_helix_angle))
    found = helix_cycle(teeth, force * cosine, positions)
    cycle = found.cycle
    # A tilt that closes the flanks at larger z.
    tangents = cycle.along_face * np.array([1.0, -1.0])
    place = tangents[:, 0, 1] / tangents[:, 0, 0]
    against_tilt = tangents[:, 1, 1] - place * tangents[:, 0, 1]
    deflection, moment = found.mean(np.stack([cycle.deflection, cycle.moment], axis=1))
    # Tangents step where pairs come and go: straight between positions.
    springs = np.stack([1.0 / tangents[:, 0, 0], place, against_tilt], axis=1)
    compliance, mean_place, mean_against_tilt = cycle.weight @ springs
    k, k_tilt, _, tilt_tilt = cycle.weight @ tangents.reshape(-1, 4)
    z, line_load = load_per_width(cycle, teeth.width, min(_PLACES, found.problem.slices))
    largest = int(np.argmax(line_load))
    return FaceLoad(
        width=teeth.width,
        misalignment=teeth.misalignment,
        force=force,
        moment=float(moment),
        approach=cosine * float(deflection),
        static=FaceSpring(1.0 / float(compliance), float(mean_place), float(mean_against_tilt)),
        dynamic=FaceSpring(float(k), float(k_tilt / k), float(tilt_tilt - k_tilt**2 / k)),
        z=z,
        line_load=line_load,
        load_factor=float(line_load[largest] * teeth.width / force),
        peak_place=float(z[largest]),
        peak_pressure=float(cycle.pressure.max()),
        warnings=found.problem.warnings + cycle.warnings,
    )


def load_per_width(cycle: MeshCycle, width: float, places: int) -> tuple[np.ndarray, np.ndarray]:
    """Normal force per width of all pairs, mean of the cycle, at the middles of equal stretches of the face.

    Returns:
        z (n,) from the middle of the face (m), and N/m (n,).
    """
    edges = np.linspace(-0.5 * width, 0.5 * width, places + 1)
    slices = cycle.slices
    middle = slices.z @ slices.weight
    # A slice carries evenly along its length: what stands left of each edge, and the differences of that.
    left = np.clip((edges - middle[:, None]) / slices.length[:, None] + 0.5, 0.0, 1.0)
    force = np.diff((cycle.force * cycle.weight[slices.position]) @ left)
    return 0.5 * (edges[1:] + edges[:-1]), np.asarray(force / np.diff(edges))
