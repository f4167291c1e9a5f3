"""What a report computes: the analyses that a model has the parts for, their CPU seconds, and why others are not there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from rotorgear.analysis.campbell.campbell import campbell
from rotorgear.analysis.campbell.critical import critical
from rotorgear.analysis.campbell.critical_map import critical_map
from rotorgear.analysis.casing.casing import casing
from rotorgear.analysis.common.describe_model import check
from rotorgear.analysis.common.excitation import excitation_orders
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.stream import Piece, unkept
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.response.response import HIGHEST as TOP
from rotorgear.analysis.response.response import response
from rotorgear.analysis.rig.compare import compare
from rotorgear.analysis.standards.standards import HIGHEST, judged
from rotorgear.analysis.static.static import static
from rotorgear.analysis.teeth.gear_sheet import gear
from rotorgear.analysis.teeth.mesh import mesh
from rotorgear.cpu import compiling_seconds, cpu_seconds
from rotorgear.errors import AnalysisError, RotorgearError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.critical import CriticalResult
from rotorgear.results.standards import StandardsResult

# Modes of the table where no rig asks for more, speeds of the diagram, stiffnesses of the map.
MODES = 24
CAMPBELL_SPEEDS = 31
MAP_STIFFNESSES = 9
MESH_ORDERS_OF_RUN_UP = 3
_ABOVE_RIG = 1.15
_LOADED = "tooth_fe"
_NO_SPEED = "the model has no operating speed"
# Sections of a page, and the analyses behind each.
SECTIONS = {
    "model": ("check", "gear", "modal"),
    "statics": ("static",),
    "modes": ("modal",),
    "campbell": ("campbell",),
    "critical": ("critical", "critical_map"),
    "standards": ("critical", "standards"),
    "run-up": ("response",),
    "teeth": ("mesh",),
    "casings": ("casing",),
    "rig": ("modal", "rig"),
}


@dataclass
class Contents:
    """Results by the name they have in the page's numbers, their CPU seconds, and what was not computed and why.

    `only`: names of sections; all where there are none.
    """

    model: Model
    progress: Progress = silent
    piece: Piece = unkept
    results: dict[str, Any] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    missing: dict[str, str] = field(default_factory=dict)
    seconds_of_all: float = 0.0
    only: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        unknown = [name for name in self.only if name not in SECTIONS]
        if unknown:
            raise AnalysisError(f"only: got '{unknown[0]}', expected sections among {', '.join(SECTIONS)}")

    def wants(self, name: str) -> bool:
        """Whether an analysis stands behind a section that was asked for."""
        kind = name.partition(" ")[0]
        return not self.only or any(kind in SECTIONS[section] for section in self.only)

    def lacks(self, name: str, reason: str) -> None:
        """Keep why an analysis that was asked for is not there."""
        if self.wants(name):
            self.missing[name] = reason

    def run(self, name: str, begins: float, analysis: Callable[[], Any]) -> Any:
        """Run an analysis, which begins at a fraction of the whole; what the model lacks for it is kept as the reason why not."""
        if not self.wants(name):
            return None
        self.progress(begins, name.replace("_", " "))
        done = self.piece(partial(_section, analysis))
        if "missing" in done:
            self.missing[name] = done["missing"]
            return None
        self.seconds[name] = done["seconds"]
        self.results[name] = done["result"]
        return self.results[name]


def _section(analysis: Callable[[], Any]) -> dict[str, Any]:
    start = cpu_seconds() - compiling_seconds()
    try:
        result = analysis()
    except RotorgearError as error:
        return {"missing": str(error)}
    return {"result": result, "seconds": cpu_seconds() - compiling_seconds() - start}


def computed(
    model: Model,
    rig: Any,
    grade: float,
    run_up: dict[str, Any],
    progress: Progress = silent,
    piece: Piece = unkept,
    only: tuple[str, ...] = (),
) -> Contents:
    """Run the analyses of a report.

    Args:
        model: a checked model. rig: measured lines, or none.
        grade: balance quality grade in mm/s.
        run_up: modal_damping and fmax of `response`; without fmax orders go up to those of `_highest_order`.
        progress: callable that is told fraction and step.
        piece: does the work of a section, or takes it over.
        only: names of `SECTIONS`; all where there are none.

    Raises:
        AnalysisError: no such section.
    """
    found = Contents(model, progress, piece, only=only)
    speed = model.operating_speed
    found.run("check", 0.02, lambda: check(model))
    if model.meshes:
        found.run("gear", 0.03, lambda: gear(model))
    found.run("static", 0.05, lambda: static(model))
    highest = max((line.frequency_hz for line in rig), default=0.0)
    wanted = {"fmax": _ABOVE_RIG * highest} if highest else {"modes": MODES}
    modes = found.run("modal", 0.1, lambda: modal(model, **wanted))
    if rig and modes is not None:
        found.run("rig", 0.18, lambda: compare(modes, rig, known_to_hz=wanted.get("fmax")))
    if speed:
        # The analyses over a range of speeds.
        found.run("campbell", 0.2, lambda: campbell(model, points=CAMPBELL_SPEEDS, modes=MODES, mesh_orders=(1,)))
        # The rules judge the critical speeds of the table: both go as far as the widest margin reaches.
        speeds = found.run("critical", 0.45, lambda: critical(model, stop=HIGHEST * speed))
        if model.bearings:
            found.run("critical_map", 0.5, lambda: critical_map(model, stiffness=_stiffnesses(model)))
        else:
            found.lacks("critical_map", "the model has no bearings")
        if speeds is not None:
            found.run("standards", 0.55, lambda: _standards(model, critical_speeds=speeds, grade=grade))
        else:
            found.lacks("standards", found.missing.get("critical", ""))
        asked = run_up if run_up["fmax"] is not None else {**run_up, "fmax": _highest_order(model)}
        found.run("response", 0.65, lambda: response(model, **asked))
    else:
        for name in ("campbell", "critical", "critical_map", "standards", "response"):
            found.lacks(name, _NO_SPEED)
    for name in loaded_meshes(model):
        found.run(f"mesh {name}", 0.8, lambda name=name: mesh(model, name))  # type: ignore[misc]
    for name in model.casings:
        found.run(f"casing {name}", 0.85, lambda name=name: casing(model, name))  # type: ignore[misc]
    return found


@recorded
def _standards(model: Model, *, critical_speeds: CriticalResult, grade: float) -> StandardsResult:
    return judged(critical_speeds, model, grade)


def _highest_order(model: Model) -> float | None:
    """Frequency in Hz of the last order of the fastest mesh in a run-up, at its highest speed; None without a mesh."""
    lines = excitation_orders(model, (), (MESH_ORDERS_OF_RUN_UP,))
    highest = max((line.frequency_hz(TOP * (model.operating_speed or 0.0)) for line in lines), default=0.0)
    return (1.0 + 1e-9) * highest or None


def _stiffnesses(model: Model) -> list[float]:
    """Radial stiffnesses of a map: a decade and a half to both sides of what the model's bearings have."""
    known = [
        float(value)
        for bearing in model.bearings.values()
        if bearing.stiffness is not None
        for value in np.diag(np.array(bearing.stiffness.as_rows()))[:2]
        if value > 0.0
    ]
    middle = float(np.sqrt(min(known) * max(known))) if known else 1e8
    return [float(k) for k in middle * np.logspace(-1.5, 1.5, MAP_STIFFNESSES)]


def loaded_meshes(model: Model) -> list[str]:
    """Meshes whose stiffness is that of loaded finite-element teeth, one of those between gears that are alike."""
    place = {"shaft", "at"}
    teeth = {name: repr(gear.model_dump(exclude=place)) for name, gear in model.gears.items()}
    chosen: dict[tuple[str, str, str], str] = {}
    for name, part in model.meshes.items():
        if part.stiffness == _LOADED:
            chosen.setdefault((teeth[part.pinion], teeth[part.gear], repr(part.tooth_fe)), name)
    return list(chosen.values())


def error_of(result: Any) -> float | None:
    """The largest error estimate that a result has, relative; None where it states none."""
    error: Any = getattr(result, "error_estimate", None)
    rows = {"standards": "criticals", "critical": "speeds"}.get(result.kind)
    if rows is not None:
        error = [item.error_estimate for item in getattr(result, rows)]
    elif result.kind == "mesh":
        error = result.errors and result.errors.worst
    if error is None:
        return None
    values = np.atleast_1d(np.asarray(error, float))
    values = values[np.isfinite(values)]
    return float(values.max()) if values.size else None
