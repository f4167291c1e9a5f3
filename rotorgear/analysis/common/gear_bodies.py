"""What analyses say of elastic gear bodies: how far they were reduced, and what of their rotation is not there."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.analysis.common.casings import casing_notes
from rotorgear.system.system import System

# A change of frequency by taking a body for one of revolution, above which it is worth a warning.
_NOTICED = 2e-3


def body_notes(system: System) -> Iterator[str]:
    """Say what of casings and gear bodies was left out."""
    yield from casing_notes(system)
    for name, wheel in system.layout.elastic_bodies.items():
        address = f"gears.{name}.body"
        yield (
            f"{address}: all but {wheel.modes} modes of its mesh on its bore below {wheel.left_frequency:.4g} Hz and its static "
            "answers to forces on the rim; its growth by centrifugal forces, whose stiffness is there"
        )
        yield f"{address}: the error of its mesh, up to {wheel.mesh_error:.1e} in the frequencies of its modes on the bore"
        yield f"{address}: what differs around its axis, by a mean over all angles; {wheel.averaged:.1e} in frequency"
        yield from (f"{address}: {note}" for note in wheel.notes)


def gear_body_warnings(system: System) -> Iterator[str]:
    """A sentence for each body that is not quite one of revolution."""
    for name, wheel in system.layout.elastic_bodies.items():
        if wheel.averaged > _NOTICED:
            yield (
                f"gears.{name}.body: taken for a body of revolution by a mean over all angles, which moves the frequency of one "
                f"of its modes by {100.0 * wheel.averaged:.2g} %; what changes with its angle is not there"
            )
