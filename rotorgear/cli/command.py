"""A command as it is declared: a verb, what becomes of its result, and what is the command's own; typer makes the rest of it."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import typer
from typer.core import TyperCommand

from rotorgear.cli.options import Option, kind_of, option_of, parameter
from rotorgear.cli.verb import REQUIRED, Argument, arguments_of, summary_of, told_by

OWN, FILES = "Options", "Files and pictures"
# Where a result goes: one option of one meaning for all commands.
SHOWS = {
    "json": Option("Write the result as JSON to this file.", "path"),
    "save": Option("Save the result (HDF5).", "path"),
    "plot": Option(
        "Draw the result: to a file that ends in .png, .svg or .pdf, or every picture of it into a folder.", "path"
    ),
    "vtk": Option("Write the result for ParaView (VTK) into this folder.", "path"),
    "uff": Option("Write a universal file (UFF) for modal-test programs.", "path"),
    "csv": Option("Write the points as a table (CSV).", "path"),
    "xlsx": Option("Write the tables of the result as a workbook (XLSX), a sheet each.", "path"),
    "output": Option("", "path", flags=("-o", "--output")),
}
# Arguments of verbs that work in blocks, and the options that stand for them.
_BLOCKS = {
    "save": Option("Save the result (HDF5), in blocks while it runs.", "path"),
    "resume": Option("Go on with an interrupted run of the same --save.", "flag"),
}
_SECTIONS = {"resume": Option("Go on with an interrupted run of the same --output.", "flag")}
_CLUSTER = Option("Workers elsewhere: a dask scheduler such as tcp://host:8786, or local:N processes here.", "text")


@dataclass(frozen=True)
class Command:
    """A command of the command line.

    Attributes:
        name: as it is called.
        summary: what that list says of it.
        verb: the verbs whose arguments it takes, the one behind it first; by default the one of its name.
        shows: what may become of the result, among the keys of `SHOWS`.
        options: those that no verb has, and what is the command's own in those that one has.
        hidden: arguments of the verb that are no options.
        positional: arguments that are given by place, beside the first one of the verb.
        table, picture: options that are handed to the table and to the picture of the result.
        needs: optional package -> what needs it, as a sentence begins with it.
        kept_beside: the option that names the file beside which an interrupted run has its blocks.
        body: "module.function" below rotorgear.cli that does more than to run the verb and to show its result.
        group: under which `rotorgear --help` lists it.
    """

    name: str
    summary: str
    verb: tuple[str, ...] | None = None
    shows: tuple[str, ...] = ("json",)
    options: Mapping[str, Option] = field(default_factory=dict)
    hidden: tuple[str, ...] = ()
    positional: tuple[str, ...] = ()
    table: tuple[str, ...] = ()
    picture: tuple[str, ...] = ()
    needs: Mapping[str, str] = field(default_factory=dict)
    kept_beside: str = "save"
    body: str = "show.analyse"
    group: str = ""

    @property
    def verbs(self) -> tuple[str, ...]:
        """The verbs whose arguments the command takes."""
        return (self.name.replace("-", "_"),) if self.verb is None else self.verb

    @cached_property
    def arguments(self) -> dict[str, Argument]:
        """The arguments of all its verbs; the first verb that has one describes it."""
        arguments: dict[str, Argument] = {}
        for verb in self.verbs:
            arguments |= {name: said for name, said in arguments_of(verb).items() if name not in arguments}
        return arguments

    @property
    def source(self) -> str:
        """The argument that is named first: a file with a model, of most."""
        return next(iter(self.arguments), "")

    @cached_property
    def choices(self) -> dict[str, Option]:
        """All options and arguments of the command by name, in the order of its help."""
        choices = {}
        for name, said in self.arguments.items():
            own = self.options.get(name)
            if name == self.source and "Model" in said.annotation:
                what = ", or a result saved by modal --save (HDF5)" if "ModalResult" in said.annotation else ""
                own = Option(f"Model file (TOML){what}.", "path", REQUIRED)
            if name not in self.hidden and (own or kind_of(said.annotation)):
                choices[name] = option_of(name, said, own)
        if "executor" in self.arguments:
            choices["cluster"] = option_of("cluster", None, _CLUSTER)
        choices |= {name: option_of(name, None, own) for name, own in self.options.items() if name not in choices}
        shown = {name: SHOWS[name] for name in self.shows}
        if "stream" in self.arguments:
            shown |= _BLOCKS if self.kept_beside == "save" else _SECTIONS
        return choices | {name: option_of(name, None, self.options.get(name, option)) for name, option in shown.items()}

    def function(self, body: Callable[[Command, dict[str, Any]], None]) -> Callable[..., None]:
        """The command as a function with the signature that typer reads; `body` is told the command and what was given."""

        def run(**given: Any) -> None:
            body(self, given)

        positional = (self.source, *self.positional)
        parameters = [
            parameter(name, option, FILES if name in SHOWS or name in _BLOCKS else OWN, name in positional)
            for name, option in self.choices.items()
        ]
        run.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
        run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
        # In place of the verb's first sentence that of the list of commands; what follows it in the docstring, as it is.
        more = "\n\n".join(summary_of(verb).partition("\n\n")[2] for verb in self.verbs[:1])
        run.__doc__ = f"{self.summary}.\n\n{more}".replace("`", "")
        return run

    def to_typer(self, body: Callable[[Command, dict[str, Any]], None]) -> Any:
        """The command as typer runs it; `body` as in `function`."""
        single = typer.Typer(add_completion=False, rich_markup_mode=None)
        single.command(self.name, cls=CommandInGroups)(self.function(body))
        made: Any = typer.main.get_command(single)
        made.verbs = self.verbs
        return made


class CommandInGroups(TyperCommand):
    """A command whose help lists its options in groups, and then what its result tells."""

    verbs: tuple[str, ...] = ()

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        # Read here and not when the command is made: only who asks for help is to wait for it.
        if told := told_by(self.verbs[0]) if self.verbs else "":
            self.epilog = f"The result tells: {told}."
        super().format_epilog(ctx, formatter)

    def format_options(self, ctx: Any, formatter: Any) -> None:
        groups: dict[str, list[tuple[str, str]]] = {"Arguments": [], OWN: [], FILES: []}
        for one in self.get_params(ctx):
            record = one.get_help_record(ctx)
            if record is not None:
                group = (
                    "Arguments" if one.param_type_name == "argument" else getattr(one, "rich_help_panel", None) or OWN
                )
                groups[group].append(record)
        for group, records in groups.items():
            if records:
                with formatter.section(group):
                    formatter.write_dl(records)
