"""How many modes to expect below a frequency, from the waves that fit on the shafts (Weyl's count), before anything is solved.

Each wave of wave number k that a section of length L carries brings k L / pi modes: torsion with sqrt(G/rho), axial with
sqrt(E/rho), and bending in two planes with the two branches of Timoshenko's beam, the positive roots k^2 of

    E I kG A k^4 - (E I rho A + kG A rho I) w^2 k^2 + rho A w^2 (rho I w^2 - kG A) = 0.
"""

from __future__ import annotations

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model

# A request for more modes than this is taken for a mistake: their shapes would fill the memory.
MOST_MODES = 2000

_SHEAR = 0.9  # coefficient of a round section: a count needs no more
_HIGHEST = 1e30  # rad/s; its fourth power is still a number, and far fewer modes than up to there are too many


def expected_modes(model: Model, limit: float) -> float:
    """About how many modes the shafts of a model have up to a frequency in rad/s; gears and springs add a few."""
    count = 0.0
    w = min(limit, _HIGHEST)
    for name, shaft in model.shafts.items():
        for section in shaft.sections:
            if section.rigid:
                continue
            material = model.material_of(name, section)
            outer, bore = section.stiffness_diameters()[:2]
            area = np.pi / 4.0 * (outer**2 - bore**2)
            inertia = np.pi / 64.0 * (outer**4 - bore**4)
            E = material.youngs_modulus
            G = material.g
            rho = material.density
            # a (k^2)^2 - b k^2 + c = 0 for the wave numbers of bending
            a = E * inertia * _SHEAR * G * area
            b = (E * inertia * rho * area + _SHEAR * G * area * rho * inertia) * w**2
            c = rho * area * w**2 * (rho * inertia * w**2 - _SHEAR * G * area)
            root = np.sqrt(max(b**2 - 4.0 * a * c, 0.0))
            squares = [(b + root) / (2.0 * a), (b - root) / (2.0 * a)]
            # A negative square is a near field that decays, not a wave; both planes count.
            bending = 2.0 * sum(np.sqrt(k) for k in squares if k > 0.0)
            wave_number = {"bending": bending, "axial": w * np.sqrt(rho / E), "torsion": w * np.sqrt(rho / G)}
            count += sum(wave_number[motion] for motion in model.motions) * section.length / np.pi
    return count


def check_count(model: Model, fmax: float) -> None:
    """Refuse a frequency in Hz below which there are more modes than can be used, before they are computed.

    Raises:
        AnalysisError: more than `MOST_MODES` are expected.
    """
    expected = expected_modes(model, 2.0 * np.pi * fmax)
    if expected > MOST_MODES:
        raise AnalysisError(f"about {expected:.2g} modes lie below {fmax:g} Hz, more than {MOST_MODES}; ask for fewer")
