"""The oscillator x'' + 2 z x' + g(x) = Fm + Fa cos(W t), g with a dead zone of half width 1, as a model file.

Two equal gears in torsion: x = (d + b)/b with the displacement d along the line of action and half the backlash b; the load on
one gear carries a ripple, damping is proportional to inertia. Exact values by shooting with located switches:
z .05 Fm .1 Fa .05 folds at W .7481043, z .05 Fm .1 Fa .2 doubles its period at W 1.6076657.

    python -m validation.studies.dead_zone
    python -m validation.studies.dead_zone family 0.05,0.1,0.05 0.1,0.1,0.15
    python -m validation.studies.dead_zone jumps

The second prints the special points between W .3 and 1.8 of oscillators z,Fm,Fa by both methods, side by side: what one finds and
the other does not is spurious or missed. The third sweeps that with Fa .05 up and down, and prints between which speeds its
motion jumps: the folds have to lie there.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass

import numpy as np

import rotorgear as rg

TEETH = 20
HALF_BACKLASH = 20e-6
STIFFNESS = 1e8
_RADIUS = 0.05
_INERTIA = 2e-3


@dataclass(frozen=True)
class DeadZone:
    """The oscillator: damping ratio, mean force and amplitude of the force, over k b."""

    ratio: float = 0.05
    mean: float = 0.1
    amplitude: float = 0.05

    @property
    def frequency(self) -> float:
        """sqrt(k/m) in rad/s."""
        return float(np.sqrt(STIFFNESS / (_INERTIA / (2.0 * _RADIUS**2))))

    def speed(self, W: float) -> float:
        """Speed in rad/s at which the ripple comes with W sqrt(k/m)."""
        return W * self.frequency / TEETH

    def text(self, W: float = 1.0) -> str:
        """The model file at a frequency ratio."""
        gears = "".join(
            f"""
[shafts.{shaft}]

[gears.{gear}]
shaft = "{shaft}"
at = "start"
kind = "spur"
teeth = {TEETH}
base_radius = {_RADIUS}
mass = 1.8
polar_inertia = {_INERTIA}
diametral_inertia = 1e-3
"""
            for shaft, gear in (("a", "pinion"), ("b", "wheel"))
        )
        return f"""schema_version = 1
title = "Oscillator with a dead zone"
motions = ["torsion"]

[operation]
input_shaft = "a"
speed = {self.speed(W)!r}

[damping]
rayleigh_alpha = {2.0 * self.ratio * self.frequency!r}

[loads.drive]
shaft = "a"
kind = "input"
torque = {self.mean * STIFFNESS * HALF_BACKLASH * _RADIUS!r}
ripple = {2.0 * self.amplitude / self.mean!r}
ripple_order = {TEETH}

[loads.driven]
shaft = "b"
kind = "output"
{gears}
[meshes.pair]
pinion = "pinion"
gear = "wheel"
stiffness = {STIFFNESS!r}
centre_line_angle = 0
pressure_angle = "20 deg"
backlash = {2.0 * HALF_BACKLASH!r}
"""

    def orbits(self, W: tuple[float, float], **options: object) -> rg.OrbitsResult:
        """The periodic motions over a range of frequency ratios."""
        ends = [self.speed(one) for one in W]
        return rg.orbits(rg.loads(self.text(W[0])), {"operation.speed": ends}, **options)  # type: ignore[arg-type]

    def ratio_of(self, speed: float) -> float:
        """W at a speed in rad/s."""
        return speed * TEETH / self.frequency


def main() -> None:
    """Print special points, extremes and multipliers of both cases by both methods."""
    for amplitude, ends in ((0.05, (0.3, 1.8)), (0.2, (1.5, 1.8))):
        case = DeadZone(amplitude=amplitude)
        for method in ("shooting", "harmonic balance"):
            found = case.orbits(ends, method=method)
            mu = np.where(np.isnan(found.multipliers), 1.0, found.multipliers)
            exact = np.exp(-2.0 * case.ratio * case.frequency * found.period)
            print(
                f"Fa {amplitude}, {method}: {len(found.value)} points, {1e3 * found.cpu_per_point:.0f} ms CPU a point"
            )
            print(
                f"  product of multipliers over exp(-2 z T), less 1: {np.abs(mu.prod(axis=1) / exact - 1.0).max():.1e}"
            )
            for point in found.special_points:
                low, high = 1.0 + point.approach_extremes[0] / HALF_BACKLASH
                sizes = ", ".join(f"{x:.6f}" for x in point.multiplier_real)
                W = case.ratio_of(point.value)
                print(f"  {point.kind} at W {W:.7f}, x {low:.6f} to {high:.6f}, multipliers {sizes}")


# Frequency ratios of the sweep: close about both folds of the first oscillator.
SWEPT = (
    0.448,
    0.4495,
    0.4503,
    0.4508,
    0.452,
    0.455,
    0.46,
    0.5,
    0.55,
    0.6,
    0.65,
    0.7,
    0.72,
    0.735,
    0.742,
    0.7465,
    0.7478,
    0.7484,
    0.75,
)


def jumps() -> dict[str, tuple[float, float]]:
    """Frequency ratios between which a sweep of the first oscillator jumps, by its direction."""
    case = DeadZone()
    over = {"operation.speed": [case.speed(W) for W in SWEPT]}
    found = rg.sweep(rg.loads(case.text(SWEPT[0])), over, direction="both", discard=400, sample=50, exponents=0)
    at = np.abs(np.diff(np.log(found.peak_to_peak[:, :, 0]), axis=0)).argmax(axis=0)
    return {run: (SWEPT[i], SWEPT[i + 1]) for run, i in zip(found.run, at, strict=True)}


def family(cases: list[str]) -> None:
    """Print the special points of oscillators "z,Fm,Fa" by shooting and by harmonic balance."""
    for text in cases:
        case = DeadZone(*(float(value) for value in text.split(",")))
        for method in ("shooting", "harmonic balance"):
            found = case.orbits((0.3, 1.8), method=method)
            points = ", ".join(f"{point.kind} {case.ratio_of(point.value):.6f}" for point in found.special_points)
            ends = "; ".join(branch.ended for branch in found.branches)
            print(f"{text} {method}: {points or 'none'} ({len(found.value)} points, {ends})", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["family"]:
        family(sys.argv[2:])
    elif sys.argv[1:2] == ["jumps"]:
        for run, (low, high) in jumps().items():
            print(f"{run}: jumps between W {low} and {high}")
    else:
        main()
