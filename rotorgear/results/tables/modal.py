"""The modal result as a table for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.tables.common import error_words, notes_of, plain_table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.modal import ModalResult


def modal_table(result: ModalResult, *, energies: bool = False) -> RenderableType:
    """Return modes, notes and, where asked for, energy shares as one rich renderable that fits 80 columns."""
    from rich.console import Group
    from rich.text import Text

    damped = result.speed is not None
    how = "undamped, at standstill"
    if result.speed is not None:
        how = f"damped, {result.model.reference_shaft} at {result.speed * RPM_PER_RAD_S:.6g} rpm"
    modes = plain_table()
    modes.add_column("mode", justify="right")
    modes.add_column("Hz", justify="right")
    modes.add_column("error", justify="right")
    if damped:
        modes.add_column("zeta %", justify="right")
        modes.add_column("whirl")
    modes.add_column("what moves", overflow="fold")
    for k in range(len(result)):
        # A rigid body has no frequency whose error could be relative to it.
        error = float(result.error_estimate[k])
        known = not result.rigid[k] and error == error
        row = [str(k + 1), f"{result.frequency_hz[k]:.4f}", error_words(error) if known else "-"]
        if damped:
            row += [f"{100.0 * result.damping_ratio[k]:.3f}", result.whirl[k]]
        modes.add_row(*row, result.description[k])
    notes = ["", f"{result.dofs} dofs, {result.mesh_text}, {result.seconds['total']:.2f} s; {result.method}"]
    estimates = result.error_estimate[np.isfinite(result.error_estimate)]
    if estimates.size:
        notes.append(f"error: estimated relative error of each frequency; largest {estimates.max():.1e}")
    notes += notes_of(result)
    title = Text(f"{result.model.title or 'Modes'}: {how}", style="bold")
    parts: list[RenderableType] = [title, modes]
    if energies:
        shares = plain_table("Energy shares")
        shares.add_column("mode", justify="right")
        shares.add_column("kinetic, by part", overflow="fold")
        shares.add_column("strain, by part", overflow="fold")
        for k in range(len(result)):
            shares.add_row(str(k + 1), _largest(result.kinetic_energy, k), _largest(result.strain_energy, k))
        parts.append(shares)
    return Group(*parts, *(Text(note) for note in notes), "")


def _largest(shares: dict[str, Any], k: int) -> str:
    ranked = sorted(((float(share[k]), part) for part, share in shares.items()), reverse=True)[:4]
    return ", ".join(f"{part} {100.0 * share:.0f}%" for share, part in ranked if share >= 0.01)
