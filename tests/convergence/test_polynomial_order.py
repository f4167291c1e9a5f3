"""Shaft elements of higher order: exponential convergence to closed forms, cones, and the limit without shear."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import rotorgear as rg

# Pinned-pinned Timoshenko beam, L = 1 m, E = 210 GPa, nu = 0.3, rho = 7850, kappa = 6(1+nu)/(7+6nu): closed-form quartic.
E_MODULUS = 210e9
NU = 0.3
RHO = 7850.0
LENGTH = 1.0
KAPPA = 6.0 * (1.0 + NU) / (7.0 + 6.0 * NU)


def pinned_beam(diameter: float, motions: tuple[str, ...] = ("bending",)) -> rg.Model:
    section = rg.Section(length=LENGTH, outer_diameter=diameter, shear_coefficient=KAPPA)
    return rg.Model(
        motions=motions,
        materials={"m": rg.Material(youngs_modulus=E_MODULUS, poisson_ratio=NU, density=RHO)},
        shafts={"s": rg.Shaft(material="m", sections=[section])},
        supports={
            "a": rg.Support(shaft="s", at="start", fixed=("x", "y")),
            "b": rg.Support(shaft="s", at="end", fixed=("x", "y")),
        },
    )


def closed_form(diameter: float, n: int) -> float:
    """Lower branch of rho^2 I/(kappa G) w^4 - [rho A + rho I k^2 (1 + E/(kappa G))] w^2 + E I k^4 = 0 in Hz."""
    area = np.pi / 4 * diameter**2
    inertia = np.pi / 64 * diameter**4
    shear = KAPPA * E_MODULUS / (2 * (1 + NU))
    k = n * np.pi / LENGTH
    a = RHO**2 * inertia / shear
    b = RHO * area + RHO * inertia * k**2 * (1 + E_MODULUS / shear)
    c = E_MODULUS * inertia * k**4
    return float(np.sqrt(2 * c / (b + np.sqrt(b * b - 4 * a * c))) / (2 * np.pi))


@pytest.mark.parametrize("diameter", [0.02, 0.2])
@pytest.mark.parametrize("accuracy", [1e-3, 1e-5, 1e-7, 1e-9])
def test_a_beam_is_within_the_accuracy_that_is_asked_for(diameter: float, accuracy: float) -> None:
    result = rg.modal(pinned_beam(diameter), modes=10, accuracy=accuracy)
    exact = np.repeat([closed_form(diameter, n) for n in range(1, 6)], 2)
    assert np.max(np.abs(result.frequency_hz / exact - 1.0)) <= accuracy


@pytest.mark.parametrize("diameter", [0.02, 0.2])
@pytest.mark.parametrize("elements", [1, 2, 4, 8, 16])
def test_the_estimate_is_within_a_factor_of_three_of_the_true_error(diameter: float, elements: int) -> None:
    result = rg.modal(pinned_beam(diameter), modes=6, elements=elements)
    exact = np.repeat([closed_form(diameter, n) for n in range(1, 4)], 2)[: len(result)]
    error = np.abs(result.frequency_hz / exact - 1.0)
    # Where the mesh is too coarse for a mode the estimate says infinite, and that must be so only for large errors.
    told = np.isfinite(result.error_estimate)
    assert np.all(error[~told] > 1e-2)
    ratio = result.error_estimate[told] / error[told]
    assert np.all((ratio > 1 / 3) & (ratio < 3)), ratio


def test_the_error_falls_by_a_factor_of_ten_or_more_with_every_second_order() -> None:
    from rotorgear.system.plan import Plan

    exact = closed_form(0.2, 1)
    errors = [
        abs(rg.modal(rg.System(pinned_beam(0.2), plan=Plan(1, order)), modes=1).frequency_hz[0] / exact - 1.0)
        for order in (2, 4, 6, 8)
    ]
    assert all(finer < coarser / 10 for coarser, finer in pairwise(errors)), errors
    assert errors[-1] < 1e-10


@pytest.mark.parametrize(("motion", "wave"), [("axial", E_MODULUS), ("torsion", E_MODULUS / (2 * (1 + NU)))])
def test_a_free_bar_has_its_closed_form_frequencies(motion: str, wave: float) -> None:
    model = rg.Model(
        motions=(motion,),
        materials={"m": rg.Material(youngs_modulus=E_MODULUS, poisson_ratio=NU, density=RHO)},
        shafts={"s": rg.Shaft(material="m", sections=[rg.Section(length=LENGTH, outer_diameter=0.05)])},
    )
    result = rg.modal(model, modes=4, accuracy=1e-9)
    exact = np.arange(1, 4) * np.sqrt(wave / RHO) / (2 * LENGTH)
    assert result.rigid.tolist() == [True, False, False, False]
    assert np.max(np.abs(result.frequency_hz[1:] / exact - 1.0)) < 1e-9


def test_a_cone_of_one_element_converges_to_the_same_frequencies_as_many_elements() -> None:
    section = rg.Section(length=0.5, outer_diameter=0.08, outer_diameter_end=0.04, bore=0.02, bore_end=0.01)
    model = rg.Model(shafts={"s": rg.Shaft(sections=[section])})
    fine = rg.modal(model, modes=14, elements=200)
    one = rg.modal(model, modes=14, accuracy=1e-8)
    assert np.max(np.abs(one.frequency_hz[6:] / fine.frequency_hz[6:] - 1.0)) < 2e-4
    assert one.dofs < fine.dofs / 3


def test_without_shear_deformation_a_thin_beam_approaches_euler_and_bernoulli() -> None:
    d = 0.001
    model = rg.Model(
        motions=("bending",),
        materials={"m": rg.Material(youngs_modulus=E_MODULUS, poisson_ratio=NU, density=RHO)},
        shafts={
            "s": rg.Shaft(material="m", shear_deformation=False, sections=[rg.Section(length=1.0, outer_diameter=d)])
        },
        supports={
            "a": rg.Support(shaft="s", at="start", fixed=("x", "y")),
            "b": rg.Support(shaft="s", at="end", fixed=("x", "y")),
        },
    )
    result = rg.modal(model, modes=4, accuracy=1e-9)
    euler = np.pi / 2 * np.sqrt(E_MODULUS * (d / 4) ** 2 / RHO)
    k = np.pi  # rotary inertia lowers the frequency by 1/sqrt(1 + (k r)^2), r = d/4
    assert result.frequency_hz[0] == pytest.approx(euler / np.sqrt(1 + (k * d / 4) ** 2), rel=1e-8)


def test_a_piece_that_no_requested_mode_bends_stays_coarse() -> None:
    """A stiff and massive stub beside a soft overhang: the lowest modes live in the overhang."""
    sections = [rg.Section(length=0.05, outer_diameter=0.3), rg.Section(length=1.0, outer_diameter=0.02)]
    model = rg.Model(
        motions=("bending",),
        shafts={"s": rg.Shaft(sections=sections)},
        supports={"a": rg.Support(shaft="s", at="start", fixed=("x", "y", "tilt_x", "tilt_y"))},
    )
    result = rg.modal(model, modes=8, accuracy=1e-6)
    stub, overhang = result.discretisation
    assert stub.elements * stub.order < overhang.elements * overhang.order


def test_a_shaft_that_no_requested_mode_moves_stays_as_it_started() -> None:
    soft = rg.Shaft(sections=[rg.Section(length=1.0, outer_diameter=0.02)])
    stiff = rg.Shaft(sections=[rg.Section(length=0.2, outer_diameter=0.2)])
    held = ("x", "y", "tilt_x", "tilt_y")
    model = rg.Model(
        motions=("bending",),
        shafts={"soft": soft, "stiff": stiff},
        supports={name: rg.Support(shaft=name, at="start", fixed=held) for name in ("soft", "stiff")},
    )
    pieces = {piece.shaft: piece for piece in rg.modal(model, modes=2, accuracy=1e-7).discretisation}
    assert (pieces["stiff"].elements, pieces["stiff"].order) == (1, 2)
    assert pieces["soft"].order > 2


def test_a_spinning_beam_is_within_the_accuracy_and_its_estimate_is_honest() -> None:
    """Closed-form quartic (kGA k^2 - rho A w^2)(E I k^2 + kGA - rho I w^2 + 2 rho I W w) = (kGA k)^2 of case spinning_shaft."""
    model = pinned_beam(0.2)
    exact = {"b": 2428.15841364 / (2 * np.pi), "f": 2449.22609259 / (2 * np.pi)}
    result = rg.modal(model, speed=500.0, modes=2, accuracy=1e-8)
    assert np.max(np.abs(np.sort(result.frequency_hz) / [exact["b"], exact["f"]] - 1.0)) < 1e-8
    coarse = rg.modal(model, speed=500.0, modes=2, elements=4)
    error = np.abs(np.sort(coarse.frequency_hz) / [exact["b"], exact["f"]] - 1.0)
    assert np.all((coarse.error_estimate / error > 1 / 3) & (coarse.error_estimate / error < 3))
    assert coarse.whirl == ("backward", "forward")


def test_a_mode_that_a_coarse_mesh_puts_above_the_limit_is_not_lost() -> None:
    """One element of order 2 has its second pair of bending modes far too high; the limit lies just above the true one."""
    model = pinned_beam(0.02)
    limit = 1.001 * closed_form(0.02, 5)
    result = rg.modal(model, fmax=limit, accuracy=1e-3)
    assert len(result) == 10


def test_a_mesh_with_too_few_modes_is_refined_until_it_has_those_asked_for() -> None:
    held = ("x", "y", "tilt_x", "tilt_y")
    model = rg.Model(
        motions=("bending",),
        shafts={"s": rg.Shaft(sections=[rg.Section(length=1.0, outer_diameter=0.02)])},
        supports={end: rg.Support(shaft="s", at=end, fixed=held) for end in ("start", "end")},
    )
    result = rg.modal(model, modes=40)
    assert len(result) == 40
    assert result.error_estimate.max() <= 1e-3
