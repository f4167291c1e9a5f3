"""The mesh on which a model is solved again and again: fine enough for all its modes below one frequency."""

from __future__ import annotations

from rotorgear.analysis.modal.modal import modal
from rotorgear.model.model import Model
from rotorgear.results.modal import ModalResult
from rotorgear.system.plan import Plan


def plan_of(model: Model, fmax: float, accuracy: float | None) -> Plan:
    """The mesh on which all modes up to `fmax` are within an accuracy."""
    return mesh_of(modal(model, fmax=fmax, accuracy=accuracy))


def mesh_of(result: ModalResult) -> Plan:
    """The mesh that modes were found on."""
    cut = {}
    counted: dict[str, int] = {}
    for piece in result.discretisation:
        number = counted.get(piece.shaft, 0)
        counted[piece.shaft] = number + 1
        cut[piece.shaft, number] = (piece.elements, piece.order)
    return Plan(cut=cut)
