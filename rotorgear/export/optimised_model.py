"""The model file of a layout found: the user's own, with the new numbers and what they were beside them."""

from __future__ import annotations

from pathlib import Path

from rotorgear.export.files import replacing
from rotorgear.export.model_text import scaled_text
from rotorgear.results.optimise import OptimiseResult, value_words


def write_optimised_model(result: OptimiseResult, source: str | Path, path: str | Path) -> Path:
    """Write the model file of a layout.

    Args:
        result: of `optimise`.
        source: the model file that it began with.
        path: of the new file.

    Raises:
        AnalysisError: a number that the file does not spell out. WriteError: the file can't be written.
        MissingExtraError: tomlkit is not installed.
    """
    moved = [row for row in result.numbers if row.after != row.before]
    factors = {row.address: row.after / row.before for row in moved if row.before}
    # 0, "start" and "end" have no factor that leads anywhere: there the new place is written.
    texts = {row.address: f"{1e3 * row.after:.7g} mm" for row in moved if row.unit == "m"}
    remarks = {row.address: f"optimised, was {value_words(row, row.before)}" for row in moved}
    text = scaled_text(Path(source).read_text(encoding="utf-8"), factors, remarks, texts)
    with replacing(path) as scratch:
        scratch.write_text(text, encoding="utf-8")
    return Path(path)
