"""Force laws of bearings from the geometry in the model file: oil films, balls and rollers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.parts.supports import Bearing, JournalGeometry, Oil, RollingElements, ThrustGeometry

if TYPE_CHECKING:
    from rotorgear.forces.journal_film import JournalFilm
    from rotorgear.forces.law import ForceLaw
    from rotorgear.forces.thrust_film import ThrustFilm
    from rotorgear.forces.tilting_pads import TiltingPads


# Temperatures in deg C beyond which mineral oil is no liquid, and Vogel's equation no viscosity.
_CELSIUS = 273.15
_LIQUID = (-60.0, 200.0)


def check_oil(address: str, bearing: Bearing) -> None:
    """The oil of a film in heat balance flows in as a liquid.

    Raises:
        AnalysisError: it does not.
    """
    given = bearing.film.inlet_temperature if bearing.film is not None else None
    if given is not None and not _LIQUID[0] <= given - _CELSIUS <= _LIQUID[1]:
        raise AnalysisError(
            f"{address}: the oil would flow in at {given - _CELSIUS:.4g} degC, where mineral oil is no liquid "
            f"({_LIQUID[0]:g} to {_LIQUID[1]:g} degC); check inlet_temperature and its unit"
        )


def _oil_of(film: Oil) -> dict[str, Any]:
    """Parameters of the oil of a film, which begins at the temperature of the inlet."""
    from rotorgear.forces.oil import oil_viscosity

    given = {"density": film.density, "specific_heat": film.specific_heat, "heat_share": film.heat_share}
    if film.viscosity is not None:
        return {**given, "viscosity": film.viscosity}
    assert film.inlet_temperature is not None
    return {
        **given,
        "viscosity": oil_viscosity(film.grade, film.density, film.inlet_temperature),
        "grade": film.grade,
        "inlet_temperature": film.inlet_temperature,
    }


def journal_law(journal: JournalGeometry, ratio: float, sense: float = 1.0) -> JournalFilm | TiltingPads:
    """The film of a journal bearing on a shaft that turns at so many times the speed of the reference.

    Pivots and least gaps lie in the sense of rotation for which it is built: that of the reference times `sense`, 1 or -1.
    """
    if journal.pads:
        from rotorgear.forces.tilting_pads import TiltingPads

        return TiltingPads(
            **_oil_of(journal),
            radius=0.5 * journal.diameter,
            length=journal.length,
            clearance=journal.clearance,
            pads=journal.pads,
            arc=journal.pad_arc or 0.8 * 2.0 * np.pi / journal.pads,
            at=journal.pad_at,
            pivot=journal.pivot if sense > 0.0 else 1.0 - journal.pivot,
            preload=journal.preload,
            order=ratio,
            whirl_ratio=journal.whirl_ratio,
            cavitation=journal.cavitation,
            around=journal.around,
            along=journal.along,
        )
    from rotorgear.forces.journal_film import JournalFilm

    return JournalFilm(
        **_oil_of(journal),
        radius=0.5 * journal.diameter,
        length=journal.length,
        clearance=journal.clearance,
        order=ratio,
        lobes=journal.lobes,
        arc=journal.lobe_arc or 0.0,
        at=journal.lobe_at,
        preload=journal.preload,
        offset=journal.offset if sense > 0.0 else 1.0 - journal.offset,
        inlet=journal.inlet or 0.0,
        follows=journal.inlet is None and journal.lobes == 1,
        cavitation=journal.cavitation,
        around=journal.around,
        along=journal.along,
    )


def thrust_law(thrust: ThrustGeometry, ratio: float, sense: float = 1.0) -> ThrustFilm:
    """The films of a thrust bearing, as `journal_law`."""
    from rotorgear.forces.thrust_film import ThrustFilm

    return ThrustFilm(
        **_oil_of(thrust),
        inner_radius=0.5 * thrust.inner_diameter,
        outer_radius=0.5 * thrust.outer_diameter,
        clearance=thrust.clearance,
        pads=thrust.pads,
        arc=thrust.pad_arc or 0.85 * 2.0 * np.pi / thrust.pads,
        at=thrust.pad_at,
        taper=thrust.taper or 0.0,
        taper_share=thrust.taper_share,
        pivot=-1.0 if thrust.pivot is None else thrust.pivot if sense > 0.0 else 1.0 - thrust.pivot,
        acts=thrust.acts,
        order=ratio,
        whirl_ratio=thrust.whirl_ratio,
        around=thrust.around,
        across=thrust.across,
    )


def bearing_law(bearing: Bearing, ratio: float, sense: float) -> ForceLaw:
    """The law of a bearing that has one.

    Args:
        bearing: with rolling elements, or a film. ratio: turns of its shaft for each turn of the reference.
        sense: of rotation of the reference for which it is built, 1 or -1.
    """
    if bearing.journal is not None:
        return journal_law(bearing.journal, ratio, sense)
    if bearing.thrust is not None:
        return thrust_law(bearing.thrust, ratio, sense)
    from rotorgear.forces.ball_bearing import BallBearing
    from rotorgear.forces.clearance_classes import class_clearance
    from rotorgear.forces.roller_bearing import RollerBearing

    rolling = bearing.rolling
    assert rolling is not None
    # Elements that roll without slip between a turning inner ring and a still outer one: the cage turns at
    # (1 - D_w cos(alpha) / D_pw) / 2 of the shaft.
    slip_free = 0.5 * (1.0 - rolling.element_diameter * np.cos(rolling.contact_angle) / rolling.pitch_diameter)
    linear = np.diag(np.array(bearing.stiffness.as_rows())) if bearing.stiffness else np.zeros(6)
    order = float(ratio * slip_free)
    if rolling.kind == "tapered" or (rolling.kind == "roller" and (rolling.slices or 1) > 1):
        return _sliced(rolling, order, linear)
    if rolling.kind == "roller":
        return RollerBearing(
            rollers=rolling.elements,
            length=rolling.length or 0.0,
            clearance=rolling.clearance,
            order=order,
            reference=(float(linear[0]), float(linear[1])),
            roller_diameter=rolling.element_diameter,
            pitch_diameter=rolling.pitch_diameter,
        )
    clearance = rolling.clearance
    if rolling.clearance_class is not None and rolling.bore is not None:
        clearance = 0.5 * sum(class_clearance(rolling.bore, rolling.clearance_class) or (0.0, 0.0))
    side = -1.0 if rolling.contact_angle < 0.0 else 1.0
    law = BallBearing(
        balls=rolling.elements,
        ball_diameter=rolling.element_diameter,
        pitch_diameter=rolling.pitch_diameter,
        inner_groove=rolling.inner_groove,
        outer_groove=rolling.outer_groove,
        clearance=clearance,
        contact_angle=rolling.contact_angle,
        order=order,
        preload=side * rolling.preload_displacement,
        reference=tuple(map(float, linear[:5])),
        arrangement="four-point" if rolling.kind == "four-point" else rolling.arrangement,
        row_distance=rolling.row_distance or 0.0,
    )
    return law.pressed_by(rolling.preload_force) if rolling.preload_force else law


def _sliced(rolling: RollingElements, order: float, linear: np.ndarray) -> ForceLaw:
    """Rollers whose loads vary along them: tapered ones, or cylindrical ones that feel tilt."""
    from rotorgear.forces.tapered_bearing import SlicedRollers, TaperedBearing

    law = (TaperedBearing if rolling.kind == "tapered" else SlicedRollers)(
        rollers=rolling.elements,
        length=rolling.length or 0.0,
        roller_diameter=rolling.element_diameter,
        pitch_diameter=rolling.pitch_diameter,
        contact_angle=rolling.contact_angle,
        clearance=rolling.clearance,
        preload=rolling.preload_displacement,
        slices=rolling.slices or 21,
        order=order,
        reference=tuple(map(float, linear[:5])),
        arrangement=rolling.arrangement,
        row_distance=rolling.row_distance or 0.0,
    )
    return law.pressed_by(rolling.preload_force) if rolling.preload_force else law
