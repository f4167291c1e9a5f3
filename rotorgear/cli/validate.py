"""rotorgear validate: the validation cases with their sources, from a checkout of the repository."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import JsonOption
from rotorgear.errors import AnalysisError


def validate(
    cases: Annotated[
        list[str] | None,
        typer.Argument(help="Cases to run, such as two_disk_rotor (default: all).", show_default=False),
    ] = None,
    json: JsonOption = None,
) -> None:
    """Run the validation cases: expected, got, error, dofs, seconds. Exit code 1 where one is out of tolerance."""
    root = Path.cwd()
    if not (root / "validation" / "runner.py").is_file():
        raise AnalysisError(
            "the validation cases are not part of the installed package: they lie in the folder validation/ of the repository "
            "and of the source archive (pip download rotorgear --no-deps --no-binary rotorgear); run this in the folder above it"
        )
    if str(root) not in sys.path:
        sys.path.insert(0, str(root))
    importlib.invalidate_caches()
    from validation.runner import main  # the wing stands outside the package

    raise typer.Exit(main(cases or [], json))
