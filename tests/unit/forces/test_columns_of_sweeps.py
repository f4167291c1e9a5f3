"""What sweeps take of a law in vector registers, its columns and tables, against the force of the law itself."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.forces.law import ForceLaw
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.forces.rotating_force import RotatingForce
from rotorgear.solvers.batch.columns import ERROR, FORCE_SHARE, SLOPE, STIFFNESS

ANGLES = np.linspace(0.0, 0.7, 9)


def table_of(law: ForceLaw, order: float) -> np.ndarray:
    schedule, _ = law.functions()
    states = np.zeros((ANGLES.size, law.state_size()))
    for state, angle in zip(states, ANGLES, strict=True):
        schedule(angle, 1.0, 0.0, np.ascontiguousarray(law.parameters(), dtype=float), state)
    return law.table(ANGLES, states, order)


@pytest.mark.parametrize(
    "law",
    [
        RotatingForce(2e-3, -0.6, 0.7, 2.0, plane=True),
        RotatingForce(80.0, 3.0, -0.4),
        RotatingForce(5.0, 1.5, 1.1, 1.0),
    ],
)
def test_a_turning_force_is_its_share_of_the_push_at_every_angle_and_speed(law: RotatingForce) -> None:
    for speed in (90.0, 250.0):
        columns = law.columns(speed)
        table = table_of(law, 20.0)
        for i, angle in enumerate(ANGLES):
            force = law.evaluate(np.zeros(law.components), 0.0, angle=angle, speed=speed).force
            assert [c.prescribed * table[i, k, FORCE_SHARE] for k, c in enumerate(columns)] == pytest.approx(
                list(force), abs=1e-9
            )


@pytest.mark.parametrize(
    "law",
    [
        MeshContact(
            3e8,
            order=-20.0,
            phase=0.3,
            stiffness_cos=(0.2, 0.05),
            stiffness_sin=(0.1,),
            error_cos=(2e-6,),
            error_sin=(1e-6,),
        ),
        MeshContact(3e8, order=20.0, pieces=((0.0, 0.8, 1.0), (0.4, 1.2, 1.1)), error_mean=1e-6, impact=50.0),
    ],
)
def test_a_contact_is_its_share_of_the_mean_stiffness_on_what_the_error_leaves(law: MeshContact) -> None:
    (column,) = law.columns(200.0)
    table = table_of(law, 20.0)
    d = 9e-6
    for i, angle in enumerate(ANGLES):
        row = table[i, 0]
        force = column.stiffness * row[STIFFNESS] * (d - row[ERROR]) + column.prescribed * row[FORCE_SHARE]
        assert force == pytest.approx(law.evaluate([d], angle=angle).force[0], rel=1e-9)
    # The time of the sweep counts radians of a mesh of this order: e falls or rises with it.

    def error(angle: float) -> float:
        value = law.evaluate([d], angle=angle)
        return float(d - value.force[0] / value.in_displacement[0, 0])

    h = 1e-6
    for i, angle in enumerate(ANGLES if law.error_cos else ()):
        assert 1e6 * table[i, 0, SLOPE] == pytest.approx(
            1e6 * (error(angle + h) - error(angle - h)) / (2.0 * h * 20.0), abs=1e-3
        )
