"""The verb behind `rotorgear mesh-map`: one mesh over torque and misalignment."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.clock import Clock
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.teeth.mesh import POSITIONS, require_positions
from rotorgear.analysis.teeth.operating_points import mesh_figures, one_kind_of_model, operating_axes, operating_values
from rotorgear.analysis.teeth.request import mesh_request
from rotorgear.gears.loaded.tooth_contact import contact_problem
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.mesh_map import MeshMap


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
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a mesh, load or setting that can't be; torques of both senses.
        ConvergenceError: contact that does not come to rest.
        MissingExtraError: scikit-fem is not installed.
    """
    require_positions(positions)
    clock = Clock()
    torques = operating_values(over, "torque")
    asked = float(torques[0]) if torque is None and torques is not None and len(torques) else torque
    request = mesh_request(model, mesh, "tooth_fe", asked, {"preset": preset, "body": body})
    assert request.teeth is not None
    load, misalignment = operating_axes(over, request)
    teeth = one_kind_of_model(request.teeth, misalignment)
    problem = contact_problem(teeth, part_of(progress, 0.0, 0.3))
    points = [(i, j) for i in range(len(load)) for j in range(len(misalignment))]
    figures = []
    for number, (i, j) in enumerate(points):
        told = part_of(progress, 0.3 + 0.7 * number / len(points), 0.3 + 0.7 * (number + 1) / len(points))
        askew = replace(teeth, misalignment=float(misalignment[j]))
        figures.append(mesh_figures(request, askew, float(load[i]), positions, told))
    clock.lap("teeth and contact")
    shape = (len(load), len(misalignment))
    notes = dict.fromkeys(note for point in figures for note in point.warnings)
    return MeshMap(
        title=model.title,
        mesh=request.name,
        pinion=request.mesh.pinion.name,
        gear=request.mesh.gear.name,
        preset=teeth.fe.preset,
        body=problem.body,
        helices=request.helices,
        positions=positions,
        pinion_torque=load,
        misalignment=misalignment,
        ste_peak_to_peak=np.reshape([point.ste_peak_to_peak for point in figures], shape),
        ste_harmonics=np.reshape([point.ste_harmonics for point in figures], (*shape, -1)),
        largest_pressure=np.reshape([point.largest_pressure for point in figures], shape),
        face_load_factor=np.reshape([point.face_load_factor for point in figures], shape),
        mean_stiffness=np.reshape([point.mean_stiffness for point in figures], shape),
        dofs=problem.unknowns,
        seconds=clock.total(),
        left_out=_left_out(teeth.first_flank.single_teeth or teeth.second_flank.single_teeth),
        warnings=tuple(notes),
    )


def _left_out(single: tuple[int, ...]) -> tuple[str, ...]:
    said = ["error estimates: `rotorgear mesh` gives them for one point"]
    if single:
        said.append("errors of single teeth beyond the first mesh period: `rotorgear mesh` follows them all")
    return tuple(said)
