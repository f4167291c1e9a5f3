"""Draws the convergence study of a mesh: errors of stiffness and transmission error against CPU seconds."""

from __future__ import annotations

from pathlib import Path

from rotorgear.errors import MissingExtraError
from rotorgear.export.files import replacing
from rotorgear.results.mesh_convergence import MeshConvergenceStudy

_CURVES = (
    ("mean_stiffness", "o", "#1f5fa8", "mean stiffness"),
    ("peak_to_peak_stiffness", "s", "#b3541e", "its peak to peak"),
    ("ste_peak_to_peak", "^", "#3a7d44", "transmission error, peak to peak"),
)


def draw_mesh_convergence(study: MeshConvergenceStudy, path: str | Path) -> Path:
    """Write the study as a picture (PNG or SVG by the name's ending) and return its path.

    Raises:
        MissingExtraError: matplotlib is not installed.
        WriteError: the file can't be written.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtraError("A plot", "matplotlib", "plots") from None
    figure = Figure(figsize=(7.5, 4.6), layout="constrained")
    axis = figure.subplots()
    for name, marker, colour, label in _CURVES:
        seconds = [rung.fe_seconds + rung.contact_seconds for rung in study.rungs]
        errors = [100.0 * max(getattr(rung.error, name), 1e-7) for rung in study.rungs]
        axis.loglog(seconds, errors, marker, color=colour, ms=7, label=label)
        known = [(s, rung.estimate) for s, rung in zip(seconds, study.rungs, strict=True) if rung.estimate]
        axis.loglog([s for s, _ in known], [100.0 * getattr(e, name) for _, e in known], "x", color=colour, ms=6)
    for rung in study.rungs:
        top = 100.0 * rung.error.worst
        place = (rung.fe_seconds + rung.contact_seconds, top)
        axis.annotate(rung.method.removeprefix("preset "), place, (4, 6), textcoords="offset points", fontsize=8)
    axis.loglog([], [], "x", color="#444444", label="its own estimate")
    axis.set_xlabel("CPU seconds, teeth and contact of 64 positions")
    axis.set_ylabel("relative error, %")
    axis.grid(True, which="major", alpha=0.25)
    axis.legend(frameon=False, fontsize=8)
    axis.set_title(f"{study.title}: {study.mesh}", fontsize=10)
    target = Path(path)
    with replacing(target) as scratch:
        plain = target.suffix.lower() == ".svg"
        figure.savefig(scratch, dpi=120, format=target.suffix[1:].lower(), metadata={"Date": None} if plain else None)
    return target
