"""Result of an import from REXS: the text of the model file, and all that was assumed in it."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.quantity import counted
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of
from rotorgear.results.table import Block, Line


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

    def tables(self) -> Iterator[Block]:
        """What was read, the assumptions, and what was left out."""
        made = f"REXS {self.version}" + (f" by {self.application}" if self.application else "")
        yield Line(self.file, f": {made}" + (f", load case {self.load_case}" if self.load_case else ""))
        yield ", ".join(counted(getattr(self, name), name) for name in ("shafts", "gears", "meshes", "bearings"))
        yield from ("", *self._assumed(), "")
        yield f"{counted(len(self.assumptions), 'assumptions')}; each stands as a comment in the model file"
        yield from self.remarks()

    def _assumed(self) -> Iterator[str]:
        """One sentence for each reason; parts of one table with the same reason are counted, and named in the model file."""
        alike: dict[tuple[str, str, str], list[Assumption]] = {}
        for item in self.assumptions:
            table, _, rest = item.address.partition(".")
            alike.setdefault((table, rest.partition(".")[2], item.reason), []).append(item)
        for (table, key, reason), items in alike.items():
            values = list(dict.fromkeys(item.value for item in items))
            if len(items) == 1:
                yield f"assumed {items[0].address} = {values[0]}: {reason}"
            else:
                shown = values[0] if len(values) == 1 else f"{values[0]} and others"
                yield f"assumed {table}.*.{key} = {shown} ({len(items)} of them): {reason}"
