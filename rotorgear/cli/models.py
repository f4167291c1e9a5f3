"""rotorgear models: the models that come with the package."""

from __future__ import annotations

from rotorgear.cli.common import console


def models() -> None:
    """List the models that come with rotorgear, to look at and to start from."""
    import rotorgear as rg

    out = console()
    shipped = rg.models()
    width = max(len(model.name) for model in shipped)
    for model in shipped:
        out.print(f"{model.name:{width}}  {model.title}", markup=False, no_wrap=True, overflow="ellipsis")
    out.print("\nTo begin with one of them:  rotorgear new gearbox.toml --from NAME")
