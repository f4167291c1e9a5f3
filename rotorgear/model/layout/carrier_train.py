"""Trains with carriers: the speeds of parts that meshes on carriers join, in exact fractions.

Every part of the train that meshes and couplings of shafts in bearings join turns with one unknown speed. A mesh on a carrier
is a linear equation between three of them, a held shaft and a given speed are one each. Elimination keeps the equations solved
for one unknown each, so that what is left of a new one is told at once: nothing (it repeats what is known), a contradiction, or
a further speed. The unknowns that no equation is solved for are the free rotations of the train.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction

from rotorgear.errors import Problem
from rotorgear.model.layout.train import EXTREME_RATIO, LOOP_TOLERANCE, Link, Ratio, Train, ratio_text
from rotorgear.model.parts.tables import Tables

# Three shafts of a mesh on a carrier, with their factors: their speeds times these add up to 0; the carrier is the last.
CarrierLink = tuple[str, tuple[tuple[str, Ratio], tuple[str, Ratio], tuple[str, Ratio]]]
# Unknown -> factor; the number behind the equals sign stands at the unknown -1.
_Row = dict[int, Fraction]
_KNOWN = -1


@dataclass
class _Equations:
    """Linear equations, each solved for one unknown.

    Attributes:
        solved: unknown -> the other terms that it is the sum of.
        exact: whether all factors are whole numbers of teeth; base radii close a loop only roughly.
    """

    solved: dict[int, _Row] = field(default_factory=dict)
    exact: bool = True

    def rest(self, row: _Row) -> _Row:
        """What is left of a row where the solved unknowns are put in."""
        left: _Row = {}
        for unknown, factor in row.items():
            terms = self.solved.get(unknown, {unknown: Fraction(1)})
            for other, share in terms.items():
                left[other] = left.get(other, Fraction(0)) + factor * share
        least = 0.0 if self.exact else LOOP_TOLERANCE * max((abs(float(x)) for x in row.values()), default=0.0)
        return {unknown: factor for unknown, factor in left.items() if abs(factor) > least}

    def add(self, row: _Row, last: int) -> _Row:
        """Take an equation (row = 0) in and return what was left of it; the unknown `last` is solved for only if need be."""
        left = self.rest(row)
        unknowns = [unknown for unknown in left if unknown != _KNOWN]
        if unknowns:
            pivot = max(unknowns, key=lambda unknown: (unknown != last, unknown))
            terms = {other: -factor / left[pivot] for other, factor in left.items() if other != pivot}
            for unknown, known in self.solved.items():
                if pivot in known:
                    self.solved[unknown] = _put_in(known, pivot, terms)
            self.solved[pivot] = terms
        return left


def _put_in(row: _Row, pivot: int, terms: _Row) -> _Row:
    factor = row[pivot]
    new = {unknown: share for unknown, share in row.items() if unknown != pivot}
    for other, share in terms.items():
        new[other] = new.get(other, Fraction(0)) + factor * share
    return {unknown: share for unknown, share in new.items() if share}


def carrier_links(model: Tables, factors: dict[str, tuple[Ratio, Ratio]]) -> list[CarrierLink]:
    """Meshes on carriers, of which `factors` has teeth or base radii of pinion and gear, those of a ring negative."""
    found: list[CarrierLink] = []
    for name, (first, second) in factors.items():
        pair = [model.gears[gear].shaft for gear in (model.meshes[name].pinion, model.meshes[name].gear)]
        carrier = next((shaft.carrier for shaft in map(model.shafts.get, pair) if shaft and shaft.carrier), None)
        if carrier is not None:
            own = model.carriers[carrier].shaft
            found.append((f"meshes.{name}", ((pair[0], first), (pair[1], second), (own, -(first + second)))))
    return found


def solve_parts(train: Train, model: Tables, links: list[Link], carried: list[CarrierLink]) -> list[Problem]:
    """Put the speeds of all shafts into a train whose ratios are those within each part, and the parts that carriers join.

    Returns:
        Equations that contradict each other, and speeds that nothing determines.
    """
    within = {name: _fraction(ratio) for name, ratio in train.ratios.items()}
    part = dict(train.group)
    equations = _Equations(exact=all(isinstance(factor, Fraction) for _, terms in carried for _, factor in terms))
    reference = part[train.reference]
    problems: list[Problem] = []

    def row(*terms: tuple[str, Ratio]) -> _Row:
        found: _Row = {}
        for shaft, factor in terms:
            found[part[shaft]] = found.get(part[shaft], Fraction(0)) + _fraction(factor) * within[shaft]
        return found

    for _, terms in carried:
        equations.add(row(*terms), reference)
    joined = {part[shaft] for _, terms in carried for shaft, _ in terms}
    given = {
        name: ratio for name in model.shafts if part[name] in joined and (ratio := given_ratio(model, name)) is not None
    }
    for name in [name for name, ratio in given.items() if ratio == 0]:
        left = equations.add(row((name, Fraction(1))), reference)
        if left and set(left) == {reference}:
            address = f"shafts.{name}.speed_ratio"
            text = f"the input shaft '{train.reference}' stands still then"
            problems.append(Problem(address, "0", "a train that turns", f"{text}: hold another shaft"))
    if problems:
        return problems
    free = {unknown: dict(equations.solved.get(unknown, {unknown: Fraction(1)})) for unknown in set(part.values())}
    _join(train, links, carried)
    known = {train.reference: Fraction(1), **{name: ratio for name, ratio in given.items() if ratio != 0}}
    for name, ratio in known.items():
        left = equations.add(row((name, Fraction(1))) | {_KNOWN: -ratio}, _KNOWN)
        if set(left) == {_KNOWN}:
            text = f"{ratio_text(ratio + left[_KNOWN])}, which follows from the train"
            problems.append(Problem(f"shafts.{name}.speed_ratio", f"{float(ratio):.9g}", text, "leave speed_ratio out"))
    driven = {train.group[name] for name in known}
    unknown_parts = set()
    for name in train.ratios:
        left = equations.rest({part[name]: within[name]})
        if set(left) - {_KNOWN} and (part[name] not in joined or train.group[name] not in driven):
            # Nothing drives it, so it stands still, or turns as the file says.
            own = given_ratio(model, name) if part[name] not in joined else None
            train.ratios[name] = within[name] * (own or Fraction(0))
            continue
        if set(left) - {_KNOWN}:
            unknown_parts.add(name)
            continue
        speed = left.get(_KNOWN, Fraction(0))
        train.ratios[name] = speed if equations.exact else float(speed)
        if abs(speed) > EXTREME_RATIO:
            text = f"a ratio of {float(speed):.3g} to the input shaft"
            problems.append(Problem(f"shafts.{name}", text, f"ratios below {EXTREME_RATIO:g}"))
    if unknown_parts:
        central = [name for name in model.shafts if name in unknown_parts and model.shafts[name].carrier is None]
        names = ", ".join(f"'{name}'" for name in central)
        why = "required of one of them: speed_ratio = 0 where it is held, or the second given speed of a differential"
        problems.append(Problem(f"shafts.{central[0]}.speed_ratio", "", f"missing: nothing says how {names} turn", why))
    for group in {train.group[name] for name in train.ratios if part[name] in joined}:
        train.rotations[group] = tuple(_rotations(train, group, part, within, free))
    return problems


def given_ratio(model: Tables, shaft: str) -> Fraction | None:
    """Speed of a shaft over that of the input shaft as the file gives it, its digits taken as a fraction."""
    part = model.shafts[shaft]
    if part.speed_ratio is not None:
        return Fraction(repr(part.speed_ratio))
    if part.speed is not None and model.operating_speed:
        return Fraction(part.speed / model.operating_speed).limit_denominator(10**9)
    return None


def _rotations(
    train: Train, group: int, part: dict[str, int], within: dict[str, Fraction], free: dict[int, _Row]
) -> Iterator[dict[str, Ratio]]:
    """Speeds of the shafts of a group in each of its free rotations."""
    shafts = [name for name in train.ratios if train.group[name] == group]
    unknowns = sorted({unknown for name in shafts for unknown in free[part[name]]})
    if len(unknowns) == 1 and part[train.reference] in {part[name] for name in shafts}:
        yield train.ratios
        return
    for unknown in unknowns:
        yield {name: within[name] * free[part[name]].get(unknown, Fraction(0)) for name in shafts}


def _join(train: Train, links: list[Link], carried: list[CarrierLink]) -> None:
    """Groups, depths and ways of a train with its carriers: the walk once more, over all meshes."""
    beside: dict[str, list[tuple[str, str]]] = {name: [] for name in train.ratios}
    every: list[tuple[str, tuple[str, ...]]] = [(address, (one, other)) for address, one, other, _ in links]
    every += [(address, tuple(shaft for shaft, _ in terms)) for address, terms in carried]
    for address, shafts in every:
        for one in shafts:
            beside[one] += [(address, other) for other in shafts if other != one]
    for values in (train.depth, train.group, train.reached_by):
        values.clear()
    for start in [train.reference, *train.ratios]:
        if start in train.depth:
            continue
        train.depth[start] = 0
        train.group[start] = len(set(train.group.values()))
        train.reached_by[start] = ""
        queue = deque([start])
        while queue:
            shaft = queue.popleft()
            for address, other in beside[shaft]:
                if other not in train.depth:
                    train.depth[other] = train.depth[shaft] + 1
                    train.group[other] = train.group[start]
                    train.reached_by[other] = address
                    queue.append(other)


def _fraction(ratio: Ratio) -> Fraction:
    return ratio if isinstance(ratio, Fraction) else Fraction(ratio)
