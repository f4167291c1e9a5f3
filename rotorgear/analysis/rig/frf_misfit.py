"""Measured frequency responses beside those of a model with free numbers: the logarithm of their ratio at every frequency.

    r = ln(H_rig / H_model),    dr/dx = -H_model' / H_model

A peak that lies elsewhere leaves differences |H_rig - H_model| that no small step lessens, while those of the logarithm fall all
the way to where the peaks meet (Balmes 1993, A finite element updating procedure using frequency response functions, IMAC 11).
On the way there both are smoothed alike over a band, so that peaks are as wide as they are apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.rig.measured import MeasuredFrf
from rotorgear.analysis.rig.receptance_model import ReceptanceModel, Receptances
from rotorgear.analysis.rig.rig_model import RigModel, RigModes
from rotorgear.errors import AnalysisError

# So many frequencies are enough for all resonances of a band; more are left out evenly.
MOST_FREQUENCIES = 500
# Noise is never below that of a response of this share of the pair's root mean square.
_FLOOR = 0.01
# Width of the band that is smoothed over, as a share of the frequency, and noise of the logarithm, where looseness is 1.
_SMOOTHED = 0.2
_LOOSE = 0.5
# Smoothed responses are further apart than by this factor, or point against each other by this cosine, for other reasons.
_OTHER_SIZE = 20.0
_OTHER_SIGN = -0.5


@dataclass
class FrfMisfit:
    """Measured responses of p pairs of places beside a model.

    Attributes:
        model: with its mesh and speed.
        given: what was measured.
        noise: standard deviation of a response, as a share of its size.
        modal_damping: damping ratio added to every elastic mode.
    """

    model: RigModel
    given: MeasuredFrf
    noise: float
    modal_damping: float

    def __post_init__(self) -> None:
        self._seen: tuple[bytes, Receptances] | None = None
        for name, row in zip(self.names, self.given.receptance, strict=True):
            dead = np.flatnonzero(~(np.abs(row) > 0.0) | ~np.isfinite(row))
            if dead.size:
                more = f" and {dead.size - 1} more frequencies" if dead.size > 1 else ""
                raise AnalysisError(
                    f"the measured response {name} is 0 or no number at {self.given.frequency_hz[dead[0]]:.6g} Hz{more}: leave "
                    "it out of the file"
                )

    @property
    def names(self) -> tuple[str, ...]:
        """Of the pairs."""
        pairs = zip(self.given.responses, self.given.references, strict=True)
        return tuple(f"{response} over {reference}" for response, reference in pairs)

    @cached_property
    def frequency_hz(self) -> NDArray[np.float64]:
        """The frequencies that count (f,)."""
        return self.given.frequency_hz[self._at]

    @cached_property
    def measured(self) -> NDArray[np.complex128]:
        """Measured receptances there (p, f)."""
        return self.given.receptance[:, self._at]

    @cached_property
    def notes(self) -> tuple[str, ...]:
        """What is left out."""
        every = len(self.given.frequency_hz)
        if len(self._at) == every:
            return ()
        return (f"{len(self._at)} of {every} frequencies of the measured responses are compared, evenly chosen",)

    @cached_property
    def _at(self) -> NDArray[np.intp]:
        every = len(self.given.frequency_hz)
        return np.unique(np.linspace(0, every - 1, min(every, MOST_FREQUENCIES)).round().astype(np.intp))

    @cached_property
    def _receptances(self) -> ReceptanceModel:
        outputs = tuple(dict.fromkeys(self.given.responses))
        inputs = tuple(dict.fromkeys(self.given.references))
        return ReceptanceModel(self.model, self.frequency_hz, outputs, inputs, self.modal_damping)

    def computed(self, x: NDArray[np.float64], modes: RigModes) -> NDArray[np.complex128]:
        """Receptances of the model (p, f)."""
        return self._of_pairs(self._look(x, modes).H[None])[0]

    def residual(
        self, x: NDArray[np.float64], modes: RigModes, looseness: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Real and imaginary parts of r, and their standard deviations, (p, 2 f) each."""
        S = self._smoothing(looseness)
        rig = self.measured @ S.T
        ratio = np.log(rig / (self.computed(x, modes) @ S.T))
        floor = _FLOOR * np.sqrt(np.mean(np.abs(self.measured) ** 2, axis=1, keepdims=True))
        sigma = self.noise * np.sqrt(1.0 + (floor / np.abs(rig)) ** 2) / np.sqrt(2.0)
        if looseness:
            # Smoothed over a band, neighbours tell the same.
            span = max(float(np.log(self.frequency_hz[-1] / self.frequency_hz[0])), 1e-3)
            alike = max(1.0, len(self.frequency_hz) * _SMOOTHED * looseness / span)
            sigma = np.hypot(sigma, _LOOSE * looseness) * np.sqrt(alike)
        return np.hstack([ratio.real, ratio.imag]), np.hstack([sigma, sigma])

    def slopes(self, x: NDArray[np.float64], modes: RigModes, looseness: float) -> NDArray[np.float64]:
        """d ln H_model / dx (p, 2 f, k) of k numbers."""
        S = self._smoothing(looseness)
        here = self._look(x, modes)
        H = self._of_pairs(here.H[None])[0] @ S.T
        change = self._of_pairs(self._receptances.slopes(x, here)) @ S.T
        rate = np.transpose(change / H, (1, 2, 0))
        return np.concatenate([rate.real, rate.imag], axis=1)

    def doubts(self, x: NDArray[np.float64], modes: RigModes) -> list[str]:
        """Responses that are of the other sign or of quite another size, both smoothed: no stiffness does that."""
        S = self._smoothing(1.0)
        said = []
        for name, rig, own in zip(self.names, self.measured @ S.T, self.computed(x, modes) @ S.T, strict=True):
            ratio = float(np.exp(np.mean(np.log(np.abs(rig / own)))))
            cosine = float(np.real(np.vdot(own, rig)) / (np.linalg.norm(own) * np.linalg.norm(rig)))
            if not 1.0 / _OTHER_SIZE < ratio < _OTHER_SIZE:
                said.append(
                    f"{name} was measured {ratio:.2g} times as large as the model has it: is its unit or its place another one"
                )
            elif cosine < _OTHER_SIGN:
                said.append(
                    f"{name} was measured with the other sign: does the sensor or the hammer look the other way"
                )
        return said

    def basis_error(self, x: NDArray[np.float64], modes: RigModes) -> float:
        """Error of the shapes that carry the responses: see `ReceptanceModel.error`."""
        return self._receptances.error(x, self._look(x, modes))

    def _look(self, x: NDArray[np.float64], modes: RigModes) -> Receptances:
        key = x.tobytes()
        if self._seen is None or self._seen[0] != key:
            here = self._receptances.look(x, modes)
            for name, H in zip(self.names, self._of_pairs(here.H[None])[0], strict=True):
                if not np.all(np.abs(H) > 0.0):
                    raise AnalysisError(
                        f"in the model {name} is 0: a force there moves nothing here; look at directions and places of sensors"
                    )
            self._seen = (key, here)
        return self._seen[1]

    def _of_pairs(self, H: NDArray[np.complex128]) -> NDArray[np.complex128]:
        """(a, p, f) of receptances (a, f, o, i)."""
        model = self._receptances
        o = [model.outputs.index(name) for name in self.given.responses]
        i = [model.inputs.index(name) for name in self.given.references]
        return np.transpose(H[:, :, o, i], (0, 2, 1))

    def _smoothing(self, looseness: float) -> NDArray[np.float64]:
        """Weights (f, f) of a mean about each frequency, with those of a resonance as wide as the band."""
        f = self.frequency_hz
        if not looseness:
            return np.eye(len(f))
        width = np.gradient(f) if len(f) > 1 else np.ones(1)
        weights = width / ((f - f[:, None]) ** 2 + (_SMOOTHED * looseness * f[:, None]) ** 2)
        return np.asarray(weights / weights.sum(axis=1, keepdims=True))
