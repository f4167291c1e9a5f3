"""Result of a direct calculation of critical speeds, and of a map of them over support stiffness."""

from __future__ import annotations

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.results.laws import AboutEquilibrium
from rotorgear.results.modal import WHIRL_WORDS, NodeTable, Piece
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, Written, derived, of


class CriticalSpeed(Record):
    """A speed at which a line of excitation meets a mode."""

    line: str = of("excitation line")
    speed: float = of("speed of the input shaft", "rad/s", json="speed_rpm")
    frequency_hz: float = of("frequency", "Hz", note=" of the mode there, the damped one", form=".3f")
    damping_ratio: float = of("damping ratio", note=" of the mode there; 0 in an undamped analysis")
    whirl: str = of("sense of whirl", note=' there, for the shaft whose line it is; `""` where that does not bend')
    participation: float = of("share of the exciting part in the energy of the mode")
    excited: bool = of("whether the line can excite the mode", note=": whether the participation is above 1e-4")
    description: str = of("what moves")
    residual: float = of(
        "residual",
        note=" |w - p W| / (p W): relative difference of the frequency from the line, with the eigenvalue of the system "
        "solved for again at that speed",
        form=".0e",
    )
    error_estimate: float = of(
        "estimated relative discretisation error",
        note=" of the speed; infinite (`null`) where the mesh can't follow the shape",
        form=".0e",
        default=0.0,
    )


def _columns_of_speeds() -> tuple[Written, ...]:
    """The critical speeds are written by columns: a list over all of them for each field but the speed."""

    def column(name: str) -> Written:
        one = CriticalSpeed.declarations[name]
        return Written(
            name,
            lambda result, speeds: [getattr(item, name) for item in speeds],
            unit=one.unit,
            axes=("critical_speed",),
            label=one.label,
            note=one.note,
        )

    return tuple(column(name) for name in CriticalSpeed.declarations if name != "speed")


class CriticalResult(AboutEquilibrium, kind="critical"):
    """c critical speeds, ascending; shapes have modal mass 1."""

    damped: bool = of("whether damping and circulatory terms took part")
    low_speed: float = of("lowest speed looked at", "rad/s", json="low_speed_rpm")
    top_speed: float = of(
        "highest speed looked at", "rad/s", json="top_speed_rpm", note=", negative for the other sense"
    )

    @derived("critical speeds of the input shaft", "rpm", "critical_speed", form=".2f")
    def critical_speed_rpm(self) -> np.ndarray:
        """Speeds of the input shaft in rpm, (c,)."""
        return np.array([item.speed * RPM_PER_RAD_S for item in self.speeds])

    speeds: tuple[CriticalSpeed, ...] = of(
        "critical speeds", "", "critical_speed", record=CriticalSpeed, json=_columns_of_speeds()
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


class CriticalMap(ModelResult, kind="critical_map"):
    """Undamped critical speeds over one radial stiffness of all bearings.

    The k-th lowest speed never falls with the stiffness (Rayleigh), whatever its mode looks like; NaN beyond the last one below
    `top_speed`. `dofs` are those of the largest problem.
    """

    line: str = of("excitation line", note=" of the map")
    stiffness: np.ndarray = of(
        "stiffness", "N/m", "stiffness", json="stiffness_n_per_m", note=", radial, of all bearings"
    )
    critical_speeds: np.ndarray = of(
        "critical speeds of the input shaft",
        "rad/s",
        "stiffness",
        "critical_speed",
        json="critical_rpm",
        note=", ascending",
    )
    whirl: np.ndarray = of(
        "sense of whirl",
        "",
        "stiffness",
        "critical_speed",
        json=Written(
            "whirl", lambda result, whirl: [[WHIRL_WORDS[number] for number in row] for row in whirl.tolist()]
        ),
        note=' of the shaft whose line it is, `""` for a torsional or axial mode; in Python numbers into `WHIRL_WORDS`',
    )
    bearings: dict[str, np.ndarray] = of(
        "radial stiffness along x and y that the bearings of the model have",
        "N/m",
        "BEARING",
        "xy",
        json="bearing_stiffness_n_per_m",
    )
    top_speed: float = of("highest speed looked at", "rad/s", json="top_speed_rpm")

    @derived(
        "critical speeds with forward whirl",
        "rad/s",
        "stiffness",
        "forward_speed",
        json="forward_rpm",
        note=", ascending at each stiffness: no curves",
    )
    def forward(self) -> np.ndarray:
        """Those of `critical_speeds` with forward whirl, (k, f), NaN behind the last one."""
        return self._with("forward")

    @derived(
        "critical speeds with backward whirl",
        "rad/s",
        "stiffness",
        "backward_speed",
        json="backward_rpm",
        note=", ascending at each stiffness: no curves",
    )
    def backward(self) -> np.ndarray:
        """Those of `critical_speeds` with backward whirl, (k, b), NaN behind the last one."""
        return self._with("backward")

    @derived(
        "critical speeds of modes that do not whirl",
        "rad/s",
        "stiffness",
        "other_speed",
        json="other_rpm",
        note=", ascending at each stiffness: no curves",
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
