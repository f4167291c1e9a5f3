"""Result of an import from REXS: the text of the model file, and all that was assumed in it."""

from __future__ import annotations

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of


class Assumption(Record):
    """A value of the model file that the REXS file does not say."""

    address: str = of("address in the model file")
    value: str = of("value that was put there")
    reason: str = of("why", note=" this value")


class RexsImport(Result, kind="import"):
    """A model file made of a REXS file."""

    file: str = of("REXS file")
    version: str = of("version of REXS")
    application: str = of("program that wrote the file")
    load_case: str = of("load case that was taken", note="; empty: the file has none")
    shafts: int = of("number of shafts")
    gears: int = of("number of gears")
    meshes: int = of("number of meshes")
    bearings: int = of("number of bearings", note=", those between two shafts included")
    toml: str = of("text of the model file")
    assumptions: tuple[Assumption, ...] = of("assumptions", "", "assumption", record=Assumption)
