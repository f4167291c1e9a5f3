"""What a transient says beside its numbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.analysis.common.casings import time_warnings
from rotorgear.analysis.common.left_out import GIVE_DAMPING, left_out
from rotorgear.analysis.common.mesh_notes import map_errors, unlike_teeth_left_out
from rotorgear.analysis.static.mean_state import mean_torsion_notes
from rotorgear.analysis.transient.channels import rigid_channels
from rotorgear.analysis.transient.request import STARTS, Grid, Task, history_bytes
from rotorgear.analysis.transient.statistics import halves_differ
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import DOF_NAMES, in_words
from rotorgear.model.parts.mesh import Mesh
from rotorgear.note import Note, as_notes
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.transient import TransientResult
from rotorgear.solvers.time.contact_equilibrium import unbalanced
from rotorgear.system.internal_loads import read_loads
from rotorgear.system.local import LocalModel
from rotorgear.system.rigid_forces import on_shafts

# Numerical share of the energy above which a run is warned about.
ENERGY_BOUND = 0.05
_UNSETTLED = 0.1
# Share of the prescribed speed by which a gear may be off at the end.
_DRIFT = 0.01


def left_out_in_time(local: LocalModel, speed: float, *, contacts_only: bool = False) -> tuple[Note, ...]:
    """What a motion over time at a speed of the reference in rad/s leaves out of its model; `contacts_only` as in `left_out`."""
    system = local.system
    told = left_out(system, "time", speed, contacts_only=contacts_only)
    return (*told, *transient_left_out(local), *mean_torsion_notes(system, speed))


def damped_at_nodes(model: Model) -> tuple[Note, ...]:
    """The loads inside shafts of a model whose modes have a damping ratio."""
    if not model.damping.modal_ratio:
        return ()
    why = "it acts at the nodes, as forces from outside"
    what = "what damping of modes does between two nodes"
    return tuple(Note(f"points.{name}", what, why) for name in read_loads(model))


def damped_in_bearings(model: Model) -> tuple[Note, ...]:
    """The forces in rigid directions of bearings of such a model."""
    rigid = [name for name, bearing in model.bearings.items() if bearing.rigid_directions and model.damping.modal_ratio]
    what = "what damping of modes does beside its rigid directions"
    return tuple(Note(f"bearings.{name}", what, "its force is that of all else") for name in rigid)


def transient_left_out(local: LocalModel) -> tuple[Note, ...]:
    """What motions over time do not take of the teeth: by the laws of the meshes, and by what the file does not give."""
    system = local.system
    law_of = {part.part: part.law for part in reversed(local.parts) if part.is_mesh}
    notes = [Note(part, text) for part, law in law_of.items() for text in law.left_out()]
    for name, mesh in system.model.meshes.items():
        address = f"meshes.{name}"
        if address not in law_of:  # rigid teeth have no law
            continue
        law = law_of[address]
        if mesh.backlash is None:
            what, then = (
                ("coast flanks", "nothing stops teeth that part") if law.can_part else ("contact loss", "no teeth part")
            )
            notes.append(Note(address, what, f"no backlash is given, so {then}"))
        if mesh.rubs:
            notes.append(Note(address, "what friction takes of the torques", "they balance as without it"))
        whole = system.layout.mesh(name).part
        given = whole.transmission_error or whole.stiffness_variation or whole.corner_impact
        if not given and all(part.law.steady for part in local.parts if part.is_mesh and part.part == address):
            notes.append(Note(address, "excitation", "neither transmission error nor stiffness variation is given"))
        curve = system.state.curves[name][0] if name in system.state.curves else None
        if curve and law.known_up_to == np.inf:
            if not np.ptp(curve.transverse):
                notes.append(Note(address, f"ripple of the stiffness, which '{curve.model}' does not know"))
            elif curve.load:
                why = f"'{curve.model}' gives the stiffness over the cycle at this load, and no transmission error without one"
                notes.append(Note(address, "what changes with the load", why, f"F_bt = {curve.load:.4g} N"))
        if name in system.state.faces:
            notes += _along_face(address, mesh, follows=law.components == 2)
    told = rigid_channels(local).values()
    for channel in (f"bearings.{name} force {DOF_NAMES[k]}" for name, k in on_shafts(system) if k < 3):
        if channel not in told:
            notes.append(Note(channel, "", "gyroscopic terms take part in it, which are those of a constant speed"))
    for state in system.state.forces:
        along = law_of[f"meshes.{state.contact.mesh}"].components == 2
        of_teeth = system.state.face_map(state) if along else system.state.contact_map(state)
        notes += map_errors([(state.contact.mesh, of_teeth)])
    return as_notes([*notes, *unlike_teeth_left_out(system)])


def intact(result: TransientResult, local: LocalModel) -> Iterator[Note]:
    """The backlash of each mesh whose teeth never part in a run: it plays no part then."""
    losses = zip((part.part for part in local.parts if part.is_mesh), result.contact_losses, strict=True)
    parted = {part for part, count in losses if count}
    for name, mesh in local.system.model.meshes.items():
        if mesh.backlash is not None and f"meshes.{name}" not in parted:
            yield Note(f"meshes.{name}.backlash", "", "no teeth part in this run", in_words(mesh, "backlash"))


def _along_face(address: str, mesh: Mesh, *, follows: bool) -> Iterator[Note]:
    """What of the tilt of a mesh stays as in the static equilibrium; `follows`: whether its law knows the tilt."""
    as_in_statics = "the teeth are misaligned as in the static equilibrium"
    if not follows:
        why = f"{as_in_statics}, and resist a tilt by the tangent about it, even where they part"
        yield Note(address, "how the load moves along the face in time", why)
    elif mesh.damping or mesh.damping_ratio:
        why = "it is that of the mean state, also where teeth part"
        yield Note(address, "how the damping against a tilt changes with what carries", why)
    if mesh.backlash is not None:
        yield Note(address, "how the tilt of the coast flanks changes in time", as_in_statics)


def adrift(task: Task) -> Iterator[Note]:
    """Whether the loads do not balance on a free motion, on average over what pulses, and what friction has to do with it."""
    rest = task.rest
    what = "the loads do not balance on a free motion"
    why = "it is carried along and drifts with constant acceleration"
    rubbing = [name for name, mesh in task.local.system.model.meshes.items() if mesh.rubs]
    if rubbing and unbalanced(task.local.local, rest.free, rest.force):
        takes = f"friction in {', '.join(rubbing)} takes power that the torques do not give"
        remedy = "with speed_power in a load the shafts settle where they balance, and sweep keeps their speed"
        yield Note("", what, f"{why}; {takes}: {remedy}")
    elif unbalanced(task.local.local, rest.free):
        yield Note("", what, why)


def transient_warnings(result: TransientResult, task: Task, *, estimated: bool, keeps_energy: bool) -> Iterator[str]:
    """Yield what the reader should know before using the numbers."""
    local = task.local
    yield from local.system.nodes.merged
    if result.status != "success":
        yield Note("", f"the run ended early at t = {result.time[-1]:.6g} s", result.status)
        if result.time[-1] <= result.settle:
            what = f"it ended before the {result.settle:.6g} s that are discarded"
            yield Note("", what, "there are no statistics, only histories")
    outer = ~np.any(local.local.forces.reference_stiffness, axis=1)
    if task.start == STARTS[0] and np.any(task.rest.force[outer] != task.rest_force[outer]):
        what = "the run starts from the deflection under the unbalances and harmonic forces of t = 0"
        yield Note("", what, "--start mean begins with that under the mean forces, and these set in at once")
    if not task.rest.converged and task.start != STARTS[-1]:
        why = "the run starts from that with linear contacts and has to settle"
        yield Note("", f"no static equilibrium was found; {why}")
    drift = list(adrift(task))
    yield from drift
    damped = np.any(local.local.forces.reference_damping) or local.system.model.nonlinear_elements
    if any(note.startswith("damping matrix") for note in result.left_out) and not damped:
        why = (
            f"what the start sets swinging never dies out; {GIVE_DAMPING}, or --modal-damping with --method exponential"
        )
        yield Note("", "nothing damps", why)
    if estimated and result.status == "success" and not np.isfinite(result.error_estimate):
        why = "a run of another step, or with more modes, did not end well"
        yield Note("", "there is no error estimate", why)
    if not keeps_energy and result.contact_losses.any():
        what = f"teeth part, and '{result.method}' may gain energy where they meet again"
        yield Note("", what, "take newmark or exponential, which keep it")
    if result.energy.share > ENERGY_BOUND:
        lost = f"the integration added or removed {100.0 * result.energy.share:.2g} % of the energy"
        yield Note("", "energy error", f"{lost}; take a smaller step or record more often")
    held = _held(result.model)
    fastest = float(np.abs(result.speed).max(initial=0.0))
    if not local.local.rotation.is_constant and held:
        rpm = f"{fastest * RPM_PER_RAD_S:.6g} rpm"
        yield Note("", f"{held} are held at their values for the largest speed, {rpm}, over the whole run-up")
    yield from time_warnings(local.system.model, local.local.forces.laws, fastest)
    yield from _beyond_maps(result, local)
    if not drift:
        yield from _off_speed(result, local)
    # Both halves of what counts.
    force = result.mesh_force[result.counted]
    if len(force) >= 16 and force.any() and np.ptp(result.speed) == 0.0:
        change, what = halves_differ(result)
        if change > _UNSETTLED:
            differ = f"the two halves of the time that counts differ by {100.0 * change:.2g} %"
            yield Note("", what, f"{differ}: not settled, or not periodic; settle longer or run longer")


def thinned(task: Task, grid: Grid) -> Iterator[Note]:
    """Which records the histories of a long run leave out."""
    if grid.kept > 1:
        what = f"{grid.kept - 1} of {grid.kept} records of the histories"
        whole = f"all of them would take {1e-9 * history_bytes(task, grid.records):.3g} GB"
        reach = f"statistics count every step, but spectra end at {0.5 / (grid.spacing * grid.kept):.4g} Hz"
        yield Note("", what, f"{whole}; {reach}; more by --records, or less time")


def _held(model: Model) -> str:
    """What depends on speed beside the gyroscopic terms, in words; "" where nothing does."""
    parts = {
        "the tables of the bearings": [name for name, bearing in model.bearings.items() if bearing.table],
        "the internal damping of": [name for name, shaft in model.shafts.items() if shaft.internal_damping],
        "the centrifugal terms of": [name for name, gear in model.gears.items() if gear.body.mesh is not None],
    }
    return " and ".join(f"{what} {', '.join(names)}" for what, names in parts.items() if names)


def _beyond_maps(result: TransientResult, local: LocalModel) -> Iterator[Note]:
    """Where teeth part that nothing stops, and forces above those that the laws were made for."""
    meshes = [part for part in local.parts if part.is_mesh]
    for part, losses, force in zip(meshes, result.contact_losses, result.mesh_force.T, strict=True):
        mesh = local.system.layout.mesh(part.part.removeprefix("meshes.")).part
        if losses and mesh.backlash is None and part.law.can_part:
            why = "no backlash is given, so nothing stops them behind; give `backlash`"
            yield Note(part.label, f"the teeth part, but {why}")
        if force.max() > part.law.known_up_to:
            known = f"its loaded teeth were solved up to {part.law.known_up_to:.4g} N"
            why = f"{known}, above which their map goes on along its tangent"
            yield Note(part.label, f"the force reaches {force.max():.4g} N", why)


def _off_speed(result: TransientResult, local: LocalModel) -> Iterator[Note]:
    """Compare the speed of each gear at the end with the prescribed one, where the loads balance at the start."""
    train = result.model.layout.train
    shares = {"": 0.0}
    for gear, part in result.model.gears.items():
        history = f"gears.{gear} speed fluctuation"
        prescribed = abs(float(train.ratio(part.shaft)) * result.speed[-1])
        if history in result.channel and prescribed:
            values = result.history(history)
            shares[gear] = abs(float(values[-max(len(values) // 10, 1) :].mean())) / prescribed
    worst = max(shares, key=lambda gear: shares[gear])
    if shares[worst] > _DRIFT:
        changing = [part.part for part in local.parts if part.law.unsettled()]
        why = f"; with {', '.join(changing)}, which change in time, the loads need not balance" if changing else ""
        off = f"{100.0 * shares[worst]:.2g} % off its prescribed speed, to which mesh phases and gyroscopic terms keep"
        yield Note("", f"at the end {worst} turns {off}{why}")
