"""rotorgear check: what a model file describes, before anything is solved."""

from __future__ import annotations

from rotorgear.cli.common import ElementsOption, JsonOption, ModelFile, console, write_json


def check(model: ModelFile, elements: ElementsOption = None, json: JsonOption = None) -> None:
    """Show what a model file describes: speeds, mesh frequencies, torques, contact ratios, masses, dofs, warnings."""
    import rotorgear as rg

    description = rg.check(rg.load(model), elements=elements)
    out = console()
    out.print(description.table())
    write_json(description.to_dict(), json)
