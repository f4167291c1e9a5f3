"""What becomes of a result: its table, JSON, HDF5, pictures, files for ParaView and for programs of modal tests."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import typer

import rotorgear as rg
from rotorgear.cli.console import console, progress_bar, say
from rotorgear.cli.run import Call
from rotorgear.errors import AnalysisError
from rotorgear.files.numbers import is_count

# Modes that modal draws and writes for ParaView unless --shapes says otherwise.
_LOWEST = 6
# No result has more modes.
_MOST_MODES = 1_000_000


def analyse(call: Call) -> None:
    """Run the verb of a command and show its result."""
    show(call, call.result())


def show(
    call: Call, result: Any, beside: Mapping[str, Any] | None = None, drawn: Any = None, *, whole: bool = True
) -> None:
    """Print a result and write the files that were asked for.

    Args:
        call: the command with its options.
        result: of its verb.
        beside: more results, which are printed below it and stand in its JSON under these keys.
        drawn: the one that --plot draws, where that is another.
        whole: an interrupted one is not: the blocks behind it stay, for --resume.

    Raises:
        Exit: with code 1, where a transient ended early.
    """
    out = console()
    out.print(result.table(**{name: call[name] for name in call.command.table}))
    for more in (beside or {}).values():
        out.print(more.table())
    early = call.command.name == "transient" and result.ended_early
    # First the file that holds everything.
    if call["save"] and not early:
        say(f"saved {rg.save(result, call['save'])}")
        if whole and "stream" in call.command.arguments:
            rg.stream(call["save"]).close()
    if call["json"]:
        data = result.to_dict(max(call["harmonics"], 8)) if result.kind == "mesh" else result.to_dict()
        write_json(call, data | {key: more.to_dict() for key, more in (beside or {}).items()})
    if call["plot"]:
        _draw(call, result if drawn is None else drawn, call["plot"])
    if call["waterfall"]:
        say(f"wrote {rg.plot.save(rg.plot.waterfall(result, at=call['at']), call['waterfall'])}")
    if call["order_map"]:
        say(f"wrote {rg.plot.save(rg.plot.order_map(result, at=call['at']), call['order_map'])}")
    if call["vtk"]:
        _write_vtk(call, result, call["vtk"])
    if call["uff"]:
        modes = None if call["shapes"] is None else _shapes(call, result)
        say(f"wrote {rg.write_uff(result, call['uff'], modes=modes)}")
    if call["xlsx"]:
        say(f"wrote {rg.write_xlsx(result, call['xlsx'])}")
    if call["csv"]:
        from rotorgear.export.tables import write_csv

        say(f"wrote {write_csv(_rows_of_a_map(result), call['csv'])}")
    if call["output"]:
        source = call.source_path
        write: dict[str, Callable[[Path], Path]] = {
            "sensors": partial(rg.write_sensors, result),
            "update": partial(rg.write_updated_model, result, source),
            "optimise": partial(rg.write_optimised_model, result, source),
            "compare_time": lambda path: rg.write_rig_lines(result.ring_down_lines(), path),
        }
        say(f"wrote {write[result.kind](call['output'])}")
    if early:
        say("the run ended early: what it gave so far stands above", err=True)
        raise typer.Exit(1)


def write_json(call: Call, data: dict[str, Any]) -> None:
    """Write plain values where a file was asked for."""
    if call["json"]:
        from rotorgear.files.write import write_json as write

        write(data, call["json"])


def _draw(call: Call, result: Any, path: Path) -> None:
    """Draw a result: to a file where the name has an ending, else every picture of it into a folder."""
    if result.kind == "modal":
        from rotorgear.files.write import written
        from rotorgear.plots.mode_pictures import write_modes

        modes = _shapes(call, result)
        with progress_bar("plot") as progress:
            if not path.suffix:
                _tell(
                    "picture", write_modes(result, path, modes=modes, progress=progress), path, _of_modes(result, modes)
                )
                return
            if path.suffix.lower() != ".png":
                raise AnalysisError(f"--plot: modes are rendered as PNG; got '{path.name}'")
            with TemporaryDirectory() as folder, written(path) as scratch:
                (picture,) = write_modes(result, folder, modes=modes[:1], progress=progress)
                shutil.copyfile(picture, scratch)
        say(f"wrote {path}, mode {modes[0] + 1}")
        return
    draw = partial(result.plot, **{name: call[name] for name in call.command.picture})
    if path.suffix:
        say(f"wrote {rg.plot.save(draw(), path)}")
        return
    if result.kind == "transient":
        from rotorgear.plots import transient

        paths = transient.write_pictures(result, path)
    elif result.kind == "sweep":
        from rotorgear.plots import sweep

        paths = sweep.write_pictures(result, path)
    else:
        from rotorgear.plots.figure import save_all

        paths = save_all({f"{result.kind}.png": draw}, path)
    _tell("picture", paths, path)


def _write_vtk(call: Call, result: Any, folder: Path) -> None:
    """Write a result for ParaView."""
    hint = ""
    with progress_bar("vtk") as progress:
        match result.kind:
            case "modal":
                modes = _shapes(call, result)
                hint = _of_modes(result, modes)
                paths = rg.write_vtk(result, folder, modes=modes, progress=progress)
            case "campbell":
                from rotorgear.export.vtk_results import write_branch

                hint = f" for branch {call['branch']}; --branch chooses another"
                paths = write_branch(result, folder, call["branch"] - 1, progress=progress)
            case "transient":
                hint = "; open motion.pvd in ParaView"
                paths = rg.write_motion(result, folder)
            case "casing":
                paths = rg.write_casing_vtk(result, folder)
            case "mesh":
                from rotorgear.analysis.teeth.inside_teeth import tooth_fields
                from rotorgear.export.vtk_parts import write_tooth_vtk

                # Both tooth meshes at one position of a mesh cycle.
                asked = {"torque": call["torque"], "preset": result.preset, "body": call["body"], "at": call["at"]}
                fields = tooth_fields(call.source, result.mesh, **asked, progress=progress)
                paths = write_tooth_vtk(fields, folder)
            case _:
                paths = rg.write_deflections(result, folder, progress=progress)
    _tell("file", paths, folder, hint)


def _shapes(call: Call, result: Any) -> list[int]:
    """The modes of --shapes, counted from 1 in the text and from 0 here; without it the lowest.

    Raises:
        AnalysisError: no such numbers, or more than the result has.
    """
    numbers = numbers_of_modes(call["shapes"])
    if numbers is None:
        return list(range(min(len(result), _LOWEST)))
    beyond = [number + 1 for number in numbers if number >= len(result)]
    if beyond:
        raise AnalysisError(f"--shapes: there is no mode {beyond[0]}, the result has {len(result)}")
    return numbers


def numbers_of_modes(text: str | None) -> list[int] | None:
    """Numbers of modes from 0, of a text that counts from 1 such as "1,6,9-12".

    Raises:
        AnalysisError: another text.
    """
    if text is None:
        return None
    chosen: list[int] = []
    for part in text.split(","):
        first, _, last = part.strip().partition("-")
        if (
            not is_count(first)
            or (last and not is_count(last))
            or not 1 <= int(first) <= int(last or first) <= _MOST_MODES
        ):
            raise AnalysisError(f"--shapes: got '{text}', expected numbers of modes such as 1,6,9-12")
        chosen += range(int(first) - 1, int(last or first))
    return chosen


def _of_modes(result: Any, modes: list[int]) -> str:
    return "" if len(modes) == len(result) else f" for {len(modes)} of {len(result)} modes; --shapes chooses them"


def _tell(what: str, paths: list[Path], folder: Path, hint: str = "") -> None:
    say(f"wrote {len(paths)} {what}{'s'[: len(paths) != 1]} to {folder}{hint}")


def _rows_of_a_map(points: Any) -> list[dict[str, float]]:
    """One row a point of a map over loads, in the order of its table."""
    return [
        {
            "pinion_torque_n_m": float(torque),
            "misalignment_m": float(misalignment),
            "ste_peak_to_peak_m": float(points.ste_peak_to_peak[i, j]),
            **{f"ste_order_{n + 1}_m": float(value) for n, value in enumerate(points.ste_harmonics[i, j])},
            "largest_pressure_pa": float(points.largest_pressure[i, j]),
            "face_load_factor": float(points.face_load_factor[i, j]),
            "mean_stiffness_n_per_m": float(points.mean_stiffness[i, j]),
        }
        for i, torque in enumerate(points.pinion_torque)
        for j, misalignment in enumerate(points.misalignment)
    ]
