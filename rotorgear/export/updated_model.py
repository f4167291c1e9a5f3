"""The model file of an update: the user's own, with the new numbers and what is known of each beside them."""

from __future__ import annotations

from pathlib import Path

from rotorgear.export.files import replacing
from rotorgear.export.model_text import scaled_text
from rotorgear.results.update import UpdateResult


def write_updated_model(result: UpdateResult, source: str | Path, path: str | Path) -> Path:
    """Write the model file of an update.

    Args:
        result: of `update`.
        source: the model file that was updated.
        path: of the new file.

    Raises:
        AnalysisError: a number that the file does not spell out. WriteError: the file can't be written.
        MissingExtraError: tomlkit is not installed.
    """
    factors = {row.address: row.factor for row in result.parameters}
    remarks = {
        row.address: f"updated, x {row.factor:.4f}, +-{100 * row.sigma:.2g} %"
        + ("" if row.identified else f", not identified ({100 * row.learnt:.0f} % learnt)")
        for row in result.parameters
    }
    text = scaled_text(Path(source).read_text(encoding="utf-8"), factors, remarks)
    with replacing(path) as scratch:
        scratch.write_text(text, encoding="utf-8")
    return Path(path)
