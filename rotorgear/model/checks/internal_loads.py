"""Checks of points that read the load inside a shaft or coupling: along a direction that it has, where elastic parts carry."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.errors import Problem
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.operation import MOTION_OF_LOAD
from rotorgear.model.parts.problems import told
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import millimetres


def load_points(model: Tables) -> Iterator[Problem]:
    """A load is read along a direction that it has; a motion has no side, and a coupling has two."""
    for name, point in model.points.items():
        motion = point.quantity is None
        two = "required on a coupling, whose ends move each by themselves: axial, torque, shear or bending"
        inside = "a motion, so left out: loads inside shafts and couplings are known"
        cut = not motion and point.side is not None and point.on_coupling
        along = "x or y" if point.quantity in ("shear", "bending") else "nothing here: the quantity says it"
        held = not motion and not model.has(MOTION_OF_LOAD[point.quantity or ""])
        yield from told(
            f"points.{name}",
            ("quantity", motion and point.on_coupling, "", "missing", two),
            ("side", motion and point.side is not None, f"'{point.side}'", "nothing here: a motion has no side"),
            ("side", cut, f"'{point.side}'", "nothing here: a coupling carries one load"),
            ("quantity", not motion and point.on_casing is not None, f"'{point.quantity}'", inside),
            ("quantity", held, f"'{point.quantity}'", "the load of a motion that the model has", "see motions"),
            ("direction", not motion and point.load is None, f"'{point.direction}'", along),
        )


def cut_places(layout: Layout) -> Iterator[Problem]:
    """At the place of such a point an elastic section goes on, towards the side that it names, and no carrier turns it."""
    model = layout.model
    for name, point in model.points.items():
        if point.quantity is None or point.on_coupling:
            continue
        place = layout.place(f"points.{name}")
        shaft = model.shafts[place.shaft]
        elastic = shaft.elastic_sides(place.z)
        asked = {"left": elastic[0], "right": elastic[1], None: any(elastic)}[point.side]
        beside = f"z = {millimetres(place.z)} of shaft '{place.shaft}'" + (f", {point.side}" if point.side else "")
        goes_round = shaft.carrier is not None
        yield from told(
            f"points.{name}",
            ("", not asked, beside, "a place where an elastic section of the shaft goes on", "see side, at and rigid"),
            ("", goes_round, f"a load in shaft '{place.shaft}', which a carrier takes round", "a shaft that stands"),
        )
