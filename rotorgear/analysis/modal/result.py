"""Makes the result of a modal analysis of eigenvalues and shapes: energies, whirl, words, warnings."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.common.clock import Clock
from rotorgear.analysis.common.notes import left_out, mode_warnings
from rotorgear.analysis.common.pieces import pieces
from rotorgear.analysis.common.points import point_amplitudes
from rotorgear.analysis.common.stations import shapes_at_stations
from rotorgear.analysis.modal.conditioning import conditioning_warnings
from rotorgear.analysis.modal.describe import describe
from rotorgear.analysis.modal.energies import mode_energies
from rotorgear.analysis.modal.modes import Modes
from rotorgear.analysis.modal.whirl import whirl_of, whirl_words
from rotorgear.results.modal import ModalResult
from rotorgear.solvers.sparse.entries import stretches
from rotorgear.system.system import System


def modal_result(
    system: System,
    speed: float | None,
    wanted: tuple[int | None, float | None],
    found: Modes,
    q: np.ndarray,
    estimate: np.ndarray,
    clock: Clock,
) -> ModalResult:
    """Return the result of the modes `found` with all displacements q (a, m); `wanted` is modes and highest frequency in Hz."""
    asked, fmax = wanted
    nodes, displaced = shapes_at_stations(system, q)
    everywhere = _turned(displaced)
    shapes = everywhere[: len(system.nodes)]
    energies = mode_energies(system, speed or 0.0, q, found.rigid)
    whirl = whirl_of(system, shapes, speed or 0.0)
    real_root = (found.eigenvalues.imag == 0.0) & ~found.rigid
    lines = describe(system, q, energies, found.rigid, real_root)
    clock.lap("energies")
    return ModalResult(
        model=system.model,
        speed=speed,
        eigenvalues=found.eigenvalues,
        rigid=found.rigid,
        shapes=everywhere,
        nodes=nodes,
        error_estimate=estimate,
        kinetic_energy=energies.kinetic,
        strain_energy=energies.strain,
        kinetic_by_motion=energies.kinetic_by_motion,
        strain_by_motion=energies.strain_by_motion,
        whirl=whirl_words(whirl, energies),
        whirl_by_shaft=whirl.net,
        description=lines,
        backward_error=found.backward_error,
        dofs=system.n,
        discretisation=pieces(system),
        seconds=clock.total(),
        left_out=(*left_out(system, speed), *found.groups),
        warnings=(
            *mode_warnings(system, asked, found.eigenvalues, fmax),
            *conditioning_warnings(system, speed, found.eigenvalues, found.rigid, energies.strain),
        ),
        method=found.method,
        point_amplitudes=point_amplitudes(system, nodes, everywhere),
    )


def _largest(shapes: np.ndarray) -> np.ndarray:
    """The entry of the largest size, the first of such, in each mode (m,) of shapes (p, d, m)."""
    modes = shapes.shape[2]
    found = np.zeros(modes, dtype=shapes.dtype)
    size = np.full(modes, -1.0)
    for nodes in stretches(len(shapes)):
        part = shapes[nodes].reshape(-1, modes)
        sizes = np.abs(part)
        place = (sizes.argmax(axis=0), np.arange(modes))
        larger = sizes[place] > size
        found = np.where(larger, part[place], found)
        size = np.where(larger, sizes[place], size)
    return found


def _turned(shapes: np.ndarray) -> np.ndarray:
    """Complex shapes, each mode's phase turned so that its largest displacement is real and positive.

    An eigenvector has no phase of its own; without this choice the same mode would look different from run to run.
    """
    if shapes.shape[2] == 0:
        return shapes.astype(complex)
    peak = _largest(shapes[:, :3])
    rotation = _largest(shapes[:, 3:])
    # A mode that only tilts or twists has no displacement to speak of: its largest rotation is turned then.
    peak = np.where(np.abs(peak) <= 1e-9 * np.abs(rotation), rotation, peak)
    turn = np.where(peak != 0.0, np.conj(peak) / np.where(peak != 0.0, np.abs(peak), 1.0), 1.0)
    if np.iscomplexobj(shapes):
        return np.asarray(shapes * turn)
    turned = np.zeros(shapes.shape, dtype=complex)
    np.multiply(shapes, turn, out=turned.real)
    return turned
