"""Model files: a copy of a shipped one, that of an import, and the user's own with the numbers of an update or an optimisation.

In the user's own everything else, comments and units too, stays as it was written.
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rotorgear.errors import AnalysisError
from rotorgear.extras import require
from rotorgear.files.bounds import MODEL
from rotorgear.files.own import text_of
from rotorgear.files.read import read_text
from rotorgear.files.write import written
from rotorgear.model.load import schema
from rotorgear.model.model import Model
from rotorgear.model.shipped import models, shipped_model
from rotorgear.model.text import below
from rotorgear.results.optimise import OptimiseResult, value_words
from rotorgear.results.rexs_import import RexsImport
from rotorgear.results.update import UpdateResult

# The model that has every part of a plain gearbox once.
DEFAULT = "helical_pair"
# Beside a new model file: editors complete and check keys by it, as the first line of the model says.
SCHEMA = "model.schema.json"


def new(path: str | Path, source: str | None = None, force: bool = False) -> list[Path]:
    """Write a model file with comments, as a copy of one that comes with the package, to change freely.

    Files that it names (meshes of casings, measured flanks) and the lines of its rig are written beside it, and the JSON Schema
    that its first line names to editors, where none is there.

    Args:
        path: file to write, such as "gearbox.toml".
        source: name of the model to copy, as `models` lists them (default: that of the file's name, or helical_pair).
        force: overwrite files that exist.

    Returns:
        The paths of the written files, the model first.

    Raises:
        AnalysisError: no model of that name, another ending than .toml, or a file that is there and would be overwritten; then
            nothing is written. WriteError: the folder can't be written.
    """
    target = Path(path)
    if target.suffix.lower() != ".toml":
        raise AnalysisError(f"a model file ends in .toml; got '{target.name}'")
    if source is None:
        source = target.stem if target.stem in {model.name for model in models()} else DEFAULT
    model = shipped_model(source)
    copies = {target: model.path} | {target.with_name(file.name): file for file in model.companions}
    there = [str(file) for file in copies if file.exists()]
    if there and not force:
        raise AnalysisError(f"{' and '.join(there)} would be overwritten: choose another name, or give --force")
    for file, original in copies.items():
        with written(file) as scratch:
            if file == target:
                scratch.write_text(f"#:schema ./{SCHEMA}\n{text_of(original)}", encoding="utf-8", newline="\n")
            else:
                shutil.copyfile(original, scratch)
    beside = target.with_name(SCHEMA)
    if beside.exists() and not force:
        return list(copies)
    with written(beside) as scratch:
        scratch.write_text(json.dumps(schema(), indent=2), encoding="utf-8")
    return [*copies, beside]


_NUMBER = re.compile(r"\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
# Digits of a written number; more would claim an accuracy that it has not.
_DIGITS = 6
# Of a Fourier series only the mean is a size; amplitudes are shares of it.
_MEAN = "mean"


def scaled_text(
    text: str,
    factors: Mapping[str, float],
    remarks: Mapping[str, str] | None = None,
    texts: Mapping[str, str] | None = None,
) -> str:
    """Return the text of a model file with the values at some addresses times a factor.

    Args:
        text: of the file (TOML).
        factors: address, such as "bearings.left.stiffness" or "shafts.rotor.sections[0].length", -> factor.
        texts: address -> what is written in place of a value that is 0 or a word such as "start", which no factor moves.
        remarks: address -> comment to put behind the new value, before the old comment.

    Raises:
        AnalysisError: an address that the file does not spell out, or a value that is no number.
        MissingExtraError: tomlkit is not installed.
    """
    require("tomlkit", "Writing a changed model file")
    import tomlkit

    document = tomlkit.parse(text)
    for address in [*factors, *(name for name in texts or {} if name not in factors)]:
        *owners, last = re.sub(r"\[(\d+)\]", r".\1", address).split(".")
        owner: Any = document
        for key in owners:
            owner = below(owner, key, address)
        old = below(owner, last, address)
        place: Any = int(last) if isinstance(owner, list) else last
        comment = old.trivia.comment.lstrip("# ") if hasattr(old, "trivia") else ""
        fixed = (texts or {}).get(address)
        owner[place] = fixed if fixed is not None and _stays(old) else _times(old, factors[address], address)
        remark = "; ".join(part for part in ((remarks or {}).get(address, ""), comment) if part)
        if remark and not isinstance(owner, list | tomlkit.items.InlineTable):
            owner[place].comment(remark)
    return tomlkit.dumps(document)


def _stays(value: Any) -> bool:
    """Whether no factor moves a value: a word, or 0."""
    if not isinstance(value, str):
        return not isinstance(value, dict | list) and float(value) == 0.0
    number = _NUMBER.match(value)
    return number is None or float(number[0]) == 0.0


def _times(value: Any, factor: float, address: str) -> Any:
    """A number, a text that begins with one, or several of them, times a factor."""
    if isinstance(value, dict):
        scaled = {_MEAN: value[_MEAN]} if _MEAN in value else value
        table = value.copy()
        for key, entry in scaled.items():
            table[key] = _times(entry, factor, address)
        return table
    if isinstance(value, list):
        return [_times(entry, factor, address) for entry in value]
    if isinstance(value, str):
        number = _NUMBER.match(value)
        if number is None:
            raise AnalysisError(f"{address}: '{value}' is no number, so it can't be scaled")
        return f"{float(number[0]) * factor:.{_DIGITS}g}{value[number.end() :]}"
    return float(f"{float(value) * factor:.{_DIGITS}g}")


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
    return _write(path, scaled_text(read_text(source, MODEL.most_bytes), factors, remarks))


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
    # No factor changes 0, "start" or "end": there the new place itself is written.
    texts = {row.address: f"{1e3 * row.after:.7g} mm" for row in moved if row.unit == "m"}
    remarks = {row.address: f"optimised, was {value_words(row, row.before)}" for row in moved}
    return _write(path, scaled_text(read_text(source, MODEL.most_bytes), factors, remarks, texts))


def write_model_file(result: RexsImport | Model, path: str | Path) -> Path:
    """Write the model file that `import_rexs` made, with its comments, or that of a model (`Model.to_toml`).

    Args:
        result: of `import_rexs`, or a model.
        path: of the file, such as "gearbox.toml".

    Raises:
        WriteError: the file can't be written. MissingExtraError: tomlkit is not installed, for a model.
    """
    return result.to_toml(path) if isinstance(result, Model) else _write(path, result.toml)


def _write(path: str | Path, text: str) -> Path:
    with written(path) as scratch:
        scratch.write_text(text, encoding="utf-8")
    return Path(path)
