"""Lines of spectra, alone and beside those of a rig, as tables for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.results.tables.common import table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.spectrum import RigSpectrum, SpectralLines


def spectral_lines_table(lines: SpectralLines) -> RenderableType:
    """Return the lines of a spectrum."""
    from rich.console import Group
    from rich.text import Text

    out = table()
    out.add_column("Hz", justify="right")
    out.add_column(f"amplitude {lines.unit}", justify="right")
    out.add_column("order", overflow="fold")
    for f, a, what in zip(lines.frequency_hz, lines.amplitude, lines.source, strict=True):
        out.add_row(f"{f:.2f}", f"{a:.4g}", what)
    head = f"Spectrum of {lines.name}, {lines.window} window, {lines.resolution_hz:.3g} Hz apart"
    return Group(Text(head, style="bold"), out, "")


def rig_spectrum_table(beside: RigSpectrum) -> RenderableType:
    """Return rig lines beside spectral lines."""
    from rich.console import Group
    from rich.text import Text

    out = table()
    for name in ("rig Hz", "Hz", f"amplitude {beside.unit}"):
        out.add_column(name, justify="right")
    out.add_column("order, or why there is no line", overflow="fold")
    for rig, f, a, source, reason in zip(
        beside.rig_hz, beside.frequency_hz, beside.amplitude, beside.source, beside.reason, strict=True
    ):
        explained = not reason
        out.add_row(f"{rig:.6g}", f"{f:.2f}" if explained else "-", f"{a:.4g}" if explained else "-", reason or source)
    return Group(Text(f"Rig lines within {100.0 * beside.tolerance:g} %", style="bold"), out, "")
