"""The mean state that linear responses and motions in time are about: flanks and mean forces from statics.

Torsional springs between turning shafts and the ground represent machines that turn with the train, and whose torque is among
the loads: a mean torque in them would be there twice. So they act on vibration only, about the mean twist. Statics leaves them
out (`without_torsion_to_ground`); responses are about that state; in time they get the load f = K_g q_mean, with which they carry
nothing at the mean displacements. Where the loads do not balance by themselves there is no such state: the springs then hold
the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.common.mesh_notes import unlike_teeth_left_out
from rotorgear.analysis.common.request import direction_of
from rotorgear.analysis.static.about_equilibrium import along_faces
from rotorgear.analysis.static.cycle import over_cycle
from rotorgear.analysis.static.joint_state import JointState
from rotorgear.analysis.static.solve import Equilibrated, equilibrate, is_loaded, without_torsion_to_ground
from rotorgear.analysis.static.state_at import state_at
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.system.assembly import assemble
from rotorgear.system.contacts import ContactLines, contact_lines
from rotorgear.system.local import LocalModel
from rotorgear.system.system import System, flow_system


@dataclass(frozen=True)
class Setup:
    """A system about its mean state, with its contacts, and their mean forces.

    `joint` is the state of the loaded teeth over their cycles, None without such teeth; `notes` say what is left
    out.
    """

    system: System
    lines: ContactLines
    mean_force: np.ndarray
    notes: tuple[Note, ...]
    joint: JointState | None = None

    def with_tangents(self, state: State) -> State:
        """The mean state for small motions about it, with the tangents of laws of another state."""
        of = self.system.state.of_kind("dynamic")
        return replace(of, tangents=state.tangents, operating=state.operating, notes=state.notes)


def about_mean(model: Model, speeds: Sequence[float | None], at: float) -> tuple[State, Setup]:
    """What a linear response is about: the state about the equilibria at some speeds, and the mean state at one of them.

    Modes for the mesh are about the first one. The response is about the second, with the tangents of the first over speed:
    `with_tangents` puts the two together.

    Args:
        model: a checked model.
        speeds: of the reference shaft in rad/s, as of `state_at`.
        at: speed of the mean state in rad/s.

    Raises:
        AnalysisError: there is no equilibrium, or some contact is open in it.
    """
    return state_at(model, speeds), mean_state(flow_system(model, direction=direction_of(at), kind="static"), at)


def mean_state(system: System, speed: float) -> Setup:
    """Flanks and mean forces from statics; without loads, the flanks are assumed and the mean forces are zero.

    Raises:
        AnalysisError: some contact is open under the mean loads, so that there is no linear response about it.
    """
    found = along_faces(system.model, [speed], system.state)
    if found is not system.state:
        system = system.with_state(found.of_kind(system.state.kind))
    if not system.state.forces or not is_loaded(system):
        lines = contact_lines(system)
        meshes = system.model.meshes.items()
        notes = tuple(
            Note(f"meshes.{name}", "stiffness variation", "no torque, so no mean force that it acts on")
            for name, m in meshes
            if m.stiffness_variation or not isinstance(m.stiffness, int | float)
        )
        return Setup(system, lines, np.zeros(len(lines.states)), notes)
    equilibrium, joint = over_cycle(equilibrate(system, speed), speed)
    if not equilibrium.closed.all():
        name = equilibrium.lines.names[int(np.flatnonzero(~equilibrium.closed)[0])]
        raise AnalysisError(
            f"meshes.{name} carries nothing under the mean loads, so there is no linear response about them; give more torque or "
            "a smaller index error"
        )
    settled = equilibrium.system.with_state(equilibrium.system.state.with_forces(equilibrium.force))
    notes = about_mean_twist(equilibrium.notes)
    if joint is not None and len(joint.cycles) > 1:
        names = "; ".join(", ".join(cycle.meshes) for cycle in joint.cycles)
        why = "each is taken for itself, with the loaded teeth of the others on the mean of their curves"
        notes = (*notes, Note("", f"what the cycles of meshes {names} do to each other", why))
    notes = (*notes, *unlike_teeth_left_out(settled))
    return Setup(settled, contact_lines(settled), equilibrium.force, notes, joint)


def springs_about_mean(found: LocalModel, speed: float) -> LocalModel:
    """A model for integration in time whose torsional springs to ground act about the mean twist of its train.

    Args:
        found: with these springs unstrained where the structure is.
        speed: of the reference shaft in rad/s.
    """
    system = found.system
    rest = _mean(system, speed)
    if rest is None:
        return found
    groups = system.groups_at(speed)
    cut, _ = without_torsion_to_ground(system, groups)
    whole = assemble(groups, system.dofs, lambda group: group.matrices.stiffness)
    without = assemble(cut, system.dofs, lambda group: group.matrices.stiffness)
    load = found.local.load + np.asarray((whole - without) @ rest.q)
    return replace(found, local=replace(found.local, load=load))


def mean_torsion_notes(system: System, speed: float) -> tuple[Note, ...]:
    """What the torsional springs to ground do not carry, where there is a mean twist that they act about."""
    rest = _mean(system, speed)
    return () if rest is None else about_mean_twist(rest.notes)


def about_mean_twist(notes: tuple[Note, ...]) -> tuple[Note, ...]:
    """What statics says it leaves out of springs to ground, as responses and motions in time do."""
    why = "the loads hold it, and the stiffness acts about the mean twist"
    return tuple(Note(note.part, "mean torque in the torsional stiffness to ground", why) for note in notes)


def _mean(system: System, speed: float) -> Equilibrated | None:
    """The mean state without the torsional springs to ground; None where there are none, or they have to hold the loads."""
    if not system.state.applied or not without_torsion_to_ground(system, system.groups_at(speed))[1]:
        return None
    try:
        return equilibrate(system.with_state(system.state.of_kind("static")), speed)
    except AnalysisError:
        return None
