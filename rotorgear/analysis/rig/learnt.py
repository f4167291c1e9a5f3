"""How much the matched lines of a rig teach of the stiffnesses of a model, before anybody updates it.

d ln f / d ln k of a spring is half its share in the strain energy of the mode (Rayleigh's quotient: Fox and Kapoor 1968, Rates of
change of eigenvalues and eigenvectors, AIAA Journal 6), so a modal analysis holds all that is needed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rotorgear.analysis.rig.posterior import Posterior
from rotorgear.model.layout.state import SPRING_TABLES
from rotorgear.results.comparison import LearntParameter, RigLine

# What a designer usually knows of the stiffness of a mesh, bearing or support, and what a rig of a frequency that states nothing.
STIFFNESS_PRIOR = 0.30
LINE_NOISE = 0.005
# Stiffness of shafts, casings and elastic gears follows from drawings and a modulus known to a few per cent.
SPRINGS = ("meshes", *SPRING_TABLES)


def learnt_stiffnesses(
    strain_energy: Mapping[str, ArrayLike], modes: Sequence[int], lines: Sequence[RigLine]
) -> tuple[LearntParameter, ...]:
    """Return what each spring's stiffness is known to once mode `modes[k]` is held to `lines[k]`.

    Args:
        strain_energy: share of each part in the strain energy of all m modes, part -> (m,).
        modes: index of the mode of each matched line (n).
        lines: the matched lines (n).
    """
    springs = _springs(strain_energy)
    if not springs or not lines:
        return ()
    shares = spring_shares(strain_energy, np.array(modes))
    posterior = Posterior(
        jacobian=0.5 * shares.T,
        noise=np.array([line_noise(line) for line in lines]),
        prior=np.full(len(springs), STIFFNESS_PRIOR),
    )
    rows = zip(springs, posterior.sigma, posterior.learnt, strict=True)
    return tuple(
        LearntParameter(f"{part}.stiffness", STIFFNESS_PRIOR, float(sigma), float(learnt))
        for part, sigma, learnt in rows
    )


def spring_shares(strain_energy: Mapping[str, ArrayLike], modes: NDArray[np.intp]) -> NDArray[np.float64]:
    """Share of each spring in the strain energy of some modes, (springs, modes)."""
    rows = [np.asarray(strain_energy[part], dtype=float)[modes] for part in _springs(strain_energy)]
    return np.array(rows).reshape(-1, len(modes))


def _springs(strain_energy: Mapping[str, ArrayLike]) -> list[str]:
    return [part for part in strain_energy if part.partition(".")[0] in SPRINGS]


def line_noise(line: RigLine) -> float:
    """Relative standard deviation of a line: its own, else 0.5 %."""
    # A line that claims to be exact would settle one direction entirely; no reading is better than rounding.
    return LINE_NOISE if line.uncertainty_hz is None else max(line.uncertainty_hz / line.frequency_hz, 1e-12)
