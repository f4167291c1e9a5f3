"""Studies of single parts: the grid of a film and the positions of rolling elements, and the meshes of teeth."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from rotorgear.analysis.bearing.state import (
    address_of,
    by_its_law,
    carried,
    change_of_tangents,
    law_at,
    laws_of,
    on_grid,
)
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import speed_or_operating
from rotorgear.analysis.common.study import REPEAT, Judged, Setting, Study, keeper, kept
from rotorgear.analysis.static.solve import LawState
from rotorgear.analysis.teeth.errors import error_parts
from rotorgear.analysis.teeth.request import mesh_request, solve_helices
from rotorgear.cpu import cpu_seconds
from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, mesh_cycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem, contact_problem, in_space
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import PRESETS, sized
from rotorgear.model.layout.mesh_layout import mirrored
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.quantity import counted
from rotorgear.results.convergence import ConvergenceStudy, MeshConvergenceStudy, MeshRung
from rotorgear.results.mesh import MeshErrors

# Finenesses of a film's grid, as multiples of the file's number of cells each way; numbers of positions of rolling elements.
_GRIDS = (0.25, 0.5, 1.0)
_FINEST_GRID = 4.0
_POINTS = (2, 4, 8, 16, 32, 64)
_FINEST_POINTS = 1024
_ROUNDING = 1e-9


@recorded
def bearing_convergence_study(
    model: Model,
    bearing: str | None = None,
    *,
    speed: float | str | None = None,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run one bearing at the load that its gearbox puts on it, over a series of grids or of positions of its elements.

    The errors are those of displacements, stiffness and damping, each relative to the largest of its kind; the estimate is
    twice the change of stiffness and damping on a grid of twice the cells, or with twice the positions, as on the sheet.

    Args:
        model, bearing, speed: as for `bearing`.
        repeat: runs of each rung that are timed at least.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no such bearing, no equilibrium, or nothing in the bearing that a series could refine.
    """
    address = address_of(model, bearing)
    given = speed_or_operating(speed, model) or 0.0
    progress(0.0, "equilibrium of the gearbox")
    state = law_at(laws_of(by_its_law(model, address), given), address)
    law = state.part.law
    film = bool(law.grid)
    if not film and not (law.cycle() and given):
        raise AnalysisError(
            f"{address}: its law is a formula without a grid or turning elements; there is nothing to refine"
        )

    def at(fineness: float) -> LawState:
        if film:
            return carried(state, on_grid(law, fineness), given)
        return carried(state, law, given, points=int(fineness))

    def judge(found: tuple[LawState, LawState]) -> Judged:
        here, finer = found
        errors = []
        for key in ("d", "stiffness", "damping"):
            exact = getattr(truth, key).ravel()
            size = float(np.abs(exact).max(initial=0.0))
            errors.append(np.abs(getattr(here, key).ravel() - exact) / size if size else np.zeros_like(exact))
        return Judged(state.d.size, np.concatenate(errors), np.array([change_of_tangents(here, finer)]))

    if film:
        truth = at(_FINEST_GRID)
        settings = [Setting(f"{on_grid(law, g).cells} cells", "grid", g, {"fineness": g}) for g in _GRIDS]
        words = f"the same film on {on_grid(law, _FINEST_GRID).cells} cells"
    else:
        truth = at(_FINEST_POINTS)
        settings = [Setting(f"{n} positions in a pitch", "positions", float(n), {"fineness": n}) for n in _POINTS]
        words = f"the same law, means over {_FINEST_POINTS} positions in a pitch"
    return Study(
        settings,
        run=lambda options: (at(options["fineness"]), at(2.0 * options["fineness"])),
        judge=judge,
        compared="displacements, stiffness and damping",
        count=state.d.size + 2 * state.d.size**2,
        reference=words,
        resolution=_ROUNDING,
        rising=("grid", "positions"),
    ).result("bearing", model, repeat, part_of(progress, 0.3, 1.0))


POSITIONS = 64
# Meshes between the presets, and the reference: rows and columns, and thickness of a layer in normal modules.
_PLANE = {"coarse": MeshSize(4, 2, 4, 2, 3), "medium": MeshSize(8, 3, 6, 3, 5)}
_SPACE = {"coarse": (MeshSize(5, 2, 4, 2, 3), 3.6), "medium": (MeshSize(7, 2, 4, 2, 3), 2.7)}
_REFERENCE = (MeshSize(24, 6, 16, 6, 10), (MeshSize(12, 4, 7, 3, 4), 0.54))


@recorded
def mesh_convergence_study(
    model: Model, mesh: str | None = None, *, torque: float | str | None = None, progress: Progress = silent
) -> MeshConvergenceStudy:
    """Run the loaded contact of one helix of a mesh over presets and mesh sizes, without stored compliances.

    Args:
        model: as for `mesh`.
        mesh: as for `mesh`.
        torque: as for `mesh`.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a mesh or load that can't be.
    """
    request = mesh_request(model, mesh, "tooth_fe", torque, {})
    assert request.teeth is not None
    teeth = request.teeth if request.senses[0] > 0 else mirrored(request.teeth)
    modules = teeth.width / teeth.first.normal_module
    space = in_space(replace(teeth, fe=replace(teeth.fe, preset="default")))[0]

    def size_of(pair: ToothPair) -> MeshSize:
        return pair.fe.mesh_size(modules, space=in_space(pair)[0])

    def solved(pair: ToothPair, told: Progress) -> tuple[ContactProblem, MeshCycle, float, float]:
        """The contact, its cycle, and CPU seconds of the compliances and of the cycle."""
        start = cpu_seconds()
        problem = contact_problem(pair, part_of(told, 0.0, 0.8), fresh=True)
        middle = cpu_seconds()
        cycle = mesh_cycle(problem, request.base_force, np.arange(POSITIONS) / POSITIONS, part_of(told, 0.8, 1.0))
        return problem, cycle, middle - start, cpu_seconds() - middle

    runs: list[tuple[str, ToothPair]] = [
        (name, replace(teeth, fe=sized(teeth.fe, size, modules)))
        for name, size in (_SPACE if space else _PLANE).items()
    ]
    runs += [(f"preset {name}", replace(teeth, fe=replace(teeth.fe, preset=name))) for name in PRESETS]
    runs.sort(key=lambda run: run[0] == "preset fine")
    runs.sort(key=lambda run: run[0] != "preset preview" if space else size_of(run[1]).elements)
    finest = sized(replace(teeth.fe, preset="fine"), _REFERENCE[space], modules)
    steps = len(runs) + 4
    piece = keeper()

    def exact() -> dict[str, Any]:
        problem, cycle, *_ = solved(replace(teeth, fe=finest), part_of(progress, 0.0, 4.0 / steps))
        return {**{name: getattr(problem, name) for name in ("unknowns", "slices", "body")}, "figures": _figures(cycle)}

    reference = piece(exact)
    truth = reference["figures"]
    size = finest.mesh_size(modules, space=space)
    layers = f" in {size.face} layers" if size.face else ""
    words = (
        f"{size.elements} elements a pitch{layers}, {reference['unknowns']} dofs, {counted(reference['slices'], 'slices')}; "
        "the same elements and contact, only finer"
    )
    rungs: list[MeshRung] = []

    def study(status: str = "success") -> MeshConvergenceStudy:
        given = (request.mesh.name, reference["body"], request.base_force)
        return MeshConvergenceStudy(model.title, *given, words, tuple(rungs), status=status)

    def rung_of(name: str, pair: ToothPair, told: Progress) -> dict[str, MeshRung]:
        problem, cycle, fe_seconds, contact_seconds = solved(pair, told)
        figures = _figures(cycle)
        estimate = None
        if name.startswith("preset"):
            # What an analysis with this preset states of one helix; its compliances may come from the disk.
            one = replace(request, senses=(1,))
            helices = solve_helices(one, pair, POSITIONS, judged=True)
            parts = error_parts(one, pair, helices)
            estimate = parts.total if parts else None
        size = size_of(pair)
        errors = MeshErrors(*(abs(here / there - 1.0) for here, there in zip(figures, truth, strict=True)))
        seconds = (fe_seconds, contact_seconds)
        return {
            "rung": MeshRung(name, size.elements, size.face, problem.unknowns, *seconds, *figures, errors, estimate)
        }

    with kept(rungs, len(runs), study):
        for number, (name, pair) in enumerate(runs):
            told = part_of(progress, (number + 4) / steps, (number + 5) / steps)
            rungs.append(piece(partial(rung_of, name, pair, told))["rung"])
    progress(1.0, "done")
    return study()


def _figures(cycle: MeshCycle) -> tuple[float, float, float]:
    """Mean stiffness, its peak to peak, and that of the transmission error."""
    return float(cycle.secant.mean()), float(np.ptp(cycle.secant)), float(np.ptp(cycle.deflection))
