"""Result of a direct calculation of critical speeds, and of a map of them over support stiffness."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.results.laws import AboutEquilibrium
from rotorgear.results.modal import WHIRL_WORDS, WRITTEN_WHIRL, NodeTable, Piece
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Declared, Record, Written, derived, of
from rotorgear.results.table import Block, Column, Line, error_words, exact, grid, table_of


class CriticalSpeed(Record):
    """A speed at which a line of excitation meets a mode."""

    line: str = of("excitation line", column="line")
    speed: float = of("speed of the input shaft", "rad/s", form=".2f", column="rpm")
    frequency_hz: float = of(
        "frequency", "Hz", note=" of the mode there, the damped one", form=exact(".3f"), column="Hz"
    )
    damping_ratio: float = of(
        "damping ratio", note=" of the mode there; 0 in an undamped analysis", form=".3f", column="zeta %"
    )
    whirl: str = of(
        "sense of whirl", note=' there, for the shaft whose line it is; `""` where that does not bend', column="whirl"
    )
    participation: float = of("share of the exciting part in the energy of the mode")
    excited: bool = of("whether the line can excite the mode", note=": whether the participation is above 1e-4")
    description: str = of("what moves", column="what moves")
    residual: float = of(
        "residual", note=" |w - p W| / (p W), with the eigenvalue solved for again at that speed", form=error_words
    )
    error_estimate: float = of(
        "estimated relative discretisation error",
        note=" of the speed; infinite (`null`) where the mesh can't follow the shape",
        default=0.0,
        form=error_words,
        column="error",
    )


def _column(one: Declared) -> Written:
    """The critical speeds are written by columns: a list over all of them for each field but the speed."""

    def entries(result: CriticalResult, speeds: tuple[CriticalSpeed, ...]) -> list[Any]:
        return [getattr(item, one.name) for item in speeds]

    return Written(one.name, entries, one.unit, ("critical_speed",), one.label, one.note)


class CriticalResult(AboutEquilibrium, kind="critical"):
    """c critical speeds, ascending; shapes have modal mass 1."""

    damped: bool = of("whether damping and circulatory terms took part")
    low_speed: float = of("lowest speed looked at", "rad/s")
    top_speed: float = of("highest speed looked at", "rad/s", note=", negative for the other sense")

    @derived("critical speeds of the input shaft", "rpm", "critical_speed", form=".2f")
    def critical_speed_rpm(self) -> np.ndarray:
        """Speeds of the input shaft in rpm, (c,)."""
        return np.array([item.speed * RPM_PER_RAD_S for item in self.speeds])

    speeds: tuple[CriticalSpeed, ...] = of(
        "critical speeds",
        "",
        "critical_speed",
        record=CriticalSpeed,
        json=tuple(_column(one) for one in CriticalSpeed.declarations.values() if one.name != "speed"),
    )
    lines: tuple[ExcitationOrder, ...] = of("excitation lines", "", "line", record=ExcitationOrder)
    shapes: np.ndarray = of("displacements x y z tx ty tz", "m, rad", "node", "component", "critical_speed", json=None)
    nodes: NodeTable = of("nodes", record=NodeTable, json=None)
    discretisation: tuple[Piece, ...] = of("how each shaft segment was divided", "", "piece", record=Piece)

    def __len__(self) -> int:
        return len(self.speeds)

    @property
    def worst_residual(self) -> float:
        """Largest residual; 0 without critical speeds."""
        return max((item.residual for item in self.speeds), default=0.0)

    def tables(self) -> Iterator[Block]:
        """The critical speeds and the notes."""
        kind = "damped" if self.damped else "undamped"
        title = self.model.title or "Critical speeds"
        yield Line(f"{title}: {kind} critical speeds to {self.top_speed * RPM_PER_RAD_S:.6g} rpm")
        part = Column("energy\n%", "participation", ".2f", "%", where=lambda one: one.excited, without="none")
        columns = ("speed", "frequency_hz", "line", *(("damping_ratio",) if self.damped else ()), "whirl", part)
        # A critical speed is written by columns.
        keys = {"speed_rpm": "critical_speed_rpm"}
        yield table_of(self, "speeds", *columns, "description", at=lambda k, key: (keys.get(key, key), k))
        # The residuals' power of ten; below 1e-12 they are rounding.
        bound = 10.0 ** math.ceil(math.log10(max(self.worst_residual, 1e-12)))
        worst = max((one.error_estimate for one in self.speeds), default=0.0)
        yield from ("", f"{self.dofs} dofs, {self.cost}; {self.method}")
        yield f"substituted back: |w - p W| / (p W) at most {bound:.0e}"
        yield f"estimated relative discretisation error of the speeds at most {error_words(worst)}"
        yield from self.remarks()


class CriticalMap(ModelResult, kind="critical_map"):
    """Undamped critical speeds over one radial stiffness of all bearings.

    The k-th lowest speed never falls with the stiffness (Rayleigh), whatever its mode looks like; NaN beyond the last one below
    `top_speed`. `dofs` are those of the largest problem.
    """

    line: str = of("excitation line", note=" of the map")
    stiffness: np.ndarray = of("stiffness", "N/m", "stiffness", note=", radial, of all bearings")
    critical_speeds: np.ndarray = of(
        "critical speeds of the input shaft", "rad/s", "stiffness", "critical_speed", json="critical_rpm"
    )
    whirl: np.ndarray = of(
        "sense of whirl",
        "",
        "stiffness",
        "critical_speed",
        json=WRITTEN_WHIRL,
        note=' of the shaft whose line it is, `""` for a torsional or axial mode; in Python numbers into `WHIRL_WORDS`',
    )
    bearings: dict[str, np.ndarray] = of(
        "radial stiffness of the bearings along x and y", "N/m", "BEARING", "xy", json="bearing_stiffness_n_per_m"
    )
    top_speed: float = of("highest speed looked at", "rad/s")

    @derived("critical speeds with forward whirl", "rad/s", "stiffness", "forward_speed", note=", ascending: no curves")
    def forward(self) -> np.ndarray:
        """Those of `critical_speeds` with forward whirl, (k, f), NaN behind the last one."""
        return self._with("forward")

    @derived(
        "critical speeds with backward whirl", "rad/s", "stiffness", "backward_speed", note=", ascending: no curves"
    )
    def backward(self) -> np.ndarray:
        """Those of `critical_speeds` with backward whirl, (k, b), NaN behind the last one."""
        return self._with("backward")

    @derived(
        "critical speeds of modes that do not whirl", "rad/s", "stiffness", "other_speed", note=", ascending: no curves"
    )
    def other(self) -> np.ndarray:
        """Those of `critical_speeds` that whirl in no single sense, (k, o), NaN behind the last one."""
        return self._with("", "planar", "mixed")

    def _with(self, *words: str) -> np.ndarray:
        chosen = np.isin(self.whirl, [WHIRL_WORDS.index(word) for word in words]) & np.isfinite(self.critical_speeds)
        # Chosen ones first, in the order they have.
        order = np.argsort(~chosen, axis=1, kind="stable")
        found = np.take_along_axis(np.where(chosen, self.critical_speeds, np.nan), order, axis=1)
        return np.asarray(found[:, : int(chosen.sum(axis=1).max(initial=0))])

    def tables(self) -> Iterator[Block]:
        """Critical speeds in ascending order, whirl by letter."""
        rows = []
        for k in range(0, len(self.stiffness), max(1, len(self.stiffness) // 8)):
            known = [(v, WHIRL_WORDS[w]) for v, w in zip(self.critical_speeds[k], self.whirl[k], strict=True) if v == v]
            speeds = ", ".join(f"{v * RPM_PER_RAD_S:.0f} {word[:1]}".rstrip() for v, word in known)
            rows.append((f"{self.stiffness[k]:.2e}", speeds))
        title = f"Undamped map: {self.line}, rpm of the input shaft"
        yield grid(rows, "N/m", "critical speeds", left=0, last=True, caption=title, titled=True)
        yield "f forward, b backward, m mixed, p planar for the shaft of the line; no letter: torsional or axial"
