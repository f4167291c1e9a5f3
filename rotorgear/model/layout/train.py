"""The gear train: speed and sense of every shaft, by a walk over meshes and couplings from the input shaft.

An external mesh multiplies the speed by -z_1/z_2, a coupling with torsional stiffness by 1. A closed loop (split torque)
must give one ratio on every path; with whole numbers of teeth that is decided in exact fractions.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from fractions import Fraction

from rotorgear.errors import Problem
from rotorgear.model.parts.tables import Tables

# Base radii come rounded to a few digits, so a loop of lumped gears closes only to this; loops with teeth close exactly.
LOOP_TOLERANCE = 1e-6
# No train comes near this ratio; within it, speeds and torques stay in the range of numbers.
EXTREME_RATIO = 1e12


@dataclass(frozen=True)
class Link:
    """What joins two shafts kinematically: `ratio` is the speed of `to_shaft` over that of `from_shaft`."""

    part: str
    from_shaft: str
    to_shaft: str
    ratio: Fraction | float

    def seen_from(self, shaft: str) -> tuple[str, Fraction | float]:
        """Return the other shaft and its ratio to `shaft`."""
        return (self.to_shaft, self.ratio) if shaft == self.from_shaft else (self.from_shaft, 1 / self.ratio)


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
    ratios: dict[str, Fraction | float] = field(default_factory=dict)
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
    found = []
    for name, mesh in model.meshes.items():
        pinion = model.gears.get(mesh.pinion)
        gear = model.gears.get(mesh.gear)
        if pinion is None or gear is None or pinion.shaft == gear.shaft:
            continue
        ratio: Fraction | float | None = None
        if pinion.teeth and gear.teeth:
            ratio = -Fraction(pinion.teeth, gear.teeth)
        elif pinion.base_radius and gear.base_radius:
            ratio = -pinion.base_radius / gear.base_radius
        if ratio is not None:
            found.append(Link(f"meshes.{name}", pinion.shaft, gear.shaft, ratio))
    for name, coupling in model.couplings.items():
        if coupling.turns_both:
            found.append(Link(f"couplings.{name}", coupling.from_shaft, coupling.to_shaft, Fraction(1)))
    return [link for link in found if link.from_shaft in model.shafts and link.to_shaft in model.shafts]


def walk(model: Tables) -> tuple[Train, list[Problem]]:
    """Walk the train from the reference shaft, then from every shaft not reached yet.

    Returns the train and the problems: loops with two ratios, and given speed ratios that contradict the train.
    """
    train = Train(model.reference_shaft)
    problems = []
    at_shaft: dict[str, list[Link]] = {}
    for link in links(model):
        at_shaft.setdefault(link.from_shaft, []).append(link)
        at_shaft.setdefault(link.to_shaft, []).append(link)
    starts = [train.reference, *sorted(model.shafts, key=lambda name: model.shafts[name].speed_ratio is None)]
    for number, start in enumerate(starts):
        if start in train.ratios or start not in model.shafts:
            continue
        given = model.shafts[start].speed_ratio
        first: Fraction | float = Fraction(1) if number == 0 else (given or Fraction(0))
        problems += _walk_group(train, at_shaft, start, first)
    # A shaft's own ratio serves where no mesh or coupling reaches it; elsewhere it may only repeat what the train gives.
    for name, shaft in model.shafts.items():
        if shaft.speed_ratio is None or name not in train.ratios or _same(shaft.speed_ratio, train.ratio(name)):
            continue
        by = train.reached_by[name] or "it is the reference shaft"
        follows = f"{train.ratio(name):.9g}, which follows from the train ({by})"
        address = f"shafts.{name}.speed_ratio"
        problems.append(Problem(address, f"{shaft.speed_ratio:.9g}", follows, "leave speed_ratio out"))
    return train, problems


def _walk_group(train: Train, at_shaft: dict[str, list[Link]], start: str, ratio: Fraction | float) -> list[Problem]:
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
        for link in at_shaft.get(shaft, ()):
            if link.part in used:
                continue
            used.add(link.part)
            other, step = link.seen_from(shaft)
            speed: Fraction | float = train.ratios[shaft] * step
            if speed and not 1.0 / EXTREME_RATIO < abs(float(speed)) < EXTREME_RATIO:
                expected = f"shafts whose speeds differ by less than a factor of {EXTREME_RATIO:g}"
                problems.append(
                    Problem(link.part, f"a ratio of {float(speed):.3g} to the start of the train", expected)
                )
                continue
            if other not in train.ratios:
                train.ratios[other] = speed
                train.depth[other] = train.depth[shaft] + 1
                train.group[other] = group
                train.reached_by[other] = link.part
                queue.append(other)
            elif not _same(speed, train.ratios[other]):
                problems.append(
                    Problem(
                        link.part,
                        f"ratio {_ratio_text(speed)} of shaft '{other}' on this path of a closed loop",
                        f"{_ratio_text(train.ratios[other])}, as on the path through "
                        f"{train.reached_by[other] or 'the input shaft'}",
                        "change the numbers of teeth so that both paths give one ratio",
                    )
                )
    return problems


def _same(first: Fraction | float, second: Fraction | float) -> bool:
    if isinstance(first, Fraction) and isinstance(second, Fraction):
        return first == second
    return math.isclose(first, second, rel_tol=LOOP_TOLERANCE, abs_tol=0.0)


def _ratio_text(ratio: Fraction | float) -> str:
    exact = f" ({ratio.numerator}/{ratio.denominator})" if isinstance(ratio, Fraction) and ratio.denominator > 1 else ""
    return f"{float(ratio):.9g}{exact}"
