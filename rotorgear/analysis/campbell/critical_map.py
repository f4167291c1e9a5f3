"""Undamped critical speed map: critical speeds over one radial stiffness that replaces that of all bearings.

Rieger, Vibrations of Rotating Machinery; Vance, Rotordynamics of Turbomachinery, chapter 3: where the stiffness of a real bearing
cuts the curves, its undamped critical speeds are read from the map.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.campbell.critical import affine_pieces, looks_of, roots_of
from rotorgear.analysis.campbell.crossings import whirl_for
from rotorgear.analysis.campbell.speed_family import SpeedFamily
from rotorgear.analysis.campbell.speeds import highest_speed, system_for_speeds
from rotorgear.analysis.common.excitation import excitation_orders
from rotorgear.analysis.common.forecast import Forecast
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.modal.branch_shapes import whirl_numbers
from rotorgear.analysis.modal.modal import ModalRequest
from rotorgear.analysis.static.state_at import state_at
from rotorgear.cpu import Clock, cpu_seconds
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.spring import constant_spring
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.critical import CriticalMap

# Decades below the softest and above the stiffest bearing of the model that the map covers.
_DECADES = 2.0
_POINTS = 33
# With less bending in its kinetic energy a mode counts as torsional or axial.
_BENDS = 0.5


@recorded
def critical_map(
    model: Model,
    *,
    stiffness: Sequence[float] | None = None,
    shaft: str | None = None,
    order: float = 1.0,
    stop: float | str | None = None,
    elements: int | None = None,
    accuracy: float | None = None,
    progress: Progress = silent,
) -> CriticalMap:
    """Return undamped critical speeds of one order of one shaft over the radial stiffness of all bearings.

    Every bearing keeps its axial, tilting and torsional stiffness and its pedestal; its stiffness along x and y, cross terms and
    table give way to the one value.

    Args:
        model: a model with at least one bearing.
        stiffness: stiffnesses in N/m, positive (default: 33 values from two decades below the softest bearing to two above the
            stiffest).
        shaft: shaft whose order excites (default: the input shaft).
        order: multiple of the speed of that shaft.
        stop: as in `critical`.
        elements: as in `critical`.
        accuracy: as in `critical`.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no bearings, no such shaft, a stiffness that is not positive.
    """
    if not model.bearings:
        raise AnalysisError("the model has no bearings, so there is no support stiffness to vary")
    rigid = [f"bearings.{name}" for name, bearing in model.bearings.items() if set(bearing.rigid_directions) & {0, 1}]
    if rigid:
        raise AnalysisError(
            f"{rigid[0]}.stiffness: rigid across the shaft, where a map varies it: give it any stiffness"
        )
    shaft = shaft or model.reference_shaft
    line = next((item for item in excitation_orders(model, (order,), ()) if shaft in item.parts), None)
    if line is None:
        raise AnalysisError(f"there is no turning shaft '{shaft}'; there are {', '.join(model.shafts)}")
    top = highest_speed(model, stop)
    about = state_at(model, [top])
    radial = {name: np.diag(_middle(about, name))[:2] for name in model.bearings}
    if stiffness is None:
        present = np.concatenate(list(radial.values()))
        present = present[present > 0.0]
        if not present.size:
            raise AnalysisError("no bearing has a radial stiffness, so there is none to vary")
        values = np.logspace(np.log10(present.min()) - _DECADES, np.log10(present.max()) + _DECADES, _POINTS)
    else:
        values = np.sort(np.asarray(stiffness, float))
    if not values.size or not np.all(np.isfinite(values) & (values > 0.0)):
        raise AnalysisError("the support stiffness must be positive, in N/m")
    clock = Clock()
    asked = ModalRequest(fmax=line.frequency_hz(top), elements=elements, accuracy=accuracy)
    stiffest = with_radial_stiffness(model, about, float(values[-1]), top)
    mesh = system_for_speeds(model, [top], asked, stiffest, progress)
    clock.lap("mesh")
    forecast = Forecast("critical map", clock.worked, len(values))
    rows: list[tuple[np.ndarray, np.ndarray]] = []
    for k, value in enumerate(values):
        progress(0.1 + 0.9 * k / len(values), f"{value:.3g} N/m")
        begun = cpu_seconds()
        system = mesh.with_state(with_radial_stiffness(model, about, float(value), top))
        family = SpeedFamily(system, *sorted((0.0, top)))
        ranges = list(affine_pieces(system, family, top, damped=False))
        found, _ = roots_of(system, family, ranges, line.order, top)
        found.sort(key=lambda root: root.speed)
        _, _, speeds, seen = looks_of(system, found, top)
        bending = seen.energies.kinetic_by_motion.get("bending", np.zeros(len(found)))
        words = [whirl_for(line, seen, n) if bending[n] >= _BENDS else "" for n in range(len(found))]
        rows.append((speeds, whirl_numbers(tuple(words))))
        forecast.add(cpu_seconds() - begun)
    clock.lap("critical speeds")
    # How many lie below the top speed depends on the stiffness: NaN fills the rows up.
    width = max(len(speeds) for speeds, _ in rows)
    speeds = np.array([np.pad(row, (0, width - len(row)), constant_values=np.nan) for row, _ in rows])
    return CriticalMap(
        model=model,
        line=line.name,
        stiffness=values,
        critical_speeds=speeds,
        whirl=np.array([np.pad(numbers, (0, width - len(numbers))) for _, numbers in rows]),
        bearings=radial,
        top_speed=top,
        dofs=mesh.n,
        seconds=clock.total(),
    )


def with_radial_stiffness(model: Model, about: State, value: float, speed: float) -> State:
    """The state at a speed with one radial stiffness in N/m in all bearings that have a radial one, and no damping in them.

    `about` is that of the bearings as they are; what they leave of it, such as the load along the faces, is found anew.
    """
    springs = {}
    for name in model.bearings:
        rows = _middle(about, name).copy()
        if not np.any(np.diag(rows)[:2]):
            continue
        rows[:2, :] = 0.0
        rows[:, :2] = 0.0
        rows[0, 0] = rows[1, 1] = value
        springs[f"bearings.{name}"] = constant_spring(rows, np.zeros((6, 6)))
    return state_at(model, [speed], springs=springs)


def _middle(about: State, bearing: str) -> np.ndarray:
    """Stiffness (6, 6) of a bearing; of a table that in the middle row."""
    stiffness = about.springs[f"bearings.{bearing}"].stiffness
    return stiffness[len(stiffness) // 2]
