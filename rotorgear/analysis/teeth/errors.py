"""Error estimates of a mesh analysis: the same on a coarser mesh of the same kind.

The two differ by the error of the coarser one less that of the finer one. What remains of it on the finer mesh was measured
on spur and helical pairs, and docs/mesh.md shows estimates beside errors. What lies between the positions of the cycle is not
in them: both meshes are sampled alike.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.gears.loaded.tooth_contact import in_space
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.settings import coarser_size
from rotorgear.results.mesh import MeshErrors

# Shares in the plane and in space, where the default mesh and the fine one lie close together.
_REMAINING = {"preview": (1.5, 1.5), "default": (0.35, 0.35), "fine": (0.6, 3.5)}


def coarser(teeth: ToothPair) -> ToothPair | None:
    """The same teeth on a coarser mesh; None for uncoupled slices, whose error no mesh of theirs can show."""
    space, uncoupled = in_space(teeth)
    if uncoupled:
        return None
    size = coarser_size(teeth.fe, teeth.width / teeth.first.normal_module, space=space)
    return replace(teeth, fe=replace(teeth.fe, size=size))


def estimated(
    teeth: ToothPair, k: np.ndarray, error: np.ndarray, other_k: np.ndarray, other_error: np.ndarray
) -> MeshErrors:
    """Estimates from stiffness and transmission error (p,) of the teeth and of the same on the coarser mesh."""
    share = 1.0 if teeth.fe.size is not None else _REMAINING[teeth.fe.preset][in_space(teeth)[0]]

    def relative(one: float, other: float) -> float:
        return share * abs(other - one) / max(abs(one), 1e-300)

    mean = relative(float(k.mean()), float(other_k.mean()))
    # A ripple is not known better than the mean: its two errors may cancel between two meshes.
    return MeshErrors(
        mean,
        max(mean, relative(float(np.ptp(k)), float(np.ptp(other_k)))),
        max(mean, relative(float(np.ptp(error)), float(np.ptp(other_error)))),
    )
