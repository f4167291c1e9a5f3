"""Where components stand in space: support vectors and axes, each in the frame of the component that it refers to.

u runs along a shaft, w is a second axis, v = w x u. Model files have z along u, x along v and y along w of the gear unit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.rexs.account import Account
from rotorgear.rexs.document import Component, Document

# Axes of one gearbox are given with ten digits or more; a tenth of a millirad apart is a drawing's rounding, not an angle.
_PARALLEL = 1e-4


@dataclass(frozen=True)
class Frame:
    """Origin (3,) in m and axes u, v, w as rows (3, 3) of a component, in the space of the file."""

    origin: np.ndarray
    axes: np.ndarray


class Frames:
    """The frames of all components of a document."""

    def __init__(self, document: Document, account: Account) -> None:
        self.document = document
        self.account = account
        self._known: dict[str, Frame | None] = {}

    def of(self, component: Component, below: tuple[str, ...] = ()) -> Frame | None:
        """Frame of a component; None where the file gives it no support vector."""
        if component.id in self._known:
            return self._known[component.id]
        support = self.account.numbers(component, "support_vector", "length", 3)
        found = None
        if support is not None:
            base = self._base(component, below)
            axes = self._axes(component) @ base.axes
            found = Frame(base.origin + np.array(support) @ base.axes, axes)
        self._known[component.id] = found
        return found

    def _base(self, component: Component, below: tuple[str, ...]) -> Frame:
        world = Frame(np.zeros(3), np.eye(3))
        number = self.account.text(component, "reference_component_for_position").removesuffix(".0")
        # A gear unit refers to itself, and its frame is that of the space.
        if not number or number == component.id or number in below:
            return world
        reference = self.document.components.get(number)
        return (self.of(reference, (*below, component.id)) if reference is not None else None) or world

    def _axes(self, component: Component) -> np.ndarray:
        u = np.array(self.account.numbers(component, "u_axis_vector", "length", 3) or (1e-3, 0.0, 0.0))
        w = np.array(self.account.numbers(component, "w_axis_vector", "length", 3) or (0.0, 0.0, 1e-3))
        if not np.linalg.norm(u) or not np.linalg.norm(np.cross(w, u)):
            self.account.missing(component, "its axes u and w must be two directions, and are not")
            return np.eye(3)
        u = u / np.linalg.norm(u)
        v = np.cross(w, u)
        v = v / np.linalg.norm(v)
        return np.array([u, v, np.cross(u, v)])


@dataclass(frozen=True)
class Axis:
    """The axis of a shaft in the frame of the model: x and y in m, z of its origin, and -1 where u runs against z.

    `rotation` (3, 3) takes components along u, v, w of the shaft to those along z, x, y of the model.
    """

    x: float
    y: float
    origin: float
    sense: int
    rotation: tuple[tuple[float, ...], ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

    def z(self, u: float) -> float:
        """z of a coordinate u on the shaft, both in m."""
        return self.origin + self.sense * u


def axis_in(frame: Frame, model: Frame) -> Axis | None:
    """The axis of a shaft in the model's frame; None where it is not parallel to the model's u."""
    u = model.axes @ frame.axes[0]
    if abs(abs(u[0]) - 1.0) > _PARALLEL**2 or np.hypot(u[1], u[2]) > _PARALLEL:
        return None
    along, x, y = model.axes @ (frame.origin - model.origin)
    rotation = tuple(tuple(float(entry) for entry in row) for row in model.axes @ frame.axes.T)
    return Axis(float(x), float(y), float(along), 1 if u[0] > 0.0 else -1, rotation)
