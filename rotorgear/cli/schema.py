"""rotorgear schema: the JSON Schema of the model file, for editors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import write_json


def schema(
    json: Annotated[
        Path | None, typer.Option("--json", help="Write it to this file instead of the terminal.", show_default=False)
    ] = None,
) -> None:
    """Print the JSON Schema of the model file, for completion and checks in editors."""
    import json as json_module

    import rotorgear as rg

    data = rg.schema()
    if json is None:
        typer.echo(json_module.dumps(data, indent=2))
    else:
        write_json(data, json)
        typer.echo(f"wrote {json}")
