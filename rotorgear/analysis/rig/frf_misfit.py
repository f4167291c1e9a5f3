"""Measured frequency responses beside those of a model with free numbers: the logarithm of their ratio at every frequency.

    r = ln(H_rig / H_model),    dr/dx = -H_model' / H_model

A peak that lies elsewhere leaves differences |H_rig - H_model| that no small step lessens, while those of the logarithm fall all
the way to where the peaks meet (Balmes 1993, A finite element updating procedure using frequency response functions, IMAC 11).
On the way there both are smoothed alike over a band, so that peaks are as wide as they are apart.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.rig.measured import MeasuredFrf
from rotorgear.analysis.rig.receptance_model import ReceptanceModel, Receptances
from rotorgear.analysis.rig.rig_model import RigModel, RigModes
from rotorgear.errors import AnalysisError
from rotorgear.note import Note

# Frequencies that are compared at most: enough for all resonances of a band. Of more, evenly spaced ones are kept.
MOST_FREQUENCIES = 500
# Noise is never below that of a response of this share of the pair's root mean square.
_FLOOR = 0.01
# Width of the band that is smoothed over, as a share of the frequency, and noise of the logarithm, where looseness is 1.
_SMOOTHED = 0.2
_LOOSE = 0.5
# Smoothed responses are further apart than by this factor, or point against each other by this cosine, for other reasons.
_OTHER_SIZE = 20.0
_OTHER_SIGN = -0.5


class FrfMisfit:
    """Measured responses of p pairs of places beside a model.

    Args:
        model: with its mesh and speed.
        given: what was measured.
        noise: standard deviation of a response, as a share of its size.
        modal_damping: damping ratio added to every elastic mode.

    Attributes:
        given: what was measured; frequency_hz, measured: the frequencies that count (f,), and the receptances there (p, f).
        notes: what is left out.
    """

    def __init__(self, model: RigModel, given: MeasuredFrf, noise: float, modal_damping: float) -> None:
        self.given = given
        self._noise = noise
        pairs = zip(given.responses, given.references, strict=True)
        self._names = tuple(f"{response} over {reference}" for response, reference in pairs)
        for name, row in zip(self._names, given.receptance, strict=True):
            dead = np.flatnonzero(~(np.abs(row) > 0.0) | ~np.isfinite(row))
            if dead.size:
                more = f" and {dead.size - 1} more frequencies" if dead.size > 1 else ""
                raise AnalysisError(
                    f"the measured response {name} is 0 or no number at {given.frequency_hz[dead[0]]:.6g} Hz{more}: leave it "
                    "out of the file"
                )
        every = len(given.frequency_hz)
        at = np.unique(np.linspace(0, every - 1, min(every, MOST_FREQUENCIES)).round().astype(np.intp))
        self.frequency_hz = given.frequency_hz[at]
        self.measured = given.receptance[:, at]
        compared = f"{len(at)} of {every} frequencies of the measured responses are compared, evenly chosen"
        self.notes = (compared,) if len(at) < every else ()
        outputs = tuple(dict.fromkeys(given.responses))
        inputs = tuple(dict.fromkeys(given.references))
        self._receptances = ReceptanceModel(model, self.frequency_hz, outputs, inputs, modal_damping)
        # Output and input of each pair.
        self._of_pair = (
            [outputs.index(name) for name in given.responses],
            [inputs.index(name) for name in given.references],
        )
        self._seen: tuple[bytes, Receptances] | None = None

    def computed(self, x: NDArray[np.float64], modes: RigModes) -> NDArray[np.complex128]:
        """Receptances of the model (p, f)."""
        return self._of_pairs(self._look(x, modes).H)

    def residual(
        self, x: NDArray[np.float64], modes: RigModes, looseness: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Real and imaginary parts of r, and their standard deviations, (p, 2 f) each."""
        S = self._smoothing(looseness)
        rig = self.measured @ S.T
        ratio = np.log(rig / (self.computed(x, modes) @ S.T))
        floor = _FLOOR * np.sqrt(np.mean(np.abs(self.measured) ** 2, axis=1, keepdims=True))
        sigma = self._noise * np.sqrt(1.0 + (floor / np.abs(rig)) ** 2) / np.sqrt(2.0)
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
        H = self._of_pairs(here.H) @ S.T
        change = self._of_pairs(self._receptances.slopes(x, here)) @ S.T
        rate = np.transpose(change / H, (1, 2, 0))
        return np.concatenate([rate.real, rate.imag], axis=1)

    def doubts(self, x: NDArray[np.float64], modes: RigModes) -> Iterator[Note]:
        """Responses that are of the other sign or of quite another size, both smoothed: no stiffness does that."""
        S = self._smoothing(1.0)
        for name, rig, own in zip(self._names, self.measured @ S.T, self.computed(x, modes) @ S.T, strict=True):
            ratio = float(np.exp(np.mean(np.log(np.abs(rig / own)))))
            cosine = float(np.real(np.vdot(own, rig)) / (np.linalg.norm(own) * np.linalg.norm(rig)))
            if not 1.0 / _OTHER_SIZE < ratio < _OTHER_SIZE:
                what = f"{name} was measured {ratio:.2g} times as large as the model has it"
                yield Note("", what, "is its unit or its place another one")
            elif cosine < _OTHER_SIGN:
                what = f"{name} was measured with the other sign"
                yield Note("", what, "does the sensor or the hammer look the other way")

    def basis_error(self, x: NDArray[np.float64], modes: RigModes) -> float:
        """Error of the shapes that carry the responses: see `ReceptanceModel.error`."""
        return self._receptances.error(x, self._look(x, modes))

    def _look(self, x: NDArray[np.float64], modes: RigModes) -> Receptances:
        key = x.tobytes()
        if self._seen is None or self._seen[0] != key:
            here = self._receptances.look(x, modes)
            for name, H in zip(self._names, self._of_pairs(here.H), strict=True):
                if not np.all(np.abs(H) > 0.0):
                    raise AnalysisError(
                        f"in the model {name} is 0: a force there moves nothing here; look at directions and places of sensors"
                    )
            self._seen = (key, here)
        return self._seen[1]

    def _of_pairs(self, H: NDArray[np.complex128]) -> NDArray[np.complex128]:
        """(..., p, f) of receptances (..., f, o, i)."""
        return np.swapaxes(H[..., *self._of_pair], -1, -2)

    def _smoothing(self, looseness: float) -> NDArray[np.float64]:
        """Weights (f, f) of a mean about each frequency, with those of a resonance as wide as the band."""
        f = self.frequency_hz
        if not looseness:
            return np.eye(len(f))
        width = np.gradient(f) if len(f) > 1 else np.ones(1)
        weights = width / ((f - f[:, None]) ** 2 + (_SMOOTHED * looseness * f[:, None]) ** 2)
        return np.asarray(weights / weights.sum(axis=1, keepdims=True))
