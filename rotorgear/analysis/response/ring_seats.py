"""What rings that stand in casings put on their seats.

A seat carries its ring rigidly, q_ring = A q_seat about the point of the seat, and no element stands between both: the seat
feels what is missing for equilibrium at the ring, over its own motions

    -Aᵀ (Σ v F + Σ v_t N + α M q' + M q''),

with the forces F and the moments N of its meshes along the face. Nothing else can be on such a ring.
"""

from __future__ import annotations

import numpy as np

from rotorgear.system.assembly import assemble
from rotorgear.system.contacts import ContactLines
from rotorgear.system.system import System


class RingSeats:
    """The seats of a system that rings stand in: `names` of them, such as "box.ring"."""

    def __init__(self, system: System) -> None:
        layout = system.layout
        seats = dict.fromkeys((casing, number) for casing, number, _ in layout.ring_seats.values())
        rings = {f"gears.{name}" for name in layout.ring_seats}
        M = assemble([group for group in system.groups if group.part in rings], system.dofs, lambda g: g.matrices.mass)
        T = system.dofs.transform
        self.names = tuple(f"{casing}.{layout.casing(casing).seats[number]}" for casing, number in seats)
        rows = [T[system.nodes.of_seat(*seat), :].indices for seat in seats]
        # The motions of seats are free ones, x y z tilt_x tilt_y torsion of each.
        self._of_seats = np.array(rows, dtype=int).ravel()
        self._mass = M.tocsr()[self._of_seats, :]
        self._alpha = system.model.damping.rayleigh_alpha
        self._beta = system.model.damping.rayleigh_beta

    def read(
        self,
        lines: ContactLines,
        force: np.ndarray,
        couple: np.ndarray,
        w: np.ndarray,
        q: np.ndarray,
        brake: np.ndarray | None,
    ) -> np.ndarray:
        """Amplitudes (o, s, 6) of force, and moment about the point, on each seat.

        Args:
            lines: the contacts. force: on their flanks, (o, c).
            couple: of loaded teeth, beside their resistance to tilts, (o, c).
            w: frequencies (o,) in rad/s. q: displacements (n, o).
            brake: accelerations (n, o) that the damping of modes acts as.
        """
        moment = couple.T + (1.0 + 1j * w * self._beta) * (lines.tilt_stiffness[:, None] * (lines.tilt.T @ q))
        moved = (1j * w * self._alpha - w**2) * q
        if brake is not None:
            moved = moved + brake
        whole = lines.vectors[self._of_seats] @ force.T + lines.tilt[self._of_seats] @ moment + self._mass @ moved
        return -whole.T.reshape(len(w), -1, 6)
