"""Discretisation error of modes, from the next higher internal polynomials of every shaft element.

A mode (s, q) of the discretised model leaves a residual r = (s^2 M + s D + K) q against bubbles b that the element doesn't have
yet. Solved in each element by itself, the quadratic form moves by

    d = sum over elements  t^T (s^2 M_bb + s D_bb + K_bb)^-1 r,        |ds| = |d| / |y^H (2 s M + D) q|

with the left shape y and its residual t: the hierarchical estimate of Bank and Smith, SIAM J. Numer. Anal. 30 (1993) 921, for
an eigenvalue. It needs no second solution, and it says where the error comes from. Lumped mass adds its own change, of the
other sign.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rotorgear.elements.by_content import kept_by_content
from rotorgear.elements.shaft import ShaftElements, distinct_elements
from rotorgear.elements.shaft_bubbles import bubble_motions, bubble_places
from rotorgear.solvers.eigen.shift_invert import symmetric_pair
from rotorgear.system.groups import alike, element_data, shaft_dofs
from rotorgear.system.left_shapes import left_shapes
from rotorgear.system.nodes import Element
from rotorgear.system.plan import PieceKey
from rotorgear.system.system import System

# Orders added for the estimate: two, so that an even and an odd polynomial of each field take part.
_RICHER = 2
# An element whose own bubbles vibrate below this multiple of a mode's frequency squared is too coarse for any estimate.
_RESOLVED = 2.0


@dataclass(frozen=True)
class Bubbles:
    """Bubble modes of the k different elements of a group: w^2 (k, b), and what they take from an element's dofs, (k, b, d)."""

    squared: np.ndarray
    mass: np.ndarray
    stiffness: np.ndarray
    gyroscopic: np.ndarray
    lumping: np.ndarray | None


@dataclass(frozen=True)
class BubbleGroup:
    """Elements of a shaft of one order: the kind of each (e,), the dofs of each (e, d), and the bubbles of the kinds."""

    shaft: str
    elements: list[Element]
    which: np.ndarray
    dofs: np.ndarray
    bubbles: Bubbles


def bubble_groups(system: System) -> Iterator[BubbleGroup]:
    """Yield the elastic shaft elements of a system with the bubbles that they lack."""
    model = system.model
    for shaft in model.shafts:
        shear = model.shafts[shaft].shear_deformation
        lumped = model.shafts[shaft].mass_matrix == "lumped"
        for rigid, order, elements in alike(model, system.nodes, shaft):
            if rigid:
                continue
            kinds, which = element_data(model, shaft, elements).unique()
            bubbles = _bubble_modes(kinds, order, shear, lumped, model.motions)
            yield BubbleGroup(shaft, elements, which, shaft_dofs(system.nodes, elements, shear), bubbles)


def bubble_errors(system: System, speed: float | None, s: np.ndarray, x: np.ndarray) -> dict[PieceKey, np.ndarray]:
    """Return the estimated relative error of |s| that each shaft segment brings: piece -> (m,), infinite where it is too coarse.

    Args:
        system: the discretised model.
        speed: speed of the reference shaft in rad/s; None is undamped at standstill.
        s: eigenvalues (m,), none of them zero.
        x: their shapes in the free dofs (n, m), of any scale.
    """
    y = left_shapes(system, speed, s, x)
    first, second = _frequency_form(system, speed, s, x, y)
    right = system.dofs.expand(x)
    left = system.dofs.expand(y)
    errors: dict[PieceKey, np.ndarray] = {}
    for group in bubble_groups(system):
        moved = _moved(system, speed or 0.0, group, s, right, left)  # (e, m)
        for piece in sorted({element.piece for element in group.elements}):
            of_piece = [k for k, element in enumerate(group.elements) if element.piece == piece]
            change = np.abs(moved[of_piece].sum(axis=0))
            finite = np.where(np.isfinite(change), change, 0.0)
            # Root of second e^2 + first e = |d| in the form that loses no digits where the square matters little.
            share = 2.0 * finite / (first + np.sqrt(first**2 + 4.0 * second * finite))
            errors[group.shaft, piece] = np.where(np.isfinite(change), share, np.inf)
    return errors


def _frequency_form(
    system: System, speed: float | None, s: np.ndarray, x: np.ndarray, y: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """|s y^H (2 s M + D) x| and |s^2 y^H M x|, each (m,).

    A change d of the quadratic form moves s by e s with second e^2 + first e = |d|; the square matters next to double roots.
    """
    inertia = system.mass @ x
    product = 2.0 * s * inertia
    D = system.velocity_terms(speed)
    if D is not None:
        product = product + D @ x
    first = np.abs(s * np.sum(y.conj() * product, axis=0))
    return first, np.abs(s**2 * np.sum(y.conj() * inertia, axis=0))


def _moved(
    system: System, speed: float, group: BubbleGroup, s: np.ndarray, right: np.ndarray, left: np.ndarray
) -> np.ndarray:
    """Change of the quadratic form by the bubbles of each element, (e, m)."""
    model = system.model
    shaft = group.shaft
    bubbles = group.bubbles
    which = group.which
    dofs = group.dofs
    # (e, d, m)
    x = right[dofs]
    y = left[dofs].conj()
    spin = speed * system.train.ratio(shaft)
    squared = s**2 + model.damping.rayleigh_alpha * s
    internal = model.shafts[shaft].internal_damping
    elastic = 1.0 + s * (model.damping.rayleigh_beta + internal)
    r = squared * (bubbles.mass[which] @ x) + elastic * (bubbles.stiffness[which] @ x)
    t = squared * (bubbles.mass[which] @ y) + elastic * (bubbles.stiffness[which] @ y)
    if spin:
        r = r + s * spin * (bubbles.gyroscopic[which] @ x)
        t = t - s * spin * (bubbles.gyroscopic[which] @ y)
    w2 = bubbles.squared[which][:, :, None]
    coarse = np.any(w2 < _RESOLVED * np.abs(s) ** 2, axis=1)
    # Rotating damping couples the planes of a bubble: seen in the sense of each whirl, the stiffness is w^2 (1 -+ i eta W).
    held = squared + elastic * w2
    gaps = np.array([held + turn * 1j * internal * spin * w2 for turn in (1.0, -1.0)])
    gap = gaps[0] if not internal * spin else np.where(np.abs(gaps[0]) < np.abs(gaps[1]), *gaps)
    moved = np.sum(t * r / np.where(gap != 0.0, gap, np.inf), axis=1)
    if bubbles.lumping is not None:
        moved = moved - squared * np.einsum("edm,edf,efm->em", y, bubbles.lumping[which], x)
    # Where nothing moves, a coarse element does no harm.
    return np.where(coarse & (moved != 0.0), np.inf, moved)


@kept_by_content(rows=32, results=128)
def _bubble_modes(kinds: ShaftElements, order: int, shear: bool, lumped: bool, motions: tuple[str, ...]) -> Bubbles:
    """Modes of the bubbles of an element that is two orders richer, between fixed nodes, for each different element."""
    rich = distinct_elements(kinds, order=order + _RICHER)
    assert rich.mass is not None
    assert rich.gyroscopic is not None
    K = rich.stiffness
    assert K is not None
    used = 12 + np.flatnonzero([motion in motions for motion in bubble_motions(order + _RICHER, shear)])
    present = np.concatenate([np.arange(12), 12 + bubble_places(order, order + _RICHER, shear)])
    new = ~np.isin(used, present)
    squared = []
    mass = []
    stiffness = []
    gyroscopic = []
    for k in range(len(kinds.length)):
        values, modes = symmetric_pair(K[k][np.ix_(used, used)], rich.mass[k][np.ix_(used, used)])
        taken = modes[new].T  # the residual against bubbles that are there already is zero
        squared.append(values)
        mass.append(taken @ rich.mass[k][np.ix_(used[new], present)])
        stiffness.append(taken @ K[k][np.ix_(used[new], present)])
        gyroscopic.append(taken @ rich.gyroscopic[k][np.ix_(used[new], present)])
    lumping = None
    if lumped:
        plain = distinct_elements(kinds, lumped=True).mass
        assert plain is not None
        lumping = rich.mass[:, :12, :12] - plain
    return Bubbles(np.array(squared), np.array(mass), np.array(stiffness), np.array(gyroscopic), lumping)
