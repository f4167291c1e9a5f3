"""What an analysis says beside its numbers: what was left out and why, and warnings."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.analysis.common.gear_bodies import body_notes
from rotorgear.analysis.common.load_notes import load_notes
from rotorgear.analysis.common.mesh_notes import mesh_stiffness_left_out, mesh_stiffness_warnings
from rotorgear.model.model import Model
from rotorgear.model.parts.supports import element_law
from rotorgear.system.system import System


def rolling_notes(model: Model, *, rolls: bool) -> Iterator[str]:
    """Say which of the two descriptions of a bearing with rolling elements counts, for the two need not agree.

    Args:
        model: the model.
        rolls: whether the analysis takes the rolling elements (transient, sweep), or the stiffness (statics, linear analyses).
    """
    said = (
        "its rolling elements carry, not its stiffness, which statics and linear analyses take"
        if rolls
        else "its stiffness carries, not its rolling elements, which transients and sweeps take"
    )
    for name, bearing in model.bearings.items():
        if bearing.rolling is not None and bearing.stiffness is not None:
            yield f"bearings.{name}: {said}"


def left_out(system: System, speed: float | None, *, rolls: bool = False) -> tuple[str, ...]:
    """Say what this analysis did not build or solve, and why; `rolls`: whether it takes rolling elements."""
    notes = []
    absent = [motion for motion in ("bending", "axial", "torsion") if not system.model.has(motion)]
    if absent:
        notes.append(f"{' and '.join(absent)}: {system.dofs.held['motions']} dofs, not among the motions of the model")
    if system.dofs.held["supports"]:
        notes.append(f"{system.dofs.held['supports']} dofs held fixed by supports")
    if system.dofs.held["rigid sections"]:
        notes.append(f"{system.dofs.held['rigid sections']} dofs tied by rigid sections")
    if speed is None:
        notes.append("gyroscopic matrix: standstill")
        notes.append("damping matrix: an undamped analysis (a --speed, even of 0, takes it in)")
    else:
        if speed == 0.0:
            notes.append("gyroscopic matrix: standstill")
        elif not system.gyroscopic.nnz:
            notes.append("gyroscopic matrix: nothing that turns can tilt")
        if not np.any(system.damping(speed).data) and not system.model.damping.modal_ratio:
            # The law of a nonlinear element is in no matrix until it is linearised: a film damps all the same.
            laws = [
                f"nonlinear_elements.{name}"
                for name, element in system.model.nonlinear_elements.items()
                if not element.is_given
                and f"nonlinear_elements.{name}" not in system.state.tangents
                and element_law(element, 1.0).uses_velocity
            ]
            notes.append("damping matrix: " + (f"empty; only {', '.join(laws)} can damp" if laws else "nothing damps"))
    notes += beta_notes(system, speed, rolls=rolls)
    # In time the stiffness varies as it is; what a transient leaves out of it, it says itself.
    meshes = () if rolls else mesh_stiffness_left_out(system)
    loads = load_notes(system, "time" if rolls else "modes")
    return (*notes, *body_notes(system), *rolling_notes(system.model, rolls=rolls), *meshes, *loads)


def beta_notes(system: System, speed: float | None, *, rolls: bool) -> Iterator[str]:
    """Say on which stiffness the damping beta K of the model does not act, where there is such."""
    if speed is None or not system.model.damping.rayleigh_beta:
        return
    if system.circulatory(speed).nnz:
        yield "beta K of circulatory and cross-coupled stiffness: rayleigh_beta acts on the symmetric part of K"
    if rolls:
        laws = [f"nonlinear_elements.{name}" for name in system.model.nonlinear_elements]
        laws += [f"bearings.{name}" for name, bearing in system.model.bearings.items() if bearing.has_law]
        if laws:
            yield (
                f"beta K of {', '.join(laws)}: rayleigh_beta acts on their tangents in linear analyses, in time they damp as "
                "their laws say"
            )


def mode_warnings(
    system: System, asked: int | None, eigenvalues: np.ndarray, fmax: float | None = None
) -> tuple[str, ...]:
    """Say what is odd about a set of modes: merged nodes, fewer modes than asked for, unstable ones."""
    notes = [*system.nodes.merged, *mesh_stiffness_warnings(system)]
    if not len(eigenvalues) and fmax is not None:
        notes.append(f"no mode lies at or below {fmax:g} Hz")
    elif asked is not None and fmax is None and len(eigenvalues) < asked:
        notes.append(
            f"asked for {asked} modes, but this model has only {len(eigenvalues)} with inertia; all are listed"
        )
    unstable = int(np.sum(eigenvalues.real > 1e-9 * np.abs(eigenvalues)))
    if unstable:
        notes.append(f"{unstable} unstable mode{'s' if unstable > 1 else ''}: negative damping ratio, the motion grows")
    gathers = gathering(system)
    if gathers is not None and np.any((eigenvalues.imag == 0.0) & (np.abs(eigenvalues) >= gathers)):
        notes.append(
            f"damping in proportion to the stiffness gathers overdamped modes without end at {gathers / (2.0 * np.pi):.4g} Hz: "
            "those from there on are not all that there are"
        )
    return tuple(notes)


def gathering(system: System) -> float | None:
    """Lowest |s| in rad/s, 1/b, at which overdamped modes gather where damping b K goes with the stiffness; None without."""
    given = [shaft.internal_damping for shaft in system.model.shafts.values()]
    b = system.model.damping.rayleigh_beta + max(given, default=0.0)
    return 1.0 / b if b > 0.0 else None
