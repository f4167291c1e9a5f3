"""A command with what was given to it: what is refused before anything is read, the model, and the verb with its arguments."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from functools import cached_property
from pathlib import Path
from typing import Any

import rotorgear as rg
from rotorgear.cli.command import Command
from rotorgear.cli.console import progress_bar, say
from rotorgear.cli.options import spelling, value_of
from rotorgear.cli.verb import REQUIRED, arguments_of
from rotorgear.errors import AnalysisError, RotorgearError
from rotorgear.extras import require
from rotorgear.files.write import WriteError, check_output

# Options that name what is written: files, and folders where a name has no ending.
_OUTPUTS = (
    "json",
    "save",
    "plot",
    "waterfall",
    "order_map",
    "vtk",
    "uff",
    "csv",
    "xlsx",
    "output",
    "state_space",
    "matrices",
)


class Call:
    """A command with what was given to it: `call["speed"]` is the text or number of --speed, None where it was not given."""

    def __init__(self, command: Command, given: Mapping[str, Any]) -> None:
        self.command = command
        self.given = given
        for package, purpose in command.needs.items():
            require(package, purpose)
        if self["plot"] is not None:
            if self["plot"].suffix:
                self._require_picture(self["plot"])
            require(*(("pyvista", "A picture of a mode") if command.name == "modal" else ("matplotlib", "A plot")))
        for name in ("waterfall", "order_map"):
            if self[name] is not None:
                self._require_picture(self[name])
                require("matplotlib", "A plot")
        if self["xlsx"] is not None:
            require("openpyxl", "A workbook")
        if self["vtk"] is not None:
            require("pyvista", "VTK output")
        if self["output"] is not None and command.name in ("update", "optimise"):
            require("tomlkit", "Writing a changed model file")
        if self["resume"] and self[command.kept_beside] is None:
            raise AnalysisError("--resume needs the --save of the run that was interrupted")
        for name, option in command.choices.items():
            # Those of verbs are the verbs' to judge.
            if option.kind == "float" and name not in command.arguments and not math.isfinite(self[name] or 0.0):
                raise AnalysisError(f"{spelling(name)}: got {self[name]}, expected a finite number")
        if command.name == "campbell" and self["plot"] is not None:
            from rotorgear.plots.campbell import require_colour

            require_colour(self["colour"])
        workers = self["workers"]
        cluster = self["cluster"]
        if workers is not None and workers < 1:
            raise AnalysisError(f"--workers: got {workers}, expected 1 or more")
        if workers is not None and cluster is not None:
            raise AnalysisError(
                "--workers are threads on this machine, --cluster are workers elsewhere: give one of them"
            )
        self._check_outputs()

    def _check_outputs(self, inputs: Iterable[str | Path] = ()) -> None:
        """Refuse, before anything is computed, what could not be written in the end, or would be written onto an input.

        Args:
            inputs: beside the files that options name.
        """
        paths = {name: given for name, given in self.given.items() if isinstance(given, Path)}
        outputs = {name: paths[name] for name in _OUTPUTS if name in paths}
        read = [path for name, path in paths.items() if name not in outputs]
        read += [
            path for given in self.given.values() if isinstance(given, list) for path in given if isinstance(path, Path)
        ]
        known: dict[Path, str] = {}
        for name, path in outputs.items():
            if any(_same(path, one) for one in (*read, *inputs)):
                raise WriteError(path, "this run reads it; give another name")
            check_output(path, folder=name == "vtk" or (name == "plot" and not path.suffix))
            other = known.setdefault(path.absolute(), name)
            if other != name and not path.is_char_device():
                raise AnalysisError(f"{spelling(other)} and {spelling(name)} would both be written to {path}")

    @staticmethod
    def _require_picture(path: Path) -> None:
        from rotorgear.plots.figure import require_picture_name

        require_picture_name(path)

    def __getitem__(self, name: str) -> Any:
        return self.given.get(name)

    def asked(self, name: str) -> Any:
        """The value of an option as the verb takes it; None where it was not given."""
        option = self.command.choices[name]
        given = self[name]
        default = None if option.default is REQUIRED else option.default
        if given is None or given in (default, []) or (given is False and default is None):
            return None
        return value_of(name, option, given)

    def arguments(self, verb: str) -> dict[str, Any]:
        """The arguments of a verb that were given; what was not is left to the verb."""
        # The first one is what the verb is about; a command may have an option of its own by the name of one that it hides.
        _, *names = arguments_of(verb)
        own = [name for name in names if name in self.command.choices and name not in self.command.hidden]
        asked = {name: self.asked(name) for name in own}
        return {name: value for name, value in asked.items() if value is not None}

    @property
    def source_path(self) -> Path:
        """The file that is named first."""
        path: Path = self.given[self.command.source]
        return path

    @property
    def saved(self) -> bool:
        """Whether that file is a saved result; any other is a model file."""
        return self.source_path.suffix.lower() in (".h5", ".hdf5")

    @cached_property
    def source(self) -> Any:
        """The model or the saved result of the file that is named first."""
        if self.saved:
            return rg.read(self.source_path)
        model = rg.load(self.source_path)
        # Meshes are read later; tables that the model names were read with it.
        meshes = [file for casing in model.casings.values() for file in (*casing.mesh.values(), casing.matrices)]
        meshes += [gear.body.mesh for gear in model.gears.values()]
        self._check_outputs([file for file in meshes if file])
        self._check_names(model)
        return model

    def _check_names(self, model: Any) -> None:
        """Refuse, before anything is computed, names of what is shown of a result that the model has not."""
        names = [*model.meshes, *model.bearings, *model.points]
        if (
            (self["waterfall"] or self["order_map"])
            and self["at"] is not None
            and self["at"].rpartition(".")[2] not in names
        ):
            known = ", ".join(names) or "none"
            raise AnalysisError(
                f"--at: '{self['at']}' is no mesh, bearing or point of the model: expected one of {known}"
            )
        names += [*model.gears, *model.nonlinear_elements]
        if self["spectrum"] and not any(name in self["spectrum"] for name in names):
            raise AnalysisError(
                f"--spectrum: there is no history '{self['spectrum']}': it names a mesh, bearing, point, gear or element of the "
                f"model, such as 'force {names[0] if names else 'stage'}'"
            )

    def result(self, verb: str = "", **more: Any) -> Any:
        """Run a verb, by default that of the command, with a bar of progress; `more` goes before what was given."""
        verb = verb or self.command.verbs[0]
        known = arguments_of(verb)
        with ExitStack() as stack:
            progress = stack.enter_context(progress_bar(self.command.name, lines=self.command.name == "accuracy"))
            arguments = self.arguments(verb) | more
            source = self.source
            if self["cluster"] is not None:
                arguments["executor"] = stack.enter_context(rg.cluster(self["cluster"]))
            if "stream" in known and self["save"]:
                arguments["stream"] = stack.enter_context(self.stream())
            if "progress" in known:
                arguments["progress"] = progress
            return getattr(rg, verb)(source, **arguments)

    @contextmanager
    def stream(self) -> Iterator[Any]:
        """Where the run keeps its blocks; that they are kept is said where it is interrupted."""
        beside = self[self.command.kept_beside]
        try:
            yield rg.stream(beside, resume=self["resume"])
        except (KeyboardInterrupt, RotorgearError):
            if any(Path(f"{beside}.parts").glob("chunk_*")):
                say(f"the blocks that were done are kept in {beside}.parts: go on with --resume", err=True)
            raise


def _same(path: Path, other: str | Path) -> bool:
    """Whether both name one file that is there."""
    with suppress(OSError, ValueError):
        return path.samefile(other)
    return False
