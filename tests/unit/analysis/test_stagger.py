"""The stagger of a herringbone pair is one number: each helix has its own stiffness and errors at its own phase.

Two independent descriptions: by symmetry, odd orders of the total vanish where the helices are half a pitch apart on shafts
that are mirror images of themselves; and two helical pairs on the same shafts, of opposite hands and with phases typed in, are
the same machine.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.models import spur_pair

OFFSET = 0.025  # m from the gears' middle to each helix: (gap + width)/2
BODY = {"pinion": (2.0, 2.4e-3, 2.9e-3), "wheel": (4.5, 1.2e-2, 1.0e-2)}  # kg, kg m^2, kg m^2 of the whole gears
ERRORS = [
    {"harmonic": 1, "amplitude": "2 um", "phase": "35 deg"},
    {"harmonic": 2, "amplitude": "1 um", "phase": "-70 deg"},
]
# Shafts that are no mirror image of themselves, with one diameter under both helices: their blanks have one bore.
UNEVEN = {"one": (("25 mm", "30 mm"), ("95 mm", "45 mm")), "two": (("100 mm", "60 mm"), ("20 mm", "40 mm"))}


def base(shafts: dict[str, Any] | None, **changes: Any) -> dict[str, Any]:
    own: dict[str, Any] = {
        "shafts__two__position": ["100 mm", "86.7801 mm"],
        "gears__pinion": None,
        "gears__wheel": None,
        "meshes__pair": None,
        "damping__rayleigh_beta": None,
        "damping__rayleigh_alpha": "60 1/s",
        "points": None,
        # The torque comes in and goes out between the helices, so that it twists the shafts evenly.
        "operation": {"input_shaft": "one", "speed": "1500 rpm"},
        "loads": {
            "motor": {"shaft": "one", "kind": "input", "at": "60 mm", "torque": "200 N m"},
            "mill": {"shaft": "two", "kind": "output", "at": "60 mm"},
        },
    }
    for shaft, even in (("one", (("120 mm", "40 mm"),)), ("two", (("120 mm", "50 mm"),))):
        sections = shafts[shaft] if shafts else even
        own[f"shafts__{shaft}__sections"] = [{"length": z, "outer_diameter": d} for z, d in sections]
    for name in "abcd":
        own[f"bearings__{name}__damping"] = {"radial": "2e4 N s/m", "axial": "1e4 N s/m"}
    return {**own, **changes}


def gear(shaft: str, teeth: int, **own: Any) -> dict[str, Any]:
    return {
        "shaft": shaft,
        "at": "60 mm",
        "teeth": teeth,
        "normal_module": "4 mm",
        "helix_angle": "25 deg",
        "width": "30 mm",
        **own,
    }


def mesh(stiffness: Any, damping: float, **own: Any) -> dict[str, Any]:
    return {"stiffness": stiffness, "damping": damping, "transmission_error": ERRORS, **own}


def herringbone(stiffness: Any, stagger: float, shafts: dict[str, Any] | None = None, **changes: Any) -> rg.Model:
    own = base(shafts)
    for name, shaft, teeth, hand in (("pinion", "one", 24, "right"), ("wheel", "two", 36, "left")):
        mass, polar, tilt = BODY[name]
        inertia = {"mass": mass, "polar_inertia": polar, "diametral_inertia": tilt}
        own[f"gears__{name}"] = gear(shaft, teeth, kind="herringbone", gap="20 mm", hand=hand, **inertia)
    own["meshes__pair"] = mesh(stiffness, 6e3, stagger=stagger, pinion="pinion", gear="wheel")
    return spur_pair(**{**own, **changes})


def two_helical(stiffness: Any, phases: tuple[float, float], shafts: dict[str, Any] | None = None) -> rg.Model:
    """The same machine as two helical pairs: half the body at each helix, and the phases typed in (rad)."""
    own = base(shafts)
    for helix, side in enumerate((-1, 1)):
        for name, shaft, teeth, hands in (
            ("pinion", "one", 24, ("right", "left")),
            ("wheel", "two", 36, ("left", "right")),
        ):
            mass, polar, tilt = BODY[name]
            inertia = {
                "mass": mass / 2,
                "polar_inertia": polar / 2,
                "diametral_inertia": 0.5 * (tilt - mass * OFFSET**2),
            }
            at = 0.06 + side * OFFSET
            own[f"gears__{name}_{helix}"] = gear(shaft, teeth, kind="helical", hand=hands[helix], **inertia) | {
                "at": at
            }
        ends = {"pinion": f"pinion_{helix}", "gear": f"wheel_{helix}"}
        own[f"meshes__pair_{helix}"] = mesh(stiffness, 3e3, phase=phases[helix] % (2.0 * np.pi), **ends)
    return spur_pair(**own)


def odd_share(total: np.ndarray) -> float:
    """Largest odd order over the largest even one of (n,) values of one mesh period."""
    size = np.abs(np.fft.rfft(total))[1:20]
    return float(size[::2].max() / size[1::2].max())


@pytest.mark.parametrize("model", ["contact_line", "potential_energy"])
def test_half_a_pitch_apart_odd_orders_of_the_stiffness_of_a_pair_vanish(model: str) -> None:
    found = rg.mesh(herringbone(model, 0.5), positions=64)
    assert odd_share(found.stiffness) < 1e-9
    assert odd_share(rg.mesh(herringbone(model, 0.25), positions=64).stiffness) > 0.1


@pytest.mark.parametrize("stiffness", ["potential_energy", {"mean": 4e8, "amplitudes": [0.1, 0.05, 0.02]}])
def test_half_a_pitch_apart_odd_orders_of_the_total_force_vanish_on_even_shafts(stiffness: Any) -> None:
    result = rg.response(herringbone(stiffness, 0.5), speeds=["1500 rpm"], elements=1, method="direct")
    each = np.abs(result.mesh_force[:, 0])  # (orders, helices)
    total = np.abs(result.mesh_force[:, 0].sum(axis=1))
    order = {name: k for k, name in enumerate(result.orders)}
    even = total[order["mesh pair 2x"]]
    assert total[order["mesh pair 1x"]] < 1e-9 * even
    assert total[order["mesh pair 3x"]] < 1e-9 * even
    assert each[order["mesh pair 1x"]].min() > 1e-2 * even


@pytest.mark.parametrize("shafts", [None, UNEVEN], ids=["even", "uneven"])
@pytest.mark.parametrize("stagger", [0.0, 0.25, 0.5])
@pytest.mark.parametrize("direction", [1, -1])
def test_each_helix_answers_as_in_a_model_of_two_helical_pairs(
    shafts: dict[str, Any] | None, stagger: float, direction: int
) -> None:
    one = herringbone("potential_energy", stagger, shafts)
    phase = one.torque_flow(direction).phases["pair"]
    assert phase is not None
    # A quarter of a pitch ahead about the pinion's own sense of rotation lies behind when everything turns back.
    other = two_helical("potential_energy", (phase, phase + direction * 2.0 * np.pi * stagger), shafts)
    got, want = (
        rg.response(model, speeds=[f"{direction * 1500} rpm"], elements=1, method="direct") for model in (one, other)
    )
    assert len(got.orders) == len(want.orders)
    assert got.mean_force == pytest.approx(want.mean_force, rel=1e-9)
    size = np.abs(want.mesh_force[:, 0]).max(axis=1, keepdims=True)
    assert np.max(np.abs(got.mesh_force[:, 0] - want.mesh_force[:, 0]) / size) < 1e-9


def test_half_a_pitch_apart_odd_orders_of_the_total_vanish_in_a_settled_transient() -> None:
    model = herringbone("potential_energy", 0.5)
    result = rg.transient(
        model, speed="1500 rpm", time=0.02, discard=0.3, steps=64, elements=1, method="newmark", error_estimate=False
    )
    total = result.mesh_force[result.counted].sum(axis=1)[:-1]  # twelve mesh periods; the last sample begins another
    orders = np.abs(np.fft.rfft(total))[12::12][:6]
    assert orders[::2].max() < 1e-6 * orders[1::2].max()
