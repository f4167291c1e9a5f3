"""Damping of a contact over its regularisation depth and beyond, and the momentum that it takes up on the way."""

from __future__ import annotations

import pytest
from scipy.integrate import quad

from rotorgear.forces.mesh_contact import MeshContact


def damper(kind: str, depth: float) -> float:
    """Damping force for a rate of 1 m/s at a depth, of contact without stiffness that may pull."""
    law = MeshContact(0.0, 800.0, 1.0, contact_damping=kind, ramp=4e-6)
    return float(law.evaluate([depth], [1.0]).force[0])


def test_damping_grows_over_its_depth_and_stays_or_goes_on_growing_by_penetration() -> None:
    for depth, stays, grows in ((1e-6, 0.25, 0.25), (4e-6, 1.0, 1.0), (6e-6, 1.0, 1.5), (20e-6, 1.0, 5.0)):
        assert damper("adhesive", depth) == pytest.approx(800.0 * stays, rel=1e-9)
        assert damper("non-adhesive", depth) == pytest.approx(800.0 * stays, rel=1e-9)
        assert damper("penetration", depth) == pytest.approx(800.0 * grows, rel=1e-9)


@pytest.mark.parametrize("depth", [1e-6, 3e-6, 4e-6, 7e-6])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_momentum_taken_up_is_the_integral_of_the_damping_over_the_way(depth: float, side: float) -> None:
    law = MeshContact(2e8, 800.0, 30e-6, contact_damping="adhesive", ramp=4e-6)
    taken = quad(lambda x: damper("adhesive", x), 0.0, depth, points=[4e-6])[0]
    place = depth if side > 0.0 else -30e-6 - depth
    assert 1e6 * law.impulse([place])[0] == pytest.approx(side * 1e6 * taken, rel=1e-9)
