"""The modal result as a table for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rotorgear.quantity import RPM_PER_RAD_S

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.modal import ModalResult


def modal_table(result: ModalResult, *, energies: bool = False) -> RenderableType:
    """Return modes, notes and, where asked for, energy shares as one rich renderable that fits 80 columns."""
    from rich.console import Group
    from rich.text import Text

    parts: list[RenderableType] = [Text(_title(result), style="bold"), _modes(result)]
    if energies:
        parts.append(_energies(result))
    parts += [Text(line) for line in _notes(result)]
    return Group(*parts, "")


def _modes(result: ModalResult) -> Any:
    from rich.table import Table

    damped = result.speed is not None
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("mode", justify="right")
    table.add_column("Hz", justify="right")
    table.add_column("error", justify="right")
    if damped:
        table.add_column("zeta %", justify="right")
        table.add_column("whirl")
    table.add_column("what moves", overflow="fold")
    for k in range(len(result)):
        row = [str(k + 1), f"{result.frequency_hz[k]:.4f}", _error(result, k)]
        if damped:
            row += [f"{100.0 * result.damping_ratio[k]:.3f}", result.whirl[k]]
        table.add_row(*row, result.description[k])
    return table


def _title(result: ModalResult) -> str:

    if result.speed is None:
        how = "undamped, at standstill"
    else:
        how = f"damped, {result.model.reference_shaft} at {result.speed * RPM_PER_RAD_S:.6g} rpm"
    return f"{result.model.title or 'Modes'}: {how}"


def _error(result: ModalResult, k: int) -> str:
    value = float(result.error_estimate[k])
    if result.rigid[k] or value != value:
        return "-"
    return f"{value:.0e}" if value >= 1e-9 else "<1e-9"


def _notes(result: ModalResult) -> list[str]:
    import numpy as np

    estimates = result.error_estimate[np.isfinite(result.error_estimate)]
    lines = [
        "",
        f"{result.dofs} dofs, {result.mesh_text}, {result.seconds['total']:.2f} s; {result.method}",
    ]
    if estimates.size:
        lines.append(f"error: estimated relative error of each frequency; largest {estimates.max():.1e}")
    lines += [f"left out: {note}" for note in result.left_out]
    lines += [f"Warning: {note}" for note in result.warnings]
    return lines


def _energies(result: ModalResult) -> Any:
    from rich.table import Table

    table = Table(
        box=None, pad_edge=False, title="\nEnergy shares", title_justify="left", title_style="bold", header_style="bold"
    )
    table.add_column("mode", justify="right")
    table.add_column("kinetic, by part", overflow="fold")
    table.add_column("strain, by part", overflow="fold")
    for k in range(len(result)):
        table.add_row(str(k + 1), _largest(result.kinetic_energy, k), _largest(result.strain_energy, k))
    return table


def _largest(shares: dict[str, Any], k: int) -> str:
    ranked = sorted(((float(share[k]), part) for part, share in shares.items()), reverse=True)[:4]
    return ", ".join(f"{part} {100.0 * share:.0f}%" for share, part in ranked if share >= 0.01)
