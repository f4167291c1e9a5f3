"""Stiff and extreme cases: what each is compared with, and the error it must stay below, or the sentence that refuses it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import mpmath as mp
import numpy as np

import rotorgear as rg
from tests.extreme.damped_errors import (
    backwards,
    cross_coupled,
    damped_massless,
    fast_with_table,
    internal_damping,
    overdamped_mass,
    proportional,
    tables,
    tilting_disk,
    whirl_error,
)
from tests.extreme.models import points, rotor_model
from tests.extreme.references import DIGITS, Body, Rotor, Segment, Spring
from tests.extreme.rotors import even, on
from tests.extreme.undamped_errors import (
    bar,
    chain,
    indefinite,
    massless,
    merged,
    no_elements,
    nothing_below,
    only_axial,
    pinned,
    rigid_mesh,
    rigid_shaft,
    scaled_units,
    shafts,
    strain_error,
    two_disks,
    zero_gap,
    zero_inertia_gear,
)


@dataclass(frozen=True)
class Case:
    """A case that is computed: `measure()` returns its relative error, which must be below `bound`."""

    name: str
    reference: str
    bound: float
    measure: Callable[[], float]


@dataclass(frozen=True)
class Refused:
    """A case that is refused: `act()` raises an error whose text holds `sentence`."""

    name: str
    sentence: str
    act: Callable[[], object]


@dataclass(frozen=True)
class Conditioning:
    """A row of the table of conditioning: K alone errs by more than `alone` (None: below 1e-13), strains by less than 1e-13."""

    name: str
    rotor: Rotor
    alone: float | None


_THIN = [Segment(0.1, 0.05), *[Segment(1e-4, 0.05)] * 4, Segment(0.1, 0.05)]


_MICRON = [Segment(0.1, 0.05), Segment(0.1, 0.05), Segment(1e-6, 0.05), Segment(0.1, 0.05)]


_UNEQUAL = {2: Body(1e3, 1e1, 5.0), 4: Body(1e-3, 1e-5, 5e-6)}


_WORST = Rotor(
    [Segment(0.1, 0.05), Segment(1e-4, 0.05), Segment(0.1, 0.05), Segment(0.1, 0.05)],
    {0: Spring(1e13), 4: Spring(1e3)},
    {2: Body(1e3, 1e3, 1e3), 3: Body(1e-3, 1e-3, 1e-3)},
)


CONDITIONING = [
    Conditioning("base: bearings of 1e8 N/m", Rotor(even(), on(1e8)), None),
    Conditioning("bearings of 1e-3 N/m", Rotor(even(), on(1e-3)), 1e-6),
    Conditioning("bearings of 1e3 N/m", Rotor(even(), on(1e3)), 1e-12),
    Conditioning("bearings of 1e13 N/m", Rotor(even(), on(1e13)), None),
    Conditioning("bearings of 1e3 and 1e13 N/m", Rotor(even(), on(1e3, 1e13)), 1e-12),
    Conditioning("a segment of 1 um", Rotor(_MICRON, on(1e6, last=4)), 1e-12),
    Conditioning("four segments of 0.1 mm in a row", Rotor(_THIN, on(1e6, last=6)), 1e-12),
    Conditioning("the same on bearings of 1e3 N/m", Rotor(_THIN, on(1e3, last=6)), 1e-9),
    Conditioning("inertia ratio of 1e6", Rotor(even(), on(1e8), _UNEQUAL), None),
    Conditioning("2 mm shaft on 1e13 N/m", Rotor(even(outer=0.002), on(1e13)), None),
    Conditioning("0.1 mm, 1e3 and 1e13 N/m, inertia ratio 1e6", _WORST, 1e-11),
]


def _undamped(name: str, rotor: Rotor) -> Case:
    return Case(name, "40 digits", 1e-13, lambda: strain_error(rotor))


def _whirling(name: str, rotor: Rotor, speed: float) -> Case:
    return Case(name, "40 digits", 1e-12, lambda: whirl_error(rotor, speed))


CASES: list[Case] = [
    *(_undamped(row.name, row.rotor) for row in CONDITIONING),
    _undamped("no bearings at all: six rigid modes", Rotor(even())),
    _undamped("bearings of 1 N/m", Rotor(even(), on(1.0))),
    _undamped("a segment of 100 diameters", Rotor([Segment(5.0, 0.05), Segment(0.1, 0.05)], on(1e7, last=2))),
    _undamped("a hollow shaft with walls of 1 %", Rotor(even(outer=0.1, inner=0.098), on(1e7))),
    _undamped(
        "a stub of 0.5 mm on a shaft of 0.5 m", Rotor([Segment(0.1, 0.5), Segment(0.1, 0.0005)], on(1e8, last=1))
    ),
    _whirling("spin of 1e5 rad/s", Rotor(even(), on(1e8, damping=1e3), _UNEQUAL), 1e5),
    _whirling("spin of 1e5 rad/s, a bearing of 1e13 N/m", Rotor(even(), on(1e8, 1e13), _UNEQUAL), 1e5),
    _whirling("bearings of 1e-3 N/m at 1e3 rad/s, undamped", Rotor(even(), on(1e-3)), 1e3),
    _whirling("bearings of 1e-3 N/m and 1e3 N s/m at 1e3 rad/s", Rotor(even(), on(1e-3, damping=1e3)), 1e3),
    _whirling("bearings of 1e3 and 1e13 N/m, damped, at 1e5 rad/s", Rotor(even(), on(1e3, 1e13, 1e3)), 1e5),
    _whirling("four segments of 0.1 mm, soft bearings, at 1e4 rad/s", Rotor(_THIN, on(1e3, damping=10.0, last=6)), 1e4),
    _whirling("0.1 mm, 1e3 and 1e13 N/m, inertia ratio 1e6, at 1e4 rad/s", _WORST, 1e4),
    _whirling("overdamped bearings, 1e6 N s/m", Rotor(even(), on(1e8, damping=1e6)), 0.0),
    _whirling("overdamped bearings, 1e10 N s/m", Rotor(even(), on(1e6, damping=1e10)), 0.0),
    _whirling("overdamped bearings, 1e6 N s/m, at 1e3 rad/s", Rotor(even(), on(1e6, damping=1e6)), 1e3),
    Case("internal damping of 1 s at standstill", "40 digits", 1e-12, lambda: internal_damping(1.0, 1e7, 0.0)),
    Case("internal damping above the critical speed", "40 digits", 1e-12, lambda: internal_damping(1e-5, 1e7, 2e4)),
    Case("the same on bearings of 1 N/m", "40 digits", 1e-12, lambda: internal_damping(1e-5, 1.0, 2e4)),
    Case("C = beta K with beta = 1 s, bearings of 1 N/m", "closed form", 1e-12, lambda: proportional(1.0, 1.0)),
    Case("a damping ratio of 1e5: two real roots a motion", "closed form", 1e-12, lambda: overdamped_mass(2.0, 4e5)),
    Case("cross-coupling just below the onset of whirl", "closed form", 1e-12, lambda: cross_coupled(0.999999)),
    Case("cross-coupling just above it: unstable", "closed form", 1e-12, lambda: cross_coupled(1.000001)),
    Case("a disk that only tilts, 1e-2 N m/rad at 1e5 rad/s", "closed form", 1e-12, tilting_disk),
    Case("a massless dof between two springs", "closed form", 1e-14, massless),
    Case("a massless dof with a damper", "closed form", 1e-13, damped_massless),
    Case("four loose shafts: 24 rigid modes", "40 digits", 1e-13, lambda: shafts(4, None)),
    Case("four equal shafts: every mode at least eightfold", "40 digits", 1e-13, lambda: shafts(4, 1e7)),
    Case("four shafts whose bearings differ by 1e-9", "40 digits", 1e-13, lambda: shafts(4, 1e7, 1e-9)),
    Case("a mesh of 1e12 N/m: the rigid mesh", "closed form", 1e-13, lambda: rigid_mesh(1e12)),
    Case("a mesh of 1e-3 N/m", "closed form", 1e-13, lambda: rigid_mesh(1e-3)),
    Case("gears without inertia", "40 digits", 1e-13, zero_inertia_gear),
    Case("a gearbox in um", "similarity", 1e-11, lambda: scaled_units(1e-6, None)),
    Case("a gearbox in km", "similarity", 1e-11, lambda: scaled_units(1e3, None)),
    Case("a gearbox in um at speed", "similarity", 1e-9, lambda: scaled_units(1e-6, 300.0)),
    Case("a gearbox in km at speed", "similarity", 1e-9, lambda: scaled_units(1e3, 300.0)),
    Case("a bearing with axial stiffness only", "40 digits", 1e-13, only_axial),
    Case("a coupling of 1e13 N m/rad", "closed form", 1e-14, lambda: two_disks(1e13)),
    Case("a coupling of 1e-3 N m/rad", "closed form", 1e-14, lambda: two_disks(1e-3)),
    Case("a coupling of 1e13 N m/rad across no gap", "40 digits", 1e-13, zero_gap),
    Case("torsional chain of 1000 disks", "closed form", 1e-12, lambda: chain(1000, 24)),
    Case("all modes of a chain of 300, and more asked for", "closed form", 1e-12, lambda: chain(300, 5000)),
    Case("accuracy of 1e-11, torsion of a bar", "closed form", 1e-11, lambda: bar(1e-11)),
    Case(
        "accuracy of 1e-9, ten modes of a thick pinned shaft", "closed form", 1e-9, lambda: pinned(0.3, 0.1, 1e-9, 10)
    ),
    Case("accuracy of 1e-9, pinned shaft of 1000 diameters", "closed form", 1e-9, lambda: pinned(10.0, 0.01, 1e-9, 6)),
    Case("accuracy of 1e-11 without any shaft element", "closed form", 1e-14, no_elements),
    Case("a shaft that is rigid altogether", "closed form", 1e-13, lambda: rigid_shaft((), 1e6)),
    Case("four adjacent rigid sections", "closed form", 1e-13, lambda: rigid_shaft((1e-4, 0.2, 0.3), 1e13)),
    Case("tables of bearings at 1e5 rad/s", "40 digits", 1e-12, fast_with_table),
    Case("a negative speed", "40 digits", 1e-12, backwards),
    Case("two disks 1e-11 m apart: one node, listed", "40 digits", 1e-13, merged),
    Case("no mode below fmax: an empty result", "none there", 1e-300, nothing_below),
]


REFUSED: list[Refused] = [
    Refused(
        "a dof with neither inertia nor stiffness",
        "neither inertia nor stiffness",
        lambda: rg.modal(points([0.3, 0.0, 0.0], [1e5, 0.0])),
    ),
    Refused("a speed outside a bearing's table", "its table covers", lambda: tables(3e5)),
    Refused("a 6 x 6 stiffness that is indefinite", "statically unstable", indefinite),
    Refused(
        "an accuracy below rounding",
        "the accuracy must lie between",
        lambda: rg.modal(rotor_model(Rotor(even(), on(1e8))), accuracy=1e-13),
    ),
    Refused(
        "no modes asked for",
        "the number of modes must be at least 1",
        lambda: rg.modal(rotor_model(Rotor(even())), modes=0),
    ),
    Refused(
        "everything held",
        "no free degree of freedom",
        lambda: rg.modal(
            rg.Model(shafts={"p": rg.Shaft()}, supports={"w": rg.Support(shaft="p", at=0.0, fixed=("all",))})
        ),
    ),
    Refused("a number that is not finite", "expected", lambda: rg.Section(length=float("nan"), outer_diameter=0.1)),
    Refused(
        "a wall of no thickness", "less than the outer diameter", lambda: rotor_model(Rotor([Segment(0.1, 0.05, 0.05)]))
    ),
    Refused(
        "a negative stiffness",
        "0 or more on the diagonal",
        lambda: rotor_model(
            Rotor(even()),
            supports={
                "n": rg.Support(shaft="s", at=0.0, stiffness=rg.StiffnessMatrix(matrix=np.diag([-1.0] * 6).tolist()))
            },
        ),
    ),
]


@cache
def measured(case: Case) -> float:
    """The error of a case, once for the tests and the page."""
    with mp.workdps(DIGITS):
        return case.measure()
