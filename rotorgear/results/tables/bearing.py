"""The sheet of a bearing for the terminal, 80 columns wide."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.bearing import BearingSheet, FilmState, OilState
from rotorgear.results.tables.common import error_words, heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

_COMPONENTS = ("x", "y", "z", "tilt_x", "tilt_y")
_NEGLIGIBLE = 1e-9
_CELSIUS = 273.15


def bearing_table(sheet: BearingSheet) -> RenderableType:
    """Return the sheet as one rich renderable."""
    from rich.console import Group

    turns = f"{sheet.model.reference_shaft} at {sheet.speed * RPM_PER_RAD_S:.6g} rpm"
    own = f", its shaft at {sheet.shaft_speed * RPM_PER_RAD_S:.6g} rpm" if sheet.shaft_speed != sheet.speed else ""
    parts: list[Any] = [heading(f"{sheet.bearing}: {sheet.law}", f", {turns}{own}")]
    parts += ["", _state(sheet)]
    if sheet.oil is not None:
        parts += ["", _film(sheet, sheet.oil)]
    if sheet.rolling_elements:
        parts += ["", _elements(sheet)]
    if sheet.over_speed:
        parts += ["", _speeds(sheet)]
    mean = "means over a pitch of the rolling elements; " if sheet.averaged else ""
    notes = [
        f"{mean}x, y, z in um, tilts in urad; K and C in N/um, N/urad, N m/urad and kN s/m",
        f"error: K and C {error_words(sheet.error_estimate)}, twice their change {_finer(sheet)}; the law at the state printed "
        f"differs from the load of the gearbox by {error_words(sheet.consistency)}",
        f"{sheet.cpu_seconds:.5f} s of CPU for the bearing at one speed and load, {sheet.seconds['total']:.2f} s in all",
        *_stability(sheet),
        *notes_of(sheet),
    ]
    return Group(*parts, "", *lines(*notes), "")


def _finer(sheet: BearingSheet) -> str:
    return "on a grid of twice the cells" if sheet.oil is not None else "with twice the positions in a pitch"


def _number(value: float, size: float, digits: int = 4) -> str:
    """A number in a few digits; 0 where it is rounding beside the largest."""
    return "0" if abs(value) <= _NEGLIGIBLE * size else f"{value:.{digits}g}"


def _state(sheet: BearingSheet) -> Any:
    shown = list(range(2 if sheet.along_shaft else 0, len(sheet.bearing_load)))
    names = [_COMPONENTS[i] for i in shown]
    has_damping = bool(np.any(sheet.bearing_damping))
    out = table("", "load", "moves", *(f"K {name}" for name in names), *(f"C {n}" for n in names if has_damping))
    force = float(np.abs(sheet.bearing_load).max(initial=0.0))
    largest = [float(np.abs(A).max(initial=0.0)) for A in (sheet.bearing_stiffness, sheet.bearing_damping)]
    for i, name in zip(shown, names, strict=True):
        cells = [
            _number(float(sheet.bearing_load[i]), force),
            _number(1e6 * float(sheet.bearing_displacement[i]), 1e6 * _largest(sheet)),
        ]
        cells += [_number(1e-6 * float(k), 1e-6 * largest[0]) for k in sheet.bearing_stiffness[i, shown]]
        if has_damping:
            cells += [_number(1e-3 * float(c), 1e-3 * largest[1]) for c in sheet.bearing_damping[i, shown]]
        out.add_row(f"{name}, {'N' if i < 3 else 'N m'}", *cells)
    return out


def _largest(sheet: BearingSheet) -> float:
    return float(np.abs(sheet.bearing_displacement).max(initial=0.0))


def _film(sheet: BearingSheet, film: Any) -> Any:
    out = table("", "", left=2)
    out.show_header = False
    rows = (
        *_carried(sheet, film),
        ("smallest gap", f"{1e6 * film.minimum_gap:.3f} um"),
        ("largest pressure", f"{1e-6 * film.largest_pressure:.4g} MPa"),
        ("side flow", f"{6e4 * film.side_flow:.4g} l/min"),
        ("power loss", f"{film.power_loss:.5g} W"),
        *_heat(film),
    )
    for label, value in rows:
        out.add_row(label, value)
    return out


def _carried(sheet: BearingSheet, film: OilState) -> list[tuple[str, str]]:
    """The load, and where a journal stands under it."""
    if not isinstance(film, FilmState):
        return [("load along z", f"{float(sheet.bearing_load[2]):.5g} N")]
    load = float(np.hypot(*sheet.bearing_load[:2]))
    area = 2.0 * float(sheet.geometry["radius"]) * float(sheet.geometry["length"])
    return [
        ("load W, over L D", f"{load:.5g} N, {1e-6 * load / area:.4g} MPa"),
        ("Sommerfeld number", f"{film.sommerfeld:.5g}"),
        ("eccentricity", f"{film.eccentricity:.4f} of the clearance, attitude {math.degrees(film.attitude):.2f} deg"),
    ]


def _heat(film: OilState) -> list[tuple[str, str]]:
    """Temperatures of a film in heat balance, and its viscosity there."""
    if film.film_temperature is None or film.outlet_temperature is None:
        return []
    film_temperature, outlet = (T - _CELSIUS for T in (film.film_temperature, film.outlet_temperature))
    inlet = 2.0 * film_temperature - outlet
    return [
        ("oil", f"in at {inlet:.4g} degC, out at {outlet:.4g} degC"),
        ("film", f"{film_temperature:.4g} degC, {1e3 * film.film_viscosity:.4g} mPa s"),
    ]


def _elements(sheet: BearingSheet) -> Any:
    several = any(row.row > 1 for row in sheet.rolling_elements)
    out = table(
        "element",
        *(["row"] if several else []),
        "at deg",
        "contact deg",
        "load N",
        "press um",
        "p inner MPa",
        "p outer MPa",
    )
    for number, row in enumerate(sheet.rolling_elements):
        loaded = row.load > 0.0
        out.add_row(
            str(number + 1),
            *([str(row.row)] if several else []),
            f"{math.degrees(row.angle):.2f}",
            f"{math.degrees(row.contact_angle):.2f}" if loaded else "-",
            f"{row.load:.2f}",
            f"{1e6 * row.deflection:.3f}",
            *(f"{1e-6 * p:.1f}" if loaded and p == p else "-" for p in (row.inner_pressure, row.outer_pressure)),
        )
    return out


def _speeds(sheet: BearingSheet) -> Any:
    """Across the shaft; all components are in the JSON."""
    has_damping = any(np.any(row.damping) for row in sheet.over_speed)
    names = ("zz",) if sheet.along_shaft else ("xx", "xy", "yx", "yy")
    own = slice(2, 3) if sheet.along_shaft else slice(0, 2)
    told = any(row.log_decrement is not None for row in sheet.over_speed)
    out = table(
        "rpm",
        "W N",
        *(f"K {n}" for n in names),
        *(f"C {n}" for n in names if has_damping),
        *(["decr."] if told else []),
    )
    for row in sheet.over_speed:
        K = 1e-6 * row.stiffness[own, own].ravel()
        C = 1e-3 * row.damping[own, own].ravel()
        cells = [_number(float(k), float(np.abs(K).max()), 3) for k in K]
        if has_damping:
            cells += [_number(float(c), float(np.abs(C).max()), 3) for c in C]
        if told:
            cells.append("-" if row.log_decrement is None else f"{row.log_decrement:.3g}")
        out.add_row(f"{row.speed * RPM_PER_RAD_S:.6g}", f"{np.linalg.norm(row.load[own]):.4g}", *cells)
    return out


def _stability(sheet: BearingSheet) -> list[str]:
    if sheet.film is None:
        return []
    at = min(sheet.over_speed, key=lambda row: abs(row.speed - sheet.speed), default=None)
    notes = []
    if at is not None and at.critical_mass is not None and at.whirl_ratio is not None:
        notes.append(
            f"a rigid rotor on such bearings alone whirls at {at.whirl_ratio:.3f} of the speed if it has more than "
            f"{at.critical_mass:.4g} kg a bearing ({at.speed * RPM_PER_RAD_S:.6g} rpm)"
        )
    elif at is not None:
        notes.append("a rigid rotor on such bearings alone does not whirl, whatever its mass")
    if sheet.threshold_speed is not None and sheet.threshold_frequency_hz is not None:
        notes.append(
            f"whirl threshold of the gearbox: {sheet.threshold_speed * RPM_PER_RAD_S:.6g} rpm, at "
            f"{sheet.threshold_frequency_hz:.4g} Hz (decr.: least logarithmic decrement of its modes)"
        )
    elif any(row.log_decrement is not None for row in sheet.over_speed):
        below = all((row.log_decrement or 0.0) < 0.0 for row in sheet.over_speed)
        whirls = "the gearbox whirls at all these speeds" if below else "no whirl threshold between these speeds"
        notes.append(f"{whirls} (decr.: least logarithmic decrement of its modes)")
    return notes
