"""What a mesh analysis works on: the teeth of a mesh with chosen settings, their load, and the sense of each helix.

All helices of a mesh over its cycle: positions chosen for their common curves, and what may lie between them.

Helices share the load evenly, and the mesh approaches by their mean.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.common.request import quantity
from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.cycle_positions import SampledCurves
from rotorgear.gears.loaded.helix_cycles import HelixCycles
from rotorgear.gears.loaded.mesh_cycle import MeshCycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.gears.stiffness.cycle_curve import CycleCurve
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.stiffness_models import MODELS, NEEDS_LOAD
from rotorgear.gears.tooth_fe.settings import ToothFe
from rotorgear.model.layout.mesh_layout import MeshLayout, mirrored
from rotorgear.model.layout.torque_flow import applied_torques
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.quantity import did_you_mean
from rotorgear.results.mesh import MeshLoad


@dataclass(frozen=True)
class SolvedHelices:
    """All helices of one request at one load and setting.

    Attributes:
        problem: of the last helix.
        cycles: of each helix, at the positions that are kept.
        curve: transmission error (m), stiffness and tangent stiffness (N/m) of all helices, and largest pressure (Pa).
        no_load: (p,) transmission error without load (m).
        sampling: the first, second and last of these curves, with what may lie between the positions.
    """

    problem: ContactProblem
    cycles: tuple[MeshCycle, ...]
    curve: CycleCurve
    no_load: np.ndarray
    sampling: SampledCurves

    @property
    def error(self) -> np.ndarray:
        """Transmission error (p,) in m."""
        return np.asarray(self.curve.values[:, 0])

    @property
    def stiffness(self) -> np.ndarray:
        """Secant stiffness (p,) in N/m."""
        return np.asarray(self.curve.values[:, 1])


def solve_helices(
    request: MeshRequest,
    teeth: ToothPair,
    positions: int,
    periods: int = 1,
    *,
    base_force: float | None = None,
    judged: bool = False,
    progress: Progress = silent,
) -> SolvedHelices:
    """All helices at one load.

    Args:
        request: the mesh; teeth: of a helix that runs ahead at larger z, with the flanks to be looked at.
        positions: how many are kept of a mesh period.
        periods: mesh periods that are followed.
        base_force: F_bt of one helix (N); that of the request where it is not given.
        judged: whether more positions are solved for the estimate of what lies between those that are kept.
        progress: told how far it is.
    """
    solving = _cycles(request, teeth, request.base_force if base_force is None else base_force, periods, progress)
    found = solving.sample(positions, judged=judged)
    u = found.curve.position
    event = found.curve.event
    if solving.twice:
        u = np.concatenate([u, u + solving.repeats])
        event = np.concatenate([event, event])
    numbers = solving.numbers(u)
    cycles = [one.chosen(numbers) for one in solving.cycles]
    if solving.solved < len(solving.helices):
        cycles = [cycles[0]] * len(solving.helices)
    return SolvedHelices(
        problem=solving.problems[-1],
        cycles=tuple(cycles),
        curve=CycleCurve(u, solving.values(numbers), float(periods), event),
        no_load=np.mean([one.no_load for one in cycles], axis=0),
        sampling=found,
    )


def curves_at(
    request: MeshRequest, teeth: ToothPair, positions: np.ndarray, periods: int, progress: Progress = silent
) -> np.ndarray:
    """Transmission error (m), stiffness (N/m) and largest pressure (Pa) of all helices at some positions: (m, 3)."""
    solving = _cycles(request, teeth, request.base_force, periods, progress)
    solving.twice = False
    return solving.add(positions)


def _cycles(request: MeshRequest, teeth: ToothPair, base_force: float, periods: int, progress: Progress) -> HelixCycles:
    """The helices of a request along the path of contact."""
    helices = [teeth if ahead > 0 else mirrored(teeth) for ahead in request.senses]
    return HelixCycles(helices, base_force, request.mesh.lead_on_path(request.sense), periods, progress)


@dataclass(frozen=True)
class MeshRequest:
    """A mesh of a model, ready to be solved.

    Attributes:
        mesh: what it is; model: its stiffness model, "given" for numbers of the file.
        teeth: one helix with the settings asked for; None for gears without teeth.
        sense: of the torque on the pinion about +z.
        senses: for each helix, +1 where the contact runs ahead at larger z, -1 where it runs behind.
        load: what it carries; None where nothing flows.
    """

    mesh: MeshLayout
    model: str
    teeth: ToothPair | None
    sense: int
    senses: tuple[int, ...]
    load: MeshLoad | None

    @property
    def base_force(self) -> float:
        """F_bt (N) of one helix."""
        return self.load.base_force_n / self.mesh.helices if self.load else 0.0


def mesh_request(
    model: Model, name: str | None, stiffness: str | None, torque: float | str | None, fe: dict[str, object]
) -> MeshRequest:
    """Look up a mesh, its stiffness model and its load.

    Args:
        name: of the mesh; None where the model has only one.
        stiffness: a stiffness model in place of the file's; a number in the file makes it "tooth_fe".
        torque: on the pinion, in N m or a text with its unit, positive about +z, in place of the torque flow's.
        fe: settings of `ToothFe` in place of the file's.

    Raises:
        AnalysisError: no such mesh or model, no teeth, or no load where one is needed.
    """
    names = list(model.meshes)
    if not names:
        raise AnalysisError("The model has no meshes.")
    if name is None and len(names) > 1:
        raise AnalysisError(f"Which mesh? Give --mesh with one of {', '.join(names)}.")
    if name is not None and name not in names:
        hint = did_you_mean(name, names, f"there are {', '.join(names)}.")
        raise AnalysisError(f"There is no mesh '{name}': {hint}")
    mesh = model.layout.mesh(name or names[0])
    if mesh.is_bevel:
        raise AnalysisError(
            f"meshes.{mesh.name}: bevel gears have no teeth here that could be loaded, only a mesh stiffness."
        )
    given = None if mesh.is_rigid else mesh.part.stiffness
    chosen = stiffness or (given if isinstance(given, str) else "tooth_fe")
    known = (*MODELS, "given")
    if chosen not in known:
        hint = did_you_mean(chosen, known, f"there are {', '.join(known)}")
        raise AnalysisError(f"--stiffness: there is no stiffness model '{chosen}': {hint}.")
    if chosen == "given" and mesh.is_rigid:
        raise AnalysisError(f"--stiffness given: meshes.{mesh.name} is rigid and gives no numbers.")
    if chosen == "given" and isinstance(given, str):
        raise AnalysisError(f"--stiffness given: meshes.{mesh.name} names the model '{given}' and gives no numbers.")
    load, sense = _load(model, mesh, torque)
    teeth: ToothPair | None = None
    if chosen != "given":
        wanted = {key: value for key, value in fe.items() if value is not None}
        working = mesh.working_teeth(sense)
        settings: ToothFe = replace(working.fe, **wanted)  # type: ignore[arg-type]
        teeth = replace(working, fe=settings)
    if load is None and chosen in NEEDS_LOAD:
        raise AnalysisError(
            f"meshes.{mesh.name} carries no torque, and the stiffness of loaded teeth needs one: give --torque, or power or "
            "loads in the model."
        )
    return MeshRequest(mesh, chosen, teeth, sense, mesh.helix_senses(sense), load)


def _load(model: Model, mesh: MeshLayout, given: float | str | None) -> tuple[MeshLoad | None, int]:
    """Load and sense of the torque on the pinion."""
    lever = mesh.pinion.base_radius
    cosine = math.cos(mesh.pinion.base_helix_angle)
    if given is not None:
        torque = quantity(given, "torque", "--torque")
        if torque == 0.0 or not math.isfinite(torque):
            raise AnalysisError(f"--torque: got {torque:g} N m, expected one that is not zero")
        force = abs(torque) / lever
        return MeshLoad(torque, force, force / cosine, "given"), 1 if torque > 0.0 else -1
    if not applied_torques(model.layout)[0]:
        return None, 1
    forces = model.torque_flow().of_mesh(mesh.name)
    normal = sum(force.normal_force for force in forces)
    sense = forces[0].torque_sense
    if not normal:
        return None, sense
    base = normal * cosine
    return MeshLoad(sense * base * lever, base, normal, "mean torque flow of the model"), sense
