"""Forces and moments from outside: where each acts, its constant part, and how the rest goes with angle or time.

    F(t) = F_0 + A cos(n theta + 2 pi f t + phase),   theta = ratio * angle of the reference

n is the order, f the frequency; of a history over the angle theta or over the time, F_0 is its mean over a turn or its value at
time 0, where a transient begins. The file gives them along x, y and z of the model; here they are in the frame of their shaft,
but for the values of a history.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rotorgear.model.layout.train import Train
from rotorgear.model.parts.frame import Frame
from rotorgear.model.parts.load import LoadHistory
from rotorgear.model.parts.shaft import Place
from rotorgear.model.parts.tables import Tables


@dataclass(frozen=True)
class ExternalLoad:
    """A force with its moment.

    Attributes:
        address: such as "loads.belt".
        places: where it acts, in equal parts: the nodes of a herringbone gear, else one; frame: of their shaft.
        constant: mean force and moment (6,) in N and N m.
        amplitude: of the harmonic part (6,).
        order: n times the ratio of the shaft, with its sign: radians for each of the reference.
        frequency: f in Hz; phase: in rad.
        history: what it follows over time or angle; then `ratio` is that of the shaft whose angle counts.
        counted: the shaft whose turns the order or the history counts.
        in_train: whether its moment about z drives or loads a train that turns: a shaft that turns, and no support holds.
    """

    address: str
    places: tuple[Place, ...]
    frame: Frame
    constant: np.ndarray
    amplitude: np.ndarray
    order: float
    frequency: float
    phase: float
    history: LoadHistory | None
    ratio: float
    counted: str
    in_train: bool

    @property
    def constant_on_structure(self) -> np.ndarray:
        """The constant part (6,) without the moment that the balance of torques has already."""
        held = self.constant.copy()
        if self.in_train:
            held[5] = 0.0
        return held


def external_loads(model: Tables, train: Train, places: Callable[[str], tuple[Place, ...]]) -> tuple[ExternalLoad, ...]:
    """All forces and moments of a model; `places` tells the places of a load by its address."""
    fixed = [support.shaft for support in model.supports.values() if {"torsion", "all"} & set(support.fixed)]
    # A shaft that stands still, such as a ring, holds nothing that turns.
    held = {train.group[shaft] for shaft in fixed if train.ratios[shaft] != 0}
    found = []
    for name, load in model.loads.items():
        if load.is_torque:
            continue
        address = f"loads.{name}"
        there = places(address)
        shaft = there[0].shaft
        frame = model.shafts[shaft].frame
        counted = load.order_of or shaft
        ratio = train.ratio(counted)
        given = _in_frame(np.array([*(load.force or (0.0,) * 3), *(load.moment or (0.0,) * 3)]), frame)
        varies = load.order is not None or load.frequency is not None
        nothing = np.zeros(6)
        found.append(
            ExternalLoad(
                address=address,
                places=there,
                frame=frame,
                constant=_in_frame(load.history.mean, frame) if load.history else nothing if varies else given,
                amplitude=given if varies else nothing,
                order=(load.order or 0.0) * ratio,
                frequency=load.frequency or 0.0,
                phase=load.phase,
                history=load.history,
                ratio=ratio,
                counted=counted,
                in_train=train.ratios.get(shaft, 0) != 0 and train.group[shaft] not in held,
            )
        )
    return tuple(found)


def _in_frame(wrench: np.ndarray, frame: Frame) -> np.ndarray:
    """Force and moment (6,) in the directions of a shaft, without what rounding leaves across them."""
    if not frame.is_turned:
        return wrench
    own = frame.own(wrench).reshape(2, 3)
    own[np.abs(own) < 1e-15 * np.linalg.norm(own, axis=1, keepdims=True)] = 0.0
    return own.ravel()
