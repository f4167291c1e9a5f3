"""One bearing of a gearbox in equilibrium: which law it has, and its displacement under a load, on any grid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.analysis.common.request import direction_of
from rotorgear.analysis.static.about_equilibrium import along_faces
from rotorgear.analysis.static.along_faces import decided_by_loads
from rotorgear.analysis.static.cycle import over_cycle
from rotorgear.analysis.static.film_heat import in_heat_balance
from rotorgear.analysis.static.solve import LawState, equilibrate
from rotorgear.errors import AnalysisError
from rotorgear.forces.law import CYCLE_POINTS
from rotorgear.model.model import Model
from rotorgear.model.parts.supports import Bearing
from rotorgear.quantity import did_you_mean
from rotorgear.solvers.sparse.newton import ROUNDING
from rotorgear.system.system import flow_system

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw

_ITERATIONS = 40
_TOLERANCE = 1e-11


def address_of(model: Model, name: str | None) -> str:
    """The address of a bearing, or of a nonlinear element between a shaft and the ground, that a force law describes.

    Raises:
        AnalysisError: there is none of that name, or it has no law.
    """
    laws = [f"bearings.{one}" for one, bearing in model.bearings.items() if bearing.has_law]
    laws += [f"nonlinear_elements.{one}" for one in model.nonlinear_elements]
    if name is None and len(laws) == 1:
        return laws[0]
    own = [address for address in laws if name in (address, address.partition(".")[2])]
    if name is not None and own:
        return own[0]
    known = ", ".join(address.partition(".")[2] for address in laws) or "none"
    if name in model.bearings:
        *kinds, last = (f"{kind} = {{...}}" for kind in Bearing.kinds())
        raise AnalysisError(
            f"bearings.{name}: a stiffness given by hand has no sheet; give {', '.join(kinds)} or {last}"
        )
    hint = did_you_mean(name or "", [address.partition(".")[2] for address in laws], f"those with a law are: {known}")
    got = f"the model has no bearing '{name}' with a law" if name else "name one of several bearings"
    raise AnalysisError(f"bearing: {got}; {hint}")


def by_its_law(model: Model, address: str) -> Model:
    """The model with one bearing held by its law alone, where the file gives it a stiffness as well."""
    table, _, name = address.partition(".")
    if table != "bearings" or model.bearings[name].stiffness is None:
        return model
    return model.with_({f"{address}.stiffness": None})


def laws_of(model: Model, speed: float, near: Sequence[LawState] = ()) -> tuple[LawState, ...]:
    """The laws in the equilibrium of the whole gearbox at a speed of the input shaft in rad/s, looked for from a known one.

    Loads along faces and loaded teeth are those of `static`: both move the force of a mesh along its face.

    Raises:
        AnalysisError: there is no equilibrium.
    """
    sense = direction_of(speed)
    faced = along_faces(model, [speed], model.torque_flow(sense))
    system = flow_system(model, direction=sense).with_state(faced.of_kind("static"))
    found = equilibrate(system, speed, near=near)
    if not (faced.faces and decided_by_loads(found)):
        found, _ = over_cycle(found, speed)
    return found.laws


def law_at(laws: Sequence[LawState], address: str) -> LawState:
    """The one of a bearing among the laws of an equilibrium."""
    return next(law for law in laws if law.part.part == address)


def carried(state: LawState, law: ForceLaw, speed: float, points: int = CYCLE_POINTS) -> LawState:
    """A law on its own under the force of a state, warm where it is a film; rolling elements are averaged over `points`.

    Raises:
        AnalysisError: Newton's method does not find it.
    """
    near = [state.d]

    def settled(laws: Sequence[ForceLaw]) -> tuple[np.ndarray, list[np.ndarray]]:
        near[0] = _under(laws[0], state.force, near[0], speed, points)
        return near[0], near

    (own,), d = in_heat_balance([law], speed, settled)
    tangent = own.settled(d).linearised(d, speed=speed, points=points)
    return LawState(replace(state.part, law=own), d, tangent.force, tangent.stiffness, tangent.damping)


def _under(law: ForceLaw, load: np.ndarray, start: np.ndarray, speed: float, points: int) -> np.ndarray:
    """Displacements of a law under a load, by Newton's method."""
    d = start.copy()
    size = float(np.abs(load).max(initial=0.0))
    for _ in range(_ITERATIONS):
        about = law.linearised(d, speed=speed, points=points)
        rest = load - about.force
        if np.all(np.abs(rest) <= _TOLERANCE * size + ROUNDING * np.abs(about.stiffness) @ law.extents):
            return d
        if not (np.all(np.isfinite(rest)) and np.all(np.isfinite(about.stiffness))):
            break
        # What nothing loads (a motion along a film) has no stiffness: least squares leaves it where it is.
        d = d + np.linalg.lstsq(about.stiffness, rest, rcond=1e-13)[0]
    raise AnalysisError("the bearing's own equilibrium was not found on another grid; check its load")


def change_of_tangents(here: LawState, finer: LawState) -> float:
    """Estimated relative error of stiffness and damping: twice what half the cells change, as for an error of first order."""
    changes = [(finer.stiffness - here.stiffness, here.stiffness), (finer.damping - here.damping, here.damping)]
    return 2.0 * max(relative(difference, size) for difference, size in changes)


def relative(difference: np.ndarray, of: np.ndarray) -> float:
    """Largest entry over that of another array; 0 where that has none."""
    size = float(np.abs(of).max(initial=0.0))
    return float(np.abs(difference).max(initial=0.0) / size) if size else 0.0


def on_grid(law: ForceLaw, factor: float) -> ForceLaw:
    """A film on a grid with `factor` times the cells each way, within the bounds of its law; other laws have none."""
    cells = {}
    for key in law.grid:
        about = law.declared()[key]
        cells[key] = int(np.clip(round(factor * getattr(law, key)), about.least, about.most))
    return replace(law, **cells) if cells else law
