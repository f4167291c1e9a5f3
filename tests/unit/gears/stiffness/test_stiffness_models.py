"""Mesh stiffness by the analytic models: the standard's numbers, the length of contact lines, energy, symmetry."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.geometry.pair import pair_geometry
from rotorgear.gears.stiffness.contact_lines import contact_line_length, mean_contact_line_length
from rotorgear.gears.stiffness.energy import slice_stiffness, tooth_compliance
from rotorgear.gears.stiffness.iso import iso_tooth_stiffness
from rotorgear.gears.stiffness.mesh_stiffness import ToothBody, ToothPair, given_stiffness
from rotorgear.gears.stiffness_models import mesh_stiffness
from tests.unit.gears.tooth_pairs import harmonics, swapped

deg = math.radians
ANALYTIC = ("contact_line", "iso", "potential_energy")


def teeth_of(z1: int, z2: int, module: float, helix: float, width: float, inner: float = 0.3) -> ToothPair:
    g1, g2 = (GearGeometry(z, module, deg(20), deg(helix)) for z in (z1, z2))
    bodies = (ToothBody(inner_radius=0.5 * inner * g.root_diameter) for g in (g1, g2))
    return ToothPair(g1, g2, pair_geometry(g1, g2, width), width, *bodies)


SPUR = teeth_of(34, 80, 5e-3, 0, 0.054)
HELICAL = teeth_of(34, 80, 5e-3, 20.86, 0.054)


def test_the_iso_stiffness_of_a_mesh_is_c_gamma_times_the_width() -> None:
    values = iso_tooth_stiffness(HELICAL.first, HELICAL.second, HELICAL.pair.transverse_contact_ratio)
    found = mesh_stiffness("iso", HELICAL, 60e3)
    assert found.mean == pytest.approx(values.mesh_alpha * 0.054, rel=1e-14)
    assert found.mean_normal == pytest.approx(found.mean / math.cos(HELICAL.pair.base_helix_angle) ** 2, rel=1e-14)
    assert found.peak_to_peak == 0.0


def test_below_100_newton_per_millimetre_the_iso_stiffness_falls_with_the_fourth_root_of_f_t() -> None:
    base = math.cos(HELICAL.first.transverse_pressure_angle)  # F_t = F_bt cos a_t
    full, half = (mesh_stiffness("iso", HELICAL, share * 1e5 * 0.054 / base) for share in (1.0, 0.5))
    assert full.mean == pytest.approx(mesh_stiffness("iso", HELICAL).mean, rel=1e-12)
    assert not full.warnings
    assert half.mean / full.mean == pytest.approx(0.5**0.25, rel=1e-12)
    assert "below 100 N/mm" in half.warnings[0]


@pytest.mark.parametrize("teeth", [SPUR, HELICAL, teeth_of(22, 41, 5e-3, 22, 0.12)])
def test_contact_lines_have_their_mean_and_harmonics(teeth: ToothPair) -> None:
    u = (np.arange(20000) + 0.5) / 20000
    length = contact_line_length(teeth, u)
    assert length.mean() == pytest.approx(mean_contact_line_length(teeth), rel=1e-4)
    # The length is the convolution of two boxes, eps_alpha and eps_beta wide, about the middle of the path of contact.
    middle = 0.5 * (teeth.pair.start_of_contact + teeth.pair.end_of_contact) / teeth.first.transverse_base_pitch
    for n in range(1, 5):
        boxes = 2.0 * np.sinc(n * teeth.pair.transverse_contact_ratio) * np.sinc(n * teeth.pair.overlap_ratio)
        got = 2 * np.mean(length * np.exp(-2j * np.pi * n * u)) / length.mean()
        assert abs(got - boxes * np.exp(-2j * np.pi * n * middle)) < 2e-4


def test_an_integer_overlap_ratio_leaves_no_ripple_in_the_contact_lines() -> None:
    teeth = replace(HELICAL, width=math.pi * 5e-3 / math.sin(deg(20.86)))
    assert np.ptp(contact_line_length(teeth, np.linspace(0, 1, 301))) < 1e-12
    assert mesh_stiffness("contact_line", teeth).peak_to_peak < 1e-9 * mesh_stiffness("contact_line", teeth).mean


@pytest.mark.parametrize("name", ANALYTIC)
@pytest.mark.parametrize("teeth", [SPUR, HELICAL])
def test_a_model_does_not_mind_which_gear_comes_first(name: str, teeth: ToothPair) -> None:
    one = mesh_stiffness(name, teeth, 50e3, 60)
    other = mesh_stiffness(name, swapped(teeth), 50e3, 60)
    assert other.mean == pytest.approx(one.mean, rel=1e-12)
    # seen from the other gear the cycle runs backwards
    assert other.transverse == pytest.approx(np.roll(one.transverse[::-1], 1), rel=1e-12)


@pytest.mark.parametrize("name", ANALYTIC)
def test_a_model_scales_as_elasticity_does(name: str) -> None:
    double = replace(
        HELICAL,
        first_body=replace(HELICAL.first_body, youngs_modulus=412e9),
        second_body=replace(HELICAL.second_body, youngs_modulus=412e9),
    )
    one = mesh_stiffness(name, HELICAL, 60e3)
    assert mesh_stiffness(name, double, 60e3).transverse == pytest.approx(2 * one.transverse, rel=1e-12)
    large = teeth_of(34, 80, 10e-3, 20.86, 0.108)  # the same shape twice as large: twice as stiff
    assert mesh_stiffness(name, large, 120e3).transverse == pytest.approx(2 * one.transverse, rel=1e-9)


def test_the_energy_of_a_tooth_is_that_of_its_outline_summed_in_thin_slabs() -> None:
    outline = tooth_outline(SPUR.first)
    body = ToothBody(inner_radius=0.0119)
    outer = tooth_outline(SPUR.first)
    roll = 0.75 * tooth_outline(SPUR.first).tip_roll_length
    radius, half = (float(value) for value in outer.involute(roll))
    tilt = math.atan(roll / SPUR.first.base_radius) - half
    top = radius * math.cos(half) - radius * math.sin(half) * math.tan(tilt)
    radii, angles = outer.half(4000)
    height = (radii * np.cos(angles))[4:-4][::-1]
    thick = (2 * radii * np.sin(angles))[4:-4][::-1]
    y = np.linspace(height[0], radius * math.cos(half), 20001)
    y, step = 0.5 * (y[1:] + y[:-1]), y[1] - y[0]
    s = np.interp(y, height, thick)
    moment = math.cos(tilt) * (top - y)
    e = 206e9
    g = 206e9 / 2.6
    beam = (
        np.sum(12 * moment**2 / (e * s**3) + 1.2 * math.cos(tilt) ** 2 / (g * s) + math.sin(tilt) ** 2 / (e * s)) * step
    )
    stiff = replace(body, youngs_modulus=2 * 206e9)
    whole = float(tooth_compliance(outline, body, np.array([roll]))[0])
    assert whole > beam  # the ring gives on top of it
    assert float(tooth_compliance(outline, stiff, np.array([roll]))[0]) / whole == pytest.approx(0.5, rel=1e-12)
    from rotorgear.gears.stiffness.energy import _beam, _load

    assert float(_beam(outline, body, *_load(outline, np.array([roll])))[0]) / beam == pytest.approx(1.0, rel=2e-4)


def test_a_thin_web_under_a_thin_rim_softens_the_iso_stiffness_as_c_r_says() -> None:
    webbed = replace(SPUR, second_body=replace(SPUR.second_body, web_share=0.3, rim_thickness=3 * 5e-3))
    share = mesh_stiffness("iso", webbed).mean / mesh_stiffness("iso", SPUR).mean
    assert share == pytest.approx(0.5 * (2 + math.log(0.3) / (5 * math.exp(0.6))), rel=1e-12)
    thin = replace(webbed, second_body=replace(webbed.second_body, web_share=0.01))
    least = replace(webbed, second_body=replace(webbed.second_body, web_share=0.2))
    assert mesh_stiffness("iso", thin).mean == mesh_stiffness("iso", least).mean


def test_a_single_pair_by_potential_energy_lies_within_the_scatter_of_the_standard() -> None:
    """ISO states its own polynomial for c' to be uncertain by some 20 %; C_M = 0.8 belongs to it."""
    iso = iso_tooth_stiffness(SPUR.first, SPUR.second, SPUR.pair.transverse_contact_ratio).single
    peak = slice_stiffness(SPUR, np.linspace(SPUR.pair.start_of_contact, SPUR.pair.end_of_contact, 51)).max()
    assert peak == pytest.approx(iso, rel=0.2)


def test_where_a_tip_works_below_the_base_circle_there_is_no_energy_to_compute() -> None:
    teeth = teeth_of(8, 60, 3e-3, 0, 0.03)
    assert teeth.pair.interference
    with pytest.raises(AnalysisError, match=r"interference.*reduce the tip diameter"):
        mesh_stiffness("potential_energy", teeth)
    assert "contact ratio is nominal" in mesh_stiffness("iso", teeth).warnings[-1]


def test_the_sweep_of_pairs_is_computed_or_refused_with_a_sentence() -> None:
    refused = set()
    done = 0
    for z, x, pressure, helix in itertools.product((6, 8, 12, 25, 150), (-0.6, 0.0, 0.9), (14.5, 20, 25), (0, 20, 35)):
        g = GearGeometry(z, 2e-3, deg(pressure), deg(helix), profile_shift=x)
        mate = GearGeometry(50, 2e-3, deg(pressure), deg(helix))
        bodies = (ToothBody(inner_radius=0.15 * own.root_diameter) for own in (g, mate))
        try:
            tooth_outline(g)
            teeth = ToothPair(g, mate, pair_geometry(g, mate, 0.02), 0.02, *bodies)
            iso, energy = (mesh_stiffness(name, teeth, 2e3, 16) for name in ("iso", "potential_energy"))
        except AnalysisError as error:
            refused.add(str(error))
            continue
        assert np.all(energy.transverse > 0.0)
        assert 0.7 < energy.mean / iso.mean < 1.35  # both are within their scatter of each other, for every real tooth
        done += 1
    assert done > 50
    known = ("interference", "pointed", "cuts through the root", "no involute is left")
    assert all(any(words in sentence for words in known) for sentence in refused)


def test_two_helices_double_in_phase_and_average_when_staggered() -> None:
    one = mesh_stiffness("contact_line", HELICAL, 1e3)
    both = one.of_both_helices()
    staggered = one.of_both_helices(0.5)
    assert both.transverse == pytest.approx(2 * one.transverse, rel=1e-14)
    assert (both.helices, both.load) == (2, 2e3)
    assert staggered.mean == pytest.approx(2 * one.mean, rel=1e-12)
    assert abs(harmonics(staggered, 1)[0]) < 1e-9 * one.mean
    assert harmonics(staggered, 2)[1] == pytest.approx(2 * harmonics(one, 2)[1], rel=1e-9)


def test_a_given_table_keeps_its_values_along_the_flank_normal() -> None:
    found = given_stiffness([1e9, 2e9, 3e9], 0.4, 2, None, 64)
    assert found.transverse / math.cos(0.4) ** 2 == pytest.approx([1e9, 2e9, 3e9], rel=1e-14)
    assert found.mean_normal == pytest.approx(2e9, rel=1e-14)


def test_a_model_that_does_not_exist_is_answered_with_the_nearest() -> None:
    with pytest.raises(AnalysisError, match="did you mean 'contact_line'"):
        mesh_stiffness("contact_lines", HELICAL)


def test_a_curve_from_the_cache_cannot_be_spoiled() -> None:
    with pytest.raises(ValueError, match="read-only"):
        mesh_stiffness("iso", SPUR).transverse[0] = 0.0
