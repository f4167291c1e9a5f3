"""The torque flow of a train: forces and working flanks of all meshes, and their stiffness at that load.

Forces come from static equilibrium of the train in torsion. A tree is plain statics; in a closed loop (split torque) the split
follows from the torsional stiffness of shafts, couplings and meshes. Torsional springs to ground carry no mean torque here: loads
balance by themselves. Where the file names a stiffness model, the mesh has its stiffness at that mean force; in a loop the two
are iterated until they agree.

The torques that drive and load the train come from the operating point and the loads: they balance in power, where one output
may be left open and takes the rest. In torsion shafts twist by 1/(GJ); meshes, couplings and the webs of elastic gears give
with their own stiffness. The train's free rotation is held at one node of each connected group, which takes no torque where
the loads balance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from rotorgear.errors import AnalysisError, ConvergenceError, Problem
from rotorgear.model.layout.carrier_train import given_ratio
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.mesh_layout import Contact
from rotorgear.model.layout.state import AppliedTorque, MeshForce, State, misalignments_of
from rotorgear.model.layout.train import Train
from rotorgear.model.parts.load import Load
from rotorgear.model.parts.shaft import Place
from rotorgear.model.parts.tables import Tables

if TYPE_CHECKING:
    from rotorgear.model.layout.state import Curves, Faces

# A mesh whose share of the torque is below this relative to the largest one is called unloaded.
UNLOADED = 1e-9
# Stiffness and force of modelled meshes agree when no stiffness changes by more than this; passes that are tried at most.
_AGREED = 1e-9
_PASSES = 60


def torque_flow(layout: Layout, direction: int = 1, faces: Faces | None = None) -> State:
    """Solve for the mean mesh forces of a checked model and decide the working flanks.

    Args:
        layout: of a checked model.
        direction: +1 or -1, sense about +z in which the reference shaft turns; reversed, the other flanks drive.
        faces: of meshes whose shafts are known to tilt: their teeth are misaligned as these say.

    Raises:
        AnalysisError: a stiffness model that can't do its teeth.
        ConvergenceError: in a loop, mesh stiffness and torque split don't come to agree.
    """
    applied = [replace(item, torque=direction * item.torque) for item in applied_torques(layout, direction)[0]]
    # Forces come first from the standard's stiffness: a model may need a load, and in a train without loops they stay.
    first = "iso" if applied else None
    faces = faces or {}
    modelled = [mesh for mesh in layout.meshes if mesh.is_modelled]
    curves: Curves = {
        mesh.name: mesh.helix_stiffness(name=first, misalignments=misalignments_of(faces.get(mesh.name)))
        for mesh in modelled
    }
    lines, squeeze = _solved(layout, applied, curves)
    if curves and applied:
        for _ in range(_PASSES):
            before = curves
            curves = _loaded(layout, lines, squeeze, faces)
            lines, squeeze = _solved(layout, applied, curves)
            if all(
                abs(now.mean / old.mean - 1.0) <= _AGREED
                for name in curves
                for now, old in zip(curves[name], before[name], strict=True)
            ):
                break
        else:
            raise ConvergenceError(
                "The split of the torque and the mesh stiffness that depends on it don't come to agree: "
                "give the stiffness of one mesh of the loop as a number."
            )
    # The mean state of each contact from its signed force.
    train = layout.train
    largest = max((abs(force) for force in squeeze), default=0.0)
    states = []
    for contact, force in zip(lines, squeeze, strict=True):
        mesh = layout.mesh(contact.mesh)
        pinion_sense = mesh.sense(mesh.pinion)
        unloaded = abs(force) <= UNLOADED * largest
        if unloaded:  # the shaft nearer to the input is taken to drive, in its own sense
            drives = train.depth[contact.pinion_place.shaft] <= train.depth[contact.gear_place.shaft]
            sense = direction * (pinion_sense if drives else -pinion_sense)
        else:
            sense = 1 if force > 0 else -1
        carried = 0.0 if unloaded else abs(force)
        states.append(MeshForce(contact, carried, sense, sense == direction * pinion_sense, assumed=unloaded))
    if direction != layout.direction and any(m.part.index_error or m.part.helix_index_error for m in layout.meshes):
        own = torque_flow(layout, layout.direction, faces).forces
        states = [replace(a, turned=a.torque_sense != b.torque_sense) for a, b in zip(states, own, strict=True)]
    rigid = tuple(state for state in states if layout.mesh(state.contact.mesh).is_rigid)
    elastic = tuple(state for state in states if state not in rigid)
    return State(layout, direction, tuple(applied), elastic, curves, faces=faces, rigid=rigid).of_kind("dynamic")


def _solved(layout: Layout, applied: Sequence[AppliedTorque], curves: Curves) -> tuple[list[Contact], list[float]]:
    """Contacts with their stiffness, and the signed normal force of each."""
    lines: list[Contact] = []
    for mesh in layout.meshes:
        for contact in mesh.contacts:
            given = mesh.given_mean
            stiffness = curves[mesh.name][contact.helix].static_normal if given is None else given / mesh.helices
            lines.append(replace(contact, stiffness=stiffness))
    return lines, contact_forces(layout, applied, lines) if applied and lines else [0.0] * len(lines)


def _loaded(layout: Layout, lines: Sequence[Contact], squeeze: Sequence[float], faces: Faces) -> Curves:
    """Stiffness of the modelled meshes at the mean force of a helix; where no torque flows, without one."""
    largest = max(abs(force) for force in squeeze)
    found = {}
    for mesh in layout.meshes:
        if mesh.is_modelled:
            forces = [force for line, force in zip(lines, squeeze, strict=True) if line.mesh == mesh.name]
            mean = sum(forces) / len(forces)
            load = abs(mean) if abs(mean) > UNLOADED * largest else None
            sense = 1 if mean >= 0.0 else -1
            found[mesh.name] = mesh.helix_stiffness(
                load, sense=sense, misalignments=misalignments_of(faces.get(mesh.name))
            )
    return found


def applied_torques(layout: Layout, direction: int | None = None) -> tuple[list[AppliedTorque], list[Problem]]:
    """Return the torques that drive and load the train, balanced in power, and the problems where they can't be.

    Args:
        layout: of the model.
        direction: +1 or -1, sense in which the reference shaft turns; None: that of the operating speed. Torques are those of
            the positive sense, and turn with it; moments from outside stay where they are, and have the sign that this asks for.
    """
    loads, problems = _loads(layout)
    speed = layout.model.operating_speed
    sense = direction or layout.direction
    # Constant moments about z of loads from outside on shafts that turn take part in the balance.
    found = [
        AppliedTorque(load.address, *place, sense * float(load.constant[5]) / len(load.places))
        for load in layout.external_loads
        for place in load.places
        if load.constant[5] and load.in_train
    ]
    open_ends: list[tuple[str, Load, Place]] = []
    for name, load in loads.items():
        place = layout.load_place(load)
        torque = load.torque
        if load.power is not None and speed:
            torque = load.power / abs(speed * layout.train.ratio(load.on_shaft))
        if torque is None:  # an open end, which takes the rest
            open_ends.append((name, load, place))
        else:
            drives = layout.train.sense(load.on_shaft) * (1 if load.kind == "input" else -1)
            found.append(AppliedTorque(name, *place, drives * torque))
    if problems or not (loads or found):
        return found, problems
    return _balanced(layout.train, found, open_ends)


def _loads(layout: Layout) -> tuple[dict[str, Load], list[Problem]]:
    """Merge [operation] and [loads]; loads on shafts that are not driven are problems."""
    model = layout.model
    loads = {f"loads.{name}": load for name, load in model.loads.items() if load.is_torque}
    operation = model.operation
    if operation and (operation.power is not None or operation.torque is not None):
        loads["operation"] = Load(
            shaft=operation.input_shaft, kind="input", torque=operation.torque, power=operation.power
        )
        if operation.output_shaft:
            loads["operation.output_shaft"] = Load(shaft=operation.output_shaft, kind="output")
    wanted = "a shaft that the train drives"
    hint = "no mesh or coupling leads to it from the input shaft"
    problems = [
        Problem(name, f"a load on shaft '{load.shaft}', which stands still", wanted, hint)
        for name, load in loads.items()
        if layout.train.ratios[load.on_shaft] == 0
    ]
    return ({} if problems else loads), problems


# Torques whose powers differ by no more than this share of the largest balance: their digits are rounded.
_ROUNDED = 1e-6


def _balanced(
    train: Train, found: list[AppliedTorque], open_ends: list[tuple[str, Load, Place]]
) -> tuple[list[AppliedTorque], list[Problem]]:
    """Close the balance of power of each connected part of the train with its one open end, or refuse."""
    problems: list[Problem] = []
    shafts = [*(item.shaft for item in found), *(place.shaft for _, _, place in open_ends)]
    for group in sorted({train.group[shaft] for shaft in shafts}):
        given = [item for item in found if train.group[item.shaft] == group]
        ends = [end for end in open_ends if train.group[end[2].shaft] == group]
        if len(train.free_rotations(group)) > 1:
            problems += _balanced_differential(train, group, given, ends, found)
            continue
        excess = sum(item.torque * train.ratio(item.shaft) for item in given)
        scale = max((abs(item.torque * train.ratio(item.shaft)) for item in given), default=0.0)
        if len(ends) > 1:
            names = ", ".join(name for name, _, _ in ends)
            wanted = "at most one of them: it takes the rest"
            problems.append(Problem("loads", f"{names} without torque or power", wanted))
        elif ends:
            name, load, place = ends[0]
            torque = -excess / train.ratio(load.on_shaft)
            sense = train.sense(load.on_shaft) * (1 if load.kind == "input" else -1)
            if torque * sense < 0.0:
                text = f"to balance the other loads this {load.kind} would need {abs(torque):.6g} N m against its sense"
                other = "output" if load.kind == "input" else "input"
                problems.append(Problem(name, "", text, f"change the other torques, or make it an {other}"))
            found.append(AppliedTorque(name, *place, torque))
        elif abs(excess) > _ROUNDED * scale:
            text = f"torques that leave {excess:.6g} N m, taken to the speed of shaft '{train.reference}'"
            hint = "leave the torque of one output out and it takes the rest"
            problems.append(Problem("loads", text, "torques that balance", hint))
        elif excess:
            # What the digits leave is taken by the largest: a train that turns freely has no equilibrium otherwise.
            power = [abs(item.torque * train.ratio(item.shaft)) if item in given else -1.0 for item in found]
            largest = power.index(max(power))
            item = found[largest]
            found[largest] = replace(item, torque=item.torque - excess / train.ratio(item.shaft))
    return found, problems


def _balanced_differential(
    train: Train,
    group: int,
    given: Sequence[AppliedTorque],
    ends: Sequence[tuple[str, Load, Place]],
    found: list[AppliedTorque],
) -> list[Problem]:
    """The same for a part of the train with several free rotations: the torques do no work in any of them."""
    import numpy as np

    rotations = train.free_rotations(group)
    work = np.array([[float(rotation[end[2].shaft]) for end in ends] for rotation in rotations])
    parts = np.array([[item.torque * float(rotation[item.shaft]) for item in given] for rotation in rotations])
    excess = parts.sum(axis=1)
    torques = np.linalg.lstsq(work, -excess)[0] if ends else np.zeros(0)
    sizes = np.abs(parts).sum(axis=1) + np.abs(work) @ np.abs(torques)
    if ends and np.linalg.matrix_rank(work) < len(ends):
        names = ", ".join(name for name, _, _ in ends)
        return [
            Problem(
                "loads", f"{names} without torque or power", f"at most {len(rotations)} of them: they take the rest"
            )
        ]
    if np.any(np.abs(excess + work @ torques) > _ROUNDED * sizes):
        hint = f"{len(rotations)} speeds are given: leave the torque of as many shafts out, and they take the rest"
        return [
            Problem(
                "loads", "torques that leave the members of a differential out of balance", "torques that balance", hint
            )
        ]
    found += [
        AppliedTorque(name, *place, float(torque)) for (name, _, place), torque in zip(ends, torques, strict=True)
    ]
    return []


# Places on a shaft nearer than this to each other (relative, and of a millimetre) are one.
_SAME_PLACE = 1e-9


def _network(model: Tables, places: Sequence[Place]) -> tuple[dict[Place, int], list[tuple[int, int, float]], int]:
    """Number of the node at each place, springs between nodes, and how many nodes: places that a rigid stretch joins are one."""
    from rotorgear.elements.shaft_section import torsional_flexibility

    node: dict[Place, int] = {}
    springs = []
    count = 0
    for shaft in model.shafts:
        before: float | None = None
        for z in sorted({z for name, z in places if name == shaft}):
            give = 0.0 if before is None else torsional_flexibility(*_stretch(model, shaft, before, z))
            if before is None or (give != 0.0 and z - before > _SAME_PLACE * max(1e-3, abs(z))):
                if before is not None:
                    springs.append((count - 1, count, 1.0 / give))
                count += 1
            node[Place(shaft, z)] = count - 1
            before = z
    return node, springs, count


def contact_forces(layout: Layout, applied: Sequence[AppliedTorque], lines: Sequence[Contact]) -> list[float]:
    """Signed normal force of each contact in N: positive where the pinion is turned positively into the gear.

    Args:
        layout: of a checked model.
        applied: torques that balance in each group.
        lines: the contacts.

    Raises:
        AnalysisError: stiffnesses that differ too much to be solved together.
    """
    import numpy as np

    places = [place for line in lines for place in (line.pinion_place, line.gear_place)]
    places += [place for first, second, _ in layout.turning_couplings for place in (first, second)]
    carriers = {line.mesh: pins for line in lines if (pins := layout.carrier_place(line.mesh)) is not None}
    places += carriers.values()
    places += [Place(item.shaft, item.z) for item in applied]
    node, springs, count = _network(layout.model, places)
    springs += [(node[one], node[two], k) for one, two, k in layout.turning_couplings]
    # Teeth that turn against their shaft have a node of their own, which hangs on that of the shaft.
    elastic = {key: count + number for number, key in enumerate(layout.teeth_on_bodies)}
    springs += [(node[key[1]], elastic[key], k) for key, k in layout.teeth_on_bodies.items()]
    count += len(elastic)

    # Each contact is squeezed along its flank normal by r_b cos(beta_b) times the twist of its two nodes: delta = S q.
    squeeze = np.zeros((len(lines), count))
    for row, line in zip(squeeze, lines, strict=True):
        pinion = elastic.get((line.pinion, line.pinion_place), node[line.pinion_place])
        gear = elastic.get((line.gear, line.gear_place), node[line.gear_place])
        for number, lever in zip((pinion, gear), line.levers, strict=True):
            row[number] += lever * np.cos(line.base_helix_angle)
            # Teeth of planets feel rotations against their carrier.
            if line.mesh in carriers:
                row[node[carriers[line.mesh]]] -= lever * np.cos(line.base_helix_angle)
    stiffness = np.array([line.stiffness for line in lines])
    # K = sum of the springs + S^T diag(k) S
    K = np.zeros((count, count))
    for i, j, k in springs:
        K[i, i] += k
        K[j, j] += k
        K[i, j] -= k
        K[j, i] -= k
    K = K + (squeeze.T * stiffness) @ squeeze
    torques = np.zeros(count)
    for item in applied:
        torques[node[Place(item.shaft, item.z)]] += item.torque
    # Shafts that turn together have one rotation that strains nothing: K q = torques is solved with one node of each held.
    first_node = {place.shaft: number for place, number in reversed(node.items())}
    free = np.setdiff1d(np.arange(count), [first_node[shaft] for shaft in _held(layout, list(first_node))])
    twist = np.zeros(count)
    try:
        twist[free] = np.linalg.solve(K[np.ix_(free, free)], torques[free])
    except np.linalg.LinAlgError:
        raise AnalysisError(
            "The torque flow can't be solved: the stiffnesses of meshes, couplings and shafts in torsion differ by more "
            "than numbers can hold. Check the smallest and the largest of them."
        ) from None
    return [float(force) for force in stiffness * (squeeze @ twist)]


def _held(layout: Layout, shafts: Sequence[str]) -> list[str]:
    """Those of some shafts that are held while forces are looked for: one for each free rotation, and those that stand still."""
    train = layout.train
    first: dict[int, str] = {}
    for shaft, group in train.group.items():
        if shaft in shafts and group not in train.rotations:
            first.setdefault(group, shaft)
    found = list(first.values())
    for rotations in train.rotations.values():
        for rotation in rotations:
            others = [other for other in rotations if other is not rotation]
            found += [name for name in shafts if rotation.get(name) and not any(other.get(name) for other in others)][
                :1
            ]
    return found + [
        name for name in shafts if train.group[name] in train.rotations and given_ratio(layout.model, name) == 0
    ]


def _stretch(
    model: Tables, shaft: str, left: float, right: float
) -> tuple[list[float], list[tuple[float, float, float, float]], list[float]]:
    """Lengths, end diameters and shear moduli of the flexible segments of a shaft between two places."""
    lengths = []
    diameters = []
    moduli = []
    z = model.shafts[shaft].start
    for section in model.shafts[shaft].sections:
        low = max(left, z)
        high = min(right, z + section.length)
        if high > low and not section.rigid:
            first, last = (section.diameters_at((end - z) / section.length) for end in (low, high))
            lengths.append(high - low)
            diameters.append((*first, *last))
            moduli.append(model.material_of(shaft, section).g)
        z += section.length
    return lengths, diameters, moduli
