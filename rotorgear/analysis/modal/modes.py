"""What is asked of the eigensolvers of a model, and what they give."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Wanted:
    """What a modal analysis is asked for.

    Attributes:
        speed: of the reference shaft in rad/s; None is undamped at standstill.
        modes: how many modes; limit: all of them up to this |s| in rad/s. None is no such limit.
        only: motions that a group of dofs must have to be solved; empty for all.
        pruning: False solves all dofs as one group, for comparison.
        damped: False leaves out, at a speed, all that takes energy out or brings it in: what is left is gyroscopic.
        dofs: of which a group must have one to be solved; None: all groups are.
    """

    speed: float | None
    modes: int | None
    limit: float | None
    only: tuple[str, ...] = ()
    pruning: bool = True
    damped: bool = True
    dofs: frozenset[int] | None = None


@dataclass(frozen=True)
class Modes:
    """What the solvers give: eigenvalues s (m,), free shapes (n, m), rigid (m,), backward error (m,), sentences.

    `available` is the number of modes that the model has, None where it was not counted; `groups` says how the dofs fell apart.
    """

    eigenvalues: np.ndarray
    vectors: np.ndarray
    rigid: np.ndarray
    backward_error: np.ndarray
    method: str
    available: int | None
    groups: tuple[str, ...] = ()

    @property
    def is_complete(self) -> bool:
        """Whether these are all the modes that the discretised model has."""
        return self.available is not None and len(self.eigenvalues) >= self.available

    def first(self, count: int) -> Modes:
        """The first modes only."""
        columns = slice(count)
        return replace(
            self,
            eigenvalues=self.eigenvalues[columns],
            vectors=self.vectors[:, columns],
            rigid=self.rigid[columns],
            backward_error=self.backward_error[columns],
        )
