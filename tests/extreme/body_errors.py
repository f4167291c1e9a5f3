"""Errors of casings, and of what is asked of many models at once: scatter, updates, state spaces."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

import mpmath as mp
import numpy as np

import rotorgear as rg
from tests.bar_casing import write_bar
from tests.extreme.forced_errors import mass_on_spring
from tests.unit.casings.blocks import block_model


def block_modes(
    scale: float = 1.0,
    modulus: float = 200e9,
    nu: float = 0.3,
    density: float = 7800.0,
    counts: tuple[int, int, int] = (2, 1, 3),
    kind: str = "hexahedron20",
) -> rg.CasingResult:
    """Modes of a block of 100 x 60 x 200 mm times a factor, held at its foot."""
    with tempfile.TemporaryDirectory() as folder:
        return rg.casing(block_model(Path(folder), scale, modulus, nu, density, counts, kind), modes=8)


def scaled_block(scale: float, modulus: float = 1.0, density: float = 1.0) -> float:
    """f goes as sqrt(E/rho)/length, exactly."""
    usual = block_modes().casings["box"].held_frequency_hz
    found = block_modes(scale, 200e9 * modulus, density=7800.0 * density).casings["box"].held_frequency_hz
    return float(np.abs(found * scale * np.sqrt(density / modulus) / usual - 1.0).max())


def rod(estimated: bool = False) -> float:
    """A block without lateral contraction: f = sqrt(E/rho)/4L of its axial motion; or that error over the stated one."""
    found = block_modes(nu=0.0, counts=(1, 1, 6)).casings["box"]
    exact = float(mp.sqrt(mp.mpf(200e9) / 7800) / (4 * mp.mpf("0.2")))
    k = int(np.argmin(np.abs(found.held_frequency_hz / exact - 1.0)))
    error = abs(float(found.held_frequency_hz[k]) / exact - 1.0)
    return error / float(found.held_mesh_error[k]) if estimated else error


def stiff_bar(stiffer: float) -> float:
    """A rotor on a casing so stiff that it is the ground, given by its matrices: the frequencies on rigid ground."""

    def rotor(casing: str | None, tables: dict[str, object]) -> rg.Model:
        seat = {"casing": casing} if casing else {}
        return rg.Model(
            shafts={"s": {"sections": [{"length": 0.4, "outer_diameter": 0.03}]}},
            bearings={
                f"seat_{k}": {"shaft": "s", "at": at, "stiffness": {"radial": 1e7, "axial": 1e7}, **seat}
                for k, at in ((1, 0.0), (3, 0.4))
            },
            **tables,
        )

    with tempfile.TemporaryDirectory() as folder:
        z = np.array([-0.1, 0.0, 0.2, 0.4, 0.5])
        file = write_bar(Path(folder) / "bar.npz", z=z, diameter=0.3, seats=[1, 3], held=[0, 4], stiffer=stiffer)
        on_casing = rg.modal(rotor("box", {"casings": {"box": {"matrices": str(file)}}}), modes=8, accuracy=1e-9)
    ground = rg.modal(rotor(None, {}), modes=8, accuracy=1e-9)
    return float(np.abs(on_casing.frequency_hz[~on_casing.rigid] / ground.frequency_hz[~ground.rigid] - 1.0).max())


def state_space_of_mass(stiffness: float, damping: float, ratios: Sequence[float], mass: float = 2.0) -> float:
    """H = 1 / (k - m w^2 + i w c) of the system that is written, at multiples of sqrt(k/m)."""
    w0 = float(np.sqrt(stiffness / mass))
    hertz = np.array(ratios) * w0 / (2.0 * np.pi)
    place = ["bearings.b:x"]
    model = mass_on_spring(stiffness, damping, mass)
    found = rg.state_space(model, inputs=place, outputs=place, fmax=2.0 * float(hertz.max()))
    errors = []
    for f, h in zip(hertz, found.receptance(hertz)[:, 0, 0], strict=True):
        w = 2 * mp.pi * mp.mpf(float(f))
        exact = 1 / mp.mpc(mp.mpf(stiffness) - mp.mpf(mass) * w**2, w * mp.mpf(damping))
        errors.append(float(abs(mp.mpc(complex(h)) / exact - 1)))
    return max(errors)


def scatter_of_spring(stiffness: float, sigma: float) -> float:
    """To first order the frequency of a mass on a spring scatters half as much as the spring."""
    share = f"{100.0 * sigma!r} %"
    found = rg.scatter(mass_on_spring(stiffness, 0.0), "bearings.b.stiffness", sigma=share, modes=2, samples=64)
    return float(max(abs(band.sigma_first_order / (0.5 * sigma) - 1.0) for band in found.bands))


def updated_spring(stiffness: float) -> float:
    """A frequency known to 1e-9 tells the spring of a mass: k = m w^2, whatever its size."""
    model = mass_on_spring(stiffness, 0.0)
    hertz = float(mp.sqrt(mp.mpf(1.02) * mp.mpf(stiffness) / 2) / (2 * mp.pi))
    found = rg.update(model, [rg.RigLine(hertz, uncertainty_hz=1e-9 * hertz)], free="bearings.*.stiffness", prior=0.3)
    return float(abs(found.parameters[0].factor / 1.02 - 1.0))
