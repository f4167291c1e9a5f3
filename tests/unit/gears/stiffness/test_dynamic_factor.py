"""K_v of ISO 6336-1 with the constants of the standard's table, for contact ratios on both sides of its borders."""

from __future__ import annotations

import math

import pytest

from rotorgear.gears.stiffness.dynamic_factor import iso_dynamic_factor
from tests.unit.gears.stiffness.test_dynamic_loads import MESH as WITHOUT_RELIEF
from tests.unit.gears.stiffness.test_dynamic_loads import RESONANCE

# The mesh worked by hand in `test_dynamic_loads`, here with tip relief.
MESH = WITHOUT_RELIEF | {"tip_relief": 5e-6}
B_P = 14e9 * 10e-6 * (1.0 - 0.075) / 4e5
B_F = 14e9 * 8e-6 * (1.0 - 0.075) / 4e5
B_K = abs(1.0 - 14e9 * 5e-6 / 4e5)


def factor(eps: float, N: float, line_load: float = 4e5) -> float:
    found = iso_dynamic_factor(
        **MESH | {"total_contact_ratio": eps, "pinion_speed": N * RESONANCE, "line_load": line_load}
    )
    assert found.resonance_ratio == pytest.approx(N)
    return found.value


# ISO 6336-1:2006, table 8: C_v1 ... C_v7 for eps_gamma up to 2, and at 2.2, 2.5 and 3 from its formulas.
TABLE = {
    1.4: (0.32, 0.34, 0.23, 0.90, 0.47, 0.47, 0.75),
    1.8: (0.32, 0.34, 0.23, 0.90, 0.47, 0.47, 0.875 - 0.125 * math.sin(0.2 * math.pi)),
    2.2: (0.32, 0.57 / 1.9, 0.096 / 0.64, 0.46 / 0.76, 0.47, 0.12 / 0.46, 0.875 + 0.125 * math.sin(0.2 * math.pi)),
    2.5: (0.32, 0.57 / 2.2, 0.096 / 0.94, 0.445 / 1.06, 0.47, 0.12 / 0.76, 1.0),
    3.0: (0.32, 0.57 / 2.7, 0.096 / 1.44, 0.42 / 1.56, 0.47, 0.12 / 1.26, 1.0),
}


@pytest.mark.parametrize("eps", list(TABLE))
def test_every_range_of_speed_has_the_constants_of_its_column(eps: float) -> None:
    c1, c2, c3, c4, c5, c6, c7 = TABLE[eps]
    resonance = 1.0 + c1 * B_P + c2 * B_F + c4 * B_K
    beyond = c5 * B_P + c6 * B_F + c7
    assert factor(eps, 0.6) == pytest.approx(1.0 + 0.6 * (c1 * B_P + c2 * B_F + c3 * B_K), rel=1e-12)
    assert factor(eps, 1.0) == pytest.approx(resonance, rel=1e-12)
    assert factor(eps, 1.3) == pytest.approx(beyond + (resonance - beyond) * (0.2 / 0.35), rel=1e-12)
    assert factor(eps, 2.0) == pytest.approx(beyond, rel=1e-12)


@pytest.mark.parametrize("N", [0.6, 1.0, 2.0])
def test_the_columns_of_the_table_nearly_meet_at_a_contact_ratio_of_two(N: float) -> None:
    assert factor(2.0 + 1e-9, N) == pytest.approx(factor(2.0, N), rel=0.04)


def test_light_load_begins_its_resonance_earlier() -> None:
    edge = 0.5 + 0.35 * math.sqrt(0.25)  # at a quarter of 100 N/mm
    # Below it the factor grows with the speed; in the range of the main resonance it does not.
    assert factor(1.6, edge - 1e-6, 0.25e5) > factor(1.6, edge - 1e-3, 0.25e5)
    assert factor(1.6, edge + 1e-6, 0.25e5) == factor(1.6, edge + 1e-3, 0.25e5)
