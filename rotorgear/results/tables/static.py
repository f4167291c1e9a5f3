"""The static result as tables for the terminal, 80 columns wide."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.tables.common import error_words, heading, lines, notes_of, operating_points, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.static import StaticResult

# The change that one line of the sensitivity table is for, by the end of the parameter's name, and its words.
_STEPS = {
    "index_error": (10e-6, "10 um later"),
    "stiffness": (0.1, "10 % stiffer"),
    "centre_line_angle": (math.radians(1.0), "1 deg on"),
}
_LINES = 12


def static_table(result: StaticResult, *, sensitivity: bool = False) -> RenderableType:
    """Return title, tables and notes as one rich renderable."""
    from rich.console import Group

    speed = (
        "" if result.speed is None else f", {result.model.reference_shaft} at {result.speed * RPM_PER_RAD_S:.6g} rpm"
    )
    parts: list[Any] = [heading(f"{result.model.title or 'Model'}: statics{speed}")]
    if result.torque:
        torques = "; ".join(f"{name} {value:.2f} N m" for name, value in result.torque.items())
        parts += lines(f"torques about z: {torques}")
    for name, load in result.load_force.items():
        if load.any():
            parts += lines(f"{name}: {_triple(load[:3])} N, {_triple(load[3:])} N m")
    if result.contact_mesh:
        parts += ["", _meshes(result)]
    if result.faces:
        parts += ["", _faces(result)]
    if result.shares:
        shares = table("shared by", "mesh", "share %", "times mean", "decided by", left=2)
        for row in result.shares:
            shares.add_row(row.gear, row.mesh, f"{100.0 * row.share:.3f}", f"{row.factor:.4f}", row.decided_by)
        shares.add_row("sharing factor", "", "", f"{result.sharing_factor:.4f}", "K_gamma")
        parts += ["", shares]
        if sensitivity:
            parts += ["", *_sensitivities(result)]
    for loop in result.assembly:
        if loop.gear:
            closes = (
                f"with all teeth aligned to the shafts' marks {loop.rest_pitches:+.4f} pitches are missing; "
                f"{loop.gear} clocked by {loop.clocking_deg:+.4f} deg closes it"
            )
            parts += lines(f"Loop: {loop.mesh} closes a loop: {closes}")
        else:
            missing = f"{loop.rest_pitches:+.4f} pitches missing"
            parts += lines(f"Loop: {loop.mesh} closes a loop with the clockings given: {missing}")
    if result.bearing_force or result.support_force:
        parts += ["", _supports(result)]
    if result.casing_seat_force:
        parts += ["", _on_casings(result)]
    if result.laws:
        parts += ["", operating_points(result.laws)]
    moves = table("moves", "x um", "y um", "z um", "tilt_x", "tilt_y", "twist")
    for place, value in result.place_displacement.items():
        moves.add_row(
            place.partition(".")[2].replace(" left", " L").replace(" right", " R"),
            *(f"{_rounded(1e6 * x, 5e-4):.3f}" for x in value[:3]),
            *(f"{_rounded(1e6 * x, 0.05):.1f}" for x in value[3:]),
        )
    notes = [
        "tilts and twist in urad; L and R: helix at the smaller and the larger z",
        f"{result.dofs} dofs, {result.seconds['total']:.2f} s; {result.method}",
        *_along(result),
        *(
            f"ground on casing {name}: {_triple(load[:3])} N, {_triple(load[3:])} N m about the origin"
            for name, load in result.casing_force.items()
        ),
        f"error: forces change by {error_words(result.error_estimate)} when every element is halved; "
        f"residual {error_words(result.imbalance)}",
        *notes_of(result),
    ]
    return Group(*parts, "", moves, "", *lines(*notes), "")


def _on_casings(result: StaticResult) -> Any:
    """Forces on casings: of what stands in their seats, and of the ground at their held sets and mounts."""
    out = table("on casing", "of", "Fx N", "Fy N", "Fz N", "Mx Nm", "My Nm", "Mz Nm", left=2)
    rows = [(address, "seat", load) for address, load in result.casing_seat_force.items()]
    rows += [(address, "ground", load) for address, load in result.casing_ground_force.items()]
    for address, what, load in rows:
        # What is rounding of the largest is shown as 0.
        least = 1e-9 * float(np.abs(load).max())
        out.add_row(address, what, *(f"{_rounded(x, max(least, 0.05)):.1f}" for x in load))
    return out


def _meshes(result: StaticResult) -> Any:
    out = table("mesh", "driver", "F_n N", "helix %", "press um", "Fx N", "Fy N", "Fz N", "phase", left=2)
    for k, mesh in enumerate(result.contact_mesh):
        two = len(result.contacts_of(mesh)) == 2
        name = f"{mesh} {'LR'[int(result.contact_helix[k])]}" if two else mesh
        phase = result.mesh_phase.get(mesh, math.nan)
        out.add_row(
            name,
            result.driver[k] if result.carries[k] else "open",
            f"{result.mesh_force[k]:.1f}",
            f"{100.0 * result.helix_share[k]:.2f}" if two else "-",
            f"{1e6 * result.mesh_deflection[k]:.3f}",
            *(f"{_rounded(value, 0.5):.0f}" for value in result.mesh_force_on_gear[k]),
            "-" if phase != phase else f"{phase:.4f}",
        )
    return out


def _triple(values: np.ndarray) -> str:
    return ", ".join(f"{_rounded(value, 0.005):.2f}" for value in values)


def _along(result: StaticResult) -> list[str]:
    """What the table of the faces means."""
    if not result.faces:
        return []
    agreed = (
        f"; shafts and faces agreed in {result.passes} pass{'es'[: 2 * (result.passes != 1)]}" if result.passes else ""
    )
    return [
        f"f_ma: misalignment by the shafts, + where flanks stand apart at larger z; z from the middle of the face{agreed}"
    ]


def _faces(result: StaticResult) -> Any:
    out = table("along the face", "f_ma um", "given um", "K_Hbeta", "F at z mm", "peak at mm", "p_max MPa", left=1)
    for row in result.faces:
        two = len(result.contacts_of(row.mesh)) == 2
        out.add_row(
            f"{row.mesh} {'LR'[row.helix]}" if two else row.mesh,
            f"{_rounded(1e6 * row.shaft_misalignment_m, 5e-4):+.3f}",
            f"{1e6 * row.given_misalignment_m:+.3f}" if row.given_misalignment_m else "-",
            "-" if row.face_load_factor is None else f"{row.face_load_factor:.3f}",
            "-" if row.load_place_m is None else f"{_rounded(1e3 * row.load_place_m, 5e-4):+.3f}",
            "-" if row.peak_place_m is None else f"{_rounded(1e3 * row.peak_place_m, 5e-3):+.2f}",
            "-" if row.peak_pressure_pa is None else f"{1e-6 * row.peak_pressure_pa:.1f}",
        )
    return out


def _sensitivities(result: StaticResult) -> list[Any]:
    """Change of the first branch's share in percentage points, largest first."""
    first = result.shares[0]
    rows = []
    for name, change in zip(result.parameter, result.share_derivative, strict=True):
        part, _, key = name.rpartition(".")
        step, words = _STEPS["index_error" if key.endswith("index_error") else key]
        helix = " at the larger z" if key == "helix_index_error" else ""
        rows.append((abs(step * change[0]), step * change[0], part, f"{words}{helix}"))
    rows.sort(key=lambda row: -float(f"{row[0]:.6g}"))  # mirrored parts are equal but for rounding: as in the file
    out = table("what changes", "by", "share, points", left=2)
    for _, change, part, words in rows[:_LINES]:
        out.add_row(part, words, f"{100.0 * change:+.3f}")
    more = f" (the {_LINES} largest of {len(rows)}; --json has all)" if len(rows) > _LINES else ""
    return [heading(f"Share of {first.mesh} in {first.gear}", f", change in percentage points{more}"), out]


def _supports(result: StaticResult) -> Any:
    out = table("on the shaft, from", "Fx N", "Fy N", "Fz N", "Mx N m", "My N m", "Mz N m")
    for kind, forces in (("", result.bearing_force), ("support ", result.support_force)):
        for name, value in forces.items():
            if kind and not value.any():
                continue
            out.add_row(
                f"{kind}{name}",
                *(f"{_rounded(x, 0.05):.1f}" for x in value[:3]),
                *(f"{_rounded(x, 0.005):.2f}" for x in value[3:]),
            )
    return out


def _rounded(value: float, least: float) -> float:
    """The value, or 0 where its digits would all be zeros: rounding alone decides its sign, and "-0.0" says nothing."""
    return value if abs(value) >= least else 0.0
