"""The walk over a gear train: speed and sense of every shaft, by way over meshes and couplings from the input shaft.

An external mesh multiplies the speed by -z_1/z_2, an internal one by z_1/z_2, a coupling with torsional stiffness by 1. A bevel
pair counts as an external one where both axes lead away from the apex, or both to it, else as an internal one. A closed loop
(split torque) must give one ratio on every path; with whole numbers of teeth that is decided in exact fractions.

The walk gives the speeds of shafts that are joined in this way over that of one of them. A mesh on a carrier c joins three,

    z_1 (w_1 - w_c) + z_2 (w_2 - w_c) = 0        (Willis; z_2 < 0 of a ring)

and with the given speeds these equations are solved in fractions for the speeds of the parts (`carrier_train.py`).
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection
from fractions import Fraction

from rotorgear.errors import Problem
from rotorgear.model.layout.bevel import meeting
from rotorgear.model.layout.carrier_train import carrier_links, given_ratio, solve_parts
from rotorgear.model.layout.train import EXTREME_RATIO, LOOP_TOLERANCE, Link, Neighbours, Ratio, Train, ratio_text
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.tables import Tables


def mesh_factors(model: Tables) -> dict[str, tuple[Ratio, Ratio]]:
    """z_1 and z_2 of each mesh between two shafts, or base radii; z_2 < 0 of a ring and of a bevel pair seen from both sides.

    Parts with errors are skipped.
    """
    found: dict[str, tuple[Ratio, Ratio]] = {}
    for name, mesh in model.meshes.items():
        pinion = model.gears.get(mesh.pinion)
        gear = model.gears.get(mesh.gear)
        if pinion is None or gear is None or pinion.shaft == gear.shaft:
            continue
        if pinion.shaft not in model.shafts or gear.shaft not in model.shafts:
            continue
        side = -1 if gear.internal else 1
        if pinion.teeth and gear.teeth:
            found[name] = (Fraction(pinion.teeth), Fraction(side * gear.teeth) * _sides(model, pinion, gear))
        elif pinion.base_radius and gear.base_radius:
            found[name] = (pinion.base_radius, side * gear.base_radius)
    return found


def links(model: Tables, factors: dict[str, tuple[Ratio, Ratio]], carried: Collection[str] = ()) -> list[Link]:
    """List the meshes and the torsionally stiff couplings as links between shafts, without the meshes on carriers."""
    found: list[Link] = []
    for name, (first, second) in factors.items():
        if f"meshes.{name}" not in carried:
            mesh = model.meshes[name]
            pair = (model.gears[mesh.pinion].shaft, model.gears[mesh.gear].shaft)
            found.append((f"meshes.{name}", *pair, -(first / second)))
    for name, coupling in model.couplings.items():
        if coupling.turns_both:
            found.append((f"couplings.{name}", coupling.from_shaft, coupling.to_shaft, Fraction(1)))
    return [link for link in found if link[1] in model.shafts and link[2] in model.shafts]


def _sides(model: Tables, pinion: Gear, gear: Gear) -> int:
    """-1 for bevel gears of which one axis leads to the apex and the other away from it, else 1."""
    known = pinion.is_bevel and gear.is_bevel and pinion.shaft in model.shafts and gear.shaft in model.shafts
    if not known:
        return 1
    first, second = (model.shafts[one.shaft] for one in (pinion, gear))
    met = meeting((first, second), (first.station(pinion.at), second.station(gear.at)))
    return 1 if met is None else met.sides[0] * met.sides[1]


def walk(model: Tables) -> tuple[Train, list[Problem]]:
    """Walk the train from the reference shaft, then from every shaft not reached yet.

    Returns the train and the problems: loops with two ratios, and given speed ratios that contradict the train.
    """
    train = Train(model.reference_shaft)
    problems = []
    beside: Neighbours = {}
    factors = mesh_factors(model)
    carried = carrier_links(model, factors) if model.carriers else []
    every = links(model, factors, {address for address, _ in carried})
    for part, one, other, ratio in every:
        beside.setdefault(one, []).append((part, other, ratio))
        beside.setdefault(other, []).append((part, one, 1 / ratio))
    given: dict[str, Ratio | None] = {name: shaft.speed_ratio for name, shaft in model.shafts.items()}
    given |= {name: given_ratio(model, name) for name, shaft in model.shafts.items() if shaft.speed is not None}
    starts = [train.reference, *sorted(model.shafts, key=lambda name: given[name] is None)]
    for number, start in enumerate(starts):
        if start in train.ratios or start not in model.shafts:
            continue
        known = number == 0 or bool(carried)
        problems += _walk_group(train, beside, start, Fraction(1) if known else (given[start] or Fraction(0)))
    if carried and not problems:
        return train, solve_parts(train, model, every, carried)
    # A shaft's own ratio serves where no mesh or coupling reaches it; elsewhere it may only repeat what the train gives.
    for name, ratio_given in given.items():
        if ratio_given is None or name not in train.ratios or _same(ratio_given, train.ratio(name)):
            continue
        by = train.reached_by[name] or "it is the reference shaft"
        follows = f"{train.ratio(name):.9g}, which follows from the train ({by})"
        address = f"shafts.{name}.speed_ratio"
        problems.append(Problem(address, f"{ratio_given:.9g}", follows, "leave speed_ratio out"))
    return train, problems


def _walk_group(train: Train, beside: Neighbours, start: str, ratio: Ratio) -> list[Problem]:
    """Go from one shaft to all that links lead to."""
    group = len(set(train.group.values()))
    train.ratios[start] = ratio
    train.depth[start] = 0
    train.group[start] = group
    train.reached_by[start] = ""
    queue = deque([start])
    problems = []
    used = set()
    while queue:
        shaft = queue.popleft()
        for part, other, step in beside.get(shaft, ()):
            if part in used:
                continue
            used.add(part)
            speed = train.ratios[shaft] * step
            if speed and not 1.0 / EXTREME_RATIO < abs(float(speed)) < EXTREME_RATIO:
                got = f"a ratio of {float(speed):.3g} to the start of the train"
                wanted = f"shafts whose speeds differ by less than a factor of {EXTREME_RATIO:g}"
                problems.append(Problem(part, got, wanted))
            elif other not in train.ratios:
                train.ratios[other] = speed
                train.depth[other] = train.depth[shaft] + 1
                train.group[other] = group
                train.reached_by[other] = part
                queue.append(other)
            elif not _same(speed, train.ratios[other]):
                got = f"ratio {ratio_text(speed)} of shaft '{other}' on this path of a closed loop"
                through = train.reached_by[other] or "the input shaft"
                wanted = f"{ratio_text(train.ratios[other])}, as on the path through {through}"
                hint = "change the numbers of teeth so that both paths give one ratio"
                problems.append(Problem(part, got, wanted, hint))
    return problems


def _same(first: Ratio, second: Ratio) -> bool:
    if isinstance(first, Fraction) and isinstance(second, Fraction):
        return first == second
    return math.isclose(first, second, rel_tol=LOOP_TOLERANCE, abs_tol=0.0)
