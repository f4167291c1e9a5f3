"""A model file of one's own, begun as a copy of one that comes with the package."""

from __future__ import annotations

import shutil
from pathlib import Path

from rotorgear.errors import AnalysisError
from rotorgear.export.files import replacing
from rotorgear.model.shipped import models, shipped_model

# Every part of a plain gearbox stands in it once.
DEFAULT = "helical_pair"


def new(path: str | Path, source: str | None = None, force: bool = False) -> list[Path]:
    """Write a model file with comments, as a copy of one that comes with the package, to change freely.

    Files that it names (meshes of casings, measured flanks) and the lines of its rig are written beside it.

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
        raise AnalysisError(
            f"{' and '.join(there)} would be overwritten: choose another name or folder, or give --force"
        )
    for file, original in copies.items():
        with replacing(file) as scratch:
            shutil.copyfile(original, scratch)
    return list(copies)
