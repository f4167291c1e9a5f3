"""Discretisation error of modes, from the next higher internal polynomials of every shaft element.

A mode (s, q) of the discretised model leaves a residual r = (s^2 M + s D + K) q against bubbles b that the element doesn't have
yet. Solved in each element by itself, the quadratic form moves by

    d = sum over elements  t^T (s^2 M_bb + s D_bb + K_bb)^-1 r,        |ds| = |d| / |y^H (2 s M + D) q|

with the left shape y and its residual t: the hierarchical estimate of Bank and Smith, SIAM J. Numer. Anal. 30 (1993) 921, for
an eigenvalue. It needs no second solution, and it says where the error comes from. Lumped mass adds its own change, of the
other sign.

Left shapes y, y^H Q(s) = 0 with Q(s) = s^2 M + s D + K: without damping Q(s) is Hermitian on the imaginary axis, so y = x; with
symmetric matrices y = conj(x). Else x is right up to the damping ratio, and a mode that is damped more, or a stiffness that
circulates, gets one inverse iteration with Q(s)^H. Lancaster, Lambda-Matrices and Vibrating Systems, section 4.

A forced response Z(w) q = f leaves the same residual with s = i w. It changes the receptance f^T q at the force by

    d = sum over bubbles  r r / (s^2 + (1 + s beta) w_b^2),

the same estimate for a given frequency. It costs a few products with sparse matrices, so it can be had at every frequency; a
second solution then tells the error where it is largest. A load that turns has f^T q = 0: there the Hermitian form f^H q is
looked at, with r* r in the sum.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import scipy.sparse as sp

from rotorgear.elements.matrices import kept_by_content
from rotorgear.elements.shaft import distinct_elements
from rotorgear.elements.shaft_bubbles import bubble_motions, bubble_places
from rotorgear.elements.shaft_section import ShaftElements
from rotorgear.errors import ConvergenceError
from rotorgear.solvers.eigen.shift_invert import symmetric_pair
from rotorgear.solvers.sparse.entries import times
from rotorgear.solvers.sparse.factor import factor_general
from rotorgear.system.groups import alike, element_data
from rotorgear.system.nodes import Element
from rotorgear.system.plan import PieceKey
from rotorgear.system.system import System

# Orders added for the estimate: two, so that an even and an odd polynomial of each field take part.
_RICHER = 2
# An element whose own bubbles vibrate below this multiple of a mode's frequency squared is too coarse for any estimate.
_RESOLVED = 2.0


@dataclass(frozen=True)
class Bubbles:
    """Bubble modes of e elements of one order: w^2 (e, b), and what they take from an element's dofs, (e, b, d).

    `circulatory` is that of the rotating material at unit spin and damping. A turn couples each mode of bending with the same
    mode in the other plane, its `partner` (e, b), and no other one as much: `spun` and `swept` (e, b) are the gyroscopic and the
    circulatory entries between the two. `lumping` is what consistent mass adds to a lumped one, (e, 12, 12).
    """

    squared: np.ndarray
    mass: np.ndarray
    stiffness: np.ndarray
    gyroscopic: np.ndarray
    circulatory: np.ndarray
    partner: np.ndarray
    spun: np.ndarray
    swept: np.ndarray
    lumping: np.ndarray | None


def bubble_groups(system: System) -> Iterator[tuple[str, list[Element], np.ndarray, Bubbles]]:
    """Yield the elastic shaft elements of one order of a system: their shaft, themselves, their dofs (e, d) and their bubbles."""
    model = system.model
    for name, shaft in model.shafts.items():
        lumped = shaft.mass_matrix == "lumped"
        for rigid, order, elements, dofs in alike(model, system.nodes, name):
            if rigid:
                continue
            kinds, which = element_data(model, name, elements).unique()
            b = _bubble_modes(kinds, order, shaft.shear_deformation, lumped, model.motions)
            of_elements: dict[str, Any] = {item.name: getattr(b, item.name) for item in fields(Bubbles)}
            of_elements = {term: None if A is None else A[which] for term, A in of_elements.items()}
            yield name, elements, dofs, Bubbles(**of_elements)


def bubble_errors(system: System, speed: float | None, s: np.ndarray, x: np.ndarray) -> dict[PieceKey, np.ndarray]:
    """Return the estimated relative error of |s| that each shaft segment brings: piece -> (m,), infinite where it is too coarse.

    Args:
        system: the discretised model.
        speed: speed of the reference shaft in rad/s; None is undamped at standstill.
        s: eigenvalues (m,), none of them zero.
        x: their shapes in the free dofs (n, m), of any scale.
    """
    y = left_shapes(system, speed, s, x)
    # A change d of the quadratic form moves s by e s with second e^2 + first e = |d|, first = |s y^H (2 s M + D) x| and
    # second = |s^2 y^H M x|; the square matters next to double roots.
    inertia = system.mass @ x
    product = 2.0 * s * inertia
    D = system.velocity_terms(speed)
    if D is not None:
        product = product + D @ x
    first = np.abs(s * np.sum(y.conj() * product, axis=0))
    second = np.abs(s**2 * np.sum(y.conj() * inertia, axis=0))
    right = system.dofs.expand(x)
    left = system.dofs.expand(y)
    errors: dict[PieceKey, np.ndarray] = {}
    for shaft, elements, dofs, bubbles in bubble_groups(system):
        moved = _moved(system, speed or 0.0, shaft, bubbles, s, right[dofs], left[dofs].conj())
        pieces = np.array([element.piece for element in elements])
        for piece in sorted(set(pieces.tolist())):  # np.unique would load numpy.ma
            change = np.abs(moved[np.flatnonzero(pieces == piece)].sum(axis=0))
            finite = np.where(np.isfinite(change), change, 0.0)
            # The root in the form that loses no digits where the square matters little.
            share = 2.0 * finite / (first + np.sqrt(first**2 + 4.0 * second * finite))
            errors[shaft, piece] = np.where(np.isfinite(change), share, np.inf)
    return errors


def _moved(
    system: System, speed: float, shaft: str, bubbles: Bubbles, s: np.ndarray, x: np.ndarray, y: np.ndarray
) -> np.ndarray:
    """Change (e, m) of the quadratic form by the bubbles of each element of a shaft, with right and left shapes (e, d, m)."""
    damping = system.model.damping
    spin = speed * system.train.ratio(shaft)
    squared = s**2 + damping.rayleigh_alpha * s
    internal = system.model.shafts[shaft].internal_damping
    elastic = 1.0 + s * (damping.rayleigh_beta + internal)
    r = squared * (bubbles.mass @ x) + elastic * (bubbles.stiffness @ x)
    t = squared * (bubbles.mass @ y) + elastic * (bubbles.stiffness @ y)
    if spin:
        # Both are skew, so that the left residual has them with the other sign.
        r = r + spin * (s * (bubbles.gyroscopic @ x) + internal * (bubbles.circulatory @ x))
        t = t - spin * (s * (bubbles.gyroscopic @ y) + internal * (bubbles.circulatory @ y))
    w2 = bubbles.squared[:, :, None]
    coarse = np.any(w2 < _RESOLVED * np.abs(s) ** 2, axis=1)
    # A bubble of bending and its partner in the other plane: [held, turned; -turned, held]; others answer alone.
    held = squared + elastic * w2
    turned = spin * (s * bubbles.spun[:, :, None] + internal * bubbles.swept[:, :, None])
    gap = held**2 + turned**2
    answer = held * r - turned * np.take_along_axis(r, bubbles.partner[:, :, None], axis=1)
    moved = np.sum(t * answer / np.where(gap != 0.0, gap, np.inf), axis=1)
    if bubbles.lumping is not None:
        moved = moved - squared * np.einsum("edm,edf,efm->em", y, bubbles.lumping, x)
    # Where nothing moves, a coarse element does no harm.
    return np.where(coarse & (moved != 0.0), np.inf, moved)


@kept_by_content(rows=32, results=128)
def _bubble_modes(kinds: ShaftElements, order: int, shear: bool, lumped: bool, motions: tuple[str, ...]) -> Bubbles:
    """Modes of the bubbles of an element that is two orders richer, between fixed nodes, for each different element."""
    rich = distinct_elements(kinds, order=order + _RICHER, internal_damping=1.0)
    K = rich.stiffness
    swept = rich.circulatory_per_speed
    assert swept is not None
    assert K is not None
    assert rich.mass is not None
    assert rich.gyroscopic is not None
    used = 12 + np.flatnonzero([motion in motions for motion in bubble_motions(order + _RICHER, shear)])
    present = np.concatenate([np.arange(12), 12 + bubble_places(order, order + _RICHER, shear)])
    new = ~np.isin(used, present)
    squared = []
    taken: list[list[np.ndarray]] = [[], [], [], []]
    turning: list[list[np.ndarray]] = [[], [], []]
    for k in range(len(kinds.length)):
        values, modes = symmetric_pair(K[k][np.ix_(used, used)], rich.mass[k][np.ix_(used, used)])
        squared.append(values)
        # The residual against bubbles that are there already is zero.
        for A, rows in zip((rich.mass, K, rich.gyroscopic, swept), taken, strict=True):
            rows.append(modes[new].T @ A[k][np.ix_(used[new], present)])
        between = [modes.T @ A[k][np.ix_(used, used)] @ modes for A in (swept, rich.gyroscopic)]
        partner = np.argmax(np.abs(between[0]), axis=1)
        at = np.arange(len(partner)), partner
        for one, into in zip((partner, between[1][at], between[0][at]), turning, strict=True):
            into.append(one)
    lumping = None
    if lumped:
        plain = distinct_elements(kinds, lumped=True).mass
        assert plain is not None
        lumping = rich.mass[:, :12, :12] - plain
    mass, stiffness, gyroscopic, circulatory, partner, spun, swept_by = (np.array(rows) for rows in (*taken, *turning))
    return Bubbles(np.array(squared), mass, stiffness, gyroscopic, circulatory, partner, spun, swept_by, lumping)


_LIGHT = 0.03  # damping ratio up to which x does for an estimate

_ASIDE = 1e-9  # Q is taken so far from s that it can be factored, relative to s


def left_shapes(system: System, speed: float | None, s: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Left shapes (n, m) in the free dofs of modes s (m,), x (n, m) at a reference speed in rad/s; None is undamped."""
    at = speed or 0.0
    skew = system.circulatory(at)
    if not skew.nnz and (speed is None or not system.damping(at).nnz):
        return x
    if not skew.nnz and not (at and system.gyroscopic.nnz):
        return np.asarray(x.conj())
    unsure = np.ones(len(s), dtype=bool) if skew.nnz else np.abs(s.real) > _LIGHT * np.abs(s)
    D = system.velocity_terms(speed)
    y = x.astype(complex)
    K = sp.csc_array(system.stiffness(at) + skew)
    for k in np.flatnonzero(unsure):
        z = s[k] * (1.0 + _ASIDE)
        Q = z**2 * system.mass + K if D is None else z**2 * system.mass + z * D + K
        try:
            left = factor_general(sp.csc_array(Q.conj().T)).solve(y[:, k])
        except ConvergenceError:
            continue
        y[:, k] = left / np.linalg.norm(left)
    return y


@dataclass(frozen=True)
class ForcedChanges:
    """Bubbles of all shaft elements on the n free dofs, each of modal mass 1.

    Attributes:
        mass, stiffness, gyroscopic, circulatory: what b bubbles take from the free dofs, (b, n); the last two per reference
            speed, the last with the internal damping.
        partner, spun, swept: as in `Bubbles` (b,), per reference speed and with the internal damping.
        squared: w_b^2 (b,); beta: damping of each, proportional to its stiffness (b,); alpha: to its mass.
        lumping: what consistent mass adds to a lumped one, (n, n).
    """

    mass: sp.csr_array
    stiffness: sp.csr_array
    gyroscopic: sp.csr_array
    circulatory: sp.csr_array
    partner: np.ndarray
    spun: np.ndarray
    swept: np.ndarray
    squared: np.ndarray
    beta: np.ndarray
    alpha: float
    lumping: sp.csr_array | None

    @classmethod
    def of(cls, system: System) -> ForcedChanges:
        """Those of a system."""
        model = system.model
        T = system.dofs.transform
        none = sp.csr_array((0, T.shape[1]))
        terms = {"mass": [none], "stiffness": [none], "gyroscopic": [none], "circulatory": [none]}
        each: dict[str, list[np.ndarray]] = {name: [np.zeros(0)] for name in ("spun", "swept", "squared", "beta")}
        partner = [np.zeros(0, dtype=int)]
        count = 0
        lumping = None
        for shaft, _, dofs, bubbles in bubble_groups(system):
            internal = model.shafts[shaft].internal_damping
            ratio = system.train.ratio(shaft)
            for name, factor in {
                "mass": 1.0,
                "stiffness": 1.0,
                "gyroscopic": ratio,
                "circulatory": ratio * internal,
            }.items():
                terms[name].append(_on_free_dofs(factor * getattr(bubbles, name), dofs, T))
            each["spun"].append(ratio * bubbles.spun.ravel())
            each["swept"].append(ratio * internal * bubbles.swept.ravel())
            each["squared"].append(bubbles.squared.ravel())
            each["beta"].append(np.full(bubbles.squared.size, model.damping.rayleigh_beta + internal))
            elements, own = bubbles.partner.shape
            partner.append((count + own * np.arange(elements)[:, None] + bubbles.partner).ravel())
            count += elements * own
            if bubbles.lumping is not None:
                nodal = dofs[:, : bubbles.lumping.shape[1]]
                added = T[nodal.ravel(), :].T @ _on_free_dofs(bubbles.lumping, nodal, T)
                lumping = added if lumping is None else lumping + added
        stacked = {name: sp.csr_array(sp.vstack(parts)) for name, parts in terms.items()}
        alpha = model.damping.rayleigh_alpha
        joined = {name: np.concatenate(parts) for name, parts in each.items()}
        return cls(**stacked, **joined, partner=np.concatenate(partner), alpha=alpha, lumping=lumping)

    def change(self, speed: float | np.ndarray, w: np.ndarray, q: np.ndarray, *, turning: bool) -> np.ndarray:
        """Size of d for responses q (n, m) at w (m,) in rad/s, at one reference speed in rad/s or at one for each: (m,).

        It is exact to first order where loads don't turn and the system is symmetric, and where loads turn with a rotor that is
        alike in all directions; else it says where to look.
        """
        s = 1j * np.asarray(w)
        squared = s**2 + self.alpha * s
        elastic = 1.0 + s * self.beta[:, None]
        held = squared * times(self.mass, q) + elastic * times(self.stiffness, q)
        turned = speed * (s * times(self.gyroscopic, q) + times(self.circulatory, q)) if np.any(speed) else 0.0
        gap = squared + elastic * self.squared[:, None]
        rest = held + turned
        other = rest.conj() if turning else held - turned
        # As in `_moved`: a bubble answers with its partner in the other plane.
        coupled = speed * (s * self.spun[:, None] + self.swept[:, None])
        both = gap**2 + coupled**2
        answer = (gap * rest - coupled * rest[self.partner]) / np.where(both != 0.0, both, np.inf)
        change = np.sum(other * answer, axis=0)
        if self.lumping is not None:
            change = change - squared * np.sum((q.conj() if turning else q) * times(self.lumping, q), axis=0)
        return np.abs(change)


def _on_free_dofs(rows: np.ndarray, dofs: np.ndarray, T: sp.csr_array) -> sp.csr_array:
    """Rows (e, b, d) on the dofs (e, d) of their elements as rows on the free dofs, (e b, n)."""
    count = rows.shape[0] * rows.shape[1]
    at = np.repeat(np.arange(count), rows.shape[2])
    columns = np.repeat(dofs, rows.shape[1], axis=0).ravel()
    return sp.csr_array(sp.csr_array((rows.ravel(), (at, columns)), shape=(count, T.shape[0])) @ T)
