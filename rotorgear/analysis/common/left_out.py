"""What a model file holds and an analysis does not take, part by part, with the reason and the size.

Keys that a whole kind of analysis never takes stand in one table (`_NOT_TAKEN`); what depends on the state or on other keys of
the part follows it. What an analysis leaves out by its own method it says itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np

from rotorgear.analysis.common.gear_bodies import body_notes
from rotorgear.analysis.common.planet_notes import planet_notes
from rotorgear.analysis.common.rings import ring_notes
from rotorgear.model.layout.external_loads import ExternalLoad
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import in_words
from rotorgear.model.parts.load import COMPONENTS
from rotorgear.model.parts.supports import element_law
from rotorgear.note import Note
from rotorgear.system.planets import turning_carriers
from rotorgear.system.system import System

# "modes" are modal, campbell and critical; "frf" is state space too; "time" are transients, sweeps and orbits.
Analysis = Literal["modes", "frf", "static", "response", "time"]

_LINEAR = "modes frf response"
_ALL = f"{_LINEAR} static time"
_FREE = "free vibrations have no excitation"
_UNIT = "a frequency response is that to unit forces"
_SMALL = "vibrations are small, and teeth that carry go on doing so"
_IN_TIME = "only motions over time take it"
_DAMPS = "deflections at rest have no damping"
_SHEET = "only the gear sheet takes it"
_UNDAMPED = "the analysis is undamped (a --speed, even of 0, takes damping in)"
# Where damping is given, which a warning says that misses it.
GIVE_DAMPING = "give bearings or meshes a damping, or modal_ratio under [damping]"
_FLANKS = "only stiffness = 'tooth_fe' looks at the shape of the flanks"
# Table, keys, analyses that do not take them, and why. Nothing behind a table is the whole part.
_NOT_TAKEN = (
    ("meshes", "backlash regularisation_depth", _LINEAR, _SMALL),
    ("meshes", "backlash regularisation_depth", "static", "statics looks at the flanks that the loads press together"),
    ("meshes", "transmission_error corner_impact", "modes", _FREE),
    ("meshes", "transmission_error corner_impact", "frf", _UNIT),
    (
        "meshes",
        "transmission_error corner_impact",
        "static",
        "statics takes the mean over the mesh cycle, which is zero",
    ),
    ("meshes", "stiffness_variation", "modes frf static", "the mean stiffness over the mesh cycle is taken"),
    ("meshes", "friction_coefficient lubricant_viscosity", f"{_LINEAR} static", _IN_TIME),
    ("meshes", "damping damping_ratio", "static", _DAMPS),
    ("meshes", "damping damping_ratio", "undamped", _UNDAMPED),
    ("meshes", "application_factor centre_distance_allowance", _ALL, _SHEET),
    ("gears", "accuracy_grade ball_diameter upper_thickness_allowance lower_thickness_allowance", _ALL, _SHEET),
    ("gears", "body.damping_ratio", "static", _DAMPS),
    ("gears", "body.damping_ratio", "undamped", _UNDAMPED),
    ("unbalances", "", "modes", _FREE),
    ("unbalances", "", "frf", _UNIT),
    ("unbalances", "", "static", "what turns with its shaft has no constant part"),
    ("loads", "ripple", "modes", _FREE),
    ("loads", "ripple", "frf", _UNIT),
    ("loads", "ripple", "static", "statics takes the mean"),
    ("loads", "speed_power step_to", f"{_LINEAR} static", _IN_TIME),
    *(
        (table, keys, analyses, why)
        for analyses, why in (("static", _DAMPS), ("undamped", _UNDAMPED))
        for table, keys in (
            ("damping", "rayleigh_alpha rayleigh_beta modal_ratio"),
            ("bearings", "damping pedestal.damping"),
            ("supports", "damping"),
            ("couplings", "damping"),
            ("nonlinear_elements", "damping"),
            ("casings", "damping_ratio"),
        )
    ),
    ("points", "quantity", "modes", "free vibrations have no size of their own that a load could have"),
    ("scatter", "", _ALL, "only rotorgear scatter takes it"),
)
# What only loaded teeth see of a gear.
_OF_FLANKS = (
    "tip_relief",
    "flank.root_relief",
    "flank.crowning",
    "flank.profile_crowning",
    "flank.profile_slope",
    "flank.end_relief",
    "flank.helix_slope",
    "flank.bias",
    "flank.topography",
    "flank.pitch_errors",
)
# The motion that each component of a load works on.
_MOTION = ("bending", "bending", "axial", "bending", "bending", "torsion")


def left_out(
    system: System,
    analysis: Analysis,
    speed: float | None,
    *,
    undamped: bool = False,
    modal_damping: float = 0.0,
    contacts_only: bool = False,
) -> tuple[Note, ...]:
    """What of its model an analysis at a speed in rad/s leaves out; None of the speed is an undamped one at standstill.

    `modal_damping`: ratio that the analysis adds to the modes. `contacts_only`: of the motions, the result tells those of the
    contacts.
    """
    model = system.model
    undamped = undamped or speed is None
    kinds = {analysis, "undamped"} if undamped and analysis == "modes" else {analysis}
    absent = list(_without_motion(system))
    # Statics crosses the backlash where the flanks behind carry.
    crossed = {
        f"meshes.{force.contact.mesh}.backlash"
        for force in system.state.forces
        if force.behind and analysis == "static"
    }
    notes = (
        *_dofs(system),
        *_matrices(system, analysis, speed, undamped=undamped, modal_damping=modal_damping),
        *absent,
        *(
            note
            for row in _NOT_TAKEN
            if kinds & set(row[2].split())
            for note in _given(model, row)
            if note.part not in crossed
        ),
        *_flanks(model, analysis),
        *_beside_laws(model, analysis),
        *_operating_point(system, analysis, speed),
        *(_bearing_loads(system) if contacts_only else ()),
        *(note for load in system.layout.external_loads for note in _of_load(system, load, analysis)),
        *_beta(system, analysis, speed),
        *(mesh_stiffness(system) if analysis in ("modes", "frf") else ()),
        *body_notes(system),
        *(ring_notes(system) if analysis in ("modes", "frf", "response") else ()),
        *(planet_notes(system, speed) if analysis in ("modes", "frf", "response") else ()),
        *system.state.notes,
    )
    # Of a part that is not there as a whole, nothing else need be said.
    whole = {note.part for note in absent}
    return tuple(n for n in notes if n in absent or not any(f"{n.part}.".startswith(f"{part}.") for part in whole))


def _without_motion(system: System) -> Iterator[Note]:
    """Parts that act only on motions that the model does not have."""
    model = system.model
    moves = np.array([model.has(motion) for motion in _MOTION])
    if moves.all():
        return
    why = "it acts only on motions that the model does not have"
    for address, spring in system.state.springs.items():
        table, _, name = address.partition(".")
        part = getattr(model, table)[name]
        pushes = np.any(spring.stiffness, axis=0) | np.any(spring.damping, axis=0)
        pushes[list(getattr(part, "rigid_directions", ()))] = True
        if not pushes[moves].any() and not getattr(part, "fixed", ()) and (pushes.any() or table == "bearings"):
            yield Note(address, "", why)
    if not model.has("bending"):
        for name, unbalance in model.unbalances.items():
            yield Note(f"unbalances.{name}", "", why, in_words(unbalance, "magnitude"))
    gravity = model.operation.gravity if model.operation else None
    own = [np.array(gravity) @ shaft.frame.axes for shaft in model.shafts.values()] if gravity and any(gravity) else []
    if own and not (np.abs(own)[:, moves[:3]] > 1e-12 * np.abs(own).max()).any():
        yield Note("operation.gravity", "", why)


def _given(model: Model, row: tuple[str, str, str, str]) -> Iterator[Note]:
    """A fact for each key of a row that the file gives another value than the default."""
    table, keys, _, why = row
    parts = getattr(model, table)
    for name, part in parts.items() if isinstance(parts, dict) else [("", parts)]:
        address = f"{table}.{name}" if name else table
        if not keys:
            yield Note(address, "", why, in_words(part, "magnitude") if table == "unbalances" else "")
        for key in keys.split():
            if value := given_value(part, key):
                yield Note(f"{address}.{key}", "", why, value)


def given_value(part: Any, key: str) -> str:
    """The value of a key, or of one in a table of the part, in words; "" of one that has its default."""
    *owners, last = key.split(".")
    for owner in owners:
        part = getattr(part, owner)
        if part is None:
            return ""
    default = type(part).model_fields[last].get_default(call_default_factory=True)
    return in_words(part, last) if getattr(part, last) != default else ""


def _dofs(system: System) -> Iterator[Note]:
    """What was not built: motions that the model does not have, and dofs that are held."""
    held = system.dofs.held
    absent = [motion for motion in ("bending", "axial", "torsion") if not system.model.has(motion)]
    if absent:
        yield Note("", " and ".join(absent), "not among the motions of the model", f"{held['motions']} dofs")
    for how, count in (
        ("held fixed by supports", held["supports"]),
        ("tied by rigid sections", held["rigid sections"]),
        ("taken away by rigid meshes, couplings and bearings", held.get("rigid members", 0)),
    ):
        if count:
            yield Note("", f"{count} dofs {how}")


def _matrices(
    system: System, analysis: Analysis, speed: float | None, *, undamped: bool, modal_damping: float
) -> Iterator[Note]:
    """Gyroscopic terms, and what damps beyond the keys of the file."""
    if analysis == "static":
        for name, shaft in system.model.shafts.items():
            if shaft.internal_damping and not (speed and system.model.has("bending")):
                yield Note(f"shafts.{name}.internal_damping", "", _DAMPS, in_words(shaft, "internal_damping"))
        gravity = system.model.operation.gravity if system.model.operation else None
        if not (gravity and any(gravity)):
            yield Note("", "weight", "no gravity given under [operation]")
        for name in system.model.casings if gravity and any(gravity) else ():
            if np.any(np.isnan(system.layout.casing(name).inertia_force[:, :3])):
                yield Note(f"casings.{name}", "weight", "the file of the casing does not give it")
        return
    if not system.gyroscopic.nnz:
        yield Note("", "gyroscopic matrix", "nothing that turns can tilt")
    elif not speed and not _says_speed(system, analysis, speed):
        yield Note("", "gyroscopic matrix", "standstill")
    if undamped:
        # What damps inside of a turning shaft acts on the equilibrium too.
        what = "damping of vibration" if is_about_equilibrium(system) else ""
        for name, shaft in system.model.shafts.items():
            if shaft.internal_damping:
                yield Note(f"shafts.{name}.internal_damping", what, _UNDAMPED, in_words(shaft, "internal_damping"))
        for address, spring in system.state.springs.items():
            if address in system.state.tangents and np.any(spring.damping):
                yield Note(address, "damping of the law", _UNDAMPED)
        return
    if not np.any(system.damping(speed or 0.0).data) and not (modal_damping or system.model.damping.modal_ratio):
        # The law of a nonlinear element is in no matrix until it is linearised: a film damps all the same.
        laws = [
            f"nonlinear_elements.{name}"
            for name, element in system.model.nonlinear_elements.items()
            if not element.is_given
            and f"nonlinear_elements.{name}" not in system.state.tangents
            and element_law(element, 1.0).uses_velocity
        ]
        # The modes are told of it here alone; whoever warns of it says there what to give.
        remedy = f"; {GIVE_DAMPING}" if analysis == "modes" else ""
        why = f"empty; only {', '.join(laws)} can damp" if laws else f"nothing damps{remedy}"
        yield Note("", "damping matrix", why)


def _flanks(model: Model, analysis: Analysis) -> Iterator[Note]:
    """The shape of flanks, where no mesh of a gear has loaded teeth, and misalignments that nothing feels."""
    loaded = {gear for m in model.meshes.values() if m.stiffness == "tooth_fe" for gear in (m.pinion, m.gear)}
    for name, gear in model.gears.items():
        for key in _OF_FLANKS if name not in loaded else ():
            if value := given_value(gear, key):
                yield Note(f"gears.{name}.{key}", "", _FLANKS, value)
    for name, mesh in model.meshes.items():
        if mesh.misalignment and mesh.stiffness != "tooth_fe" and not mesh.tilt:
            why = "only teeth with tilt = true or stiffness = 'tooth_fe' feel it"
            yield Note(f"meshes.{name}.misalignment", "", why, in_words(mesh, "misalignment"))
        if mesh.stiffness == "tooth_fe" and not mesh.tilt and analysis != "static":  # statics knows how large it is
            yield Note(f"meshes.{name}", "tilt along the face", "set tilt = true")


def _beside_laws(model: Model, analysis: Analysis) -> Iterator[Note]:
    """Which of two descriptions of a part counts, for the two need not agree."""
    for name, bearing in model.bearings.items():
        if bearing.rolling is not None and bearing.stiffness is not None:
            if analysis == "time":
                why = "the rolling elements carry; statics and linear analyses take the stiffness"
                yield Note(f"bearings.{name}.stiffness", "", why, in_words(bearing, "stiffness"))
            else:
                why = "the stiffness carries; transients and sweeps take the rolling elements"
                yield Note(f"bearings.{name}.rolling", "", why)
    for name, element in model.nonlinear_elements.items():
        if element.is_given:
            taken = analysis in ("static", "time")
            key = "stiffness" if element.stiffness is not None else "table"
            address = f"nonlinear_elements.{name}"
            if taken:
                yield Note(f"{address}.{key}", "", "the law acts; linear analyses take what is given beside it")
            else:
                yield Note(f"{address}.parameters", "", f"the {key} given beside the law is taken")


def _operating_point(system: System, analysis: Analysis, speed: float | None) -> Iterator[Note]:
    """The speed, the torques and what else is constant, where nothing of an analysis depends on them."""
    model = system.model
    operation = model.operation
    if analysis == "time":
        return
    about = is_about_equilibrium(system)
    if operation is not None and _says_speed(system, analysis, speed):
        why = "nothing here depends on the speed but the flanks that work"
        if analysis != "static" and not speed:
            why = "gyroscopic matrix: standstill" if system.gyroscopic.nnz else "the shafts stand still"
        yield Note("operation.speed", "", why, in_words(operation, "speed"))
    if analysis == "static":
        return
    if about:
        # Loaded teeth know their force, and not where the shafts are.
        yield from _bearing_loads(system)
        return
    if analysis != "response" or _is_determinate(system):
        why = "vibration about the mean state does not depend on it"
        if operation is not None and operation.gravity and any(operation.gravity):
            yield Note("operation.gravity", "", why, in_words(operation, "gravity"))
        for name, mesh in model.meshes.items():
            for key in ("index_error", "helix_index_error"):
                if value := given_value(mesh, key):
                    yield Note(f"meshes.{name}.{key}", "", why, value)
        for name, gap in system.layout.clocking_gaps.items():
            yield Note(f"meshes.{name}", "gap that the clockings leave", why, f"{1e6 * abs(gap):.3g} um")
        for load in system.layout.external_loads if analysis == "response" else ():
            if load.constant_on_structure.any():
                yield Note(load.address, "", why, _size(load))
    if analysis == "response" or _load_matters(system):
        return
    only = "of the mean load only its sense matters here, which chooses the flanks that work"
    for key in ("power", "torque"):
        if operation is not None and getattr(operation, key) is not None:
            yield Note(f"operation.{key}", "", only, in_words(operation, key))
        for name, torque in model.loads.items():
            if torque.kind is not None and getattr(torque, key) is not None:
                yield Note(f"loads.{name}.{key}", "", only, in_words(torque, key))


def _bearing_loads(system: System) -> Iterator[Note]:
    """Constant loads that move the shafts, where the contacts do not feel that: their forces follow from the torques."""
    model = system.model
    laws = model.nonlinear_elements or any(bearing.has_law for bearing in model.bearings.values())
    if laws or not _is_determinate(system) or any(mesh.tilt for mesh in model.meshes.values()):
        return
    why = "bearings carry it, and the contacts do not feel where the shafts are"
    if model.operation is not None and model.operation.gravity and any(model.operation.gravity):
        yield Note("operation.gravity", "", why, in_words(model.operation, "gravity"))
    for load in system.layout.external_loads:
        if load.constant.any() and not load.constant[5] and not load.amplitude.any() and load.history is None:
            yield Note(load.address, "", why, _size(load))


def _is_determinate(system: System) -> bool:
    """Whether the torques alone give the forces of all contacts."""
    return not system.layout.assembly.loops and len(system.state.forces) + len(system.state.rigid) == len(
        system.model.meshes
    )


def _says_speed(system: System, analysis: Analysis, speed: float | None) -> bool:
    """Whether the file gives a speed that the numbers of an analysis do not depend on."""
    operation = system.model.operation
    return bool(analysis != "time" and operation and operation.speed and not _turns(system, analysis, speed))


def _turns(system: System, analysis: Analysis, speed: float | None) -> bool:
    """Whether the numbers of an analysis depend on the speed of the model."""
    model = system.model
    # What damps inside of a bending shaft turns with it.
    damped = model.has("bending") and any(shaft.internal_damping for shaft in model.shafts.values())
    # A film carries by its speed; rolling elements do so whatever their speed is.
    laws = any(bearing.has_film and not bearing.is_linear for bearing in model.bearings.values()) or any(
        (analysis == "static" or not element.is_given) and element_law(element, 1.0).uses_velocity
        for element in model.nonlinear_elements.values()
    )
    given = (model.operation, *model.loads.values())
    powered = any(part is not None and part.power for part in given)  # a torque is a power over the speed
    about = is_about_equilibrium(system)
    if laws or (powered and (analysis == "static" or about or _load_matters(system))):
        return True
    tables = any(bearing.table for bearing in model.bearings.values())
    if about and analysis == "modes":  # at the operating speed, where modes are those at standstill
        return tables or damped or bool(speed and system.gyroscopic.nnz)
    if analysis != "response" and not speed:
        return False
    if turning_carriers(system.layout):
        return True
    if analysis == "static":
        return tables or damped or bool(system.layout.elastic_bodies)
    return analysis == "response" or tables or damped or bool(system.gyroscopic.nnz)


def _load_matters(system: System) -> bool:
    """Whether the stiffness of a mesh depends on its load."""
    for name, helices in system.state.curves.items():
        force = system.state.of_mesh(name)[0].normal_force
        others = system.layout.mesh(name).helix_stiffness(1.01 * force or None)
        if any(one.mean != other.mean for one, other in zip(helices, others, strict=True)):
            return True
    return False


def is_about_equilibrium(system: System) -> bool:
    """Whether a linear analysis depends on the mean load beyond the flanks that work: laws, faces or loaded teeth.

    A face of constant stiffness that presses all over is linear, and the same about any such state.
    """
    state = system.state
    linear = all(
        face.peak_pressure is None and face.line_load.min() > 0.0 for faces in state.faces.values() for face in faces
    )
    return bool(state.tangents or state.cycle or not linear)


def _of_load(system: System, load: ExternalLoad, analysis: Analysis) -> Iterator[Note]:
    """What an analysis does not take of a force or moment."""
    size = _size(load)
    given = (load.constant != 0.0) | (load.amplitude != 0.0)
    if load.history is not None:
        columns = np.eye(6)[[COMPONENTS.index(name) for name in load.history.components]]
        given |= (np.abs(load.frame.own(columns)) > 1e-12).any(axis=0)
    lost = [name for k, name in enumerate(COMPONENTS) if given[k] and not system.model.has(_MOTION[k])]
    if lost:
        words = ", ".join(lost).replace("_", " ")
        yield Note(load.address, words, "whose motion is not among those of the model", size)
    if analysis in ("modes", "frf"):
        acts = is_about_equilibrium(system) and not load.amplitude.any()
        if load.history is not None or not acts:
            what = "what varies of the history" if acts else ""
            yield Note(load.address, what, _FREE if analysis == "modes" else _UNIT, size)
    elif analysis == "static" and load.amplitude.any():
        yield Note(load.address, "", "a harmonic load has no constant part", size)
    elif analysis == "static" and load.history is not None:
        taken = "the mean over a turn acts" if load.history.over == "angle" else "the values at time 0 act"
        yield Note(load.address, "what varies of the history", taken, size)
    elif analysis == "response" and load.history is not None and load.history.over == "time":
        yield Note(load.address, "history over time", "only the values at time 0 act, on the mean state", size)


def _size(load: ExternalLoad) -> str:
    whole = load.constant + load.amplitude
    if load.history is not None:
        values = np.array(load.history.values)
        return f"{values.min():.4g} to {values.max():.4g}" if values.size else ""
    force, moment = (float(np.linalg.norm(part)) for part in (whole[:3], whole[3:]))
    return ", ".join(f"{x:.4g} {unit}" for x, unit in ((force, "N"), (moment, "N m")) if x)


def _beta(system: System, analysis: Analysis, speed: float | None) -> Iterator[Note]:
    """On which stiffness the damping beta K of the model does not act, where there is such."""
    if analysis == "static" or speed is None or not system.model.damping.rayleigh_beta:
        return
    if system.circulatory(speed).nnz:
        what = "beta K of circulatory and cross-coupled stiffness"
        yield Note("damping.rayleigh_beta", what, "rayleigh_beta acts on the symmetric part of K")
    if analysis == "time":
        laws = [f"nonlinear_elements.{name}" for name in system.model.nonlinear_elements]
        laws += [f"bearings.{name}" for name, bearing in system.model.bearings.items() if bearing.has_law]
        for part in laws:
            why = "rayleigh_beta acts on the tangent in linear analyses; in time the law says what damps"
            yield Note(part, "beta K", why)


def mesh_stiffness(system: System) -> Iterator[Note]:
    """What the mean stiffness over the mesh cycle leaves out of each mesh whose stiffness is a model's or a list."""
    for name, mesh in system.model.meshes.items():
        address = f"meshes.{name}"
        if isinstance(mesh.stiffness, tuple):
            mean = sum(mesh.stiffness) / len(mesh.stiffness)
            share = (max(mesh.stiffness) - min(mesh.stiffness)) / mean
            value = f"{100.0 * share:.3g} % of {mean:.4g} N/m"
            yield Note(address, "ripple of the given stiffness", "the mean is taken", value)
        elif curve := system.state.whole_curve(name):
            about = curve.about_load
            forces = system.state.of_mesh(name)
            taken = sum(force.contact.stiffness for force in forces)
            share = float(np.ptp(about.transverse)) / about.mean
            helices = "" if about.helices == 1 else " of both helices"
            if about.model == "tooth_fe" and all(force.start is not None for force in forces):
                value = f"{100.0 * share:.3g} % of {taken:.4g} N/m{helices}"
                yield Note(address, "ripple of loaded teeth", "the mean tangent is taken", value)
                continue
            load = "without a load" if not about.load else f"at F_bt = {about.load:.4g} N"
            value = f"{100.0 * share:.3g} % of " if share else ""
            value += f"{taken:.4g} N/m, {about.definition}, {load}{helices}"
            what = f"ripple of '{about.model}'" if share else f"ripple, which '{about.model}' does not know"
            yield Note(address, what, f"the mean stiffness of '{about.model}' along the flank normal is taken", value)
