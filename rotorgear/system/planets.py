"""Planets on a carrier that turns: what linear analyses with constant coefficients have beside the matrices of a carrier at rest.

The planets of a carrier, N >= 3, equal and equally spaced, go round with its speed W. Displacements p_i of planet i are told in
its own axes: outwards, onwards, along z. Over the sisters they are p(psi_i), and

    p(psi) = a_0 + a_c cos psi + a_s sin psi + (further classes)

Taken at the fixed directions psi_i of the pins at the start, while the pins go on, the numbers p(psi_i) are coordinates in the
fixed frame (multi-blade coordinates of helicopter rotors, Coleman): shafts in bearings have constant coefficients beside them.
Their rate seen from rest is p' + W D p, with the quarter turn S of the displacements of a node in its plane and T = -d/d psi
among the sisters, of the first class alone; the further classes stay with the carrier:

    D = S - T,    T_ij = 2/N sin(psi_i - psi_j)

    M p'' + (C + 2 W M D + W_s G) p' + (K + K_g + W^2 M D D + W W_s G D + W C S - W C_rel T) p = f

W_s is the spin of the planet about its own axis; C_rel is the damping of pins and meshes, whose strains go round, and turns with
T alone; that of the planet's material is in its own axes (`elements/shaft.py`). The steady centrifugal load f = m W^2 (r + d)
of each pin, with its give d, turns with the carrier. Of each pin K_g = f r (1 - e e') acts on the rotation vector of the
carrier, e being the direction of the arm. Without it the free rotation of the train would grow, since W^2 M D D on the planets
alone pulls it on.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rotorgear.elements.matrices import ElementMatrices
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.carriers import PlanetSet
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.carrier import MARK, Carrier, written_name
from rotorgear.solvers.time.sisters import sister_turn
from rotorgear.system.dofs import DofMap
from rotorgear.system.groups import ElementGroup, node_dofs
from rotorgear.system.nodes import Nodes

# Number of a sister behind the name of its part, and the address that it ends.
_NUMBER = re.compile(rf"{MARK}\d+")
_SISTER = re.compile(rf".*?{MARK}\d+")
# Quarter turn about z of a displacement and a rotation: x goes to y, y to -x.
_TURN = np.zeros((6, 6))
_TURN[[1, 4], [0, 3]] = 1.0
_TURN[[0, 3], [1, 4]] = -1.0
# Strains of K_g: the rotation of the carrier's node.
_ROTATION = np.eye(6)[None, 3:]
# Sisters whose matrices differ by more than this are not equal: rounding of their directions leaves less.
_ALIKE = 1e-9
# Shafts this near (m) to the axis of a carrier are on it.
_ON_AXIS = 1e-9
# Share of the stiffest below which a planet is not held at all.
_SINGULAR = 1e-13


def turning_carriers(layout: Layout) -> tuple[PlanetSet, ...]:
    """The planets whose carriers turn where the reference shaft does."""
    return tuple(planets for planets in layout.planets if layout.train.ratios[planets.shaft] != 0)


def require_constant(layout: Layout) -> None:
    """Refuse planets whose matrices change as they go round.

    Raises:
        AnalysisError: two planets, unequal spacing, or one that differs from its sisters, on a carrier that turns; or damping
            of the model against axes that stand still.
    """
    for planets in turning_carriers(layout):
        _refuse_dampers_of_all(layout)
        if not planets.part.is_regular:
            count = len(planets.planets)
            what = {1: "one planet", 2: "two planets"}.get(count, "planets at unequal angles")
            raise AnalysisError(
                f"carriers.{planets.carrier}: coefficients of {what} on a carrier that turns change with its angle, which is not "
                "built here. Take three or more planets, equally spaced, or hold the carrier: speed_ratio = 0 of "
                f"shafts.{planets.shaft}."
            )


def _refuse_dampers_of_all(layout: Layout) -> None:
    damping = layout.model.damping
    if damping.rayleigh_alpha or damping.rayleigh_beta:
        raise AnalysisError(
            "damping.rayleigh_alpha and rayleigh_beta damp against axes that stand still, which planets on a carrier that "
            "turns leave: give damping_ratio at the meshes, damping at the bearings or damping.modal_ratio"
        )


class NotSeenFromCarrierError(AnalysisError):
    """Coefficients change even in axes that turn with a carrier; `why` says of which part."""

    def __init__(self, message: str, why: str) -> None:
        super().__init__(message)
        self.why = why


def seen_from_carrier(layout: Layout, groups: Iterable[ElementGroup]) -> list[ElementGroup]:
    """What a carrier that turns adds to some groups where everything is told in axes that turn with it, D = S for all and T = 0.

    Planets may be two, have unequal meshes, or stand at unequal angles there. Their pulls are equal and balance: others would
    move the carrier off its axis and stress the meshes, and both would count in K_g.

    Raises:
        NotSeenFromCarrierError: several carriers turn, pulls that do not balance, a shaft beside the axis of the carrier, or a
            part with preferred directions at rest.
    """
    turning = turning_carriers(layout)
    if not turning:
        return []
    first = turning[0]
    ratio = layout.train.ratio(first.shaft)
    frame = layout.model.shafts[first.shaft].frame
    _refuse_dampers_of_all(layout)
    if len({planets.shaft for planets in turning}) > 1:
        others = ", ".join(dict.fromkeys(f"carriers.{planets.carrier}" for planets in turning))
        raise _changing(layout, first, f"{others} turn, and no axes turn with all of them")
    for planets in turning:
        if np.abs(_directions(planets).sum(axis=0)).max() > _ALIKE * len(planets.planets):
            raise _changing(layout, first, "the pulls of its planets do not balance")
    every = list(groups)
    for _, alike in sisters(layout, every):
        for other in alike[1:]:
            differs = _difference(alike[0], other)
            if differs and not other.part.startswith("meshes."):
                raise _changing(layout, first, f"the {differs} of {other.part} is not that of {alike[0].part}")
    found = []
    for group in every:
        carried = MARK in group.part
        own = layout.model.shafts[group.shaft].frame if group.shaft in layout.model.shafts else None
        m = group.matrices
        S = quarter_turn(group)
        d = len(S)
        if not carried:
            terms = (m.mass, m.stiffness, m.damping, m.circulatory, m.circulatory_per_speed)
            ahead = own is not None and np.allclose(own.axes[:, 2], frame.axes[:, 2], atol=_ALIKE)
            across = None if own is None else (own.origin - frame.origin) @ frame.axes[:, :2]
            straight = ahead and across is not None and float(np.abs(across).max()) < _ON_AXIS
            if not straight or any(A is not None and not _equal(A @ S, S @ A) for A in terms):
                why = "has preferred directions at rest" if straight else "is not on its axis"
                raise _changing(layout, first, f"{group.part} {why}")
        identity = np.broadcast_to(np.eye(d), (len(group.dofs), d, d))

        def seen(matrices: ElementMatrices, group: ElementGroup = group) -> ElementGroup:
            part = f"carriers.{first.carrier}"
            return ElementGroup(part, first.shaft, matrices, group.dofs, ratio, body_motions=group.dof_motions[6:])

        if m.mass is not None:
            square = m.mass @ S @ S
            if m.gyroscopic is not None:
                square = square + group.spin / ratio * (m.gyroscopic @ S)
            found.append(
                seen(
                    ElementMatrices(
                        strain=identity,
                        modulus=np.zeros(square.shape),
                        gyroscopic=_skew(2.0 * m.mass @ S),
                        modulus_per_square=0.5 * (square + np.swapaxes(square, 1, 2)),
                    )
                )
            )
        if carried and m.circulation_per_speed is not None:
            found.append(seen(ElementMatrices(strain=m.strain, circulation_per_speed=-m.circulation_per_speed)))
        elif not carried and m.damping is not None:
            found.append(seen(ElementMatrices(strain=identity, circulation_per_speed=m.damping @ S)))
    return found


def require_alike_around(layout: Layout, nodes: Nodes, acting: Iterable[tuple[str, np.ndarray]]) -> None:
    """Refuse what acts across the axis of a carrier from axes at rest, in a system that is told as seen from it.

    Args:
        layout, nodes: of the system. acting: addresses and columns (a, k) among all dofs of loads and laws.

    Raises:
        NotSeenFromCarrierError: naming the first that does.
    """
    first = turning_carriers(layout)[0]
    if layout.model.damping.modal_ratio:
        raise _changing(layout, first, "damping.modal_ratio damps against axes at rest")
    central = np.array([MARK not in shaft for shaft in nodes.shaft], dtype=bool)
    for part, columns in acting:
        of_nodes = np.abs(columns[: 6 * len(nodes)]).reshape(len(nodes), 6, -1)[central]
        if np.any(of_nodes[:, [0, 1, 3, 4]] > _ALIKE * max(float(np.abs(columns).max(initial=0.0)), 1e-300)):
            raise _changing(layout, first, f"{part} acts across its axis from axes at rest")


def _changing(layout: Layout, planets: PlanetSet, why: str) -> NotSeenFromCarrierError:
    """That coefficients change as a carrier turns, even in axes that turn with it."""
    return NotSeenFromCarrierError(
        f"carriers.{planets.carrier}: coefficients of planets that are two, differ or stand at unequal angles change with the "
        f"angle of a carrier that turns; seen from it they would not, but {why}. Take three or more equal ones, equally spaced, "
        f"or hold the carrier: speed_ratio = 0 of shafts.{planets.shaft}.",
        why,
    )


def sister_places(layout: Layout, names: Iterable[str]) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """Where planets that go round stand in a list: sets as `sisters_of` takes them, with one row of places (1, N) each.

    Args:
        layout: of the model.
        names: of the items; each begins with the address of its part, such as "bearings.pin#2 force x".
    """
    found: dict[str, list[int]] = {}
    carriers: dict[str, Carrier] = {}
    for number, name in enumerate(names):
        if address := _SISTER.match(name):
            written = _NUMBER.sub("", name)
            found.setdefault(written, []).append(number)
            carriers[written] = layout.model.carriers[_carrier_of(layout, address[0])]
    return [
        (layout.train.ratio(carrier.shaft), np.array(carrier.directions), np.array([found[written]]))
        for written, carrier in carriers.items()
        # What single sisters have is rounding of what none of them has, as of the strain of pins in torsion alone.
        if layout.train.ratios[carrier.shaft] != 0 and len(found[written]) == len(carrier.directions)
    ]


def planet_groups(layout: Layout, groups: Iterable[ElementGroup]) -> list[ElementGroup]:
    """What carriers that turn add to some groups of planets, of all sisters together, as groups with the carrier's spin.

    Raises:
        AnalysisError: see `require_constant`.
    """
    if not turning_carriers(layout):
        return []
    require_constant(layout)
    found = []
    for carrier, alike in sisters(layout, groups):
        if layout.train.ratios[layout.model.carriers[carrier].shaft] != 0:
            found += list(_carried(layout, carrier, alike))
    return found


def sisters(layout: Layout, groups: Iterable[ElementGroup]) -> Iterator[tuple[str, list[ElementGroup]]]:
    """The carrier and the groups of one part of all planets, one for each."""
    found: dict[tuple[str, int], list[ElementGroup]] = {}
    seen: dict[str, int] = {}
    for group in groups:
        if MARK in group.part:
            number = seen[group.part] = seen.get(group.part, -1) + 1
            found.setdefault((written_name(group.part), number), []).append(group)
    for alike in found.values():
        yield _carrier_of(layout, alike[0].part), alike


def _carrier_of(layout: Layout, address: str) -> str:
    """Name of the carrier that a part with sisters goes round with."""
    table, _, name = address.partition(".")
    model = layout.model
    if table == "meshes":
        shafts = [gear.shaft for gear in layout.mesh(name).gears]
    elif table == "couplings":
        shafts = [model.couplings[name].from_shaft]
    elif table == "points":
        shafts = [layout.place(address).shaft]
    else:
        shafts = [name if table == "shafts" else getattr(model, table)[name].shaft]
    return next(carrier for shaft in shafts if (carrier := model.shafts[shaft].carrier) is not None)


def _carried(layout: Layout, carrier: str, alike: list[ElementGroup]) -> Iterator[ElementGroup]:
    """The terms of one part of all planets."""
    part = layout.model.carriers[carrier]
    T = sister_turn(np.array(part.directions))
    ratio = layout.train.ratio(part.shaft)
    first = alike[0].matrices
    for other in alike[1:]:
        if differs := _difference(alike[0], other):
            raise AnalysisError(
                f"{other.part}: its {differs} differs from that of {alike[0].part}, and planets that differ have coefficients "
                "that change with the angle of their carrier, which is not built here. Make them equal, or hold the carrier: "
                f"speed_ratio = 0 of shafts.{part.shaft}."
            )
    dofs = np.hstack([group.dofs for group in alike])
    motions = tuple(motion for group in alike for motion in group.dof_motions)[6:]

    def of_all(matrices: ElementMatrices) -> ElementGroup:
        return ElementGroup(f"carriers.{carrier}", part.shaft, matrices, dofs, ratio, body_motions=motions)

    if first.mass is not None:
        D = np.kron(np.eye(len(T)), quarter_turn(alike[0])) - np.kron(T, np.eye(alike[0].dofs.shape[1]))
        M = _repeated(first.mass, len(T))
        square = M @ D @ D
        if first.gyroscopic is not None:
            square = square + alike[0].spin / ratio * (_repeated(first.gyroscopic, len(T)) @ D)
        identity = np.broadcast_to(np.eye(D.shape[0]), square.shape)
        yield of_all(
            ElementMatrices(
                strain=identity,
                modulus=np.zeros(square.shape),
                gyroscopic=_skew(2.0 * M @ D),
                modulus_per_square=0.5 * (square + np.swapaxes(square, 1, 2)),
            )
        )
    if first.viscosity is not None:
        blocks = [group.matrices.strain for group in alike]
        strain = np.stack(
            [_block_diagonal([block[e] for block in blocks if block is not None]) for e in range(len(dofs))]
        )
        Z = -np.stack([np.kron(T, V) for V in first.viscosity])
        if first.circulation_per_speed is not None:
            Z = Z - _repeated(first.circulation_per_speed, len(T))
        yield of_all(ElementMatrices(strain=strain, circulation_per_speed=Z))


def _difference(first: ElementGroup, other: ElementGroup) -> str:
    """In what the elements of two sisters differ, or ""."""
    for name, word in (("mass", "mass"), ("modulus", "stiffness"), ("viscosity", "damping")):
        mine = getattr(first.matrices, name)
        its = getattr(other.matrices, name)
        if (mine is None) != (its is None) or (mine is not None and not _equal(mine, its)):
            return word
    return ""


def _equal(mine: np.ndarray, its: np.ndarray) -> bool:
    """Whether matrices are equal up to rounding."""
    return mine.shape == its.shape and bool(
        np.abs(mine - its).max(initial=0.0) <= _ALIKE * np.abs(mine).max(initial=0.0)
    )


def _skew(A: np.ndarray) -> np.ndarray:
    return np.asarray(0.5 * (A - np.swapaxes(A, 1, 2)))


def _repeated(A: np.ndarray, count: int) -> np.ndarray:
    """Block diagonal (e, N d, N d) of N equal blocks (e, d, d)."""
    return np.stack([np.kron(np.eye(count), one) for one in A])


def _block_diagonal(blocks: list[np.ndarray]) -> np.ndarray:
    from scipy.linalg import block_diag

    return np.asarray(block_diag(*blocks))


def quarter_turn(group: ElementGroup) -> np.ndarray:
    """S (d, d) of the dofs of an element: of its nodes, and of bubbles, which are those in xz, in yz, along z and about z."""
    d = group.dofs.shape[1]
    motions = group.dof_motions
    S = np.zeros((d, d))
    nodal = next((k for k in range(0, d, 6) if motions[k : k + 6] != motions[:6] or k + 6 > d), d)
    for k in range(0, nodal, 6):
        S[k : k + 6, k : k + 6] = _TURN
    plane = sum(motion == "bending" for motion in motions[nodal:]) // 2
    xz = nodal + np.arange(plane)
    S[xz + plane, xz] = 1.0
    S[xz, xz + plane] = -1.0
    return S


@dataclass(frozen=True)
class PinLoad:
    """What the steady centrifugal load of one planet on its pin follows from.

    With K_p and M of a planet and its bearings on a carrier at rest, its give d is

        (K_p + W^2 (M S S + w G S)) d = W^2 r M e,      f = W^2 (r e' M e + e' M d),

    for the direction e of its arm and its own spin w over that of the carrier. The matrices are those of its free motions in the
    plane of the carrier, none in a model without bending, where planets stay on their pins.

    Attributes:
        planets: those of its kind.
        node: of their carrier.
        lever: sum of r (1 - e e') over the sisters, (1, 3, 3).
        stiffness: K_p (k, k); inertia: M S S + w G S (k, k).
        pull: M e on the free motions (k,); mass: e' M e in kg.
    """

    planets: PlanetSet
    node: int
    lever: np.ndarray
    stiffness: np.ndarray
    inertia: np.ndarray
    pull: np.ndarray
    mass: float

    def force(self, W: float) -> float:
        """f in N at a speed of the carrier in rad/s.

        Raises:
            AnalysisError: the bearings on the pin hold less than the load grows by with the way out.
        """
        r = self.planets.radius
        if not len(self.pull):
            return W**2 * r * self.mass
        A = self.stiffness + W**2 * self.inertia
        load = W**2 * r * self.pull
        # A planet that nothing keeps from tilting tilts under no load of its own.
        size = 1.0 / np.sqrt(np.where(A.diagonal() != 0.0, np.abs(A.diagonal()), 1.0))
        give = size * la.lstsq(A * size[:, None] * size, size * load, cond=_SINGULAR)[0]
        if not load @ give > 0.0:
            raise AnalysisError(
                f"shafts.{written_name(self.planets.planets[0])}: at {abs(W):.6g} rad/s of its carrier the centrifugal load "
                "grows faster with the way out than the bearings on its pin hold: give them radial stiffness, or stiffer ones, a "
                "lighter planet or a lower speed."
            )
        return W**2 * (r * self.mass + float(self.pull @ give))

    def beyond(self, W: float) -> float:
        """What f has beyond W^2 m r in N at a speed of the carrier in rad/s; errors as of `force`."""
        return self.force(W) - W**2 * self.planets.radius * self.mass if W else 0.0

    def group(self, beyond: float) -> ElementGroup:
        """What K_g on the carrier has beyond `group_per_square`, by what f has."""
        return self._on_carrier(ElementMatrices(strain=_ROTATION, modulus=beyond * self.lever), 0.0)

    def group_per_square(self, ratio: float) -> ElementGroup:
        """K_g of the load W^2 m r on the carrier, the sum over all sisters."""
        square = self.mass * self.planets.radius * self.lever
        still = np.zeros_like(square)
        return self._on_carrier(ElementMatrices(strain=_ROTATION, modulus=still, modulus_per_square=square), ratio)

    def _on_carrier(self, matrices: ElementMatrices, spin: float) -> ElementGroup:
        part = f"carriers.{self.planets.carrier}"
        return ElementGroup(part, self.planets.shaft, matrices, node_dofs(self.node), spin)


def _directions(planets: PlanetSet) -> np.ndarray:
    """Directions (N, 3) of the arms of planets in the frame of their carrier's shaft."""
    return np.column_stack([np.cos(planets.angles), np.sin(planets.angles), np.zeros(len(planets.angles))])


def pin_loads(layout: Layout, nodes: Nodes, dofs: DofMap, groups: Iterable[ElementGroup]) -> list[PinLoad]:
    """The loads of the pins of all carriers that turn; `groups` are the elements, with bearings of one speed where those vary."""
    every = list(groups)
    found = []
    for planets in turning_carriers(layout):
        planet = planets.planets[0]
        lever = len(planets.planets) * np.diag([0.5, 0.5, 1.0])
        if not planets.part.is_regular:
            lever = np.sum([np.eye(3) - np.outer(e, e) for e in _directions(planets)], axis=0)
        ratio = layout.train.ratio(planet) / layout.train.ratio(planets.shaft)
        size = dofs.transform.shape[0]
        K, M, inertia = (np.zeros((size, size)) for _ in "KMI")
        inside = np.zeros(size, dtype=bool)
        for group in every:
            if group.shaft != planet or group.part.startswith("carriers."):
                continue
            m = group.matrices
            S = quarter_turn(group)
            for number, on in enumerate(group.dofs):
                at = np.ix_(on, on)
                if m.stiffness is not None:
                    K[at] += m.stiffness[number]
                if m.gyroscopic is not None:
                    inertia[at] += ratio * m.gyroscopic[number] @ S
                if m.mass is not None:
                    M[at] += m.mass[number]
                    inertia[at] += m.mass[number] @ S @ S
                    inside[on[np.any(S != 0.0, axis=0)]] = True
        # Only what moves in the plane of the carrier feels it; the carrier itself stands still.
        rows = np.flatnonzero(inside)
        T = dofs.transform[rows].toarray()
        moves = np.any(T != 0.0, axis=0) if layout.model.has("bending") else np.zeros(T.shape[1], dtype=bool)
        T = T[:, moves]
        e = ((rows < 6 * len(nodes)) & (rows % 6 == 0)).astype(float)
        here = np.ix_(rows, rows)
        pull = M[here] @ e
        node = nodes.at(*layout.at(planets.shaft, planets.part.at))
        lever = planets.radius * lever[None]
        found.append(
            PinLoad(planets, node, lever, T.T @ K[here] @ T, T.T @ inertia[here] @ T, T.T @ pull, float(e @ pull))
        )
    return found
