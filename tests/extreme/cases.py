"""Stiff and extreme cases: what each is compared with, and the error it must stay below, or the sentence that refuses it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import mpmath as mp
import numpy as np

import rotorgear as rg
from tests.extreme.bearing_errors import (
    ANGULAR,
    BALLS,
    FILM,
    LOBES,
    PADS,
    ROLLERS,
    axial_angle,
    loaded,
    moved,
    ocvirk,
    power_law,
    scaled,
    sheet_stiffness,
    thick_and_slow,
)
from tests.extreme.body_errors import (
    block_modes,
    rod,
    scaled_block,
    scatter_of_spring,
    state_space_of_mass,
    stiff_bar,
    updated_spring,
)
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
from tests.extreme.forced_errors import (
    chain_estimate,
    chain_receptance,
    mass_on_spring,
    receptance,
    sag,
    static_estimate,
    unbalance_response,
)
from tests.extreme.models import points, rotor_model
from tests.extreme.orbit_errors import orbit_of_pair, orbit_of_rattle, sweep_of_rattle, transient_of_rattle
from tests.extreme.planet_errors import (
    Stage,
    inclined,
    inclined_error,
    share_error,
    stage_error,
    thin_ring,
    thin_ring_mass,
)
from tests.extreme.references import DIGITS, Body, Rotor, Segment, Spring
from tests.extreme.rotors import even, on
from tests.extreme.speed_errors import (
    RPM,
    critical_of_masses,
    critical_of_tilting,
    masses,
    tilting,
    whirls_of_tilting,
)
from tests.extreme.time_errors import linear_pair, resonance, stepped_torque, sweep_of_pair, whirl_in_time
from tests.extreme.tooth_errors import broken_contact, contact_ratio, iso_stiffness, pair_of, undercut
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
from tests.unit.analysis.impact_oscillator import ImpactOscillator


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
class Flagged:
    """A case that is computed and warned about: one of the warnings of the result of `act()` holds `sentence`."""

    name: str
    sentence: str
    act: Callable[[], rg.Result]


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


_ROD = Segment(1.0, 0.05)


FORCED: list[Case] = [
    Case("static: sag on bearings of 1e8 N/m", "closed form", 1e-12, lambda: sag(_ROD, 1e8, 1e8)),
    Case("static: sag on bearings of 1e3 and 1e13 N/m", "closed form", 1e-9, lambda: sag(_ROD, 1e3, 1e13)),
    Case(
        "static: the same on 1e-3 and 1e13 N/m, over its estimate", "estimate", 2.0, lambda: static_estimate(1e-3, 1e13)
    ),
    Case("static: 10 m of 1 mm wire on 1e13 N/m", "closed form", 1e-12, lambda: sag(Segment(10.0, 1e-3), 1e13, 1e13)),
    Case("static: a shaft of 1 um by 10 um", "closed form", 1e-11, lambda: sag(Segment(1e-5, 1e-6), 1e2, 1e2)),
    Case("static: a shaft of 1000 km", "closed form", 1e-11, lambda: sag(Segment(1e6, 1.0), 1e8, 1e8)),
    Case("static: ten times as thick as long", "closed form", 1e-11, lambda: sag(Segment(0.1, 1.0), 1e10, 1e10)),
    Case("frf: a damping ratio of 3.5e5", "closed form", 1e-14, lambda: receptance(1e6, 1e9, [1e-6, 1e-3, 1.0, 1e3])),
    Case(
        "frf: 1e-9 beside the resonance, undamped",
        "closed form",
        1e-6,
        lambda: receptance(1e6, 0.0, [1 - 1e-9, 1 + 1e-9]),
    ),
    Case(
        "frf: soft ground of 1e-3 N/m, Q of 4e7", "closed form", 1e-7, lambda: receptance(1e-3, 1e-9, [1e-6, 1.0, 1e6])
    ),
    Case("frf: 1e-6 kg on 1e13 N/m", "closed form", 1e-13, lambda: receptance(1e13, 1e2, [1e-6, 1.0, 1e3], 1e-6)),
    Case("frf: a massless point", "40 digits", 1e-13, lambda: chain_receptance([0.3, 0.0, 0.2], [1e5, 1e3], 1e4, 10.0)),
    Case(
        "frf: ground of 1e-4 N m/rad under 1e8",
        "40 digits",
        1e-11,
        lambda: chain_receptance([0.3, 0.2, 0.1], [1e8, 1e8], 1e-4, 100.0),
    ),
    Case("frf: ground of 1 N m/rad under 1e12, over its estimate", "estimate", 2.0, lambda: chain_estimate(1e12)),
    Case("frf: an inertia ratio of 1e12", "40 digits", 1e-13, lambda: chain_receptance([1e6, 1e-6], [1e3], 1e9, 1e3)),
    Case(
        "response: through resonance to 1e6 rpm",
        "closed form",
        1e-13,
        lambda: unbalance_response(1e6, 10.0, [1.0, 500**0.5 * 1e1, 1e6 * RPM]),
    ),
    Case(
        "response: 1e-9 beside the resonance, undamped",
        "closed form",
        1e-6,
        lambda: unbalance_response(1e6, 0.0, [5e5**0.5 * (1 + 1e-9)]),
    ),
    Case(
        "response: a damping ratio of 3.5e5",
        "closed form",
        1e-14,
        lambda: unbalance_response(1e6, 1e9, [1.0, 707.0, 1e5]),
    ),
    Case(
        "response: soft ground of 1e-3 N/m",
        "closed form",
        1e-14,
        lambda: unbalance_response(1e-3, 1.0, [1.0, 707.0, 1e5]),
    ),
    Case(
        "campbell: a tilting disk to 1e6 rpm",
        "closed form",
        1e-12,
        lambda: whirls_of_tilting(0.1, 0.08, 1e3, 1e6 * RPM),
    ),
    Case(
        "campbell: the same on 1e-3 N m/rad", "closed form", 1e-9, lambda: whirls_of_tilting(0.1, 0.08, 1e-3, 1e6 * RPM)
    ),
    Case(
        "campbell: the same on 1e12 N m/rad",
        "closed form",
        1e-13,
        lambda: whirls_of_tilting(0.1, 0.08, 1e12, 1e6 * RPM),
    ),
    Case(
        "campbell: a disk of 1e-24 kg m^2",
        "closed form",
        1e-12,
        lambda: whirls_of_tilting(1e-24, 0.8e-24, 1e-12, 1e6 * RPM),
    ),
    Case(
        "critical: a slender disk, both whirls", "closed form", 1e-12, lambda: critical_of_tilting(0.05, 0.08, 1e3, 1e4)
    ),
    Case(
        "critical: I_p = I_d (1 - 1e-6)",
        "closed form",
        1e-8,
        lambda: critical_of_tilting(0.08 * (1 - 1e-6), 0.08, 1e3, 1e6),
    ),
    Case(
        "critical: a flat disk, none forward", "closed form", 1e-12, lambda: critical_of_tilting(0.16, 0.08, 1e3, 1e6)
    ),
    Case("critical: springs 1e-9 apart", "closed form", 1e-12, lambda: critical_of_masses([1e6, 1e6 * (1 + 1e-9)])),
    Case("critical: springs of 1e3 and 1e12 N/m", "closed form", 1e-9, lambda: critical_of_masses([1e3, 1e12])),
    Case("gear: a contact ratio of just 1", "closed form", 1e-13, lambda: contact_ratio((24, 36), 1.0)),
    Case("gear: a contact ratio of just 2", "closed form", 1e-13, lambda: contact_ratio((80, 120), 2.0)),
    Case("gear: a module of 1 um", "closed form", 1e-12, lambda: contact_ratio((24, 36), 1.5, module=1e-6)),
    Case(
        "gear: contact ratio 1e-6 about 1: told below, not above",
        "closed form",
        1e-300,
        lambda: broken_contact((24, 36)),
    ),
    Case("gear: shift 1e-6 about undercut: told below, not above", "closed form", 1e-300, lambda: undercut(12)),
    Case("mesh: ISO stiffness of a module of 1 mm and of 1 m", "similarity", 1e-9, lambda: iso_stiffness(1e3)),
]
CASES += FORCED


# Bounds: a sweep takes 200 steps in a mesh period, a transient is asked for 1e-3 by default.
CASES += [
    Case("sweep: a stiff mesh of 1e13 N/m", "closed form", 1e-4, lambda: sweep_of_pair(1e13, 0.03, 0.5)),
    Case("sweep: a mesh of 1e-3 N/m", "closed form", 1e-4, lambda: sweep_of_pair(1e-3, 0.03, 0.5)),
    Case("sweep: at resonance", "closed form", 1e-4, lambda: sweep_of_pair(1.6e8, 0.03, 1.0)),
    Case("sweep: 100 times above the resonance", "closed form", 1e-3, lambda: sweep_of_pair(1.6e8, 0.9, 100.0)),
    Case("sweep: a hundredth of the resonance", "closed form", 1e-3, lambda: sweep_of_pair(1.6e8, 0.03, 0.01)),
    Case("transient: a torque that doubles, undamped", "closed form", 1e-3, lambda: stepped_torque(1e3)),
    Case("transient: unbalance on 1e6 N/m", "closed form", 1e-3, lambda: whirl_in_time(1e6, 2e3, 300.0)),
    Case("transient: unbalance on 1e13 N/m", "closed form", 1e-3, lambda: whirl_in_time(1e13, 1e7, 300.0)),
    Case("transient: 1e-6 kg on 1e13 N/m", "closed form", 1e-3, lambda: whirl_in_time(1e13, 1e4, 1e3, 1e-6)),
    Case("transient: overdamped at 1e6 rpm", "closed form", 1e-3, lambda: whirl_in_time(1e6, 2e5, 1e5)),
]


_STRIKES = ImpactOscillator(W=0.7, ripple=1.4, z=0.05)


CASES += [
    Case(
        "sweep: a damping ratio of 1e-6 beside the resonance",
        "closed form",
        1e-4,
        lambda: sweep_of_pair(1.6e8, 1e-6, 0.98),
    ),
    Case("sweep: flanks that strike 1 nm apart", "closed form", 1e-3, lambda: sweep_of_rattle(_tight(1e-9))),
    Case("sweep: flanks that strike on 1e13 N/m", "closed form", 1e-2, lambda: sweep_of_rattle(_stiff(1e13))),
    Case("transient: flanks that strike 1 nm apart", "closed form", 3e-3, lambda: transient_of_rattle(_tight(1e-9))),
    Case("transient: flanks that strike on 1e13 N/m", "closed form", 1e-2, lambda: transient_of_rattle(_stiff(1e13))),
    Case("orbits: a damping ratio of 1e-6 at resonance", "closed form", 1e-4, lambda: orbit_of_pair(1.6e8, 1e-6, 1.0)),
    Case(
        "orbits: the same by harmonic balance",
        "closed form",
        1e-4,
        lambda: orbit_of_pair(1.6e8, 1e-6, 1.0, "harmonic balance"),
    ),
    Case("orbits: a stiff mesh of 1e13 N/m", "closed form", 1e-7, lambda: orbit_of_pair(1e13, 0.03, 0.5)),
    Case("orbits: a mesh of 1e-3 N/m", "closed form", 1e-4, lambda: orbit_of_pair(1e-3, 0.03, 0.5)),
    Case("orbits: 100 times above the resonance", "closed form", 1e-7, lambda: orbit_of_pair(1.6e8, 0.9, 100.0)),
    Case("orbits: a hundredth of the resonance", "closed form", 1e-6, lambda: orbit_of_pair(1.6e8, 0.03, 0.01)),
    Case("orbits: flanks that strike 1 nm apart", "closed form", 1e-6, lambda: orbit_of_rattle(_tight(1e-9))),
    Case("orbits: flanks that strike on 1e13 N/m", "closed form", 1e-6, lambda: orbit_of_rattle(_stiff(1e13))),
    Case("static: rollers under 1e-6 N", "closed form", 1e-6, lambda: power_law(ROLLERS, 1e-6, 0.9)),
    Case("static: rollers under 1e9 N", "closed form", 1e-6, lambda: power_law(ROLLERS, 1e9, 0.9)),
    Case("static: balls under 1e-6 N", "closed form", 1e-6, lambda: power_law(BALLS, 1e-6, 2.0 / 3.0)),
    Case("static: angular contact balls under a push of 1e-6 N", "closed form", 1e-6, lambda: axial_angle(1e-6)),
    Case("static: the same under 1 MN", "closed form", 1e-6, lambda: axial_angle(1e6)),
    Case("static: a ball bearing in um", "similarity", 1e-6, lambda: scaled(ANGULAR, 1e-6)),
    Case("static: a ball bearing in km", "similarity", 1e-6, lambda: scaled(ANGULAR, 1e3)),
    Case("static: a short film that is hardly loaded", "closed form", 1e-6, lambda: ocvirk(1e-3, 1e3)),
    Case("static: a short film of a twelfth of its clearance", "closed form", 1e-6, lambda: ocvirk(5e4, 1e3)),
    Case("static: a journal film of 60 um", "similarity", 1e-6, lambda: scaled(FILM, 1e-3)),
    Case("static: oil of 2e7 Pa s that creeps", "similarity", 1e-6, lambda: thick_and_slow(FILM, 1e9)),
    Case("static: three lobes in pitch that creeps", "similarity", 1e-6, lambda: thick_and_slow(LOBES, 1e9)),
    Case("static: tilting pads of 60 um", "similarity", 1e-6, lambda: scaled(PADS, 1e-3)),
    Case("bearing: stiffness of rollers under 1e-6 N", "closed form", 1e-5, lambda: sheet_stiffness(1e-6)),
    Case("bearing: stiffness of rollers under 1 GN", "closed form", 1e-5, lambda: sheet_stiffness(1e9)),
    Case("casing: a block of 10 mm", "similarity", 1e-9, lambda: scaled_block(0.05)),
    Case("casing: a block of 20 m", "similarity", 1e-9, lambda: scaled_block(1e2)),
    Case("casing: rubber of 1 Pa, 1e9 times as dense", "similarity", 1e-9, lambda: scaled_block(1.0, 5e-12, 1e9)),
    Case("casing: axial motion without lateral contraction", "closed form", 1e-4, rod),
    Case("casing: the same over its estimate", "estimate", 3.0, lambda: rod(estimated=True)),
    Case("a casing 1e9 times as stiff as steel: the ground", "closed form", 1e-7, lambda: stiff_bar(1e9)),
    Case(
        "state space: Q of 4e7 on 1e-3 N/m",
        "closed form",
        1e-6,
        lambda: state_space_of_mass(1e-3, 1e-9, [1e-3, 0.5, 1.0, 1.9]),
    ),
    Case(
        "state space: a damping ratio of 3.5e5",
        "closed form",
        1e-9,
        lambda: state_space_of_mass(1e6, 1e9, [1e-3, 0.5, 1.0, 1.9]),
    ),
    Case("scatter: a spread of 1e-9", "closed form", 1e-4, lambda: scatter_of_spring(1e8, 1e-9)),
    Case("scatter: a spring of 1e-3 N/m", "closed form", 1e-6, lambda: scatter_of_spring(1e-3, 0.01)),
    Case("update: a spring of 1e-3 N/m by its frequency", "closed form", 1e-6, lambda: updated_spring(1e-3)),
    Case("update: a spring of 1e13 N/m by its frequency", "closed form", 1e-6, lambda: updated_spring(1e13)),
]


_STAGE = Stage()


# All that vibrates is faster than the carrier, which then brings no work into it.
_FAST = Stage(
    planets=4,
    planet=26,
    pin=4e10,
    mesh=6e9,
    masses=(0.26, 0.9, 1.4, 0.22),
    inertias=(3e-4, 0.03, 0.01, 5e-4),
)
_CARRIER = 1e5 * RPM


CASES += [
    Case(
        "120 planets that go round",
        "40 digits",
        1e-11,
        lambda: stage_error(Stage(planets=120, sun=1000, planet=20), 50.0),
    ),
    Case("static: 120 planets share alike", "closed form", 1e-7, lambda: share_error(120)),
    Case("pins of 4e14 N/m: a million times as stiff", "40 digits", 1e-13, lambda: stage_error(_pins(4e14))),
    Case("the same with the carrier at 300 rad/s", "40 digits", 1e-7, lambda: stage_error(_pins(4e14), 300.0)),
    Case("five planets on such pins at 10 rad/s", "40 digits", 1e-7, lambda: stage_error(_pins(4e14, 5, 26), 10.0)),
    Case("pins of 1e-3 N/m", "40 digits", 1e-13, lambda: stage_error(replace(_STAGE, pin=1e-3, tilt=1e-3))),
    Case(
        "planetary meshes of 1e13 N/m at 300 rad/s",
        "40 digits",
        1e-12,
        lambda: stage_error(replace(_STAGE, mesh=1e13), 300.0),
    ),
    Case("a carrier at 1e5 rpm", "40 digits", 1e-11, lambda: stage_error(_FAST, _CARRIER)),
    Case("the same backwards", "40 digits", 1e-11, lambda: stage_error(_FAST, -_CARRIER)),
    Case("a carrier at 1e5 rpm that makes modes grow", "40 digits", 1e-12, lambda: stage_error(_STAGE, _CARRIER)),
    Case("the mass of a ring with a rim of 1 mm", "closed form", 1e-13, lambda: thin_ring_mass(1e-3)),
    Case("planetary axes 1e-9 rad off parallel", "similarity", 1e-9, lambda: inclined_error(1e-9)),
]


def _pins(stiffness: float, planets: int = 3, teeth: int = 27) -> Stage:
    return replace(_STAGE, planets=planets, planet=teeth, pin=stiffness)


def _speed(stage: Stage, carrier: float) -> float:
    """Of the sun in rad/s, where the carrier has one."""
    return carrier * (1.0 + stage.ring / stage.sun)


def _tight(half_backlash: float) -> ImpactOscillator:
    """Flanks so near each other that the pair never feels free, under a load as much smaller."""
    return replace(_STRIKES, half_backlash=half_backlash)


def _stiff(stiffness: float) -> ImpactOscillator:
    """The same pair on a stiffer mesh, its gap as much less deep."""
    return replace(_STRIKES, stiffness=stiffness, half_backlash=_STRIKES.half_backlash * 9e7 / stiffness)


FLAGGED: list[Flagged] = [
    Flagged(
        "a carrier at 1e5 rpm that makes modes grow, told",
        "unstable",
        lambda: rg.modal(_STAGE.model(), speed=_speed(_STAGE, _CARRIER)),
    ),
    Flagged(
        "a ring with a rim of 1 mm: it is no rigid body",
        "its rim by itself bends from about",
        lambda: rg.modal(thin_ring("1 mm"), modes=6),
    ),
    Flagged(
        "transient: a damping ratio of 1e-6, too short to settle",
        "not settled",
        lambda: rg.transient(linear_pair(1.6e8, 1e-6), speed=float(resonance(linear_pair(1.6e8, 1e-6), 1.6e8)) / 41.0),
    ),
    Flagged(
        "frf: no damping at resonance",
        "nothing damps the model",
        lambda: rg.frf(
            mass_on_spring(1e6, 0.0),
            [float(np.sqrt(5e5)) / 2 / np.pi],
            inputs=["bearings.b:x"],
            outputs=["bearings.b:x"],
        ),
    ),
    Flagged(
        "response: no damping at resonance",
        "nothing damps the model",
        lambda: rg.response(mass_on_spring(1e6, 0.0, unbalance=1e-5), speeds=[float(np.sqrt(5e5))]),
    ),
    Flagged(
        "critical: springs of 1e-3 and 1e12 N/m: below a millionth of the range",
        "2 modes may be met below",
        lambda: rg.critical(masses([1e-3, 1e12]), stop=2e6),
    ),
    Flagged(
        "critical: a tilting disk at 65 rad/s, sought to 1e8",
        "may be met below",
        lambda: rg.critical(tilting(0.16, 0.08, 1e3), stop=1e8),
    ),
    Flagged(
        "gear: a contact ratio of 0.8",
        "below 1, the teeth lose contact",
        lambda: rg.check(pair_of((24, 36), addendum_factor=0.45)),
    ),
]


REFUSED += [
    Refused(
        "static: nothing loads it", "nothing loads the model", lambda: rg.static(rotor_model(Rotor(even(), on(1e8))))
    ),
    Refused("response: nothing excites it", "nothing excites the model", lambda: rg.response(mass_on_spring(1e6, 1.0))),
    Refused(
        "frf: a frequency of 0",
        "all of them positive",
        lambda: rg.frf(mass_on_spring(1e6, 1.0), [0.0], inputs=["bearings.b:x"], outputs=["bearings.b:x"]),
    ),
    Refused("campbell: no range of speed", "speed", lambda: rg.campbell(tilting(0.1, 0.08, 1e3), start=0.0, stop=0.0)),
    Refused("critical: a speed of 0", "no line of excitation", lambda: rg.critical(tilting(0.1, 0.08, 1e3), stop=0.0)),
    Refused("a massless group with a damper", "dampers but no inertia", lambda: rg.modal(_damped_end(), speed=1.0)),
    Refused("mesh: faces that just do not overlap", "face", lambda: pair_of((24, 36)).with_("gears.b.at", 0.04)),
    Refused("gear: 3 teeth, thinner than their shaft", "bore", lambda: pair_of((3, 36))),
    Refused("transient: 1e9 s", "would take", lambda: rg.transient(pair_of((24, 36)), time=1e9)),
    Refused("transient: 1e-9 s", "gives only", lambda: rg.transient(pair_of((24, 36)), time=1e-9)),
    Refused(
        "transient: at standstill, for no time", "nothing turns", lambda: rg.transient(pair_of((24, 36)), speed=0.0)
    ),
    Refused("static: a film of 60 m at 955 rpm", "turbulent", lambda: scaled(FILM, 1e3)),
    Refused("static: tilting pads in air at 1e9 rpm", "turbulent", lambda: thick_and_slow(PADS, 1e-6)),
    Refused("static: a short film under 1e8 N", "pressed into its shell", lambda: ocvirk(1e8, 1e3)),
    Refused("static: a film at standstill", "too thin", lambda: moved(loaded(FILM, (0.0, -800.0, 0.0), 0.0))),
    Refused("casing: a block of 200 nm", "Files of meshes carry no unit", lambda: block_modes(1e-6)),
    Refused("casing: a block of 200 m in a mesh of metres", "Files of meshes carry no unit", lambda: block_modes(1e3)),
    Refused(
        "orbits: at standstill", "standstill", lambda: rg.orbits(_STRIKES.model(), {"operation.speed": [0.0, 1.0]})
    ),
    Refused("state space: no range of frequencies", "must be positive", lambda: state_space_of_mass(1e6, 1.0, [0.0])),
    Refused("scatter: a spread below nothing", "not negative", lambda: scatter_of_spring(1e8, -0.1)),
    Refused("sweep: over nothing", "at least one value", lambda: rg.sweep(pair_of((24, 36)), {"operation.speed": []})),
]


REFUSED += [
    Refused("planetary axes 1e-6 rad off parallel", "5.72957795e-05 deg apart", lambda: inclined(1e-6)),
    Refused("120 planets that have no room", "touch", lambda: Stage(planets=120, sun=93).model()),
    Refused(
        "pins that give way to the load of planets at 1e5 rpm",
        "the centrifugal load grows faster with the way out",
        lambda: rg.modal(_pins(1e7).model(), speed=_speed(_STAGE, _CARRIER)),
    ),
    Refused(
        "two planets that go round",
        "coefficients of two planets on a carrier that turns",
        lambda: rg.frf(
            Stage(planets=2).model(), inputs=["gears.sun:x"], outputs=["gears.sun:x"], fmax=100.0, speed=100.0
        ),
    ),
]


def _damped_end() -> rg.Model:
    hold = rg.Support(shaft="p0", at=0.0, stiffness=rg.StiffnessMatrix(axial=1e6), damping=rg.DampingMatrix(axial=10.0))
    held = {"s": hold, "z": rg.Support(shaft="p1", at=0.0, fixed=("z",))}
    return points([0.0, 0.3], [1e5], supports=held, motions=("torsion", "axial"))


@cache
def measured(case: Case) -> float:
    """The error of a case, once for the tests and the page."""
    with mp.workdps(DIGITS):
        return case.measure()
