"""Orders of planets that go round: which of their excitations the fixed frame sees beside the order of the mesh.

Excitations g_i e^{i w t} of the N sisters, in axes that go round with the carrier, are a pattern over the directions psi_i of the
pins. Its first class turns in the ground: with W the speed of the carrier and c_m = 1/N sum_i g_i e^{i m psi_i},

    c_m e^{-i m psi} e^{i (w + m W) t},    m = +1, -1,

while the rest, with all other classes, keeps w. So equal planets whose meshes follow each other in phase have one sideband, at
one side of the order, or none (Parker, J. Sound Vib. 236 (2000) 561 for the classes; the sidebands follow from the coordinates of
`system/planets.py`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.response.order import Order
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.carriers import PlanetSet
from rotorgear.model.parts.carrier import written_name
from rotorgear.system.contacts import ContactLines, sister_contacts
from rotorgear.system.planets import turning_carriers
from rotorgear.system.system import System

# What of a class is left where the sisters cancel: rounding of sums of this many parts of the largest.
_NOTHING = 1e-12
_OF_CONTACTS = ("error", "force", "couple")
_OF_DOFS = ("unbalance", "applied")


def require_plain_teeth(system: System) -> None:
    """Refuse ripples of loaded teeth that go round.

    Raises:
        AnalysisError: loaded teeth of planets on a carrier that turns.
    """
    turning = {planets.shaft for planets in turning_carriers(system.layout)}
    for mesh in system.layout.meshes:
        if mesh.has_loaded_teeth and mesh.carrier in turning:
            raise AnalysisError(
                f"meshes.{written_name(mesh.name)}.stiffness: the ripple of loaded teeth of planets that go round is not built; "
                "give a transmission_error and a stiffness such as 'iso', or hold the carrier"
            )


def with_sidebands(system: System, lines: ContactLines, order: Order) -> Iterator[tuple[str, Order]]:
    """The parts of an order that have one frequency in the fixed frame, and what their names have behind that of the order."""
    patterns = [
        (planets, [sister_contacts(lines.states, planets)], planet_columns(system, planets))
        for planets in turning_carriers(system.layout)
    ]
    rest = order
    sides: list[tuple[str, Order]] = []
    for planets, contacts, columns in patterns:
        W = system.direction * system.train.ratio(planets.shaft)
        for m in (1, -1):
            wave = np.exp(-1j * m * planets.angles)
            changes: dict[str, Any] = {}
            for names, places in ((_OF_CONTACTS, contacts[0]), (_OF_DOFS, columns)):
                for name in names:
                    whole = np.asarray(getattr(order, name))
                    if not whole.ndim or not len(places):
                        continue
                    # places: (k, N), the same quantity of each sister.
                    share = (whole[places] @ wave.conj()) / len(wave)
                    part = np.zeros(whole.shape, complex)
                    part[places] = share[:, None] * wave
                    if np.abs(part).max(initial=0.0) > _NOTHING * np.abs(whole).max(initial=0.0):
                        changes[name] = part
            if not changes:
                continue
            nothing: dict[str, Any] = {
                name: 0.0 * np.asarray(getattr(order, name)) for name in (*_OF_CONTACTS, *_OF_DOFS)
            }
            ratio = order.ratio + m * W
            side = replace(order, ratio=ratio, **{**nothing, **changes})
            rest = replace(rest, **{name: getattr(rest, name) - part for name, part in changes.items()})
            if ratio < 0.0 and not order.fixed:  # the real part of a conjugate is the same motion
                turned: dict[str, Any] = {name: np.conj(getattr(side, name)) for name in (*_OF_CONTACTS, *_OF_DOFS)}
                side = replace(side, ratio=-ratio, **turned)
            sides.append((f" {'+' if m * W > 0.0 else '-'} {planets.carrier}", side))
    largest = {name: np.abs(np.asarray(getattr(order, name))).max(initial=0.0) for name in (*_OF_CONTACTS, *_OF_DOFS)}
    left = {name: np.abs(np.asarray(getattr(rest, name))).max(initial=0.0) for name in largest}
    if not sides or any(left[name] > _NOTHING * largest[name] for name in largest):
        yield "", rest
    yield from sides


def planet_columns(system: System, planets: PlanetSet) -> np.ndarray:
    """Free dofs (k, N) of the planets of one kind, each row the same motion of all sisters."""
    T = sp.csc_array(system.dofs.transform)
    found = []
    for planet in planets.planets:
        rows = np.concatenate([6 * node + np.arange(6) for node in system.nodes.on_shaft(planet)])
        moved = T.indices[np.isin(T.indices, rows)]
        columns = np.repeat(np.arange(T.shape[1]), np.diff(T.indptr))[np.isin(T.indices, rows)]
        found.append(np.unique(columns) if moved.size else np.zeros(0, dtype=int))
    return np.column_stack(found)
