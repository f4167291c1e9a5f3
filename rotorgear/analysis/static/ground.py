"""Torsional springs between turning shafts and the ground: what turns does not wind them up.

They stand for machines that turn with the train, and whose torque is among the loads: a mean torque in them would be there twice.
So they act on vibration only, about the mean twist. Statics leaves them out (`without_torsion_to_ground`); responses are about
that state; in time they get the load f = K_g q_mean, with which they carry nothing at the mean displacements.

Where the loads do not balance by themselves there is no such state: the springs then hold the rest.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.analysis.static.solve import Equilibrated, equilibrate, without_torsion_to_ground
from rotorgear.errors import AnalysisError
from rotorgear.note import Note
from rotorgear.system.assembly import assemble
from rotorgear.system.local import LocalModel
from rotorgear.system.system import System


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
