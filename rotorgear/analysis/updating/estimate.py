"""The most probable numbers of a model beside a rig: loose steps that find the pairs, then Gauss-Newton steps that are held back.

x = S W^T (1 + W W^T)^-1 N^-1 (y - f(x_k) + J x_k),    W = N^-1 J S      (Tarantola 2005, Inverse problem theory, section 3.4)
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.rig.posterior import Posterior
from rotorgear.analysis.rig.rig_model import ComparedModes
from rotorgear.analysis.updating.misfit import Misfit, Pair, State
from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress

# How much the noise is enlarged on the way, as a share of a shape's root mean square.
_LOOSENESS = (0.5, 0.2, 0.07)
_MOST_SOLUTIONS = 40
_LOOKS = 2
# A step that changes the objective by less than this share moves no number by more than a twentieth of what it is known to.
_AT_REST = 1e-5
# A misfit of so many times the number of values, and steps that lessen it by less than this share.
_MISFIT = 2.0
_CRAWL = 0.01


@dataclass(frozen=True)
class Estimate:
    """Steps towards the least misfit."""

    misfit: Misfit

    def start(self) -> State:
        """The state of the file's numbers."""
        x = np.zeros(len(self.misfit.model.numbers.addresses))
        modes = self.misfit.model.modes(x)
        return self.misfit.beside(x, modes, self.misfit.pairs(x, modes, None))

    def approach(self, start: State, progress: Progress) -> State:
        """One step each against noise that is less and less enlarged; modes are paired anew after each.

        Far from the truth close modes stand in for each other, and full trust in a wrong pair would lead astray.
        """
        state = start
        posterior = None
        for k, looseness in enumerate(_LOOSENESS):
            progress(0.1 + 0.1 * k, f"approach {k + 1}")
            loose = replace(self.misfit, looseness=looseness)
            state = loose.beside(state.x, state.modes, loose.pairs(state.x, state.modes, posterior))
            posterior = loose.linear(state)
            x = posterior.estimate(state.residual + posterior.jacobian @ state.x)
            modes = self.misfit.model.modes(x)
            state = loose.beside(x, modes, state.pairs)
        return self.misfit.beside(x, modes, self.misfit.pairs(x, modes, posterior))

    def estimate(self, state: State, progress: Progress) -> tuple[State, Posterior]:
        """The most probable x and the posterior about it, by steps of Levenberg (1944) and Marquardt (1963).

        With `damping` 0 a step is Gauss-Newton's. Where the objective would grow, it is held back in the metric of the priors.
        Pairs are looked at again when it rests.
        """
        posterior = self.misfit.linear(state)
        damping = 0.0
        looked = 0
        while self.misfit.model.solutions < _MOST_SOLUTIONS:
            progress(
                0.4 + 0.5 * self.misfit.model.solutions / _MOST_SOLUTIONS,
                f"modal solution {self.misfit.model.solutions + 1}",
            )
            # |N^-1 (r - J d)|^2 + |S^-1 (x + d)|^2 + damping |S^-1 d|^2, squared out for d, is a prior about -x / (1 + damping).
            pull = state.x / (1.0 + damping)
            held = Posterior(posterior.jacobian, posterior.noise, posterior.prior / np.sqrt(1.0 + damping))
            step = held.estimate(state.residual + posterior.jacobian @ pull) - pull
            x = state.x + step
            modes = self.misfit.model.modes(x)
            trial = self.misfit.beside(x, modes, _followed(state, modes))
            gain = state.objective - trial.objective
            level = abs(gain) < _AT_REST * max(1.0, state.objective)
            if gain < 0.0 and not level:
                damping = max(10.0 * damping, 1.0)
                continue
            rests = level and damping < 1.0
            state = trial
            posterior = self.misfit.linear(state)
            damping = 0.1 * damping if damping > 0.1 else 0.0
            crawls = 0.0 <= gain < _CRAWL * state.objective and state.objective > _MISFIT * len(state.residual)
            if crawls and looked < _LOOKS:
                # A misfit that steps no longer lessen is a wrong pair, most likely: all pairs are open again.
                looked += 1
                damping = 0.0
                state = self.approach(state, progress)
                posterior = self.misfit.linear(state)
            elif rests:
                pairs = self.misfit.pairs(state.x, state.modes, posterior)
                other = self.misfit.beside(state.x, state.modes, pairs)
                # Of close modes either may be a line's: as many pairs that fit worse would only be exchanged back.
                worse = len(pairs) == len(state.pairs) and other.objective >= state.objective
                if worse or pairs == state.pairs or looked == _LOOKS:
                    return state, posterior
                looked += 1
                state = other
                posterior = self.misfit.linear(state)
        apart = state.objective / max(len(state.residual), 1)
        remedy = (
            "free fewer numbers, or give smaller priors"
            if apart < _MISFIT
            else "look at units, signs, places of sensors and damping by `rotorgear compare`, or free other numbers"
        )
        raise ConvergenceError(
            f"the update did not come to rest within {_MOST_SOLUTIONS} modal solutions, with a misfit of {apart:.2g} times what "
            f"noise and priors allow: {remedy}"
        )


def _followed(before: State, modes: ComparedModes) -> tuple[Pair, ...]:
    """The pairs of a state with each mode at its new place: the one-to-one assignment of most overlap."""
    from scipy.optimize import linear_sum_assignment

    old = sorted({k for pair in before.pairs for k in pair.near})
    _, new = linear_sum_assignment(-before.modes.overlap(modes)[old])
    now = {k: int(mode) for k, mode in zip(old, new, strict=True)}
    return tuple(Pair(pair.line, now[pair.mode], tuple(sorted(now[k] for k in pair.near))) for pair in before.pairs)
