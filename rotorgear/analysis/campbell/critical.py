"""Critical speeds, directly: speeds at which an order of a shaft or a mesh meets a natural frequency; and their errors.

At a critical speed Im s(W) = p W. A mesh whose error in s is e |s| at a fixed speed moves the crossing by

    dW / W = e / (1 - s' / p),     s' = Im ds/dW = - Im [ y^H (s D_1 + K_1) x / y^H (2 s M + D) x ] ,

with the left shape y, and D = D_0 + W D_1 and K = K_0 + W K_1 near that speed. A line that runs along its mode (s' = p) has a
critical speed that nothing holds, and an error without bound.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.campbell.crossings import EXCITED, participation, whirl_for
from rotorgear.analysis.campbell.speed_family import SpeedFamily
from rotorgear.analysis.campbell.speeds import highest_speed, system_for_speeds
from rotorgear.analysis.common.casings import reduction_errors, with_casing_modes
from rotorgear.analysis.common.discretise import pieces
from rotorgear.analysis.common.excitation import excitation_orders
from rotorgear.analysis.common.left_out import left_out
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import FINEST, missed
from rotorgear.analysis.modal.branch_shapes import BasisShapes, Portraits
from rotorgear.analysis.modal.modal import ModalRequest
from rotorgear.analysis.modal.refine import errors_of, total_error
from rotorgear.analysis.static.lowest_speed import lowest_speed
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.results.critical import CriticalResult, CriticalSpeed
from rotorgear.results.laws import about_state, law_rows
from rotorgear.solvers.eigen.synchronous import LEAST_SHARE, Affine, Synchronous, synchronous_speeds
from rotorgear.solvers.sparse.pencil import count_below
from rotorgear.system.bubble_errors import left_shapes
from rotorgear.system.rigid_motions import rigid_motions
from rotorgear.system.system import System

SHAFT_ORDERS = (1.0,)
# Speeds at which nonlinear parts are linearised.
_TANGENTS = 41
_ROUNDS = 4
# Share of its own terms below which a strain energy may be rounding, and of that energy below which strains say that it is.
_LOST = 1e-9
_UNSTRAINED = 1e-3
_ROUNDING = 1e-14


@recorded
def critical(
    model: Model | System,
    *,
    start: float | str | None = None,
    stop: float | str | None = None,
    shaft_orders: Sequence[float] = SHAFT_ORDERS,
    mesh_orders: Sequence[int] = (),
    damped: bool = True,
    fmax: float | None = None,
    elements: int | None = None,
    accuracy: float | None = None,
    progress: Progress = silent,
) -> CriticalResult:
    """Return all speeds of the input shaft from `start` to `stop` at which a line meets a mode.

    Args:
        model: a model, or its assembled system, which is then taken as it is.
        start: as in `campbell`.
        stop: as in `campbell`; a negative speed turns the other way.
        shaft_orders: multiples of the speed of every shaft that excite.
        mesh_orders: multiples of the frequency of every mesh that excite (default: none).
        damped: with all damping and circulatory terms, so that it is the damped frequency that meets the line; or without them.
        fmax: only critical speeds with a frequency up to this many Hz.
        elements: as in `modal`.
        accuracy: refine the mesh until every critical speed is estimated to be within this relative error (default: 1e-3,
            unless `elements` is given).
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no speed range, no line, a speed outside of a bearing's table.
        ConvergenceError: a root does not converge, or a count shows that one is missing.
    """
    parts = model.model if isinstance(model, System) else model
    top = highest_speed(parts, stop)
    lines = excitation_orders(parts, shaft_orders, mesh_orders)
    if not lines or top == 0.0:
        raise AnalysisError(
            "no line of excitation: give a speed above 0 and an order of a shaft, or of a mesh with numbers of teeth"
        )
    if fmax is not None and not (np.isfinite(fmax) and fmax > 0.0):
        raise AnalysisError(f"the highest frequency must be positive, got {fmax} Hz")
    clock = Clock()
    low, begun = lowest_speed(parts, start, top)
    # Where a line meets a mode is not known before: tangents over the whole range.
    about = linear_system(model, list(np.linspace(low, top, _TANGENTS)))
    highest = min(max(line.frequency_hz(top) for line in lines), fmax or np.inf)
    model, few = (about, ()) if isinstance(model, System) else with_casing_modes(model, highest)
    aim = accuracy
    for _ in range(_ROUNDS):
        asked = ModalRequest(fmax=highest, elements=elements, accuracy=aim)
        system = system_for_speeds(model, [top], asked, about.state, progress)
        clock.lap("mesh")
        family = SpeedFamily(system, *sorted((low, top)))
        found: list[tuple[ExcitationOrder, Synchronous]] = []
        counted: list[bool] = []
        ranges = list(affine_pieces(system, family, top, damped))
        for k, line in enumerate(lines):
            progress(0.3 + 0.6 * k / len(lines), line.name)
            limit = abs(top) if fmax is None else min(abs(top), 2.0 * np.pi * fmax / line.order)
            if limit > abs(low):
                upto = np.copysign(limit, top)
                pieces_to = ranges if upto == top else list(affine_pieces(system, family, upto, damped))
                roots, confirmed = roots_of(system, family, pieces_to, line.order, upto)
                counted += confirmed
                # The pieces begin where tables do, which may be below the range.
                found += [(line, root) for root in roots if root.speed >= abs(low)]
        clock.lap("critical speeds")
        errors = [_speed_error(system, ranges, root, line.order, float(np.sign(top))) for line, root in found]
        clock.lap("error estimate")
        worst = max(errors, default=0.0)
        if accuracy is None or aim is None or worst <= accuracy or isinstance(model, System):
            break
        # A line that runs along a mode magnifies the error of its frequency.
        aim = max(FINEST, 0.5 * aim * accuracy / worst)
    ranked = sorted(zip(found, errors, strict=True), key=lambda item: item[0][1].speed)
    result = _result(system, ranked, lines, (low, top), damped, counted, clock)
    short = missed(accuracy, worst, "ask for less, or for a lower --to")
    return replace(
        result,
        model=parts,
        left_out=(*result.left_out, *filter(None, [begun])),
        warnings=(*result.warnings, *few, *(() if low else _too_slow(system, top, lines)), *filter(None, [short])),
        status=short or "success",
    )


def _speed_error(system: System, ranges: Sequence[Affine], root: Synchronous, order: float, sense: float) -> float:
    """Estimated relative error of one critical speed; 0 where no shaft is cut into elements, infinite where they are too coarse.

    It is that of shaft elements and of the reduction of casings.

    Args:
        system: the discretised model.
        ranges: its matrices as functions of the size of the speed.
        root: the critical speed, its mode in the free dofs.
        order: of the line that meets it.
        sense: sign of the rotation.
    """
    speed = sense * root.speed
    s = np.array([root.eigenvalue])
    x = root.vector[:, None]
    error = float(total_error(errors_of(system, speed, s, x, np.array([False])), 1)[0])
    error += float(reduction_errors(system, s, x)[0])
    if not 0.0 < error < np.inf:
        return error
    here = min(ranges, key=lambda piece: max(piece.low - root.speed, root.speed - piece.high))
    D, _ = here.at(root.speed)
    y = left_shapes(system, speed, s, x)[:, 0].conj()
    K_slope = here.K1 + 2.0 * root.speed * here.K2
    turned = y @ (root.eigenvalue * (here.D1 @ root.vector) + K_slope @ root.vector)
    held = y @ (2.0 * root.eigenvalue * (here.M @ root.vector) + D @ root.vector)
    along = abs(1.0 + float(np.imag(turned / held)) / order)
    return error / along if along else np.inf


def _too_slow(system: System, top: float, lines: tuple[ExcitationOrder, ...]) -> tuple[str, ...]:
    """Say where modes are so soft that their critical speeds lie below what the range can tell from standstill."""
    least = LEAST_SHARE * abs(top) * max(line.order for line in lines)
    # Gyroscopic moments lower a backward whirl to 1/sqrt(3) of its standstill frequency at most (I_p <= 2 I_d).
    try:
        below = count_below(system.mass, system.stiffness(), 3.0 * least**2)
    except ConvergenceError:
        return ()
    soft = below - rigid_motions(system, system.groups).shape[1] if below else 0
    if soft <= 0:
        return ()
    return (
        f"{soft} mode{'s'[: soft != 1]} may be met below {LEAST_SHARE * abs(top) * RPM_PER_RAD_S:.3g} rpm, a millionth of the "
        "highest speed, where no critical speed is sought: ask again with a lower highest speed (--to)",
    )


def roots_of(
    system: System, family: SpeedFamily, ranges: Sequence[Affine], order: float, top: float
) -> tuple[list[Synchronous], list[bool]]:
    """Synchronous speeds of all groups of dofs, as positive speeds, and whether those of each group and range were counted.

    They lie in the `ranges`, those of `affine_pieces` up to `top` in rad/s, whose sign is that of the rotation.
    """
    found = []
    counted = []
    for whole, dofs in itertools.product(ranges, family.groups):
        roots, confirmed = synchronous_speeds(whole.cut(dofs), order)
        counted.append(confirmed)
        for root in roots:
            vector = np.zeros(system.n, complex)
            vector[dofs] = root.vector
            if not _is_rounding(system, np.copysign(root.speed, top), vector):
                found.append(replace(root, vector=vector))
    return found, counted


def _is_rounding(system: System, speed: float, x: np.ndarray) -> bool:
    """Whether rounding alone holds a motion: a free rotation of a fine mesh meets any line near speed 0.

    Its energy x^H K x is lost among its terms, and the strains S x, which lose nothing, have next to none of it: of a coarse mesh
    both may be the rounding of x itself.
    """
    K = system.stiffness(speed)
    energy = abs(np.vdot(x, K @ x))
    terms = np.abs(x) @ (abs(K) @ np.abs(x))
    if energy > _LOST * terms:
        return False
    S = system.strain_factor(speed)
    return S is not None and np.linalg.norm(S @ x) ** 2 < max(_UNSTRAINED * energy, _ROUNDING**2 * terms)


def affine_pieces(system: System, family: SpeedFamily, top: float, damped: bool) -> Iterator[Affine]:
    """The matrices between two rows of any bearing's table, as functions of the size of the speed."""
    sign = float(np.sign(top))
    end = abs(top)
    knots = np.abs(family.knots).tolist()
    inner = [speed for speed in knots if 0.0 < speed < end * (1.0 - 1e-12)]
    edges = sorted({min(knots, default=0.0), *inner, end})
    K2 = system.stiffness_per_square

    def matrices(speed: float) -> tuple[sp.csc_array, sp.csc_array]:
        gyroscopic = speed * system.gyroscopic
        if not damped:
            return sp.csc_array(gyroscopic), system.stiffness(speed)
        stiffness = system.stiffness(speed) + system.circulatory(speed)
        return sp.csc_array(system.damping(speed) + gyroscopic), stiffness

    for low, high in itertools.pairwise(edges):
        (D_a, K_a), (D_b, K_b) = (matrices(sign * speed) for speed in (low, high))
        K_a = K_a - low**2 * K2
        K_b = K_b - high**2 * K2
        D1 = (D_b - D_a) / (high - low)
        K1 = (K_b - K_a) / (high - low)
        D0 = D_a - low * D1
        K0 = K_a - low * K1
        parts = ((D0, D_a), (D1, D_b / high), (K0, K_a), (K1, K_b / high))
        D0, D1, K0, K1 = (_clean(A, scale) for A, scale in parts)
        yield Affine(system.mass, D0, D1, K0, K1, K2, low, high)


def _clean(A: sp.csc_array, scale: sp.csc_array) -> sp.csc_array:
    """A without entries that are rounding of the differences it was made of."""
    A = sp.csc_array(A)
    A.data[np.abs(A.data) <= 1e-14 * (abs(scale).max() if scale.nnz else 0.0)] = 0.0
    A.eliminate_zeros()
    return A


def looks_of(
    system: System, roots: Sequence[Synchronous], top: float
) -> tuple[BasisShapes, np.ndarray, np.ndarray, Portraits]:
    """Shapes, coordinates in their basis (r, c), speeds (c,) in rad/s in the sense of `top`, and portraits of critical speeds."""
    X = np.column_stack([np.zeros((system.n, 0), complex), *(root.vector for root in roots)])
    shapes = BasisShapes(system, [np.hstack([X.real, X.imag])])
    one = np.eye(len(roots))
    coordinates = shapes.coordinates(0, np.vstack([one, 1j * one]))
    speeds = np.copysign(np.array([root.speed for root in roots]), top)
    return shapes, coordinates, speeds, shapes.portraits(coordinates, speeds, top)


def _result(
    system: System,
    found: list[tuple[tuple[ExcitationOrder, Synchronous], float]],
    lines: tuple[ExcitationOrder, ...],
    ends: tuple[float, float],
    damped: bool,
    counted: list[bool],
    clock: Clock,
) -> CriticalResult:
    """The critical speeds found, each with its line and its estimated error, with the looks of their modes."""
    low, top = ends
    shapes, coordinates, speeds, seen = looks_of(system, [root for (_, root), _ in found], top)
    words = shapes.descriptions(coordinates, speeds)
    zeta = system.model.damping.modal_ratio if damped else 0.0
    damps = damped and not SpeedFamily(system, *sorted((low, top))).is_conservative
    table = []
    for k, ((line, root), error) in enumerate(found):
        share = participation(line, seen, k)
        value = root.eigenvalue
        table.append(
            CriticalSpeed(
                line.name,
                float(speeds[k]),
                float(value.imag / (2.0 * np.pi)),
                (float(-value.real / abs(value)) if damps else 0.0) + zeta,
                whirl_for(line, seen, k),
                share,
                share >= EXCITED,
                words[k],
                root.residual,
                error,
            )
        )
    clock.lap("energies")
    solver = "damped, root of Im s = p W"
    if not damped:
        how = "" if all(counted) else "in part " if any(counted) else "not "
        solver = f"undamped, {how}counted by pivot signs"
    return CriticalResult(
        model=system.model,
        damped=damped,
        low_speed=low,
        top_speed=top,
        lines=lines,
        speeds=tuple(table),
        shapes=shapes.stations @ coordinates,
        nodes=shapes.nodes,
        dofs=system.n,
        discretisation=pieces(system),
        seconds=clock.total(),
        laws=law_rows(system.state.operating),
        left_out=left_out(system, "modes", top, undamped=not damped),
        warnings=tuple(system.nodes.merged),
        method=f"eigenproblem in the speed, {solver}{about_state(system.state)}",
    )
