"""Values of a model that are estimates, because its file names a part by a designation alone."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.model.layout.layout import Layout


def estimated(layout: Layout) -> Iterator[str]:
    """Yield a sentence on every bearing whose rolling elements follow from its boundary dimensions."""
    for name, bearing in layout.model.bearings.items():
        for kind, geometry in bearing.geometries.items():
            if geometry.estimate:
                yield f"bearings.{name}.{kind}: {geometry.estimate}"
