"""The gear train: speed and sense of every shaft, by a walk over meshes and couplings from the input shaft.

An external mesh multiplies the speed by -z_1/z_2, an internal one by z_1/z_2, a coupling with torsional stiffness by 1. A bevel
pair counts as an external one where both axes lead away from the apex, or both to it, else as an internal one. A closed loop
(split torque) must give one ratio on every path; with whole numbers of teeth that is decided in exact fractions.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from fractions import Fraction

from rotorgear.errors import Problem
from rotorgear.model.layout.bevel import meeting
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.tables import Tables

# Base radii come rounded to a few digits, so a loop of lumped gears closes only to this; loops with teeth close exactly.
LOOP_TOLERANCE = 1e-6
# No train comes near this ratio; within it, speeds and torques stay in the range of numbers.
EXTREME_RATIO = 1e12


# Speed over another speed: exact from numbers of teeth, else a float.
Ratio = Fraction | float
# What joins two shafts kinematically: its address, both shafts, the speed of the second over that of the first.
Link = tuple[str, str, str, Ratio]
# Shaft -> address, other shaft and its ratio to this one, of each link.
Neighbours = dict[str, list[tuple[str, str, Ratio]]]


@dataclass(frozen=True)
class Train:
    """Speeds of all shafts relative to the reference shaft, and the order of the walk.

    Attributes:
        reference: name of the shaft whose speed is the reference.
        ratios: shaft -> speed over that of the reference; negative turns the other way, 0 stands still.
        depth: shaft -> number of links from the reference (or from the start of its own part of the train).
        group: shaft -> number of the kinematically connected part it belongs to; 0 holds the reference.
        reached_by: shaft -> address of the mesh or coupling through which the walk came, "" at a start.
    """

    reference: str
    ratios: dict[str, Ratio] = field(default_factory=dict)
    depth: dict[str, int] = field(default_factory=dict)
    group: dict[str, int] = field(default_factory=dict)
    reached_by: dict[str, str] = field(default_factory=dict)

    def ratio(self, shaft: str) -> float:
        """Speed of a shaft over that of the reference shaft."""
        return float(self.ratios[shaft])

    def sense(self, shaft: str) -> int:
        """+1 or -1: sense of rotation about +z where the reference turns positively; +1 for a shaft at rest."""
        return -1 if self.ratios[shaft] < 0 else 1


def links(model: Tables) -> list[Link]:
    """List the meshes and the torsionally stiff couplings as links between shafts (parts with errors are skipped)."""
    found: list[Link] = []
    for name, mesh in model.meshes.items():
        pinion = model.gears.get(mesh.pinion)
        gear = model.gears.get(mesh.gear)
        if pinion is None or gear is None or pinion.shaft == gear.shaft:
            continue
        ratio: Ratio
        if pinion.teeth and gear.teeth:
            ratio = -Fraction(pinion.teeth, gear.teeth) * _sides(model, pinion, gear)
        elif pinion.base_radius and gear.base_radius:
            ratio = -pinion.base_radius / gear.base_radius
        else:
            continue
        if gear.internal:
            ratio = -ratio
        found.append((f"meshes.{name}", pinion.shaft, gear.shaft, ratio))
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
    for part, one, other, ratio in links(model):
        beside.setdefault(one, []).append((part, other, ratio))
        beside.setdefault(other, []).append((part, one, 1 / ratio))
    starts = [train.reference, *sorted(model.shafts, key=lambda name: model.shafts[name].speed_ratio is None)]
    for number, start in enumerate(starts):
        if start in train.ratios or start not in model.shafts:
            continue
        given = model.shafts[start].speed_ratio
        problems += _walk_group(train, beside, start, Fraction(1) if number == 0 else (given or Fraction(0)))
    # A shaft's own ratio serves where no mesh or coupling reaches it; elsewhere it may only repeat what the train gives.
    for name, shaft in model.shafts.items():
        if shaft.speed_ratio is None or name not in train.ratios or _same(shaft.speed_ratio, train.ratio(name)):
            continue
        by = train.reached_by[name] or "it is the reference shaft"
        follows = f"{train.ratio(name):.9g}, which follows from the train ({by})"
        address = f"shafts.{name}.speed_ratio"
        problems.append(Problem(address, f"{shaft.speed_ratio:.9g}", follows, "leave speed_ratio out"))
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
                got = f"ratio {_ratio_text(speed)} of shaft '{other}' on this path of a closed loop"
                through = train.reached_by[other] or "the input shaft"
                wanted = f"{_ratio_text(train.ratios[other])}, as on the path through {through}"
                hint = "change the numbers of teeth so that both paths give one ratio"
                problems.append(Problem(part, got, wanted, hint))
    return problems


def _same(first: Ratio, second: Ratio) -> bool:
    if isinstance(first, Fraction) and isinstance(second, Fraction):
        return first == second
    return math.isclose(first, second, rel_tol=LOOP_TOLERANCE, abs_tol=0.0)


def _ratio_text(ratio: Ratio) -> str:
    exact = f" ({ratio.numerator}/{ratio.denominator})" if isinstance(ratio, Fraction) and ratio.denominator > 1 else ""
    return f"{float(ratio):.9g}{exact}"
