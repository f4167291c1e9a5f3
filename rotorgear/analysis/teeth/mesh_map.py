"""The verb behind `rotorgear mesh-map`: one mesh over torque and misalignment.

What a mesh does at one torque and misalignment, in a few figures: what maps and optimisations ask for again and again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from rotorgear.analysis.common.pool import Pool, in_pieces
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import quantity
from rotorgear.analysis.common.stream import Piece, Stream, pieces, unkept
from rotorgear.analysis.teeth.mesh import POSITIONS, require_positions
from rotorgear.analysis.teeth.request import MeshRequest, mesh_request, solve_helices
from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.face import load_per_width
from rotorgear.gears.loaded.tooth_contact import contact_problem
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.model.model import Model, model_hash
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.mesh_map import MeshMap
from rotorgear.solvers.sparse.factor import single_thread

ORDERS = 3
# What operating points differ in, with the dimension of its values.
AXES = {"torque": "torque", "misalignment": "length"}
# Places along the face at which the load per width is compared with its mean.
_PLACES = 32
# More points than these are taken for a typing error.
_MOST_POINTS = 10_000


@dataclass(frozen=True)
class MeshFigures:
    """What a mesh does at all torques (t,) and misalignments (m,).

    Attributes:
        ste_peak_to_peak: (t, m) of the transmission error (m), mean of the helices.
        ste_harmonics: (t, m, 3) amplitudes of its first mesh orders (m).
        largest_pressure: (t, m) of both helices (Pa).
        face_load_factor: (t, m) K_Hbeta, largest load per width over the mean one, mean of the mesh cycle; the larger of both
            helices.
        mean_stiffness: (t, m) transverse, of all helices (N/m).
        warnings: sentences.
    """

    ste_peak_to_peak: np.ndarray
    ste_harmonics: np.ndarray
    largest_pressure: np.ndarray
    face_load_factor: np.ndarray
    mean_stiffness: np.ndarray
    warnings: tuple[str, ...]


def figures_at(
    request: MeshRequest,
    teeth: ToothPair,
    torque: np.ndarray,
    misalignment: np.ndarray,
    positions: int,
    progress: Progress = silent,
    piece: Piece = unkept,
    executor: Pool | None = None,
) -> MeshFigures:
    """Solve one mesh period at each of some operating points, torque by torque.

    Args:
        request: the mesh, whose flanks are those of the sense of its load.
        teeth: of one helix, with the flanks to be looked at.
        torque: (t,) on the pinion (N m), of the same sense as that of the request.
        misalignment: (m,) over the face (m).
        positions: in the mesh period.
        progress: told how far it is.
        piece: does the work of a point, or takes it over. executor: does the points in place of this process.
    """
    points = list(product(torque.tolist(), misalignment.tolist()))
    parts = [part_of(progress, number / len(points), (number + 1) / len(points)) for number in range(len(points))]
    # What is told of a point stays in the process that shows it.
    tasks = [
        (request, teeth, load, f, positions, silent if executor else told)
        for (load, f), told in zip(points, parts, strict=True)
    ]
    rows = []
    for told, row in zip(parts, in_pieces(_figures_at_point, tasks, piece, executor), strict=True):
        rows.append(row)
        told(1.0, "contact")
    size = (len(torque), len(misalignment))
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0] if name != "warnings"}
    figures = {name: column.reshape(*size, *column.shape[1:]) for name, column in columns.items()}
    return MeshFigures(**figures, warnings=tuple(dict.fromkeys(note for row in rows for note in row["warnings"])))


def _figures_at_point(
    request: MeshRequest, teeth: ToothPair, torque: float, misalignment: float, positions: int, progress: Progress
) -> dict[str, Any]:
    """The values of `MeshFigures` at one torque (N m) and misalignment (m)."""
    base_force = abs(torque) / request.mesh.pinion.base_radius / request.mesh.helices
    misaligned = replace(teeth, misalignment=misalignment)
    solved = solve_helices(request, misaligned, positions, base_force=base_force, progress=progress)
    normal_force = base_force / float(np.cos(teeth.pair.base_helix_angle))
    places = min(_PLACES, solved.problem.slices)
    largest = [load_per_width(cycle, teeth.width, places)[1].max() for cycle in solved.cycles]
    curve = solved.curve
    return {
        "ste_peak_to_peak": np.ptp(solved.error),
        "ste_harmonics": np.abs(curve.harmonics(ORDERS)[:, 0]),
        "largest_pressure": curve.values[:, 3].max(),
        "face_load_factor": max(largest) * teeth.width / normal_force,
        "mean_stiffness": curve.mean()[1],
        "warnings": (*solved.problem.warnings, *(note for cycle in solved.cycles for note in cycle.warnings)),
    }


def operating_values(given: Mapping[str, object], name: str) -> np.ndarray | None:
    """Values (n,) of an axis in SI from numbers or texts with units; None where it is not given.

    Raises:
        AnalysisError: no values, or some that are none.
    """
    if name not in given:
        return None
    values = given[name]
    listed = values if isinstance(values, list | tuple | np.ndarray) else [values]
    found = np.array([quantity(value, AXES[name], f"over {name}") for value in listed], float)
    if not len(found) or not np.isfinite(found).all():
        raise AnalysisError(f"over {name}: got {values!r}, expected at least one finite value")
    return found


def operating_points(
    model: Model,
    mesh: str | None,
    over: Mapping[str, object],
    torque: float | str | None,
    fe: dict[str, object],
) -> tuple[MeshRequest, ToothPair, np.ndarray, np.ndarray]:
    """The mesh, its teeth, torques (t,) in N m and misalignments (m,) in m, rising; what is not given is that of the model.

    The teeth have one finite-element model for all misalignments: a map must have no seam where one of them is zero.

    Raises:
        AnalysisError: another axis, torques of both senses or of none, too many points, or no torque at all.
    """
    for name in over:
        if name not in AXES:
            raise AnalysisError(f"over: there is no '{name}'; a mesh is looked at over {' and '.join(AXES)}.")
    torques = operating_values(over, "torque")
    request = mesh_request(
        model, mesh, "tooth_fe", float(torques[0]) if torque is None and torques is not None else torque, fe
    )
    teeth = request.teeth
    assert teeth is not None
    if torques is None:
        if request.load is None:
            raise AnalysisError(f"meshes.{request.mesh.name} carries no torque: give over torque, or --torque.")
        torques = np.array([request.load.pinion_torque_n_m])
    if not ((torques > 0.0).all() or (torques < 0.0).all()):
        raise AnalysisError(
            "over torque: the torques must have one sense, and none of them be zero: the other flanks differ."
        )
    misalignment = operating_values(over, "misalignment")
    if misalignment is None:
        misalignment = np.array([teeth.misalignment])
    if len(torques) * len(misalignment) > _MOST_POINTS:
        raise AnalysisError(f"over: {len(torques)} x {len(misalignment)} points are more than {_MOST_POINTS}.")
    if np.any(misalignment) and teeth.fe.preset != "preview" and teeth.fe.space is None:
        teeth = replace(teeth, fe=replace(teeth.fe, space=True))
    return request, teeth, np.unique(torques), np.unique(misalignment)


@recorded
def mesh_map(
    model: Model,
    mesh: str | None = None,
    *,
    over: Mapping[str, object],
    torque: float | str | None = None,
    preset: str | None = None,
    body: str | None = None,
    positions: int = POSITIONS,
    executor: Pool | None = None,
    stream: Stream | None = None,
    progress: Progress = silent,
) -> MeshMap:
    """Solve the loaded contact of a mesh over its cycle at each torque and misalignment.

    Args:
        model: a checked model.
        mesh: as in `mesh`.
        over: "torque" on the pinion and "misalignment" over the face: a list of values each, in N m and m or as texts with
            units. What is not given is that of the model.
        torque: as in `mesh`.
        preset: as in `mesh`.
        body: as in `mesh`.
        positions: as in `mesh`.
        executor: solves the points in place of this process: `rotorgear.cluster(address)`, or any object with `submit`.
        stream: keeps points while the map is made (`rotorgear.stream`), and starts an interrupted one again.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a mesh, load or setting that can't be; torques of both senses.
        ConvergenceError: the contact does not converge.
        MissingExtraError: scikit-fem is not installed.
    """
    require_positions(positions)
    clock = Clock()
    request, teeth, load, misalignment = operating_points(model, mesh, over, torque, {"preset": preset, "body": body})
    run = f"{request.mesh.name} {load.tolist()} {misalignment.tolist()} {positions} {preset} {body}"
    piece = pieces(stream, {"model": model_hash(model), "run": run})
    problem = contact_problem(teeth, part_of(progress, 0.0, 0.3))
    with single_thread(0):  # as workers have it: the result is the same to the last bit
        told = part_of(progress, 0.3, 1.0)
        figures = figures_at(request, teeth, load, misalignment, positions, told, piece, executor)
    clock.lap("teeth and contact")
    missing = ["error estimates: `rotorgear mesh` gives them for one point"]
    if teeth.first_flank.single_teeth or teeth.second_flank.single_teeth:
        missing.append("errors of single teeth beyond the first mesh period: `rotorgear mesh` follows them all")
    return MeshMap(
        title=model.title,
        mesh=request.mesh.name,
        pinion=request.mesh.pinion.name,
        gear=request.mesh.gear.name,
        preset=teeth.fe.preset,
        body=problem.body,
        helices=request.mesh.helices,
        positions=positions,
        pinion_torque=load,
        misalignment=misalignment,
        dofs=problem.unknowns,
        seconds=clock.total(),
        left_out=tuple(missing),
        **vars(figures),
    )
