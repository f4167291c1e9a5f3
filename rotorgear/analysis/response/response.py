"""Forced response of a gearbox over speed: unbalances, transmission errors and stiffness variation, by order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.analysis.common.casings import with_casing_modes
from rotorgear.analysis.common.discretise import pieces
from rotorgear.analysis.common.forecast import Forecast
from rotorgear.analysis.common.left_out import left_out
from rotorgear.analysis.common.mesh_notes import map_errors
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_modal_damping, check_request, check_whole, missed, speed_in_si
from rotorgear.analysis.common.stations import shapes_at_stations
from rotorgear.analysis.response.limits import against, check_limits, read_limits
from rotorgear.analysis.response.mesh import aims, damped_modes, mesh_error, meshed, parting, speed_warnings
from rotorgear.analysis.response.order import Order
from rotorgear.analysis.response.orders import orders_of
from rotorgear.analysis.response.plant import READ, Plant, Readings
from rotorgear.analysis.response.run_up import choose_method, direct_sweep, modal_sweep, solve_orders
from rotorgear.analysis.response.second_order import peaks_of
from rotorgear.analysis.static.lowest_speed import lowest_speed
from rotorgear.analysis.static.mean_state import about_mean
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.progress import Progress, silent
from rotorgear.results.laws import about_state, law_rows
from rotorgear.results.response import ResponseResult
from rotorgear.system.damped_range import damped_up_to, undamped_above

METHODS = ("auto", "modal", "direct")
# A run-up without speeds goes from a tenth of the operating speed to a fifth above it.
LOWEST = 0.1
HIGHEST = 1.2
POINTS = 221
# Speeds at which nonlinear parts are linearised at most.
_TANGENTS = 41


@recorded
def response(
    model: Model,
    *,
    start: float | str | None = None,
    stop: float | str | None = None,
    points: int = POINTS,
    speeds: Sequence[float | str] | None = None,
    fmax: float | None = None,
    modal_damping: float = 0.0,
    method: str = "auto",
    elements: int | None = None,
    accuracy: float | None = None,
    shape_speed: float | str | None = None,
    limits: str | Path | None = None,
    progress: Progress = silent,
) -> ResponseResult:
    """Return the linear response to all excitations of a model, by order and speed.

    Args:
        model: a model with unbalances, loads of an order or a frequency, or meshes with harmonics of transmission error or
            stiffness.
        start: lowest speed of the input shaft in rad/s or with its unit (default: 0.1 times the operating speed).
        stop: highest speed of the input shaft (default: 1.2 times the operating speed).
        points: number of speeds between them, evenly spaced.
        speeds: these speeds of the input shaft, in rad/s or with their unit, in place of an evenly spaced range.
        fmax: leave out orders that are above this many Hz at the highest speed.
        modal_damping: damping ratio added to every elastic mode up to 1.5 times the highest frequency, beside the damping of
            the model.
        method: auto, modal (superposition of modes) or direct (a solution at each speed).
        elements: number of basic elements in each shaft segment (default: refined as for modes up to the highest frequency).
        accuracy: refine the mesh until the forces are estimated to be within this relative error of the largest (default: modes
            up to the highest frequency are refined to 1e-3, whatever that makes of the forces).
        shape_speed: speed at which the deflection shapes are kept (default: the operating speed, else that of the largest
            force).
        limits: table (CSV) of targets over speed: `at` (mesh, bearing or point), `speed_rpm`, and `amplitude_N`, `rms_N` or
            `level_dB`; with `order` of that order alone. The table and the pictures tell what exceeds them.
        progress: callable that is told fraction and step.

    Raises:
        ModelError: mistakes in the table of limits.
        AnalysisError: nothing excites the model, speeds of both senses, a contact that is open in the mean state.
        ConvergenceError: the modal solution does not reach its tolerance, or an undamped resonance is hit exactly.
    """
    chosen, begun = _speeds(model, speeds, start, stop, points)
    targets = {} if limits is None else read_limits(limits, model)
    if method not in METHODS:
        raise AnalysisError(f"method: got '{method}', expected one of {', '.join(METHODS)}")
    check_modal_damping(modal_damping)
    check_request(fmax=fmax, elements=elements, accuracy=accuracy)
    zeta = modal_damping + model.damping.modal_ratio
    speed = float(chosen[-1])
    # Tangents at all speeds, or at enough of them for straight lines in between.
    spread = np.unique(np.linspace(0, len(chosen) - 1, _TANGENTS).round().astype(int))
    about = about_mean(model, [float(value) for value in chosen[spread]], speed)
    orders, weak = orders_of(about[1])
    orders, highest, top, left = _within(orders, float(np.max(np.abs(chosen))), fmax)
    check_limits(targets, [order.name for order in orders], chosen)
    served, few = with_casing_modes(model, top / (2.0 * np.pi))
    for aim in aims(accuracy):
        progress(0.02, "discretisation")
        system = meshed(served, about, speed, top / (2.0 * np.pi), elements, aim)
        modes = damped_modes(system, damped_up_to(system, highest), speed)
        plant = Plant(system, (*modes, zeta))
        setup = replace(about[1], system=system, lines=plant.lines)
        names = {order.name for order in orders}
        orders = [order for order in orders_of(setup)[0] if order.name in names]
        how, why = choose_method(method, len(chosen), len(orders), system.n)
        of_speeds = "for the speeds; the estimate of the error comes on top"
        measuring = Forecast("response", 0.0, whole=of_speeds).measuring(progress)
        sweep = (
            direct_sweep(plant, orders, chosen, measuring)
            if how == "direct"
            else modal_sweep(plant, orders, chosen, modes, progress, throughout=method == "modal")
        )
        readings, solver_error, checked, words = sweep
        progress(0.96, "error estimate")
        estimate = mesh_error(plant, orders, chosen, readings, (damped_up_to(system, top), zeta), setup)
        if accuracy is None or estimate <= accuracy:
            break
    short = missed(accuracy, estimate, "ask for less, or give more damping to resonances in the range")
    at = _shape_speed(model, shape_speed, chosen, readings)
    deflections = solve_orders(plant.dynamics(at), *plant.loads(orders, at))
    nodes, shapes = shapes_at_stations(system, system.dofs.expand(deflections))
    quantities: dict[str, Any] = {name: np.swapaxes(getattr(readings, name), 0, 1) for name in READ}
    joint = setup.joint
    maps = zip(setup.lines.names, joint.maps, joint.face_maps, strict=True) if joint else ()
    between_nodes = map_errors((name, one or along) for name, one, along in maps)
    progress(1.0, "done")
    result = ResponseResult(
        model=model,
        speeds=chosen,
        orders=tuple(order.name for order in orders),
        ratio=np.array([order.ratio for order in orders]),
        fixed_frequency=np.array([order.fixed / (2.0 * np.pi) for order in orders]),
        contact_mesh=setup.lines.names,
        contact_helix=np.array([state.contact.helix for state in setup.lines.states], dtype=int),
        mean_force=setup.mean_force,
        mesh_stiffness=setup.lines.stiffness,
        **quantities,
        bearings=tuple(model.bearings),
        points=plant.points,
        load_points=tuple(plant.load_units),
        places=tuple(plant.places),
        casings=tuple(plant.surfaces),
        casing_seats=tuple(plant.seats),
        casing_grounds=plant.ground.names,
        surface_area=np.array([surface.normals_and_areas()[1].sum() for surface in plant.surfaces.values()]),
        shape_speed=at,
        shapes=shapes,
        nodes=nodes,
        damping_ratio=zeta,
        solver_error=solver_error,
        checked=checked,
        error_estimate=estimate,
        dofs=system.n,
        discretisation=pieces(system),
        largest=peaks_of(joint, plant, orders, chosen, readings),
        laws=law_rows(system.state.operating),
        left_out=(
            *left,
            *undamped_above(damped_up_to(system, highest), zeta),
            *weak,
            *setup.notes,
            *between_nodes,
            *([begun] if begun else []),
            *left_out(system, "response", speed, modal_damping=modal_damping),
        ),
        warnings=(
            *few,
            *speed_warnings(plant, orders, chosen, (*modes, zeta)),
            *parting(setup, readings.mesh_force, chosen),
            *([short] if short else []),
        ),
        status=short or "success",
        method=f"{words} ({how}: {why}){about_state(system.state)}",
    )
    return replace(result, limits=against(result, targets)) if targets else result


def _within(orders: list[Order], fastest: float, fmax: float | None) -> tuple[list[Order], float, float, list[Note]]:
    """The orders up to `fmax` in Hz at the highest speed, and notes on the others.

    Between them the highest frequency in rad/s, and the highest that the mesh is made for.
    """
    if not orders:
        raise AnalysisError(
            "nothing excites the model: give [unbalances], [loads] with an order, a frequency or a ripple, or a mesh its "
            "transmission_error or stiffness_variation"
        )
    limit = np.inf if fmax is None else 2.0 * np.pi * fmax
    kept = [order for order in orders if order.frequency_at(fastest) <= limit]
    if not kept:
        lowest = min(order.frequency_at(fastest) for order in orders) / (2.0 * np.pi)
        raise AnalysisError(f"fmax: no order is as low as {fmax:g} Hz, the lowest comes to {lowest:.6g} Hz")
    above: dict[str, list[str]] = {}
    for order in orders:
        if order.frequency_at(fastest) > limit:
            part, _, multiple = order.name.rpartition(" ")
            above.setdefault(part, []).append(multiple)
    runs = {part: m[0] if len(m) == 1 else f"{m[0]} to {m[-1]}, {len(m)} orders" for part, m in above.items()}
    left = [Note("", f"{part} {many}", f"above {fmax:g} Hz at the highest speed") for part, many in runs.items()]
    highest = max(order.frequency_at(fastest) for order in kept)
    # The many minor orders of teeth that differ go far up; the mesh is made for those that shake.
    top = max((order.frequency_at(fastest) for order in kept if not order.minor), default=highest)
    beyond = [order for order in kept if order.frequency_at(fastest) > (1.0 + 1e-9) * top]
    if beyond:
        small, last = (w / (2.0 * np.pi) for w in (top, beyond[-1].frequency_at(fastest)))
        what = f"a finer mesh for {len(beyond)} small orders of loaded teeth above {small:.5g} Hz, up to {last:.5g} Hz"
        left.append(Note("", what, "they are solved on the mesh for the larger ones"))
    return kept, highest, top, left


def _speeds(
    model: Model,
    given: Sequence[float | str] | None,
    start: float | str | None,
    stop: float | str | None,
    points: int,
) -> tuple[np.ndarray, str]:
    """Speeds in rad/s, in rising order of size, all of one sense, and a note where films have chosen the lowest."""
    begun = ""
    if given is None:
        operating = model.operating_speed
        if not operating and (start is None or stop is None):
            raise AnalysisError(
                "no speeds: give start and stop (--from, --to), or [operation] a speed: the run-up then goes to a fifth above it"
            )
        check_whole("the number of points", points)
        high = HIGHEST * (operating or 0.0) if stop is None else speed_in_si(stop)
        if start is None:
            low, begun = lowest_speed(model, None, high, LOWEST * (operating or 0.0))
        else:
            low = speed_in_si(start)
        speeds = np.linspace(low, high, points)
    else:
        speeds = np.array([speed_in_si(speed) for speed in given], float)
    if not speeds.size or not np.all(np.isfinite(speeds)):
        raise AnalysisError("speeds: got none, expected at least one rotational speed")
    # One sense, because the sense of rotation chooses the working flanks, and with them the linearised model.
    if np.any(speeds == 0.0) or np.any(np.sign(speeds) != np.sign(speeds[0])):
        raise AnalysisError("speeds: all of one sense and none of them 0; at standstill nothing excites the model")
    return speeds[np.argsort(np.abs(speeds), kind="stable")], begun


def _shape_speed(model: Model, given: float | str | None, speeds: np.ndarray, readings: Readings) -> float:
    """Speed of the deflection shapes: as asked for, the operating one if it is in the range, else that of the largest force."""
    asked = speed_in_si(given)
    if asked is not None:
        if asked == 0.0 or np.sign(asked) != np.sign(speeds[0]):
            raise AnalysisError("the speed of the deflection shapes must have the sense of the run-up and not be 0")
        return asked
    operating = model.operating_speed
    if operating and np.sign(operating) == np.sign(speeds[0]) and abs(speeds[0]) <= abs(operating) <= abs(speeds[-1]):
        return operating
    return float(speeds[int(np.argmax(np.abs(readings.stacked).max(axis=(1, 2), initial=0.0)))])
