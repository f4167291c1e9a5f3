"""Scatter: against closed forms, whole systems, other ways to the same numbers, and itself on other workers."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.special import ndtr, ndtri

import rotorgear as rg
from rotorgear.analysis.scatter.family import family_of
from rotorgear.analysis.scatter.gather import quantile_error
from rotorgear.analysis.sensitivity.forms import FormNames, forms_of, modes_of, overlaps
from rotorgear.analysis.static import state_at
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.errors import ModelError
from rotorgear.gears.geometry.flank_tolerance import cumulative_pitch_tolerance
from rotorgear.model.numbers import numbers_of
from rotorgear.model.parts.operation import Scatter
from rotorgear.model.spreads import spreads_of
from rotorgear.solvers.sampling import unit_points
from rotorgear.system.plan import Plan
from tests.models import STEEL
from tests.paths import MODELS, ROOT

PENDULUM = """
motions = ["torsion"]
[shafts.one]
[disks.wheel]
shaft = "one"
at = "start"
polar_inertia = "0.02 kg m^2"
[supports.spring]
shaft = "one"
at = "start"
stiffness = { torsion = "800 N m/rad" }
"""


@cache
def model(name: str) -> rg.Model:
    return rg.load(ROOT / "models" / f"{name}.toml")


def pendulum(**more: Scatter) -> rg.ScatterResult:
    given = {
        "supports.spring.stiffness": Scatter(sigma="10 %", distribution="lognormal"),
        "disks.wheel.polar_inertia": Scatter(sigma="6 %", distribution="lognormal"),
    }
    return rg.scatter(rg.loads(PENDULUM), given | more, samples=512, modes=1, sobol=128)


def test_a_pendulum_scatters_as_the_square_root_of_its_stiffness_over_its_inertia():
    result = pendulum()
    (row,) = result.bands
    exact = 0.5 * math.hypot(0.10, 0.06)
    assert row.nominal_hz == pytest.approx(math.sqrt(800.0 / 0.02) / (2.0 * math.pi), rel=1e-12)
    assert row.sigma_first_order == pytest.approx(exact, rel=1e-5)
    assert row.sigma == pytest.approx(exact, rel=0.01)
    # ln f is normal: the 95 % quantile stands 1.645 standard deviations above.
    assert row.high_hz == pytest.approx(row.nominal_hz * math.exp(1.6449 * exact), rel=2e-3)
    assert result.first_order_share[0] == pytest.approx([0.1**2 / 0.0136, 0.06**2 / 0.0136], rel=1e-4)
    assert result.sobol_first[0] == pytest.approx(result.first_order_share[0], abs=0.03)
    assert result.sobol_total[0] == pytest.approx(result.first_order_share[0], abs=0.03)


def test_slopes_are_those_of_whole_solutions_with_rotation():
    rotor = model("jeffcott")
    free = {"disks.disk.width": Scatter(sigma="1 %"), "bearings.left.stiffness": Scatter(sigma="10 %")}
    result = rg.scatter(rotor, free, samples=4, modes=6, elements=1, speed="6000 rpm")

    def whole(address: str, factor: float) -> np.ndarray:
        numbers = numbers_of(rotor, [address])
        changed = rg.scatter(numbers.at(numbers.start * factor), free, samples=2, modes=6, elements=1, speed="6000 rpm")
        return np.array([row.nominal_hz for row in changed.bands])

    squares = np.zeros(6)
    for address, size in (("disks.disk.width", 0.01), ("bearings.left.stiffness", 0.10)):
        slope = np.log(whole(address, 1.0 + 1e-4) / whole(address, 1.0 - 1e-4)) / 2e-4
        squares += (size * slope) ** 2
    first = np.array([row.sigma_first_order for row in result.bands])
    assert first == pytest.approx(np.sqrt(squares), rel=1e-3, abs=1e-7)


def test_modes_of_forms_are_those_of_the_damped_solver_without_damping():
    rotor = model("jeffcott").with_({"bearings.*.damping": None, "supports.air": None})
    speed = 600.0
    system = linear_system(rotor, [speed], Plan(2))
    forms = forms_of(system, speed, np.eye(system.n))
    found = modes_of(forms, 8, 1.0, system.n)
    reference = rg.modal(system, speed=speed, modes=9)
    assert found.omega / (2.0 * np.pi) == pytest.approx(reference.frequency_hz[~reference.rigid][:8], rel=1e-7)
    product = overlaps(forms[0], forms[1], found, found)
    assert np.abs(product) == pytest.approx(np.eye(8), abs=1e-6)


@pytest.mark.parametrize("gyroscopic", [30.0, 0.0])
def test_rotating_states_are_those_of_the_hermitian_matrix_also_where_frequencies_meet(gyroscopic: float):
    m = 24
    count = 9
    forms = np.zeros((3, m, m))
    # Each frequency stands twice without rotation, and one such pair parts the wanted ones from the others.
    squares = np.sort(np.repeat(np.linspace(10.0, 4000.0, m // 2), 2)) ** 2
    forms[0] = np.diag(squares)
    forms[1] = np.eye(m)
    drawn = np.random.default_rng(5).normal(size=(m, m)) * gyroscopic
    forms[2] = drawn - drawn.T
    forms[2, 0, 1] -= 1e-9  # something rotates
    forms[2, 1, 0] += 1e-9
    found = modes_of(forms, count, 1.0, m)
    root = np.diag(np.sqrt(squares))
    H = np.block([[np.zeros((m, m)), -1j * root], [1j * root, 1j * forms[2]]])
    assert found.omega == pytest.approx(np.linalg.eigvalsh(H)[m : m + count], rel=1e-11)
    states = np.vstack([root @ found.q, 1j * found.q * found.omega]) / (np.sqrt(2.0) * found.omega)
    assert np.abs(states.conj().T @ states - np.eye(count)).max() < 1e-10
    assert np.abs(H @ states - states * found.omega).max() < 1e-7 * found.omega[0]


def test_forward_and_backward_whirl_take_part_in_unbalance_as_their_sense_says():
    from rotorgear.analysis.common.excitation import excitation_orders

    rotor = model("jeffcott")
    for speed in (600.0, -600.0):
        system = linear_system(rotor, [speed], Plan(2))
        forms = forms_of(system, speed, np.eye(system.n))
        found = modes_of(forms, 8, 1.0, system.n)
        lines = tuple(line for line in excitation_orders(rotor) if line.name == "shaft rotor 1x")
        taken = FormNames.of(rotor, speed).participations(lines, forms, found)[0]
        whirl = list(rg.modal(rotor, speed=speed, modes=10, elements=2).whirl)
        assert taken.max() == pytest.approx(1.0, abs=0.05)
        assert "forward" in whirl
        # Backward modes below, forward modes above: spin stiffens what precesses with it.
        bending = taken[(taken < 0.05) | (taken > 0.95)]
        assert len(bending) >= 2
        assert bending[0] < 0.05 < 0.95 < bending[1]


def test_forms_summed_over_numbers_are_those_of_whole_systems_and_numbers_that_meet_are_found_out():
    pair = model("geared_pair")
    system = linear_system(pair, [100.0], Plan(1))
    V = np.eye(system.n)[:, ::5]
    apart = spreads_of(
        pair, {"bearings.*.stiffness": Scatter(sigma="10 %"), "meshes.*.stiffness": Scatter(sigma="5 %")}
    )
    summed = family_of(apart, 100.0, Plan(1), V)
    assert summed.terms is not None
    z = np.linspace(-2.0, 2.0, len(apart))
    assert summed.at(z) == pytest.approx(summed.assembled(z), rel=1e-9, abs=1e-9 * np.abs(summed.nominal).max())
    meeting = spreads_of(
        model("jeffcott"),
        {"disks.disk.width": Scatter(sigma="5 %"), "disks.disk.outer_diameter": Scatter(sigma="5 %")},
    )
    rotor = linear_system(model("jeffcott"), [100.0], Plan(1))
    assert family_of(meeting, 100.0, Plan(1), np.eye(rotor.n)).terms is None


@pytest.mark.parametrize("loose", [1, 4])
def test_free_motions_of_several_bodies_are_no_elastic_modes(loose: int):
    # Ten and 28 motions without strain, before the first of the three modes that are asked for.
    section = [{"length": 0.2, "outer_diameter": 0.03}]
    shafts = {
        "held": {"sections": section},
        **{f"loose_{k}": {"start": 1.0 + k, "sections": section} for k in range(loose)},
    }
    bearing = {"shaft": "held", "at": "start", "stiffness": {"radial": 1e7}}
    rotor = rg.Model(materials=STEEL, shafts=shafts, bearings={"left": bearing})
    found = rg.scatter(rotor, "bearings.*.stiffness", samples=8, modes=3)
    assert found.frequency_basis_error < 1e-4
    exact = rg.modal(rotor, modes=6 * (loose + 1) + 4)
    assert [row.nominal_hz for row in found.bands] == pytest.approx(exact.frequency_hz[~exact.rigid][:3], rel=1e-3)


def test_numbers_that_meet_are_found_out_by_one_system_for_each_and_one_for_all(monkeypatch: pytest.MonkeyPatch):
    # Seed 201330: bearings beside teeth that feel the tilt of their shafts, 694 CPU s in place of 37.
    meeting = spreads_of(
        model("jeffcott"),
        {"disks.disk.width": Scatter(sigma="5 %"), "disks.disk.outer_diameter": Scatter(sigma="5 %")},
    )
    rotor = linear_system(model("jeffcott"), [100.0], Plan(1))
    taken = []
    found_there = state_at._state_at

    def counted(model: rg.Model, *rest: Any) -> Any:
        if model is not meeting.numbers.model:
            taken.append(model)
        return found_there(model, *rest)

    monkeypatch.setattr(state_at, "_state_at", counted)
    found = family_of(meeting, 100.0, Plan(1), np.eye(rotor.n))
    assert found.terms is None
    assert len(taken) == len(meeting) + 1
    z = np.array([0.3, -0.2])
    assert np.array_equal(found.at(z), found.assembled(z))
    found.system(z)
    assert len(taken) == len(meeting) + 2  # an equilibrium is found once


def test_samples_are_the_same_bit_for_bit_for_any_number_of_workers():
    given = {"free": "bearings.*.stiffness", "samples": 40, "modes": 4, "elements": 1}
    one = rg.scatter(model("geared_pair"), workers=1, **given)
    two = rg.scatter(model("geared_pair"), workers=3, **given)
    with ThreadPoolExecutor(2) as pool:
        elsewhere = rg.scatter(model("geared_pair"), executor=pool, **given)
    assert np.array_equal(one.sample_hz, two.sample_hz)
    assert np.array_equal(one.sample_margin, elsewhere.sample_margin, equal_nan=True)


def test_an_interrupted_scatter_goes_on_and_gives_the_same_numbers(tmp_path):
    given = {"free": "bearings.*.stiffness", "samples": 96, "modes": 4, "elements": 1}
    whole = rg.scatter(model("geared_pair"), **given)
    path = tmp_path / "scatter.h5"

    class StopError(Exception):
        pass

    def stop(fraction: float, step: str) -> None:
        if step.startswith("64 of"):
            raise StopError

    with pytest.raises(StopError):
        rg.scatter(model("geared_pair"), stream=rg.stream(path), progress=stop, **given)
    assert len(list((tmp_path / "scatter.h5.parts").glob("chunk_*"))) >= 2
    rest = rg.scatter(model("geared_pair"), stream=rg.stream(path, resume=True), **given)
    assert np.array_equal(rest.sample_hz, whole.sample_hz)
    assert rest == whole or rest.bands == whole.bands
    with pytest.raises(rg.RotorgearError, match="another model or other settings"):
        rg.scatter(model("geared_pair"), stream=rg.stream(path, resume=True), **{**given, "seed": 2})


def test_modes_at_a_veering_are_followed_by_shape():
    """Two pendulums with a soft spring between them: shapes turn by 45 degrees where they meet, slopes of shapes stay."""
    text = """
    motions = ["torsion"]
    [shafts.a]
    [shafts.b]
    [disks.a]
    shaft = "a"
    at = "start"
    polar_inertia = "1 kg m^2"
    [disks.b]
    shaft = "b"
    at = "start"
    polar_inertia = "1 kg m^2"
    [supports.a]
    shaft = "a"
    at = "start"
    stiffness = { torsion = "1000 N m/rad" }
    [supports.b]
    shaft = "b"
    at = "start"
    stiffness = { torsion = "1030 N m/rad" }
    [couplings.soft]
    from_shaft = "a"
    to_shaft = "b"
    stiffness = { torsion = "1 N m/rad" }
    """
    result = rg.scatter(rg.loads(text), {"supports.a.stiffness": Scatter(sigma="6 %")}, samples=512, modes=2)
    assert [group.modes for group in result.groups] == [(1, 2)]
    moved, still = result.bands
    # The first shape is almost wholly disk a, whose spring scatters: half of 6 %. By number it would share that with the other.
    assert moved.sigma_first_order == pytest.approx(0.03, rel=0.02)
    assert moved.sigma == pytest.approx(moved.sigma_first_order, rel=0.03)
    assert still.sigma < 0.003
    assert moved.found == still.found == 1.0


def test_a_class_of_iso_1328_is_the_index_error_of_two_gears():
    pair = model("helical_pair")
    name = next(iter(pair.meshes))
    spreads = spreads_of(pair, {"meshes.*.index_error": Scatter(grade=7)})
    variance = 0.0
    for gear in pair.layout.mesh(name).gears:
        g = gear.geometry
        along = math.cos(g.transverse_pressure_angle) * math.cos(g.base_helix_angle)
        variance += (cumulative_pitch_tolerance(g, 7) * along / (2.0 * math.sqrt(2.0))) ** 2
    assert spreads.size[0] == pytest.approx(math.sqrt(variance), rel=1e-12)
    # F_pT of class 5, d = 100 mm and m_n = 5 mm, by hand: 0.2 + 5.5 + 3.5 + 12 = 21.2 um.
    g = (
        rg.loads(
            '[shafts.a]\nsections = [{ length = "1 m", outer_diameter = "20 mm" }]\n'
            '[gears.g]\nshaft = "a"\nat = "1 m"\nkind = "spur"\nteeth = 20\nnormal_pressure_angle = "20 deg"\n'
            'normal_module = "5 mm"\nwidth = "20 mm"\n'
        )
        .layout.gear("g")
        .geometry
    )
    assert cumulative_pitch_tolerance(g, 5) == pytest.approx((0.2 + 5.5 + 3.5 + 12.0) * 1e-6, rel=1e-12)
    assert cumulative_pitch_tolerance(g, 7) == pytest.approx(2.0 * 21.2e-6, rel=1e-12)


def test_a_uniform_tolerance_is_its_limits_and_a_normal_one_three_sigma():
    rotor = model("jeffcott")
    uniform = spreads_of(rotor, {"bearings.*.stiffness": Scatter(tolerance="20 %", distribution="uniform")})
    values = [uniform.values(uniform.coordinates(np.full((1, 2), u))[0])[0] for u in (0.0, 0.5, 1.0)]
    assert values == pytest.approx([0.8, 1.0, 1.2])
    normal = spreads_of(rotor, {"disks.disk.at": Scatter(tolerance="3 mm")})
    assert normal.values(np.array([1.0])) == pytest.approx([0.401])


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"free": "bearings.*.stiffness", "sigma": "40 %"}, "lognormal"),
        ({"free": "bearings.*.stiffness", "sigma": "1 mm"}, "a share such as"),
        ({"free": "disks.disk.at", "sigma": "3 N/m"}, "20 mm"),
        ({"free": "bearings.nobody.stiffness"}, "no 'nobody'"),
        ({"free": {"bearings.*.stiffness": Scatter(grade=6)}}, "index_error"),
        ({}, "nothing scatters"),
        ({"free": "bearings.*.stiffness", "samples": 1}, "samples"),
        ({"free": "bearings.*.stiffness", "sampling": "halton"}, "sobol, latin"),
        ({"free": "bearings.*.stiffness", "margin": "150 %"}, "margin"),
        ({"free": "operation.speed"}, "operation.speed can.t vary.*give --speed"),
        ({"free": "disks.disk.at", "sigma": "2 mm", "samples": 4, "elements": 1, "modes": 2}, "past another"),
    ],
)
def test_what_cannot_scatter_is_refused_in_a_sentence(given, words):
    with pytest.raises(rg.RotorgearError, match=words):
        rg.scatter(model("jeffcott"), **given)


def test_the_table_of_the_file_says_what_scatters():
    text = PENDULUM + '\n[scatter]\n"supports.*.stiffness" = { sigma = "4 %" }\n'
    result = rg.scatter(rg.loads(text), samples=8, modes=1)
    assert [row.address for row in result.numbers] == ["supports.spring.stiffness"]
    assert result.bands[0].sigma_first_order == pytest.approx(0.02, rel=1e-6)
    with pytest.raises(rg.ModelError, match="one of sigma, tolerance and grade"):
        rg.loads(PENDULUM + '\n[scatter]\n"supports.*.stiffness" = { distribution = "normal" }\n')


def test_load_shares_scatter_as_their_derivatives_say():
    split = model("split_torque")
    free = {"meshes.stage_1a.index_error": Scatter(sigma="2 um")}
    result = rg.scatter(split, free, samples=32, modes=2, sharing=True, elements=1)
    statics = rg.static(split)
    j = statics.parameter.index("meshes.stage_1a.index_error")
    for row, slope in zip(result.shares, np.array(statics.share_derivative)[j], strict=True):
        assert row.sigma_first_order == pytest.approx(2e-6 * abs(slope), rel=1e-3)
        assert row.sigma == pytest.approx(row.sigma_first_order, rel=0.1)


@pytest.mark.parametrize(("sampling", "count"), [("sobol", 1), ("sobol", 4), ("random", 3), ("latin", 6)])
def test_stated_errors_of_quantiles_are_those_of_samples_whose_quantile_is_known(sampling: str, count: int):
    weight = np.linspace(0.5, 1.0, count) / np.linalg.norm(np.linspace(0.5, 1.0, count))
    exact = np.exp(0.1 * ndtri(0.05))
    true, stated = [], []
    for seed in range(40):
        y = np.exp(0.1 * ndtri(unit_points(sampling, 512, count, seed)) @ weight)
        true.append(np.quantile(y, 0.05) - exact)
        stated.append(quantile_error(y, 0.05))
    assert 0.5 < np.sqrt(np.mean(np.square(stated)) / np.mean(np.square(true))) < 3.0


def test_a_scatter_tells_the_standard_errors_of_its_quantiles():
    found = pendulum()
    band = found.bands[0]
    exact = band.nominal_hz * math.exp(-1.6449 * 0.5 * math.hypot(0.10, 0.06))
    assert 0.0 < band.low_error_hz < 0.01 * exact
    assert abs(band.low_hz - exact) < 4.0 * band.low_error_hz
    assert "standard errors of the quantiles by the number of samples: frequencies up to" in found.text()


@pytest.mark.long
def test_a_thousand_samples_of_a_split_torque_gearbox_equal_whole_solutions():
    split = model("split_torque")
    result = rg.scatter(split, "bearings.*.stiffness, meshes.*.stiffness", samples=1000)
    assert result.frequency_basis_error < 1e-4
    spreads = spreads_of(
        split, {name: Scatter(sigma="10 %") for name in ("bearings.*.stiffness", "meshes.*.stiffness")}
    )
    for k in (3, 400, 999):
        whole = rg.modal(spreads.at(result.z[k]), modes=22, speed=split.operation.speed)
        nearest = np.min(np.abs(whole.frequency_hz[None, :] / result.sample_hz[k][:, None] - 1.0), axis=1)
        lonely = [i for i, row in enumerate(result.bands) if sum(row.group == one.group for one in result.bands) == 1]
        assert nearest[lonely].max() < 5e-4


@pytest.mark.parametrize(
    ("rows", "text"),
    [
        ('"bearings.rotor_1_lft.stiffness" = { sigma = "10 %" }', "did you mean 'rotor_1_left'"),
        ('"bearings.*.stifness" = { sigma = "10 %" }', "did you mean 'stiffness'"),
        ('"bearings.*.stiffness" = { sigma = "2 kg" }', r"scatter\.\"bearings.*got '2 kg'"),
        ('"bearings.*.stiffness" = { grade = 6 }', "such as meshes"),
        ('"bearings.*.stiffness" = { sigma = "40 %" }', "lognormal"),
        ('"x.stiffness" = { sigma = "1 %" }\n"title" = { sigma = "1 %" }', "2 problems"),
    ],
)
def test_a_table_of_scatter_that_leads_nowhere_is_refused_when_the_file_is_read(rows, text):
    file = (MODELS / "geared_pair.toml").read_text() + "\n[scatter]\n"
    with pytest.raises(ModelError, match=text):
        rg.loads(file + rows)


SPRUNG = """
motions = ["bending"]
operation = { input_shaft = "one", speed = "180 rad/s" }
shafts.one = {}
disks.wheel = { shaft = "one", at = "start", mass = 2.0, polar_inertia = 0.01, diametral_inertia = 0.01 }
supports.spring = { shaft = "one", at = "start", stiffness = { radial = 8e4 }, fixed = ["tilt_x", "tilt_y"] }
"""


def test_the_share_below_the_margin_is_that_of_the_normal_distribution_between_both_sides_of_a_line():
    """ln f of a mass on a spring is normal about 200 rad/s; its unbalance turns at 180."""
    sigma = 0.5 * math.hypot(0.10, 0.06)
    given = {
        "supports.spring.stiffness": Scatter(sigma="10 %", distribution="lognormal"),
        "disks.wheel.mass": Scatter(sigma="6 %", distribution="lognormal"),
    }
    result = rg.scatter(rg.loads(SPRUNG), given, samples=256, modes=1, elements=1, margin="7 %")
    row = next(row for row in result.margins if row.frequency_hz == pytest.approx(180.0 / (2.0 * math.pi)))
    assert row.nominal == pytest.approx(200.0 / 180.0 - 1.0)
    sides = [math.log(0.9 * (1.0 + side * 0.07)) / sigma for side in (-1.0, 1.0)]
    assert row.below == pytest.approx(ndtr(sides[1]) - ndtr(sides[0]), abs=0.01)
    # |f/f_line - 1| = m where ln f is on either side: half of the samples are closer than the median.
    nearer = [math.log(0.9 * (1.0 + side * row.median)) / sigma for side in (-1.0, 1.0)]
    assert ndtr(nearer[1]) - ndtr(nearer[0]) == pytest.approx(0.5, abs=0.01)
