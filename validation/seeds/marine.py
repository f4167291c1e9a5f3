"""The marine dual-turbine train: statics, modes, and contact statistics of the low-pressure branch over the load ratio.

gamma = T_lp/T_hp at a total torque; a drag torque acts on the LP turbine. Where the net torque of that branch is negative its
teeth carry on the back flanks.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.analysis.sweep.classify import CHAOTIC, NOT_SETTLED
from validation.seeds import misprints
from validation.seeds.models import changed, loaded
from validation.seeds.motions import STARTS, ends, kinds, most, number, order, route, spread

MODEL = "marine_dual_turbine"
DRAG = 11.2e3
PITCH_RADIUS = 0.075
STIFFNESS = 1.2e10
# Super-periods of 8 periods of the first stage, after which both stages repeat. After 400, large chaos at a load ratio of 0.4
# has not died out yet.
SETTLE = 2000
COUNT = 200
STEPS = 40
# Periodic orbits that a sweep certifies: a motion on one stays there.
STABLE = ("1T", "2T", "3T", "4T")
# Load ratios looked at for the regions, those with printed numbers, and total torques (N m) of the map.
RATIOS = tuple(round(0.1 + 0.05 * i, 2) for i in range(23))
PRINTED = {"03": 0.3, "06": 0.6, "10": 1.0}
TOTALS = tuple(1e3 * total for total in (15, 20, 25, 30, 35, 40, 50, 60))
# On the map, where it may be another region after a longer time: bursts of weak chaos come and go.
OPEN = "-"
NOMINAL = 15e3 / PITCH_RADIUS / STIFFNESS
# Friction and film damping have no numbers in the account; friction needs teeth, which it does not give either.
FRICTION = 0.05
FILM = 1.5
# What `python -m validation.seeds.settling map` found after 200,000: chaos that had died out, an amplitude that crosses the bound
# of region II, and two motions that no longer read as quasi-periodic. Total torques and load ratios.
OTHER_LATER = {(15e3, 1.15), (20e3, 0.75), (50e3, 0.40), (60e3, 0.15)}
# Super-periods that settle on the map; those of the second number where a motion is not on a periodic orbit after the first.
MAP_SETTLE = (SETTLE, 10 * SETTLE)


@dataclass(frozen=True)
class Contact:
    """LP first stage in steady motion: share of the time on the back side and apart; peak to peak (m) of the mesh deflection;
    its net torque (N m); largest Lyapunov exponent with its standard error, over a period of the first stage."""

    back: float
    apart: float
    peak_to_peak: float
    net_torque: float
    exponent: float
    exponent_error: float


def operating(
    gamma: float,
    total: float = 30e3,
    *,
    drag: float = DRAG,
    table_stiffness: bool = False,
    friction: float = 0.0,
    film: float = 1.0,
) -> rg.Model:
    """The model at a load ratio and a total torque (N m); `film` multiplies the damping of the teeth."""
    hp = total / (1.0 + gamma)
    meshes: dict[str, dict[str, object]] = {name: {} for name in ("first_hp", "first_lp", "second_hp", "second_lp")}
    if table_stiffness:
        for name, keys in meshes.items():
            k, m_e = (1.2e8, 87.5) if name.startswith("first") else (2.5e8, 280.0)
            keys |= {"stiffness": k, "damping": 0.14 * math.sqrt(k * m_e)}
    base = loaded(MODEL)
    if film != 1.0:
        for name, keys in meshes.items():
            keys["damping"] = film * (base.meshes[name].damping or 0.0)
    if friction:
        for keys in meshes.values():
            keys["friction_coefficient"] = friction
    return changed(
        _with_teeth(base) if friction else base,
        meshes=meshes,
        loads={
            "hp": {"torque": hp},
            "propeller": {"torque": None},
            "lp": {"torque": gamma * hp},
            "lp_drag": {"torque": drag},
        },
    )


def _with_teeth(base: rg.Model) -> rg.Model:
    """The gears by teeth that have the printed base radii: 20 deg at the printed helix of 25 deg, and so 21.88 deg transverse.

    In torsion they act as spur teeth of that transverse section: friction then turns its sense on all of the face at once, which
    is the most that it can excite.
    """
    helix = math.radians(25.0)
    angle = math.atan(math.tan(math.radians(20.0)) / math.cos(helix))
    module = 2.0 * PITCH_RADIUS / 25.0 / math.cos(angle)
    gears = {
        name: {
            "base_radius": None,
            "normal_module": module,
            "normal_pressure_angle": angle,
            # Addendum of the normal module.
            "addendum_factor": math.cos(helix),
            "dedendum_factor": 1.25 * math.cos(helix),
            "width": 0.2,
            "mass": 1.0,
            "diametral_inertia": 1.0,
        }
        for name in base.gears
    }
    return changed(base, gears=gears)


def contact(
    gammas: Sequence[float],
    total: float = 30e3,
    *,
    settle: int = SETTLE,
    count: int = COUNT,
    table_stiffness: bool = False,
) -> list[Contact]:
    """Run to steady motion at load ratios and count."""
    result = rg.sweep(
        loaded(MODEL),
        {"load ratio": list(gammas)},
        steps=STEPS,
        discard=settle,
        sample=count,
        change=lambda _, at: operating(at[0], total, table_stiffness=table_stiffness),
    )
    i = result.contact.index("first_lp")
    found = []
    for p, gamma in enumerate(gammas):
        net = gamma * total / (1.0 + gamma) - DRAG
        found.append(
            Contact(
                float(result.back[p, 0, i]),
                float(result.apart[p, 0, i]),
                float(result.peak_to_peak[p, 0, i]),
                net,
                float(result.lyapunov[p, 0, 0]),
                float(result.lyapunov_error[p, 0, 0]),
            )
        )
    return found


def swept(
    gammas: Sequence[float], total: float = 30e3, *, settle: int = SETTLE, starts: int = STARTS, **options: float | bool
) -> rg.SweepResult:
    """Motions over load ratios from several starts; `options` are those of `operating`."""
    return rg.sweep(
        loaded(MODEL),
        {"load ratio": list(gammas)},
        steps=STEPS,
        discard=settle,
        sample=COUNT,
        initial_conditions=starts,
        change=lambda _, at: operating(at[0], total, **options),  # type: ignore[arg-type]
    )


def _begin(settle: int) -> str:
    return f"static; {settle} + {COUNT} of 8 T_m1"


def indicators(result: rg.SweepResult, suffix: str, nominal: float = NOMINAL, settle: int = SETTLE) -> dict[str, str]:
    """Exponent, amplitude, time on the back side and starts at the printed load ratios, by key."""
    i = result.contact.index("first_lp")
    found = {}
    for p, name in enumerate(PRINTED):
        own = kinds(result, p)
        found |= {
            f"motion_{name}{suffix}": most(own),
            f"le_{name}{suffix}": number(result.lyapunov[p, :, 0], own, 4),
            f"am_{name}{suffix}": spread(result.peak_to_peak[p, :, i] / nominal, own, 2),
            f"force_{name}{suffix}": spread(1e-3 * result.largest_force[p, :, i], own, 1),
            f"zeta_{name}{suffix}": number(result.back[p, :, i], own, 3),
            f"apart_{name}{suffix}": number(result.apart[p, :, i], own, 3),
            f"runs_{name}{suffix}": f"{_begin(settle)}; {ends(own)}",
        }
    return found


def torque_indicators(settle: int = SETTLE) -> dict[str, str]:
    """At both total torques with printed results."""
    ratios = list(PRINTED.values())
    return indicators(swept(ratios, settle=settle), "", settle=settle) | indicators(
        swept(ratios, 35e3, settle=settle), "_35", settle=settle
    )


def way(total: float, settle: int = SETTLE, starts: int = 1) -> rg.SweepResult:
    """Motions over the load ratio in steps of 0.02."""
    return swept([round(0.1 + 0.02 * i, 2) for i in range(56)], total, settle=settle, starts=starts)


def way_names(result: rg.SweepResult) -> list[str]:
    """Motions over the load ratio, periods counted in common ones of both stages; from 4T on they count as others."""
    found = [result.motion_at(p) for p in range(len(result.values))]
    return [kind if kind in ("1T", "2T") else "others" for kind in found]


def torque_map(
    totals: Sequence[float] = TOTALS, ratios: Sequence[float] = RATIOS, settle: Sequence[int] = MAP_SETTLE
) -> list[list[str]]:
    """Region of each total torque and load ratio, from the static start.

    What is on no stable periodic orbit after the first number of super-periods settles for the next one.
    """
    points = [(total, ratio) for total in totals for ratio in ratios]
    region = dict.fromkeys(points, "")
    moving = points
    for each in settle:
        result = rg.sweep(
            loaded(MODEL),
            {"point": list(range(len(moving)))},
            steps=STEPS,
            discard=each,
            sample=COUNT,
            change=lambda _, at, moving=moving: operating(moving[int(at[0])][1], moving[int(at[0])][0]),
        )
        region |= zip(moving, regions_of(result), strict=True)
        moving = [point for p, point in enumerate(moving) if result.motion_at(p) not in STABLE]
        if not moving:
            break
    return [[region[total, ratio] for ratio in ratios] for total in totals]


def told_map() -> list[list[str]]:
    """The map as the page tells it: what is another region after ten times the settling is open."""
    return [
        [OPEN if (total, ratio) in OTHER_LATER else region for ratio, region in zip(RATIOS, row, strict=True)]
        for total, row in zip(TOTALS, torque_map(), strict=True)
    ]


def regions_of(result: rg.SweepResult) -> list[str]:
    """Region of each point.

    I: the LP first stage is on its back side for most of the time in contact, and not chaotic. II: chaotic, with an amplitude
    above 3. III: all others. "-": weak chaos, or not settled.
    """
    i = result.contact.index("first_lp")
    row = []
    for p in range(len(result.values)):
        motion = result.motion_at(p)
        large = result.peak_to_peak[p, 0, i] > 3.0 * NOMINAL
        back = result.back[p, 0, i] > result.driving[p, 0, i]
        if motion == NOT_SETTLED or (motion == CHAOTIC and not large):
            row.append(OPEN)
        elif motion == CHAOTIC:
            row.append("II")
        else:
            row.append("I" if back else "III")
    return row


def map_words(rows: Sequence[Sequence[str]], ratios: Sequence[float] = RATIOS) -> dict[str, float | str]:
    """Load ratios of region II at each total torque, how many rows have all three regions in their order, and the rows."""
    spans = []
    in_order = 0
    for total, row in zip(TOTALS, rows, strict=True):
        chaos = [gamma for gamma, region in zip(ratios, row, strict=True) if region == "II"]
        spans.append(f"{total / 1e3:.0f}: " + (f"{chaos[0]:.2f} to {chaos[-1]:.2f}" if chaos else "none"))
        kept = [region for region in row if region != OPEN]
        first = [kept.index(name) if name in kept else -1 for name in ("I", "II", "III")]
        in_order += -1 < first[0] < first[1] and "III" in kept[first[1] :]
    regions = {f"map_{total / 1e3:.0f}": " ".join(row) for total, row in zip(TOTALS, rows, strict=True)}
    return {"map_chaos": ", ".join(spans), "map_order": float(in_order), **regions, **_slopes(rows, ratios)}


def _slopes(rows: Sequence[Sequence[str]], ratios: Sequence[float]) -> dict[str, float]:
    """Exponents n of gamma ~ T^n of both boundaries of region II, by least squares of logarithms over the totals that have it.

    The upper boundary counts where region III follows within the ratios looked at.
    """
    ends = [
        (total, [gamma for gamma, region in zip(ratios, row, strict=True) if region == "II"])
        for total, row in zip(TOTALS, rows, strict=True)
    ]
    lower = [(total, chaos[0]) for total, chaos in ends if chaos]
    upper = [(total, chaos[-1]) for total, chaos in ends if chaos and chaos[-1] < ratios[-1]]
    return {
        f"slope_{word}": float(np.polyfit(*np.log(np.array(points)).T, 1)[0])
        for word, points in (("low", lower), ("high", upper))
    }


def _way_values(total: float, suffix: str) -> dict[str, str]:
    over = way(total)
    return {f"way{suffix}": route(over, way_names(over), ".2f"), f"way_order{suffix}": order(way_names(over))}


def at_printed(suffix: str, nominal: float = NOMINAL, settle: int = SETTLE, **options: Any) -> dict[str, str]:
    """Indicators at the printed load ratios with some options of `swept`."""
    return indicators(swept(list(PRINTED.values()), settle=settle, **options), suffix, nominal, settle)


def with_friction(suffix: str, settle: int = SETTLE) -> dict[str, str]:
    """The same with friction between the teeth."""
    return at_printed(suffix, settle=settle, starts=4, friction=FRICTION)


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], Mapping[str, Any]]] = {
    "torques": torque_indicators,
    "way_30": lambda: _way_values(30e3, ""),
    "way_35": lambda: _way_values(35e3, "_35"),
    "regions": lambda: region_values(30e3, "") | region_values(35e3, "_35"),
    "printed_stiffness": lambda: at_printed("_soft", 100.0 * NOMINAL, starts=1, table_stiffness=True),
    "friction": lambda: with_friction("_rub"),
    "film": lambda: at_printed("_film", starts=4, film=FILM),
    "map": lambda: map_words(told_map()),
}


def in_region(run: Contact) -> bool:
    """Whether a motion is of region II: an exponent above 0.1 and an amplitude indicator above 3."""
    return run.peak_to_peak > 3.0 * NOMINAL and run.exponent > 0.1


def region(total: float, settle: int = SETTLE) -> str:
    """Load ratios of region II, from the static start."""
    found = zip(RATIOS, contact(RATIOS, total, settle=settle), strict=True)
    large = [gamma for gamma, run in found if in_region(run)]
    return f"{large[0]:.2f} to {large[-1]:.2f}"


def region_values(total: float, suffix: str) -> dict[str, float | str]:
    """The load ratios of region II as a text, and its ends."""
    text = region(total)
    low, _, high = text.partition(" to ")
    return {f"region{suffix}": text, f"region_low{suffix}": float(low), f"region_high{suffix}": float(high)}


def derived(values: Mapping[str, Any]) -> dict[str, str]:
    """Both ends of the way over the load ratio at 35 kN m, three motions each."""
    way = values["way_order_35"].split(", ")
    return {"way_in_35": ", ".join(way[:3]), "way_out_35": ", ".join(way[-3:])}


def quick() -> dict[str, float | str]:
    """What follows without a run."""
    model = loaded(MODEL)
    modes = rg.modal(model)
    free = operating(0.6, drag=1e-9)
    loads = rg.check(free).to_dict()["torques"]
    frequencies = rg.check(model).to_dict()["meshes"]
    hz = {row["name"]: row["mesh_frequency_hz"] for row in frequencies}
    m_e = 1.0 / (0.075**2 / 15.8 + 0.240**2 / 5.2)
    return {
        "zeta_m": (model.meshes["first_hp"].damping or 0.0) / (2.0 * math.sqrt(STIFFNESS * m_e)),
        "load_torque": abs(next(row["torque_n_m"] for row in loads if row["name"] == "loads.propeller")) / 1e3,
        "rigid_modes": float(modes.rigid.sum()),
        "stage_ratio": hz["second_hp"] / hz["first_hp"],
        "deflection_table": 1e3 * 15e3 / PITCH_RADIUS / 1.2e8,
        "deflection_over": 15e3 / PITCH_RADIUS / 1.2e8 / 40e-6,
        "periodic_motions": ", ".join(STABLE),
        "deflection_set": 1e6 * 15e3 / PITCH_RADIUS / STIFFNESS,
        "first_elastic": float(modes.frequency_hz[1]),
        "ratio_low": RATIOS[0],
        "ratio_high": RATIOS[-1],
        "hp_low": 1e-3 * TOTALS[0] / (1.0 + RATIOS[-1]),
        "hp_high": 1e-3 * TOTALS[-1] / (1.0 + RATIOS[0]),
        # T_ref that each printed boundary needs: eta = gamma sqrt(T_total/T_ref) at the printed load ratios and 30 kN m.
        "reference_1": 30.0 * (0.4 / 0.25) ** 2,
        "reference_2": 30.0 * (0.8 / 0.55) ** 2,
        # Where the net torque of the LP branch changes its sign at 30 kN m.
        "turn": DRAG / (30e3 - DRAG),
        "unbalanced": misprints.marine_balance()[0],
        "unbalanced_meant": misprints.marine_balance()[1],
        "asymmetry": misprints.marine_stiffness(),
    }
