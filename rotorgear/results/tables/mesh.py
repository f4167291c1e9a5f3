"""The result of a mesh as tables that fit 80 columns."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from rotorgear.results.mesh import PLANE, MeshResult
from rotorgear.results.mesh_convergence import MeshConvergenceStudy


def mesh_parts(found: MeshResult, harmonics: int) -> Iterator[Any]:
    """Yield what the command prints, in order."""
    yield f"[bold]{found.title or 'Mesh'}[/bold]: mesh '{found.mesh}', {found.pinion} and {found.gear}"
    yield from _setting(found)
    yield ""
    yield _main(found)
    if harmonics:
        yield ""
        yield _harmonics(found, harmonics)
    if found.loads:
        yield ""
        yield _loads(found)
    yield ""
    yield from (f"Warning: {text}" for text in found.warnings)
    if found.dofs:
        yield f"{found.dofs} dofs, {found.seconds['total']:.2f} s"


def _setting(found: MeshResult) -> Iterator[str]:
    preset = "" if found.preset is None else f", preset {found.preset}"
    yield f"stiffness model {found.stiffness_model}{preset}: {found.definition}, {PLANE}"
    yield f"body: {found.body}"
    if found.load is None:
        yield "no load"
        return
    load = found.load
    yield (
        f"load: {load.pinion_torque_n_m:.6g} N m on the pinion, F_bt {load.base_force_n:.6g} N, F_n {load.normal_force_n:.6g} N "
        f"({load.source})"
    )


def _table(*columns: str) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    for number, column in enumerate(columns):
        table.add_column(column, justify="right" if number else "left", no_wrap=True)
    return table


def _main(found: MeshResult) -> Any:
    helices = f"all {found.helices} helices" if found.helices > 1 else "one helix"
    table = _table("", helices, "per width of a helix", "est. error")
    errors = found.errors
    per = 1e-9 / (found.face_width * found.helices) if found.face_width else None

    def row(name: str, value: float, error: float | None) -> None:
        width = f"{per * value:.4f} N/(mm um)" if per else "-"
        table.add_row(name, f"{value:.5g} N/m", width, "-" if error is None else f"{100 * error:.2g} %")

    row("mean stiffness", found.mean_stiffness, errors.mean_stiffness if errors else None)
    row("peak to peak", found.peak_to_peak_stiffness, errors.peak_to_peak_stiffness if errors else None)
    if found.tangent is not None:
        row("mean tangent stiffness", float(found.tangent.mean()), None)
    row("mean along the normal", found.mean_normal_stiffness, None)
    if found.transmission_error is not None and found.no_load_error is not None:
        ste = found.transmission_error
        error = errors.ste_peak_to_peak if errors else None
        table.add_row("transmission error, mean", f"{1e6 * ste.mean():.4f} um", "", "")
        table.add_row(
            "peak to peak", f"{1e6 * np.ptp(ste):.4f} um", "", "-" if error is None else f"{100 * error:.2g} %"
        )
        table.add_row("peak to peak, no load", f"{1e6 * np.ptp(found.no_load_error):.4f} um", "", "")
    if found.helix:
        helix = found.helix
        ratio = np.mean([item.contact_ratio for item in helix])
        table.add_row("contact ratio under load", f"{ratio:.3f}", f"{helix[0].geometric_contact_ratio:.3f} without", "")
        share = max(float(values.max()) for item in helix for values in item.share.values())
        table.add_row("largest share of a pair", f"{100 * share:.1f} %", "", "")
        table.add_row("largest line load", f"{1e-3 * max(item.line_load.max() for item in helix):.4g} N/mm", "", "")
        table.add_row("largest pressure", f"{1e-6 * max(item.pressure.max() for item in helix):.4g} MPa", "", "")
    return table


def _harmonics(found: MeshResult, count: int) -> Any:
    table = _table("mesh order", "stiffness", "phase", "transmission error", "phase")
    k = found.harmonics(count)
    e = found.ste_harmonics(count)
    # Below this share of the mean an order is rounding, and its phase says nothing.
    for order in range(len(k)):
        small = abs(k[order]) < 1e-9 * found.mean_stiffness
        cells = [f"{abs(k[order]):.4g} N/m", "-" if small else f"{np.degrees(np.angle(k[order])):.1f} deg"]
        if e is not None:
            cells += [f"{1e6 * abs(e[order]):.4f} um", "-" if small else f"{np.degrees(np.angle(e[order])):.1f} deg"]
        table.add_row(str(order + 1), *cells)
    return table


def _loads(found: MeshResult) -> Any:
    table = _table("load factor", "mean stiffness", "peak to peak", "STE peak to peak", "contact ratio")
    for point in found.loads:
        table.add_row(
            f"{point.factor:g}",
            f"{point.mean_stiffness_n_per_m:.5g} N/m",
            f"{point.peak_to_peak_stiffness_n_per_m:.4g} N/m",
            f"{1e6 * point.ste_peak_to_peak_m:.4f} um",
            f"{point.contact_ratio:.3f}",
        )
    return table


def convergence_parts(study: MeshConvergenceStudy) -> Iterator[Any]:
    """The convergence study of a mesh."""
    yield f"[bold]{study.title or 'Mesh'}[/bold]: mesh '{study.mesh}', F_bt {study.base_force_n:.6g} N on a helix"
    yield f"body: {study.body}"
    yield f"errors in % against {study.reference};"
    yield "after the stroke what the analysis itself estimates"
    yield ""
    table = _table("mesh", "elements", "dofs", "FE", "contact", "k", "k pp", "STE pp")
    for rung in study.rungs:
        cells = []
        for name in ("mean_stiffness", "peak_to_peak_stiffness", "ste_peak_to_peak"):
            estimate = rung.estimate
            said = "-" if estimate is None else f"{100 * getattr(estimate, name):.2g}"
            cells.append(f"{100 * getattr(rung.error, name):.2g}/{said}")
        elements = f"{rung.elements}" + (f"x{rung.layers}" if rung.layers else "")
        method = rung.method.removeprefix("preset ")
        seconds = [f"{rung.fe_seconds:.2f} s", f"{rung.contact_seconds:.2f} s"]
        table.add_row(method, elements, str(rung.dofs), *seconds, *cells)
    yield table
    yield ""
