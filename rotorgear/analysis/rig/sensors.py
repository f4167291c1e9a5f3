"""Place the sensors of a test before it is made: effective independence, then the AutoMAC.

Rows of Phi (n, m) are candidates, columns the modes that are to be told apart. The share of row i in the rank is

    E_i = phi_i (Phi^T Phi)^-1 phi_i^T,    sum of all E = m        (Kammer 1991, J. Guidance, Control and Dynamics 14)

and the row with the least share is taken away again and again, which keeps the determinant of Phi^T Phi large. As many rows as
modes are all independent; below that, the row goes without which the modes remain least alike: least sum of squared MAC.
"""

from __future__ import annotations

import fnmatch

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.points import point_rows
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_whole
from rotorgear.analysis.modal.solve import Wanted, solve
from rotorgear.analysis.rig.compare import ABOVE_RIG
from rotorgear.analysis.rig.likeness import mac
from rotorgear.analysis.rig.rig_model import plan_of
from rotorgear.analysis.rig.sensor_table import places_of
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.progress import Progress, silent
from rotorgear.results.sensors import PlannedSensor, SensorPlan
from rotorgear.system.plan import Plan

# From this many candidates on, rows are taken away one at a time.
_ONE_BY_ONE = 200
# A mode that moves by less than this share of the others along all candidates is not seen there.
_STILL = 1e-6


@recorded
def sensors(
    model: Model,
    *,
    count: int = 12,
    modes: int | None = None,
    fmax: float | None = None,
    candidates: str = "*",
    directions: str = "xyz",
    accuracy: float | None = None,
    elements: int | None = None,
    progress: Progress = silent,
) -> SensorPlan:
    """Return the places that tell the lowest elastic modes at standstill apart.

    Args:
        model: the model. Candidates are its parts on shafts and the surface points of its casings.
        count: number of sensors.
        modes: number of elastic modes (default: that of the sensors, unless `fmax` is given).
        fmax: all elastic modes up to this many Hz.
        candidates: addresses of the places to choose from, with commas between, such as "bearings.*, casings.*".
        directions: directions that sensors may look along, letters among x, y and z.
        accuracy: as in `modal`.
        elements: as in `modal`.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no such places, fewer candidates than sensors, no elastic modes.
    """
    check_whole("the number of sensors (count)", count, 2)
    if not directions or set(directions) - set("xyz"):
        raise AnalysisError(f"directions: got '{directions}', expected letters among x, y and z")
    names, positions = places_of(model)
    patterns = [part.strip() for part in candidates.split(",")]
    kept = [k for k, name in enumerate(names) if any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)]
    if not kept:
        raise AnalysisError(f"candidates: '{candidates}' names no place of the model, such as {', '.join(names[:3])}")
    progress(0.1, "modes")
    looks = [f"{names[k]}:{axis}" for k in kept for axis in directions]
    if modes is not None:
        check_whole("the number of modes", modes, 2)
    most = None
    if fmax is None:
        # A first look at the modes says up to which frequency they reach.
        most = modes or count
        first = solve(linear_system(model, [None], Plan(elements or 2)), Wanted(None, most + 12, None))
        elastic = np.sort(np.abs(first.eigenvalues[~first.rigid]))
        if not elastic.size:
            raise AnalysisError("the model has no elastic modes to tell apart")
        fmax = ABOVE_RIG * float(elastic[min(most, len(elastic)) - 1]) / (2.0 * np.pi)
    system = linear_system(model, [None], Plan(elements) if elements else plan_of(model, fmax, accuracy))
    solved = solve(system, Wanted(None, None, 2.0 * np.pi * fmax))
    elastic = np.flatnonzero(~solved.rigid & (np.abs(solved.eigenvalues) > 0.0))[:most]
    if len(elastic) < 2:
        raise AnalysisError(f"there are {len(elastic)} elastic modes up to {fmax:.5g} Hz: nothing to tell apart")
    hz = np.abs(solved.eigenvalues[elastic]) / (2.0 * np.pi)
    numbers = elastic + 1
    shapes = np.asarray(point_rows(system, looks) @ np.real(solved.vectors[:, elastic]))
    size = np.abs(shapes).max(axis=0)
    seen = size > _STILL * size.max()
    if not seen.any():
        raise AnalysisError(f"no mode up to {hz[-1]:.5g} Hz moves a candidate along {', '.join(directions)}")
    # What rounding leaves of a mode that moves along none of the directions is no shape.
    blind = f"modes {', '.join(map(str, numbers[~seen]))} move along none of these directions"
    hz = hz[seen]
    numbers = numbers[seen]
    shapes = shapes[:, seen]
    moving = np.flatnonzero(np.abs(shapes).max(axis=1) > 1e-9 * np.abs(shapes).max())
    if len(moving) < count:
        raise AnalysisError(
            f"{count} sensors are more than the {len(moving)} places and directions that move: ask for fewer"
        )
    progress(0.6, "places")
    chosen = moving[best_rows(shapes[moving], count)]
    share = independence(shapes[chosen])
    node_of: dict[int, int] = {}
    found = []
    for row, value in zip(chosen, share, strict=True):
        place, axis = divmod(int(row), len(directions))
        node = node_of.setdefault(kept[place], len(node_of) + 1)
        found.append(PlannedSensor(names[kept[place]], node, directions[axis], positions[kept[place]], float(value)))
    everywhere = mac(shapes[moving].T, shapes[moving].T)
    return SensorPlan(
        model=model,
        sensors=tuple(found),
        mode_number=numbers,
        mode_hz=hz,
        model_auto_mac=mac(shapes[chosen].T, shapes[chosen].T),
        candidates=len(moving),
        all_auto_mac=float(np.max(np.triu(everywhere, 1), initial=0.0)),
        dofs=system.n,
        warnings=(Note("", blind, "no sensor there sees them"),) if not seen.all() else (),
        left_out=(Note("", "damping and rotation", "shapes are those at standstill"), "mass of the sensors"),
        method="effective independence, then AutoMAC",
    )


def best_rows(shapes: NDArray[np.float64], count: int) -> NDArray[np.intp]:
    """Numbers of the `count` rows of shapes (n, m) that are kept, ascending."""
    # Modes of all sizes count alike.
    phi = shapes / np.maximum(np.linalg.norm(shapes, axis=0), 1e-300)
    kept = np.arange(len(phi))
    rank = int(np.linalg.matrix_rank(phi))
    while len(kept) > max(count, rank):
        # Of thousands a tenth goes at once: what the least telling of them are hardly depends on each other.
        many = max(1, min(len(kept) // 10, len(kept) - max(_ONE_BY_ONE, count, rank)))
        kept = np.delete(kept, np.argsort(independence(phi[kept]), kind="stable")[:many])
    while len(kept) > count:
        left = [np.delete(kept, k) for k in range(len(kept))]
        kept = min(left, key=lambda rows: float(np.sum(mac(phi[rows].T, phi[rows].T) ** 2)))
    return kept


def independence(shapes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of each row in the rank of shapes (n, m), (n,): the diagonal of the projection on their columns."""
    left, singular, _ = np.linalg.svd(shapes / np.maximum(np.linalg.norm(shapes, axis=0), 1e-300), full_matrices=False)
    return np.asarray(np.sum(left[:, singular > 1e-9 * singular[0]] ** 2, axis=1))
