"""Discretisation error of modes, from the next higher internal polynomials of every shaft element.

A mode (s, q) of the discretised model leaves a residual r = (s^2 M + s D + K) q against bubbles b that the element doesn't have
yet. Solved in each element by itself, the quadratic form moves by

    d = sum over elements  r^T (K_bb - w^2 M_bb)^-1 r,        |ds| = d / |q^H (2 s M + D) q|

which is the hierarchical estimate of Bank and Smith, SIAM J. Numer. Anal. 30 (1993) 921, for an eigenvalue. It costs no second
solution, and it says where the error comes from.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rotorgear.elements.shaft import ShaftElements, distinct_elements
from rotorgear.elements.shaft_bubbles import bubble_places
from rotorgear.system.groups import alike, element_data, shaft_dofs
from rotorgear.system.nodes import Element
from rotorgear.system.plan import PieceKey
from rotorgear.system.system import System

# Orders added for the estimate: two, so that an even and an odd polynomial of each field take part.
_RICHER = 2
# An element whose own bubbles vibrate below this multiple of a mode's frequency squared is too coarse for any estimate.
_RESOLVED = 2.0


@dataclass(frozen=True)
class _Bubbles:
    """Bubble modes of the k different elements of a group: w^2 (k, b), and what they take from an element's dofs, (k, b, d)."""

    squared: np.ndarray
    mass: np.ndarray
    stiffness: np.ndarray
    gyroscopic: np.ndarray
    lumping: np.ndarray | None


def bubble_errors(system: System, speed: float | None, s: np.ndarray, q: np.ndarray) -> dict[PieceKey, np.ndarray]:
    """Return the estimated relative error of |s| that each piece of shaft brings: piece -> (m,), infinite where it is too coarse.

    Args:
        system: the discretised model.
        speed: speed of the reference shaft in rad/s; None is undamped at standstill.
        s: eigenvalues (m,), none of them zero.
        q: shapes of all dofs (a, m), of any scale.
    """
    size = _frequency_form(system, speed, s, q)
    found: dict[PieceKey, np.ndarray] = {}
    for shaft, order, elements in _flexible(system):
        moved = _moved(system, speed or 0.0, shaft, order, elements, s, q)  # (e, m)
        for number in sorted({element.piece for element in elements}):
            own = [k for k, element in enumerate(elements) if element.piece == number]
            found[shaft, number] = moved[own].sum(axis=0) / size
    return found


def _flexible(system: System) -> Iterator[tuple[str, int, list[Element]]]:
    for shaft in system.model.shafts:
        for rigid, order, elements in alike(system.model, system.nodes, shaft):
            if not rigid:
                yield shaft, order, elements


def _frequency_form(system: System, speed: float | None, s: np.ndarray, q: np.ndarray) -> np.ndarray:
    """|s q^H (2 s M + D) q|, (m,): what turns a change of the quadratic form into a relative change of s."""
    free = q[_representatives(system)] if system.dofs.selects else np.linalg.pinv(system.dofs.transform.toarray()) @ q
    product = 2.0 * s * (system.mass @ free)
    D = system.velocity_terms(speed)
    if D is not None:
        product = product + D @ free
    return np.asarray(np.abs(s * np.sum(free.conj() * product, axis=0)))


def _representatives(system: System) -> np.ndarray:
    return np.flatnonzero(system.dofs.column >= 0)


def _moved(
    system: System, speed: float, shaft: str, order: int, elements: list[Element], s: np.ndarray, q: np.ndarray
) -> np.ndarray:
    """Change of the quadratic form by the bubbles of each element, (e, m)."""
    model = system.model
    shear = model.shafts[shaft].shear_deformation
    kinds, which = element_data(model, shaft, elements).unique()
    bubbles = _bubble_modes(kinds, order, shear, model.shafts[shaft].mass_matrix == "lumped", model.motions)
    local = q[shaft_dofs(system.nodes, elements, shear)]  # (e, d, m)
    spin = speed * system.train.ratio(shaft)
    squared = s**2 + model.damping.rayleigh_alpha * s
    elastic = 1.0 + s * (model.damping.rayleigh_beta + model.shafts[shaft].internal_damping)
    r = squared * (bubbles.mass[which] @ local) + elastic * (bubbles.stiffness[which] @ local)
    if spin:
        r = r + s * spin * (bubbles.gyroscopic[which] @ local)
    gap = bubbles.squared[which][:, :, None] - np.abs(s) ** 2
    coarse = np.any(bubbles.squared[which][:, :, None] < _RESOLVED * np.abs(s) ** 2, axis=1)
    moved = np.sum(np.abs(r) ** 2 / np.where(gap > 0.0, gap, np.inf), axis=1)
    if bubbles.lumping is not None:
        crime = np.einsum("edm,edf,efm->em", local.conj(), bubbles.lumping[which], local)
        moved = moved + np.abs(squared * crime)
    # Where nothing moves, a coarse element does no harm.
    return np.where(coarse & (moved > 0.0), np.inf, moved)


def _bubble_modes(kinds: ShaftElements, order: int, shear: bool, lumped: bool, motions: tuple[str, ...]) -> _Bubbles:
    """Modes of the bubbles of an element that is two orders richer, between fixed nodes, for each different element."""
    from rotorgear.elements.shaft_bubbles import bubble_motions

    rich = distinct_elements(kinds, order=order + _RICHER)
    assert rich.mass is not None
    assert rich.gyroscopic is not None
    K = rich.stiffness
    assert K is not None
    used = 12 + np.flatnonzero([motion in motions for motion in bubble_motions(order + _RICHER, shear)])
    own = np.concatenate([np.arange(12), 12 + bubble_places(order, order + _RICHER, shear)])
    new = ~np.isin(used, own)
    squared, mass, stiffness, gyroscopic = [], [], [], []
    for k in range(len(kinds.length)):
        values, modes = la.eigh(K[k][np.ix_(used, used)], rich.mass[k][np.ix_(used, used)])
        taken = modes[new].T  # the residual against bubbles that are there already is zero
        squared.append(values)
        mass.append(taken @ rich.mass[k][np.ix_(used[new], own)])
        stiffness.append(taken @ K[k][np.ix_(used[new], own)])
        gyroscopic.append(taken @ rich.gyroscopic[k][np.ix_(used[new], own)])
    lumping = None
    if lumped:
        plain = distinct_elements(kinds, lumped=True).mass
        assert plain is not None
        lumping = rich.mass[:, :12, :12] - plain
    return _Bubbles(np.array(squared), np.array(mass), np.array(stiffness), np.array(gyroscopic), lumping)
