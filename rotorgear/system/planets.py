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

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rotorgear.elements.matrices import ElementMatrices
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.carriers import PlanetSet
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.carrier import MARK, written_name
from rotorgear.system.dofs import DofMap
from rotorgear.system.groups import ElementGroup, node_dofs
from rotorgear.system.nodes import Nodes

# Quarter turn about z of a displacement and a rotation: x goes to y, y to -x.
_TURN = np.zeros((6, 6))
_TURN[[1, 4], [0, 3]] = 1.0
_TURN[[0, 3], [1, 4]] = -1.0
# Sisters whose matrices differ by more than this are not equal: rounding of their directions leaves less.
_ALIKE = 1e-9
# Share of the stiffest below which a planet is not held at all.
_SINGULAR = 1e-13


def turning_carriers(layout: Layout) -> tuple[PlanetSet, ...]:
    """The planets whose carriers turn where the reference shaft does."""
    return tuple(planets for planets in layout.planets if layout.train.ratios[planets.shaft] != 0)


def require_constant(layout: Layout) -> None:
    """Refuse planets whose matrices change as they go round.

    Raises:
        AnalysisError: two planets, unequal spacing, or one that differs from its sisters, on a carrier that turns.
    """
    for planets in turning_carriers(layout):
        if not planets.part.is_regular:
            count = len(planets.planets)
            what = f"{count} planets" if count < 3 else "planets at unequal angles"
            raise AnalysisError(
                f"carriers.{planets.carrier}: {what} on a carrier that turns have coefficients that change with its angle, which "
                "is not built. Take three or more planets, equally spaced, or hold the carrier: speed_ratio = 0 of "
                f"shafts.{planets.shaft}."
            )


def sister_turn(angles: np.ndarray) -> np.ndarray:
    """T (N, N), which turns a pattern of the first class over the planets on by a quarter, as the carrier's angle does."""
    return np.asarray(2.0 / len(angles) * np.sin(angles[:, None] - angles[None, :]))


def planet_groups(layout: Layout, groups: Iterable[ElementGroup]) -> list[ElementGroup]:
    """What carriers that turn add to some groups of planets, of all sisters together, as groups with the carrier's spin.

    Raises:
        AnalysisError: see `require_constant`.
    """
    if not turning_carriers(layout):
        return []
    require_constant(layout)
    found = []
    for carrier, sisters in _sisters(layout, groups):
        if layout.train.ratios[layout.model.carriers[carrier].shaft] != 0:
            found += list(_carried(layout, carrier, sisters))
    return found


def _sisters(layout: Layout, groups: Iterable[ElementGroup]) -> Iterator[tuple[str, list[ElementGroup]]]:
    """The carrier and the groups of one part of all planets, one for each."""
    found: dict[tuple[str, int], list[ElementGroup]] = {}
    seen: dict[str, int] = {}
    for group in groups:
        if MARK in group.part:
            number = seen[group.part] = seen.get(group.part, -1) + 1
            found.setdefault((written_name(group.part), number), []).append(group)
    for sisters in found.values():
        yield _carrier_of(layout, sisters[0].part), sisters


def _carrier_of(layout: Layout, address: str) -> str:
    """Name of the carrier that a part with sisters goes round with."""
    table, _, name = address.partition(".")
    model = layout.model
    if table == "meshes":
        shafts = [gear.shaft for gear in layout.mesh(name).gears]
    elif table == "couplings":
        shafts = [model.couplings[name].from_shaft]
    else:
        shafts = [name if table == "shafts" else getattr(model, table)[name].shaft]
    return next(carrier for shaft in shafts if (carrier := model.shafts[shaft].carrier) is not None)


def _carried(layout: Layout, carrier: str, sisters: list[ElementGroup]) -> Iterator[ElementGroup]:
    """The terms of one part of all planets."""
    part = layout.model.carriers[carrier]
    T = sister_turn(np.array(part.directions))
    ratio = layout.train.ratio(part.shaft)
    first = sisters[0].matrices
    for other in sisters[1:]:
        for name in ("mass", "modulus", "viscosity"):
            mine = getattr(first, name)
            its = getattr(other.matrices, name)
            if (mine is None) != (its is None) or (mine is not None and not _equal(mine, its)):
                raise AnalysisError(
                    f"{other.part}: its {_WORDS[name]} differs from that of {sisters[0].part}, and planets that differ have "
                    "coefficients that change with the angle of their carrier, which is not built. Make them equal, or hold the "
                    f"carrier: speed_ratio = 0 of shafts.{part.shaft}."
                )
    dofs = np.hstack([group.dofs for group in sisters])
    motions = tuple(motion for group in sisters for motion in group.dof_motions)[6:]

    def of_all(matrices: ElementMatrices) -> ElementGroup:
        return ElementGroup(f"carriers.{carrier}", part.shaft, matrices, dofs, ratio, body_motions=motions)

    if first.mass is not None:
        D = np.kron(np.eye(len(T)), quarter_turn(sisters[0])) - np.kron(T, np.eye(sisters[0].dofs.shape[1]))
        M = _repeated(first.mass, len(T))
        square = M @ D @ D
        if first.gyroscopic is not None:
            square = square + sisters[0].spin / ratio * (_repeated(first.gyroscopic, len(T)) @ D)
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
        blocks = [group.matrices.strain for group in sisters]
        strain = np.stack(
            [_block_diagonal([block[e] for block in blocks if block is not None]) for e in range(len(dofs))]
        )
        Z = -np.stack([np.kron(T, V) for V in first.viscosity])
        if first.circulation_per_speed is not None:
            Z = Z - _repeated(first.circulation_per_speed, len(T))
        yield of_all(ElementMatrices(strain=strain, circulation_per_speed=Z))


_WORDS = {"mass": "mass", "modulus": "stiffness", "viscosity": "damping"}


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
    """The steady centrifugal load of one planet, and how the planet gives under it.

    Attributes:
        planets: those of its kind; planet: name of its shaft.
        force: f in N on its pin, outwards.
        dofs: the free dofs of the planet (k,).
        onwards: what the planet moves onwards beside its carrier for each radian of that (k,), the give of the pin along its arm,
            which turns with the arm.
    """

    planets: PlanetSet
    planet: str
    force: float
    dofs: np.ndarray
    onwards: np.ndarray


def pin_loads(
    layout: Layout, nodes: Nodes, dofs: DofMap, groups: Iterable[ElementGroup], speed: float
) -> Iterator[PinLoad]:
    """The loads of the pins of all carriers that turn.

    With K_p and M of a planet and its bearings on a carrier at rest, its give d is (K_p + W^2 M S S + W W_s G S) d = W^2 r M e
    for the direction e of its arm, and f = W^2 e' M (r e + d).

    Args:
        groups: of all elements, at the speed. speed: of the reference shaft in rad/s.

    Raises:
        AnalysisError: the bearings on the pin hold less than the load grows by with the way out.
    """
    own: dict[str, list[ElementGroup]] = {}
    for group in groups:
        own.setdefault(group.shaft, []).append(group)
    for planets in turning_carriers(layout):
        W = layout.train.ratio(planets.shaft) * speed
        for planet in planets.planets:
            parts = [group for group in own.get(planet, []) if not group.part.startswith("carriers.")]
            spin = layout.train.ratio(planet) * speed
            K, M = (np.zeros((dofs.transform.shape[0],) * 2) for _ in "KM")
            inside = np.zeros(len(K), dtype=bool)
            for group in parts:
                m = group.matrices
                S = quarter_turn(group)
                for number, on in enumerate(group.dofs):
                    at = np.ix_(on, on)
                    if m.stiffness is not None:
                        K[at] += m.stiffness[number]
                    if m.gyroscopic is not None:
                        K[at] += spin * W * m.gyroscopic[number] @ S
                    if m.mass is not None:
                        M[at] += m.mass[number]
                        K[at] += W**2 * m.mass[number] @ S @ S
                        inside[on[np.any(S != 0.0, axis=0)]] = True
            # Only what moves in the plane of the carrier feels it; the carrier itself stands still.
            rows = np.flatnonzero(inside)
            T = dofs.transform[rows].toarray()
            # Without bending planets stay on their pins.
            moves = np.any(T != 0.0, axis=0) if layout.model.has("bending") else np.zeros(T.shape[1], dtype=bool)
            free = np.flatnonzero(moves)
            T = T[:, free]
            along = rows < 6 * len(nodes)
            e = (along & (rows % 6 == 0)).astype(float)
            onwards = (along & (rows % 6 == 1)).astype(float)
            M = M[np.ix_(rows, rows)]
            pull = T.T @ K[np.ix_(rows, rows)] @ T
            load = W**2 * planets.radius * (T.T @ M @ np.column_stack([e, onwards]))
            # A planet that nothing keeps from tilting tilts under no load of its own.
            size = 1.0 / np.sqrt(np.where(pull.diagonal() != 0.0, np.abs(pull.diagonal()), 1.0))
            scaled = pull * size[:, None] * size
            give = size[:, None] * la.lstsq(scaled, size[:, None] * load, cond=_SINGULAR)[0] if free.size else load
            if speed and free.size and not load[:, 0] @ give[:, 0] > 0.0:
                raise AnalysisError(
                    f"shafts.{written_name(planet)}: at {abs(W):.6g} rad/s of its carrier the centrifugal load grows faster with "
                    "the way out than the bearings on its pin hold: give them radial stiffness, or stiffer bearings, a lighter "
                    "planet or a lower speed."
                )
            force = W**2 * float(e @ M @ (planets.radius * e + T @ give[:, 0]))
            yield PinLoad(planets, planet, force, free, give[:, 1])


def pin_load_groups(
    layout: Layout, nodes: Nodes, dofs: DofMap, groups: Iterable[ElementGroup], speed: float
) -> list[ElementGroup]:
    """K_g of the pins' centrifugal loads at a reference speed in rad/s, on the nodes of the carriers; see `pin_loads`."""
    found = []
    for load in pin_loads(layout, nodes, dofs, groups, speed) if speed else ():
        planets = load.planets
        if load.planet != planets.planets[0]:
            continue  # the sum over the sisters is that of equal ones
        rotation = np.zeros((1, 3, 6))
        rotation[0, :, 3:] = np.eye(3)
        K = load.force * planets.radius * len(planets.planets) * np.diag([0.5, 0.5, 1.0])
        node = nodes.at(*layout.at(planets.shaft, planets.part.at))
        matrices = ElementMatrices(strain=rotation, modulus=K[None])
        found.append(ElementGroup(f"carriers.{planets.carrier}", planets.shaft, matrices, node_dofs(node)))
    return found
