"""Where a finer mesh would change a forced response most, from the next higher internal polynomials of every shaft element.

A response Z(w) q = f leaves a residual r = (s^2 M + s D + K) q, s = i w, against bubbles b that the elements lack. Solved in each
element by itself, it changes the receptance f^T q at the force by

    d = sum over bubbles  r r / (s^2 + (1 + s beta) w_b^2)

the estimate of `bubble_errors` for a given frequency. It costs a few products with sparse matrices, so it can be had at every
frequency; a second solution then tells the error where it is largest. A load that turns has f^T q = 0: there the Hermitian form
f^H q is looked at, with r* r in the sum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.system.bubble_errors import bubble_groups
from rotorgear.system.system import System


@dataclass(frozen=True)
class ForcedChanges:
    """Bubbles of all shaft elements on the n free dofs, each of modal mass 1.

    Attributes:
        mass, stiffness, gyroscopic: what b bubbles take from the free dofs, (b, n); the last per reference speed.
        squared: w_b^2 (b,); beta: damping of each, proportional to its stiffness (b,); alpha: to its mass.
        lumping: what consistent mass adds to a lumped one, (n, n).
    """

    mass: sp.csr_array
    stiffness: sp.csr_array
    gyroscopic: sp.csr_array
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
        terms = {"mass": [none], "stiffness": [none], "gyroscopic": [none]}
        squared = [np.zeros(0)]
        beta = [np.zeros(0)]
        lumping = None
        for group in bubble_groups(system):
            bubbles = group.bubbles
            own = bubbles.squared[group.which].ravel()
            squared.append(own)
            beta.append(np.full(len(own), model.damping.rayleigh_beta + model.shafts[group.shaft].internal_damping))
            turning = system.train.ratio(group.shaft) * bubbles.gyroscopic
            for name, kinds in (("mass", bubbles.mass), ("stiffness", bubbles.stiffness), ("gyroscopic", turning)):
                terms[name].append(_on_free_dofs(kinds[group.which], group.dofs, T))
            if bubbles.lumping is not None:
                dofs = group.dofs
                nodal = dofs[:, : bubbles.lumping.shape[1]]
                rows = _on_free_dofs(bubbles.lumping[group.which], nodal, T)
                added = T[nodal.ravel(), :].T @ rows
                lumping = added if lumping is None else lumping + added
        stacked = {name: sp.csr_array(sp.vstack(parts)) for name, parts in terms.items()}
        alpha = model.damping.rayleigh_alpha
        return cls(**stacked, squared=np.concatenate(squared), beta=np.concatenate(beta), alpha=alpha, lumping=lumping)

    def change(self, speed: float, w: np.ndarray, q: np.ndarray, *, turning: bool) -> np.ndarray:
        """Size of d for responses q (n, m) at w (m,) in rad/s, at a reference speed in rad/s: (m,).

        It is exact to first order where loads don't turn and the system is symmetric; else it says where to look.
        """
        s = 1j * np.asarray(w)
        squared = s**2 + self.alpha * s
        elastic = 1.0 + s * self.beta[:, None]
        held = squared * (self.mass @ q) + elastic * (self.stiffness @ q)
        turned = s * speed * (self.gyroscopic @ q) if speed else 0.0
        gap = squared + elastic * self.squared[:, None]
        rest = held + turned
        other = rest.conj() if turning else held - turned
        change = np.sum(rest * other / np.where(gap != 0.0, gap, np.inf), axis=0)
        if self.lumping is not None:
            change = change - squared * np.sum((q.conj() if turning else q) * (self.lumping @ q), axis=0)
        return np.abs(change)


def _on_free_dofs(rows: np.ndarray, dofs: np.ndarray, T: sp.csr_array) -> sp.csr_array:
    """Rows (e, b, d) on the dofs (e, d) of their elements as rows on the free dofs, (e b, n)."""
    count = rows.shape[0] * rows.shape[1]
    at = np.repeat(np.arange(count), rows.shape[2])
    columns = np.repeat(dofs, rows.shape[1], axis=0).ravel()
    return sp.csr_array(sp.csr_array((rows.ravel(), (at, columns)), shape=(count, T.shape[0])) @ T)
