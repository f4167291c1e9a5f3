"""The verb `casing`: what the casings of a model are by themselves, from mesh to reduced body, with errors and cost."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rotorgear.analysis.common.request import quantity
from rotorgear.casings.fe_body import FiniteElementBody, finite_element_body
from rotorgear.casings.mesh_error import eigenvalue_errors
from rotorgear.casings.reduction import MeshModes, free_modes, held_modes, reduce, rigid_residual
from rotorgear.casings.settings import BEYOND
from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError
from rotorgear.memory import largest_memory
from rotorgear.model.layout.casings import casing_settings
from rotorgear.model.model import Model, model_hash
from rotorgear.progress import Progress, part_of, silent
from rotorgear.quantity import did_you_mean
from rotorgear.results.casing import CasingRow, CasingSeat, CasingSurvey

_MOST_MODES = 200


def casing(
    model: Model,
    name: str | None = None,
    *,
    modes: int = 10,
    fmax: float | str | None = None,
    progress: Progress = silent,
) -> CasingSurvey:
    """Read, check and reduce the casings of a model, and find the modes of their whole meshes.

    Args:
        model: with casings from meshes.
        name: name of one casing (default: all).
        modes: number of elastic modes that are found, free and held.
        fmax: highest frequency that the reduced body is to serve, in Hz or with its unit, such as "2 kHz", where the file has
            no `modes_to`.
        progress: callable that is told fraction and step.

    Returns:
        Mass, modes, seats, errors and cost of each casing.

    Raises:
        AnalysisError: no casing of that name, or what is wrong with its mesh. MissingExtraError: meshio or scikit-fem is missing.
    """
    clock = Clock()
    if not 1 <= modes <= _MOST_MODES:
        raise AnalysisError(f"modes: got {modes}, expected a number from 1 to {_MOST_MODES}")
    highest = None if fmax is None else quantity(fmax, "frequency", "fmax")
    names = casing_names(model, name)
    rows = {
        one: _row(model, one, modes, highest, part_of(progress, number / len(names), (number + 1) / len(names)))
        for number, one in enumerate(names)
    }
    clock.lap("casings")
    return CasingSurvey(
        title=model.title,
        casings=rows,
        seconds=clock.total(),
        method="Craig-Bampton with residual shapes; modes by Lanczos on the factored stiffness",
        model_hash=model_hash(model),
        settings={"name": name, "modes": modes, "fmax": highest},
    )


def casing_names(model: Model, name: str | None) -> list[str]:
    """Names of all casings from meshes, or the one that is asked for.

    Raises:
        AnalysisError: there is none, or it was reduced elsewhere.
    """
    names = [name] if name is not None else [one for one, part in model.casings.items() if part.matrices is None]
    if not model.casings:
        raise AnalysisError("casing: the model has no casing; give it one under [casings], with its mesh")
    if name is not None and name not in model.casings:
        hint = did_you_mean(name, model.casings, f"the model has: {', '.join(model.casings)}")
        raise AnalysisError(f"casing: the model has no casing {name!r}; {hint}")
    if not names or model.casings[names[0]].matrices is not None:
        raise AnalysisError("casing: this casing has no mesh; its matrices come from elsewhere")
    return names


def _row(model: Model, name: str, count: int, fmax: float | None, tell: Progress) -> CasingRow:
    settings = casing_settings(model, name)
    clock = Clock()
    fe = finite_element_body(settings, part_of(tell, 0.0, 0.15))
    clock.lap("reading and assembly")
    body, factor = reduce(fe, settings.modes_to or (BEYOND * fmax if fmax else None), part_of(tell, 0.15, 0.55))[:2]
    clock.lap("reduction")
    count = min(count, len(fe.mesh.points))
    # The factor of the reduction serves again where it is that of the body without rigid seats.
    again = factor if settings.connection == "mean" or not fe.seats else None
    del factor
    held = MeshModes(np.zeros(0), np.zeros((fe.dofs, 0)))
    if body.held:
        held = held_modes(fe, count, again, part_of(tell, 0.55, 0.7))
    if len(fe.held):
        again = None
    free = free_modes(fe, count, again, part_of(tell, 0.7, 0.9))
    clock.lap("modes of the mesh")
    tell(0.9, f"{settings.address}: error of the mesh")
    free_error = _mesh_error(fe, free)
    held_error = _mesh_error(fe, held)
    clock.lap("error of the mesh")
    residual, rigid_frequency = rigid_residual(fe)
    frequency, shapes = body.modes()
    first = 0 if body.held else 6
    chosen = range(first, min(first + count, body.size))
    errors = [body.eigenvalue_error((2.0 * np.pi * frequency[i]) ** 2, shapes[:, i]) or 0.0 for i in chosen]
    mass, centre, inertia = fe.mass_properties
    nodes, surface_nodes = len(fe.mesh.points), np.unique(fe.mesh.boundary)
    assert body.surface is not None, "a body of a mesh has a surface"
    tell(1.0, f"{settings.address}: done")
    # Stiffness of each seat: of a body that is held with the other seats free, else with them held.
    K = body.stiffness[: body.interface, : body.interface]
    flexibility = np.linalg.inv(K) if body.held else None
    seats = []
    for number, (seat, patch) in enumerate(zip(body.seats, fe.seats, strict=True)):
        own = slice(6 * number, 6 * number + 6)
        stiffness = K[own, own] if flexibility is None else np.linalg.inv(flexibility[own, own])
        others = "held" if flexibility is None else "free"
        seats.append(CasingSeat(seat, patch.point, patch.area, len(patch.nodes), stiffness, others))
    return CasingRow(
        files=tuple(Path(path).name for _, path in settings.files),
        element=fe.mesh.kind,
        elements=len(fe.mesh.cells),
        nodes=nodes,
        dofs=fe.dofs,
        size_m=np.ptp(fe.mesh.points, axis=0),
        mass_kg=mass,
        centre_m=centre,
        inertia_kg_m2=inertia,
        connection=settings.connection,
        jacobian_least=fe.mesh.jacobian_low,
        straightened=tuple(number + 1 for number in fe.mesh.straightened),
        rigid_residual=residual,
        rigid_frequency_hz=rigid_frequency,
        free_frequency_hz=free.frequency,
        free_mesh_error=free_error,
        held_frequency_hz=held.frequency,
        held_mesh_error=held_error,
        fixed_frequency_hz=body.fixed_frequency,
        coordinates=body.size,
        reduced_frequency_hz=frequency[list(chosen)],
        reduction_error=0.5 * np.array(errors),
        seats=tuple(seats),
        notes=fe.mesh.notes,
        memory_bytes=largest_memory(),
        seconds=clock.laps,
        points=body.surface.points,
        triangles=body.surface.triangles,
        free_shapes=free.shapes.reshape(nodes, 3, -1)[surface_nodes],
        held_shapes=held.shapes.reshape(nodes, 3, -1)[surface_nodes],
    )


def _mesh_error(fe: FiniteElementBody, modes: MeshModes) -> np.ndarray:
    """Relative error (k,) of the frequencies of modes of the mesh: half of that of λ."""
    if not len(modes.eigenvalues):
        return np.zeros(0)
    return np.asarray(0.5 * eigenvalue_errors(fe, modes.eigenvalues, modes.shapes) / modes.eigenvalues)
