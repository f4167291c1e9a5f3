"""The model file of an import."""

from __future__ import annotations

from pathlib import Path

from rotorgear.export.files import replacing
from rotorgear.results.rexs_import import RexsImport


def write_model_file(result: RexsImport, path: str | Path) -> Path:
    """Write the model file that `import_rexs` made, with its comments.

    Args:
        result: of `import_rexs`.
        path: of the file, such as "gearbox.toml".

    Raises:
        WriteError: the file can't be written.
    """
    with replacing(path) as scratch:
        scratch.write_text(result.toml, encoding="utf-8")
    return Path(path)
