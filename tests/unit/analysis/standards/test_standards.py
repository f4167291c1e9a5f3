"""Rules of standards against closed forms: the Jeffcott rotor's half-power points, orbits, torsion, balance."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq

import rotorgear as rg
from rotorgear.analysis.standards import rules
from rotorgear.results.standards import RuleCheck, StandardsResult
from tests.paths import ROOT

MASS = 10.0
STIFFNESS = 1e5
NATURAL = math.sqrt(STIFFNESS / MASS)


def jeffcott(zeta: float, speed: float, more: str = "") -> rg.Model:
    """A point mass on a spring and damper; the shaft has no length."""
    return rg.loads(jeffcott_text(zeta, speed) + more)


def jeffcott_text(zeta: float, speed: float) -> str:
    """Its model file."""
    return f"""
[operation]
input_shaft = "rotor"
speed = {speed * NATURAL}
[shafts.rotor]
[disks.disk]
shaft = "rotor"
at = "start"
mass = {MASS}
polar_inertia = 0.01
diametral_inertia = 0.01
[bearings.spring]
shaft = "rotor"
at = "start"
stiffness = {{ radial = {STIFFNESS} }}
damping = {{ radial = {2.0 * zeta * MASS * NATURAL} }}
[supports.hold]
shaft = "rotor"
at = "start"
fixed = ["tilt_x", "tilt_y", "z"]
"""


def whirled(r: float, zeta: float) -> float:
    """Radius of the orbit over the eccentricity."""
    return r * r / math.hypot(1.0 - r * r, 2.0 * zeta * r)


def margin_of(result: StandardsResult) -> tuple[float | None, float | None, str]:
    check = next(check for check in result.checks if check.rule == "separation margin")
    return check.value, check.limit, check.verdict


@pytest.mark.parametrize("zeta", [0.01, 0.15])
@pytest.mark.parametrize(("speed", "more"), [(1.4, 0.0), (0.8, 10.0)])
def test_factor_and_margin_are_those_of_the_closed_form(zeta: float, speed: float, more: float) -> None:
    result = rg.standards(jeffcott(zeta, speed))
    (peak,) = result.criticals
    top = 1.0 / math.sqrt(1.0 - 2.0 * zeta**2)
    level = whirled(top, zeta) / math.sqrt(2.0)
    below = brentq(lambda r: whirled(r, zeta) - level, 0.1, top)
    above = brentq(lambda r: whirled(r, zeta) - level, top, 5.0)
    rpm = NATURAL * 30.0 / math.pi
    assert [peak.shaft_rpm, peak.below_rpm, peak.above_rpm] == pytest.approx(
        [top * rpm, below * rpm, above * rpm], rel=1e-5
    )
    factor = top / (above - below)
    assert peak.amplification_factor == pytest.approx(factor, rel=1e-4)
    asked = 17.0 * (1.0 - 1.0 / (factor - 1.5)) + more
    separation = 100.0 * abs(speed - top) / speed
    value, limit, verdict = margin_of(result)
    assert (value, limit) == pytest.approx((separation, asked), rel=1e-4)
    assert verdict == ("within" if separation >= asked else "not within")


def test_the_printed_factors_of_a_twentieth_of_critical_damping() -> None:
    (peak,) = rg.standards(jeffcott(0.05, 1.4)).criticals
    ratios = np.array([peak.shaft_rpm, peak.below_rpm, peak.above_rpm]) / (NATURAL * 30.0 / math.pi)
    assert ratios.round(5).tolist() == [1.00251, 0.95569, 1.05696]
    assert round(peak.amplification_factor, 4) == 9.8996
    assert [round(rules.separation_margin(peak.amplification_factor, side), 2) for side in (True, False)] == [
        14.98,
        24.98,
    ]


def test_a_well_damped_peak_asks_for_no_margin_and_an_undamped_one_for_the_largest() -> None:
    assert margin_of(rg.standards(jeffcott(0.25, 1.3)))[1:] == (None, "not applicable")
    value, limit, verdict = margin_of(rg.standards(jeffcott(0.0, 0.9)))
    assert (value, limit, verdict) == (pytest.approx(100.0 / 9.0, rel=1e-6), 27.0, "not within")


def test_a_response_that_rises_again_has_its_factor_from_the_other_side() -> None:
    # Two peaks near each other: between them the response falls to no more than 0.8 of the lower one.
    def response(r: float) -> float:
        return abs(1.0 / (1.0 - r * r + 0.06j * r) + 1.0 / (1.1 - r * r + 0.06j * r))

    peak = rules.response_peak(response, 1.0, 0.03)
    assert peak is not None
    assert math.isnan(peak.above)
    assert peak.amplification_factor == pytest.approx(peak.speed / (2.0 * (peak.speed - peak.below)))


@pytest.mark.parametrize(("fall", "known"), [(1.4, True), (2.1, False)])
def test_a_response_that_falls_too_late_has_its_factor_from_the_other_side(fall: float, known: bool) -> None:
    """A peak at 5 that rises over 1 and falls to 0.707 of itself within 1 or `fall` of its own speed."""

    def response(speed: float) -> float:
        width = 1.0 if speed < 5.0 else 5.0 * fall
        return 1.0 - (1.0 - math.sqrt(0.5)) * ((speed - 5.0) / width) ** 2

    peak = rules.response_peak(response, 5.0, 0.3)
    assert peak is not None
    assert peak.below == pytest.approx(4.0, rel=1e-6)
    assert peak.above == pytest.approx(5.0 * (1.0 + fall), rel=1e-6) if known else math.isnan(peak.above)


def test_a_peak_is_found_in_few_looks_at_any_speed() -> None:
    for natural in (1e-2, 1e4):
        looks = []

        def response(speed: float, natural: float = natural, looks: list[float] = looks) -> float:
            looks.append(speed)
            r = speed / natural
            return abs(1.0 / (1.0 - r * r + 0.06j * r))

        peak = rules.response_peak(response, natural, 0.03)
        assert peak is not None
        assert peak.speed == pytest.approx(natural * math.sqrt(1.0 - 2.0 * 0.03**2), rel=1e-6)
        assert peak.amplification_factor == pytest.approx(0.5 / 0.03, rel=5e-3)
        assert len(looks) < 100


def test_the_orbit_at_the_operating_speed_is_that_of_the_trial_unbalance() -> None:
    zeta = 0.05
    speed = 1.4
    rpm = speed * NATURAL * 30.0 / math.pi
    eccentricity = 2.0 * 6350.0e-6 / rpm  # of 2 x 6350 W/N g mm on W
    check = next(c for c in rg.standards(jeffcott(zeta, speed)).checks if c.rule == "vibration limit")
    assert check.value == pytest.approx(2e6 * eccentricity * whirled(speed, zeta), rel=1e-5)
    assert check.limit == pytest.approx(25.4)
    assert rules.vibration_limit(48000.0) == pytest.approx(12.7e-6)


def test_stability_speaks_of_the_logarithmic_decrement_of_the_forward_whirl() -> None:
    for zeta, verdict in ((0.05, "within"), (0.015, "not within")):
        # Modes that whirl backward and die away are not listed.
        (check,) = [c for c in rg.standards(jeffcott(zeta, 1.4)).checks if c.rule == "stability"]
        assert check.value == pytest.approx(2.0 * math.pi * zeta / math.sqrt(1.0 - zeta**2), rel=1e-5)
        assert check.verdict == verdict


def test_residual_unbalance_is_compared_by_the_grade() -> None:
    unbalance = '[unbalances.u]\nshaft = "rotor"\nat = "start"\nmagnitude = "200 g mm"'
    model = jeffcott(0.05, 1.4, unbalance)
    limit = 9549.0 * 2.5 * MASS / (1.4 * NATURAL * 30.0 / math.pi)
    check = next(c for c in rg.standards(model).checks if c.rule == "residual unbalance")
    assert (check.value, check.limit) == pytest.approx((200.0, limit), rel=1e-6)
    assert check.verdict == "not within"
    wider = next(c for c in rg.standards(model, grade=6.3).checks if c.rule == "residual unbalance")
    assert wider.verdict == "within"


def torsional_checks(share: float) -> tuple[float, list[RuleCheck]]:
    """Twice the speed in Hz, where that is a share of the first torsional mode of a chain, and what the rule says of it."""
    path = ROOT / "models" / "torsion_chain.toml"
    chain = rg.load(path)
    natural = rg.modal(chain).frequency_hz
    twice = share * float(natural[natural > 0.0][0])
    operation = {"input_shaft": next(iter(chain.shafts)), "speed": math.pi * twice}
    checks = rg.standards(chain.with_("operation", operation)).checks
    return twice, [check for check in checks if check.rule == "torsional interference"]


@pytest.mark.parametrize("share", [1.05, 0.85])
def test_torsional_modes_are_held_against_the_orders_of_shafts(share: float) -> None:
    found = next(check for check in torsional_checks(share)[1] if check.part.endswith("2x"))
    assert found.value == pytest.approx(100.0 * abs(1.0 - 1.0 / share), rel=1e-6)
    assert found.verdict == ("within" if found.value > 10.0 else "not within")


def test_a_torsional_mode_a_fifth_above_all_lines_is_none_to_fear() -> None:
    twice, checks = torsional_checks(0.75)
    assert [check.value for check in checks] == [None] * len(checks)
    assert [check.verdict for check in checks] == ["not applicable"] * len(checks)
    assert f"no torsional mode up to {1.2 * twice:.5g} Hz" in [check.note for check in checks]


def test_a_model_without_torsion_has_no_torsional_mode() -> None:
    model = rg.load(ROOT / "models" / "helical_pair.toml").with_({"motions": ["bending"]})
    checks = [c for c in rg.standards(model).checks if c.rule == "torsional interference"]
    assert checks
    assert all(check.value is None and "no torsional mode" in check.note for check in checks)


def test_a_model_without_a_speed_and_a_grade_without_a_size_are_refused() -> None:
    with pytest.raises(rg.AnalysisError, match=r"speed of \[operation\]"):
        rg.standards(rg.load(ROOT / "models" / "torsion_chain.toml"))
    with pytest.raises(rg.AnalysisError, match="grade"):
        rg.standards(jeffcott(0.05, 1.4), grade=0.0)


def half_power(amplitude: Callable[[float], float], near: float) -> tuple[float, float, float, float]:
    """Place of a peak, the places where it has fallen to 0.707 of itself, and N_c/(N_2 - N_1), from the formula of a response."""
    top = near
    for width in (1e-1, 1e-3, 1e-5, 1e-7):
        there = top * (1.0 + width * np.linspace(-1.0, 1.0, 401))
        top = float(there[int(np.argmax([amplitude(w) for w in there]))])
    level = amplitude(top) / math.sqrt(2.0)
    low = brentq(lambda w: amplitude(w) - level, 0.85 * top, top)
    high = brentq(lambda w: amplitude(w) - level, top, 1.15 * top)
    return top, low, high, top / (high - low)


def test_a_rotor_on_unlike_springs_has_two_peaks_of_the_major_axis_of_its_orbit() -> None:
    # X = e w^2/(w_x^2 - w^2 + i c w/m), Y = -i e w^2/(w_y^2 - w^2 + i c w/m); the orbit is an ellipse between the peaks.
    across = 1.44 * STIFFNESS
    damping = 2.0 * 0.02 * MASS * NATURAL
    source = jeffcott_text(0.02, 2.0).replace(f"radial = {STIFFNESS}", f"x = {STIFFNESS}, y = {across}")
    result = rg.standards(rg.loads(source))

    def major(w: float) -> float:
        x, y = (w * w / (k / MASS - w * w + 1j * damping * w / MASS) for k in (STIFFNESS, across))
        return abs(x + y) + abs(x - y)  # Y = -i y: |X + iY| = |x + y|

    assert len(result.criticals) == 2
    for peak, near in zip(result.criticals, (NATURAL, 1.2 * NATURAL), strict=True):
        top, low, high, factor = half_power(major, near)
        rpm = 30.0 / math.pi
        assert [peak.shaft_rpm, peak.below_rpm, peak.above_rpm] == pytest.approx(
            [top * rpm, low * rpm, high * rpm], rel=1e-5
        )
        assert peak.amplification_factor == pytest.approx(factor, rel=1e-3)
    # The curve of the page is the same formula at every speed, between the peaks too, where the minor axis turns its sign.
    curve = result.curves["rotor"]
    expected = np.array([major(w) for w in result.curve_speeds])
    assert curve == pytest.approx(expected * curve.max() / expected.max(), rel=1e-4)


def test_an_overhung_disk_has_the_factor_of_its_two_equations() -> None:
    # A disk at the end of a massless cantilever, damped at the disk. In forward whirl at the speed of the shaft J_d - J_p stands
    # in place of J_d; K = E I [[12/L^3, -6/L^2], [-6/L^2, 4/L]].
    length = 0.5
    d = 0.02
    E = 206e9
    mass = 5.0
    polar = 0.04
    diametral = 0.021
    c = 60.0
    model = rg.loads(f"""
[operation]
input_shaft = "rotor"
speed = "6000 rpm"
[materials.light]
youngs_modulus = {E}
poisson_ratio = 0.3
density = 1e-3
[shafts.rotor]
material = "light"
sections = [{{ length = {length}, outer_diameter = {d} }}]
[disks.disk]
shaft = "rotor"
at = "end"
mass = {mass}
polar_inertia = {polar}
diametral_inertia = {diametral}
[bearings.damper]
shaft = "rotor"
at = "end"
stiffness = {{ radial = 1.0 }}
damping = {{ radial = {c} }}
[supports.clamp]
shaft = "rotor"
at = "start"
fixed = ["x", "y", "z", "tilt_x", "tilt_y"]
""")
    EI = E * math.pi * d**4 / 64.0
    K = EI * np.array([[12.0 / length**3, -6.0 / length**2], [-6.0 / length**2, 4.0 / length]])

    def radius(w: float) -> float:
        D = K - w**2 * np.diag([mass, diametral - polar]) + 1j * w * np.diag([c, 0.0])
        return float(abs(np.linalg.solve(D, [w**2, 0.0])[0]))

    (peak,) = rg.standards(model).criticals
    near = peak.shaft_rpm * math.pi / 30.0
    top, low, high, factor = half_power(radius, near)
    rpm = 30.0 / math.pi
    # Of the shear of a shaft 25 diameters long there is 1e-3.
    assert [peak.shaft_rpm, peak.below_rpm, peak.above_rpm] == pytest.approx(
        [top * rpm, low * rpm, high * rpm], rel=2e-3
    )
    assert peak.amplification_factor == pytest.approx(factor, rel=5e-3)
    assert peak.whirl == "forward"


def test_the_orbit_in_a_loose_bearing_is_held_against_three_quarters_of_its_play() -> None:
    """Springs hold the mass in the middle of the clearance of 40 um: the limit of the major axis is 30 um."""
    loose = """
[bearings.loose]
shaft = "rotor"
at = "start"
rolling = { kind = "roller", elements = 9, element_diameter = 0.012, pitch_diameter = 0.06, length = 0.012, clearance = 40e-6 }
"""
    text = jeffcott_text(0.05, 1.4).replace("[bearings.spring]", "[supports.spring]") + loose
    checks = rg.standards(rg.loads(text)).checks
    found = {check.rule: check for check in checks if check.part == "bearings.loose"}
    assert found["clearance"].limit == pytest.approx(30.0)
    assert found["clearance"].value == found["vibration limit"].value


def cross_coupled(q: float, sense: float) -> rg.Model:
    """m u'' + c u' + (k - i q) u = m e w^2 e^{iwt} of u = x + iy, as in a seal; sense: of rotation and of q."""
    source = jeffcott_text(0.05, sense * 1.4).replace(
        f"radial = {STIFFNESS} ", f"radial = {STIFFNESS}, xy = {sense * q}, yx = {-sense * q} "
    )
    return rg.loads(source)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_seal_that_drives_the_forward_whirl_takes_its_force_from_the_damping(sense: float) -> None:
    damping, q = 2.0 * 0.05 * MASS * NATURAL, 4e3
    result = rg.standards(cross_coupled(q, sense))

    def radius(w: float) -> float:
        return w * w / abs(STIFFNESS / MASS - w * w + 1j * (damping * w - q) / MASS)

    (peak,) = result.criticals
    top, low, high, factor = half_power(radius, NATURAL)
    rpm = 30.0 / math.pi
    assert [peak.shaft_rpm, peak.below_rpm, peak.above_rpm] == pytest.approx(
        [top * rpm, low * rpm, high * rpm], rel=1e-5
    )
    assert peak.amplification_factor == pytest.approx(factor, rel=1e-3)
    # Its page shows the response from a fiftieth of the highest speed on, which is half above the operating one.
    top = 1.5 * 1.4 * NATURAL
    assert (result.curve_speeds[0], result.curve_speeds[-1]) == pytest.approx((0.02 * top, top))
    (check,) = [one for one in result.checks if one.rule == "stability"]
    s = max(np.roots([MASS, damping, STIFFNESS - 1j * q]), key=lambda root: root.imag)
    zeta = -s.real / abs(s)
    assert check.value == pytest.approx(2.0 * math.pi * zeta / math.sqrt(1.0 - zeta**2), rel=1e-5)


def test_a_backward_whirl_that_grows_is_told_beside_the_forward_one() -> None:
    q = -1.5e4
    checks = [one for one in rg.standards(cross_coupled(q, 1.0)).checks if one.rule == "stability"]
    found = {}
    for s in np.roots([MASS, 2.0 * 0.05 * MASS * NATURAL, STIFFNESS - 1j * q]):
        zeta = -s.real / abs(s)
        found[s.imag > 0.0] = 2.0 * math.pi * zeta / math.sqrt(1.0 - zeta**2)
    assert [check.value for check in checks] == pytest.approx([found[True], found[False]], rel=1e-5)
    assert [check.verdict for check in checks] == ["within", "not within"]
    assert [check.part.split(" ")[0] for check in checks] == ["shafts.rotor", "mode"]


def test_of_a_peak_with_one_flank_the_factor_is_that_of_twice_the_distance_to_it() -> None:
    for below, above, factor in ((97.0, 104.0, 100.0 / 7.0), (math.nan, 104.0, 12.5), (97.0, math.nan, 100.0 / 6.0)):
        peak = rules.ResponsePeak(100.0, 1.0, below, above)
        assert peak.amplification_factor == pytest.approx(factor)
    assert math.isnan(rules.ResponsePeak(100.0, 1.0, math.nan, math.nan).amplification_factor)
