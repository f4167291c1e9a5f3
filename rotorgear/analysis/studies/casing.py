"""Error against run time of a casing: over the order of its elements, their number, and fixed-interface modes.

A gearbox with the casing is undamped and at standstill. With every node of the casing's mesh beside the rotors, nothing of it
reduced, the unknowns are x = [u of the free nodes; dofs of all else], the motions of seats being means of the nodes' (or, rigid,
unknowns of their own):

    (K_fe + Pᵀ K_r P) x = λ (M_fe + Pᵀ M_r P) x
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.analysis.casing.casing import casing_names
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.study import REPEAT, Judged, Setting, Study
from rotorgear.casings.assembly import assemble as mesh_matrices
from rotorgear.casings.casing import keep
from rotorgear.casings.constrained import lowest_modes
from rotorgear.casings.fe_body import FiniteElementBody, finite_element_body
from rotorgear.casings.mesh_error import eigenvalue_errors
from rotorgear.casings.reduction import MeshModes, free_modes, held_modes, reduce
from rotorgear.casings.split import without_middles
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.casings import casing_settings
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.convergence import ConvergenceStudy
from rotorgear.solvers.sparse.large import factor_positive
from rotorgear.system.assembly import assemble
from rotorgear.system.system import flow_system

# A mode below this share of the highest one compared is a rigid motion.
_RIGID = 1e-3


def reduced_modes(model: Model, name: str, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """The lowest elastic modes with the casing read, reduced as its settings say, and put between the rotors.

    Returns:
        Frequencies in Hz, rising, (k,); their estimated relative errors by the mesh of the casing and by its reduction, (k,);
        unknowns of the mesh.
    """
    settings = casing_settings(model, name)
    fe = finite_element_body(settings)
    body, _, basis = reduce(fe, settings.modes_to)
    keep(settings, body)
    system = flow_system(model)
    eigenvalues, shapes = la.eigh(system.stiffness().toarray(), system.mass.toarray())
    chosen = _elastic(eigenvalues, count)
    eigenvalues = eigenvalues[chosen]
    own = system.dofs.expand(shapes[:, chosen])[system.nodes.of_casing(name)]
    reduction = [body.eigenvalue_error(value, shape) or 0.0 for value, shape in zip(eigenvalues, own.T, strict=True)]
    mesh_error = 0.5 * eigenvalue_errors(fe, eigenvalues, basis @ own) / eigenvalues
    return np.sqrt(eigenvalues) / (2.0 * np.pi), mesh_error, 0.5 * np.array(reduction), fe.dofs


def whole_frequencies(model: Model, name: str, count: int) -> np.ndarray:
    """The lowest elastic frequencies (count,) in Hz with every node of the casing's mesh: nothing of it is reduced."""
    system = flow_system(model)
    fe = finite_element_body(casing_settings(model, name))
    # Displacements (3p, f) of the mesh from its unknowns, and motions (6 s, f) of the seats from them.
    mean = fe.settings.connection == "mean"
    space = fe.free_space(held=True, rigid_seats=not mean)
    if mean:
        shapes = space.shapes
        seats = sp.csr_array(space.forces(fe.mean_weights(fe.seats)).T)
    else:
        count_of_seats = space.seats.shape[1]
        elastic = sp.csr_array((count_of_seats, space.shapes.shape[1]))
        seats = sp.csr_array(sp.hstack([elastic, sp.eye_array(count_of_seats)], format="csr"))
        shapes = sp.csr_array(sp.hstack([space.shapes, space.seats], format="csr"))
    of_casing = system.nodes.of_casing(name)
    numbers = np.flatnonzero(np.abs(system.dofs.transform[of_casing, :]).sum(axis=0))
    others = np.setdiff1d(np.arange(system.n), numbers)
    # The reduced body's other coordinates have no part in the matrices of the rotors.
    rows = sp.csr_array((np.ones(len(others)), (others, np.arange(len(others)))), shape=(system.n, len(others)))
    means = sp.coo_array(seats)
    motions = sp.csr_array((means.data, (numbers[means.row], means.col)), shape=(system.n, seats.shape[1]))
    P = sp.hstack([motions, rows], format="csr")
    groups = [group for group in system.groups_at(0.0) if group.part != f"casings.{name}"]
    mass = sp.kron(fe.matrices.mass, sp.eye_array(3), format="csr")
    springs, flexibility, _ = fe.springs()
    spring = sp.csr_array(shapes.T @ springs)
    empty = sp.csr_array((len(others), len(others)))
    rotor_stiffness = assemble(groups, system.dofs, lambda g: g.matrices.stiffness)
    rotor_mass = assemble(groups, system.dofs, lambda g: g.matrices.mass)
    casing_stiffness = fe.stiffness_in(shapes) + (spring / flexibility) @ spring.T
    K = sp.csr_array(sp.block_diag([casing_stiffness, empty]) + P.T @ (rotor_stiffness @ P))
    M = sp.csr_array(sp.block_diag([shapes.T @ mass @ shapes, empty]) + P.T @ (rotor_mass @ P))
    # Rotors may turn freely: a shift below the elastic modes makes the matrix one that is positive.
    shift = float(K.diagonal().sum() / M.diagonal().sum()) * 1e-8
    solve = factor_positive(sp.csr_array(K + shift * M), 1, f"casings.{name} with the rotors", silent)
    squares, _ = lowest_modes(solve, lambda x: np.asarray(M @ x), K.shape[0], count + 8)
    squares = squares - shift
    return np.asarray(np.sqrt(squares[_elastic(squares, count)]) / (2.0 * np.pi))


def _elastic(eigenvalues: np.ndarray, count: int) -> np.ndarray:
    """Numbers of the lowest elastic modes among rising eigenvalues: rigid ones are far below all of them."""
    highest = eigenvalues[min(count, len(eigenvalues) - 1)]
    return np.flatnonzero(eigenvalues > _RIGID**2 * highest)[:count]


MODES = 8
# The reference has no more unknowns than this, about: half a minute and 4 GB for its factor.
FINEST = 300_000
# Fixed-interface modes of the rungs.
FIXED = (5, 10, 20, 40)
# Splitting an element in eight multiplies the unknowns by about as much.
_EIGHT = 8.0
# What Lanczos leaves of the frequencies of a whole mesh.
_RESOLVED = 1e-9
# What is left of a reference's estimated error when it is taken off.
_LEFT = 0.5


@recorded
def casing_convergence_study(
    model: Model,
    *,
    casing: str | None = None,
    coupled: bool = False,
    modes: int = MODES,
    finest: int = FINEST,
    fixed: tuple[int, ...] = FIXED,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Frequencies of a casing, or of the whole gearbox with it, on a series of meshes and of reductions.

    Meshes are compared with the same body in the finest mesh that is affordable, every element split in eight once or more, whose
    own estimated error is taken off; reductions with the whole mesh, not reduced.

    Args:
        model: with a casing from a mesh.
        casing: its name; None where there is only one.
        coupled: whether the modes are those of the gearbox with the casing, undamped at standstill; else of the casing, held as
            it is with its seats free, or floating.
        modes: how many elastic modes are compared.
        finest: most unknowns of the mesh to compare with, about.
        fixed: numbers of fixed-interface modes.
        repeat: runs of each rung that are timed at least.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no such casing, or one that was reduced elsewhere; a mesh too large for a finer reference.
    """
    names = casing_names(model, casing)
    if len(names) > 1:
        raise AnalysisError(f"--casing: the model has {len(names)} casings; name one of {', '.join(names)}")
    if modes < 1:
        raise AnalysisError(f"modes: got {modes}, expected 1 or more")
    name = names[0]
    settings = casing_settings(model, name)
    fe = finite_element_body(settings)
    finer = int(np.floor(np.log(max(finest, 1) / fe.dofs) / np.log(_EIGHT)))
    if finer < 1:
        raise AnalysisError(
            f"casings.{name}: its mesh has {fe.dofs} unknowns, and one split in eight to compare with has more than "
            f"{finest}. Study a coarser mesh of the same body, or raise finest."
        )
    # The limit in Hz that keeps n fixed-interface modes lies between the last of them and the next one.
    frequency = reduce(fe, None)[0].fixed_frequency
    while max(fixed) >= len(frequency):
        more = reduce(fe, 1.5 * float(frequency[-1]))[0].fixed_frequency
        if len(more) == len(frequency):  # a mesh of few unknowns has no more
            break
        frequency = more
    fixed_modes = [
        Setting(f"{n} fixed modes", "fixed modes", float(n), {"modes_to": 0.5 * float(frequency[n - 1] + frequency[n])})
        for n in fixed
        if n < len(frequency)
    ]
    studies = _of_gearbox(model, name, modes, finer, progress) if coupled else _of_casing(fe, modes, finer, progress)
    meshes, reductions = studies
    also = replace(reductions, settings=fixed_modes)
    return meshes.result("casing", model, repeat, part_of(progress, 0.4, 1.0), also)


def _of_casing(fe: FiniteElementBody, count: int, finer: int, progress: Progress) -> tuple[Study[Any], Study[Any]]:
    """Studies of a casing by itself: of its meshes, and of its reductions, whose settings are those of any casing."""
    settings = fe.settings

    def solved(body: FiniteElementBody) -> tuple[FiniteElementBody, MeshModes]:
        held = len(settings.held) or len(settings.mounts)
        return body, (held_modes if held else free_modes)(body, count)

    def run(options: dict[str, Any]) -> tuple[FiniteElementBody, MeshModes]:
        body = finite_element_body(replace(settings, splits=settings.splits + options["splits"]))
        return solved(_linear(body) if options.get("linear") else body)

    progress(0.0, "reference")
    finest, reference = run({"splits": finer})
    truth, words, resolution = _reference(reference.frequency, _relative(finest, reference), finest.dofs)

    def judge(found: tuple[FiniteElementBody, MeshModes]) -> Judged:
        body, modes = found
        linear = body.mesh.kind in ("tetra", "hexahedron")
        estimate = np.full(count, np.nan) if linear else _relative(body, modes)
        return Judged(body.dofs, np.abs(modes.frequency / truth - 1.0), estimate)

    # Joins and mounts are on nodes in the middle of edges too.
    plain = not settings.joins and not settings.mounts
    order = [Setting("linear elements", "order", 1.0, {"splits": 0, "linear": True})] if plain else []
    meshes = Study(
        [*order, *(Setting(words, "elements", 2.0**k, {"splits": k}) for k, words in _splits(finer))],
        run=run,
        judge=judge,
        compared="frequencies of the casing",
        count=count,
        reference=words,
        resolution=resolution,
    )
    whole = solved(fe)[1].frequency

    def reduced(options: dict[str, Any]) -> Judged:
        body = reduce(fe, options["modes_to"])[0]
        frequency, shapes = body.modes()
        elastic = np.flatnonzero(np.arange(body.size) >= (0 if body.held else 6))[:count]
        stated = [body.eigenvalue_error((2.0 * np.pi * frequency[k]) ** 2, shapes[:, k]) or 0.0 for k in elastic]
        return Judged(body.size, np.abs(frequency[elastic] / whole - 1.0), 0.5 * np.array(stated))

    return meshes, Study([], run=reduced, judge=lambda found: found, resolution=_RESOLVED, rising=())


def _of_gearbox(model: Model, name: str, count: int, finer: int, progress: Progress) -> tuple[Study[Any], Study[Any]]:
    """Studies of a gearbox with its casing: of the casing's meshes, and of its reductions."""
    settings = casing_settings(model, name)
    whole = whole_frequencies(model, name, count)
    # Reductions of the meshes to compare are so good that what differs is the mesh.
    limit = max(4.0 * float(whole[-1]), settings.modes_to or 0.0)

    def run(options: dict[str, Any]) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
        changed = model.with_({f"casings.{name}.{key}": value for key, value in options.items()})
        return reduced_modes(changed, name, count)

    def refined(k: int) -> dict[str, Any]:
        return {"splits": settings.splits + k, "modes_to": limit}

    progress(0.0, "reference")
    frequency, mesh_error, reduction_error, dofs = run(refined(finer))
    truth, words, resolution = _reference(frequency, mesh_error + reduction_error, dofs)

    def judge(found: tuple[np.ndarray, np.ndarray, np.ndarray, int]) -> Judged:
        frequency, mesh_error, reduction_error, dofs = found
        return Judged(dofs, np.abs(frequency / truth - 1.0), mesh_error + reduction_error)

    def judge_reduction(found: tuple[np.ndarray, np.ndarray, np.ndarray, int]) -> Judged:
        frequency, _, reduction_error, dofs = found
        return Judged(dofs, np.abs(frequency / whole - 1.0), reduction_error)

    meshes = Study(
        [Setting(words, "elements", 2.0**k, refined(k)) for k, words in _splits(finer)],
        run=run,
        judge=judge,
        compared="frequencies of the gearbox",
        count=count,
        reference=words,
        resolution=resolution,
    )
    return meshes, Study([], run=run, judge=judge_reduction, resolution=_RESOLVED, rising=())


def _reference(frequency: np.ndarray, error: np.ndarray, dofs: int) -> tuple[np.ndarray, str, float]:
    """Frequencies (k,) in Hz that are taken for the truth, what they are in words, and the relative error that they resolve."""
    largest = float(error.max())
    words = (
        f"the same body in a mesh of {dofs} dofs, its own estimated error of {largest:.1e} taken off; fixed modes: against "
        "the whole mesh, not reduced"
    )
    return frequency * (1.0 - error), words, _LEFT * largest


def _splits(finer: int) -> list[tuple[int, str]]:
    """Meshes coarser than the reference: how often each element is split in eight, and what the row says."""
    names = ("the file's mesh", "elements split once", "split twice", "split three times")
    return list(enumerate(names))[:finer]


def _linear(fe: FiniteElementBody) -> FiniteElementBody:
    """The body in linear elements on the same corners, its seats and held nodes those of them that are corners."""
    mesh = without_middles(fe.mesh)
    corners = np.unique(fe.mesh.cells[:, : fe.mesh.element.corners])
    held = np.flatnonzero(np.isin(corners, fe.held))
    joined = replace(fe.joined, mesh=mesh)
    return FiniteElementBody(fe.settings, mesh, mesh_matrices(mesh, fe.settings.material), joined, (), (), held)


def _relative(fe: FiniteElementBody, modes: MeshModes) -> np.ndarray:
    return np.asarray(0.5 * eigenvalue_errors(fe, modes.eigenvalues, modes.shapes) / modes.eigenvalues)
