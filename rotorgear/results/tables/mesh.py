"""The result of a mesh as tables that fit 80 columns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.results.mesh import PLANE, MeshResult
from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType


def mesh_table(result: MeshResult, *, harmonics: int = 0) -> RenderableType:
    """Return stiffness, transmission error and, where asked for, so many orders of the mesh as one rich renderable."""
    from rich.console import Group

    preset = "" if result.preset is None else f", preset {result.preset}"
    setting = [
        f"stiffness model {result.stiffness_model}{preset}: {result.definition}, {PLANE}",
        f"body: {result.body}",
    ]
    if result.load is None:
        setting.append("no load")
    else:
        load = result.load
        setting.append(
            f"load: {load.pinion_torque_n_m:.6g} N m on the pinion, F_bt {load.base_force_n:.6g} N, "
            f"F_n {load.normal_force_n:.6g} N ({load.source})"
        )
    title = heading(result.title or "Mesh", f": mesh '{result.mesh}', {result.pinion} and {result.gear}")
    parts: list[Any] = [title, *lines(*setting), "", _main(result)]
    if harmonics:
        parts += ["", _harmonics(result, harmonics)]
    if result.loads:
        loads = table(
            "load factor", "mean stiffness", "peak to peak", "STE peak to peak", "contact ratio", no_wrap=True
        )
        for point in result.loads:
            loads.add_row(
                f"{point.factor:g}",
                f"{point.mean_stiffness_n_per_m:.5g} N/m",
                f"{point.peak_to_peak_stiffness_n_per_m:.4g} N/m",
                f"{1e6 * point.ste_peak_to_peak_m:.4f} um",
                f"{point.contact_ratio:.3f}",
            )
        parts += ["", loads]
    parts += ["", *lines(*notes_of(result))]
    if result.dofs:
        # Teeth in the plane take nothing worth a word.
        told = result.memory_bytes is not None and any(np.ptp(helix.z) > 0.0 for helix in result.helix)
        memory = f", {1e-9 * (result.memory_bytes or 0.0):.1f} GB" if told else ""
        parts.append(f"{result.dofs} dofs, {result.seconds['total']:.2f} s{memory}")
    return Group(*parts)


def _main(result: MeshResult) -> Any:
    helices = f"all {result.helices} helices" if result.helices > 1 else "one helix"
    out = table("", helices, "per width of a helix", "est. error", no_wrap=True)
    errors = result.errors
    per = 1e-9 / (result.face_width * result.helices) if result.face_width else None

    def row(name: str, value: float, error: float | None) -> None:
        width = f"{per * value:.4f} N/(mm um)" if per else "-"
        out.add_row(name, f"{value:.5g} N/m", width, "-" if error is None else f"{100 * error:.2g} %")

    row("mean stiffness", result.mean_stiffness, errors.mean_stiffness if errors else None)
    row("peak to peak", result.peak_to_peak_stiffness, errors.peak_to_peak_stiffness if errors else None)
    if result.tangent is not None:
        row("mean tangent stiffness", float(result.mean_tangent_stiffness or 0.0), None)
    row("mean along the normal", result.mean_normal_stiffness, None)
    if result.transmission_error is not None and result.no_load_error is not None:
        ste = result.transmission_error
        error = errors.ste_peak_to_peak if errors else None
        out.add_row("transmission error, mean", f"{1e6 * (result.mean_transmission_error or 0.0):.4f} um", "", "")
        out.add_row("peak to peak", f"{1e6 * np.ptp(ste):.4f} um", "", "-" if error is None else f"{100 * error:.2g} %")
        out.add_row("peak to peak, no load", f"{1e6 * np.ptp(result.no_load_error):.4f} um", "", "")
    if result.helix:
        helix = result.helix
        ratio = np.mean([item.contact_ratio for item in helix])
        out.add_row("contact ratio under load", f"{ratio:.3f}", f"{helix[0].geometric_contact_ratio:.3f} geometric", "")
        share = max(float(values.max()) for item in helix for values in item.share.values())
        out.add_row("largest share of a pair", f"{100 * share:.1f} %", "", "")
        out.add_row("largest line load", f"{1e-3 * max(item.line_load.max() for item in helix):.4g} N/mm", "", "")
        pressure = f"{1e-6 * max(item.pressure.max() for item in helix):.4g} MPa"
        of_pressure = errors.largest_pressure if errors else None
        out.add_row("largest pressure", pressure, "", "-" if of_pressure is None else f"{100 * of_pressure:.2g} %")
    return out


def _harmonics(result: MeshResult, count: int) -> Any:
    out = table("mesh order", "stiffness", "phase", "transmission error", "phase", no_wrap=True)
    k = result.harmonics(count)
    e = result.ste_harmonics(count)
    for order in range(len(k)):
        # Below this share of the mean an order is rounding, and its phase says nothing.
        small = abs(k[order]) < 1e-9 * result.mean_stiffness
        cells = [f"{abs(k[order]):.4g} N/m", "-" if small else f"{np.degrees(np.angle(k[order])):.1f} deg"]
        if e is not None:
            cells += [f"{1e6 * abs(e[order]):.4f} um", "-" if small else f"{np.degrees(np.angle(e[order])):.1f} deg"]
        out.add_row(str(order + 1), *cells)
    return out
