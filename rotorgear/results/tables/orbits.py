"""The periodic motions of a model over a parameter as a table for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.orbits import OrbitsResult, SpecialCurve

# Points of a branch that are shown; all are in the files.
_SHOWN = 12


def orbits_table(result: OrbitsResult) -> RenderableType:
    """Return special points, branches and notes, 80 columns wide."""
    from rich.console import Group

    title = f"{result.model.title or 'Orbits'}: periodic motions over {result.address[0]}"
    parts: list[RenderableType] = [heading(title), *lines("", f"excited by {result.excited}")]
    parts += lines("", "Special points") + ([_special(result)] if result.special_points else lines("none"))
    for number in range(len(result.branches)):
        parts += [*lines(""), _branch(result, number)]
    for curve in result.curves:
        parts += [*lines(""), _curve(result, curve)]
    if result.verifications:
        parts += [*lines("", "Transients started on orbits"), _verifications(result)]
    notes = [
        "",
        _legend(result),
        f"{result.dofs} dofs; {result.method}",
        f"{result.cpu_per_point:.3g} s a point, {result.seconds['total']:.2f} s in all",
    ]
    if result.error_estimate == result.error_estimate:
        notes.append(f"error estimate {result.error_estimate:.1e} of the motions' coefficients")
    notes += notes_of(result)
    return Group(*parts, *lines(*notes, ""))


def _legend(result: OrbitsResult) -> str:
    if result.contact:
        return "|mu|: largest Floquet multiplier; p-p: approach of the flanks, peak to peak, F max, loss: of the worst contact"
    return f"|mu|: largest Floquet multiplier; p-p: largest peak to peak of {', '.join(result.shown().label)}"


def _value(result: OrbitsResult, si: float, parameter: int = 0) -> str:
    return f"{si / result.per_unit[parameter]:.8g}"


def _column(result: OrbitsResult, parameter: int = 0) -> str:
    return f"{result.address[parameter].rpartition('.')[2]} {result.unit[parameter]}".strip()


def _special(result: OrbitsResult) -> Any:
    out = table("kind", _column(result), "branch", "period\nms", "multipliers", left=1)
    for point in result.special_points:
        mu = point.multiplier_real + 1j * point.multiplier_imaginary
        out.add_row(
            point.kind,
            _value(result, point.value),
            result.branches[point.branch].name,
            f"{1e3 * point.period:.4g}",
            ", ".join(_complex(x) for x in mu[:3]),
        )
    return out


def _complex(value: complex) -> str:
    return f"{value.real:.4g}" if abs(value.imag) < 1e-9 else f"{value.real:.3g}{value.imag:+.3g}i"


def _branch(result: OrbitsResult, number: int) -> Any:
    from rich.console import Group

    own = np.flatnonzero(result.branch == number)
    branch = result.branches[number]
    text = f"Branch {branch.name}: {_points(len(own))}, {int(result.stable[own].sum())} stable, to {branch.ended}"
    shown = result.shown()
    forces = ("F mean\nN", "F max\nN", "loss\n%") if result.contact else ()
    out = table(_column(result), "stable", "|mu|", f"p-p\nu{shown.unit}", *forces, left=0)
    sizes = shown.peak_to_peak(result)
    listed = own[np.unique(np.linspace(0, len(own) - 1, min(_SHOWN, len(own))).round().astype(int))]
    for i in listed:
        worst = int(np.argmax(sizes[i]))
        cells = [f"{1e6 * sizes[i, worst]:.4g}"]
        if result.contact:
            cells += [
                f"{result.mean_force[i, worst]:.4g}",
                f"{result.largest_force[i, worst]:.4g}",
                f"{100.0 * result.apart[i, worst]:.1f}",
            ]
        size = float(np.nanmax(np.abs(result.multipliers[i])))
        out.add_row(_value(result, float(result.value[i])), "yes" if result.stable[i] else "no", f"{size:.4f}", *cells)
    return Group(*lines(text), out)


def _points(number: int) -> str:
    return "1 point" if number == 1 else f"{number} points"


def _curve(result: OrbitsResult, curve: SpecialCurve) -> Any:
    from rich.console import Group

    name = result.branches[curve.branch].name
    text = f"Curve of the {curve.kind} of branch {name}: {_points(len(curve.value))}, to {curve.ended}"
    shown = result.shown()
    out = table(_column(result), _column(result, 1), "period\nms", f"p-p\nu{shown.unit}", left=0)
    sizes = shown.peak_to_peak(curve)
    for i in np.unique(np.linspace(0, len(curve.value) - 1, min(_SHOWN, len(curve.value))).round().astype(int)):
        cells = [f"{1e3 * curve.period[i]:.4g}", f"{1e6 * sizes[i].max():.4g}"]
        out.add_row(_value(result, float(curve.value[i])), _value(result, float(curve.second[i]), 1), *cells)
    return Group(*lines(text), out)


def _verifications(result: OrbitsResult) -> Any:
    out = table(_column(result), "stable", "deviation", "growth", "|mu|", left=0)
    for one in result.verifications:
        growth = f"{one.growth:.5f}" if one.growth == one.growth else "-"
        out.add_row(
            _value(result, one.value),
            "yes" if one.stable else "no",
            f"{one.deviation:.1e}",
            growth,
            f"{one.expected:.5f}",
        )
    return out
