"""Values of a model that are estimates, because its file names a part by a designation alone."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.forces.designations import inner_geometry
from rotorgear.model.layout.layout import Layout


def estimated(layout: Layout) -> Iterator[str]:
    """Yield a sentence on every bearing whose rolling elements follow from its boundary dimensions."""
    for name, bearing in layout.model.bearings.items():
        rolling = bearing.rolling
        if rolling is None or rolling.designation is None:
            continue
        known = inner_geometry(rolling.designation)
        if known is not None and known.estimated:
            yield (
                f"bearings.{name}.rolling: {rolling.elements} elements of {1e3 * rolling.element_diameter:.4g} mm on "
                f"{1e3 * rolling.pitch_diameter:.4g} mm in a {rolling.designation} are {known.source}, because no maker prints "
                "them: stiffness and loads are an order of size; give elements and diameters where you know them"
            )
