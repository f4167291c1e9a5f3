"""The table of a transient's channels: rounding is no number."""

from __future__ import annotations

from types import SimpleNamespace

from rotorgear.results.schema import Row
from rotorgear.results.transient import TransientResult


def row(name: str, mean: float, rms: float, largest: float, smallest: float) -> Row:
    return Row(name=name, unit="N", mean=mean, rms=rms, largest=largest, smallest=smallest)


def test_components_that_rounding_leaves_of_a_vector_are_shown_as_zero_and_small_vectors_are_not() -> None:
    channels = (
        row("bearings.left force x", 0.0, 4.0, 6.0, -6.0),
        row("bearings.left force y", 850.0, 20.0, 900.0, 800.0),
        row("bearings.left force z", 3.1e-12, 4.2e-13, 5e-12, -2e-12),
        row("bearings.right force x", 2e-12, 1e-12, 3e-12, 1e-12),
    )
    table = TransientResult._channels(SimpleNamespace(channels=channels, error_of=lambda name: 2e-3))  # type: ignore[arg-type]
    lines = {name.text: [cell.text for cell in cells] for name, *cells in table.rows}
    assert lines["left force z"] == ["0", "0", "0", "0", "2e-03", "N"]
    assert lines["left force y"] == ["850", "20", "900", "800", "2e-03", "N"]
    assert lines["right force x"] == ["2e-12", "1e-12", "3e-12", "1e-12", "2e-03", "N"]
