"""rotorgear mesh: stiffness, transmission error and load distribution of one mesh over its cycle."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rotorgear.cli.common import (
    JsonOption,
    ModelFile,
    console,
    picture_name,
    progress_bar,
    vtk_folder,
    words_of,
    write_json,
)
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from rotorgear.results.parts.mesh_map import MeshMap


def mesh(
    model: ModelFile,
    mesh: Annotated[
        str | None, typer.Option("--mesh", help="Name of the mesh; not needed where there is one.", show_default=False)
    ] = None,
    stiffness: Annotated[
        str | None,
        typer.Option(
            "--stiffness",
            help="tooth_fe, iso, contact_line, potential_energy, or given (the numbers of the file). "
            "Default: the model that the file names, else tooth_fe.",
            show_default=False,
        ),
    ] = None,
    torque: Annotated[
        str | None,
        typer.Option(
            "--torque", help="Torque on the pinion, such as '2000 N m', in place of the model's.", show_default=False
        ),
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option("--preset", help="preview, default or fine, in place of the file's.", show_default=False),
    ] = None,
    accuracy: Annotated[
        float | None,
        typer.Option(
            "--accuracy", help="Take the cheapest preset whose estimated error is within this.", show_default=False
        ),
    ] = None,
    body: Annotated[
        str | None, typer.Option("--body", help="Body under the teeth: rim, ring or wheel.", show_default=False)
    ] = None,
    positions: Annotated[
        int | None,
        typer.Option(
            "--positions", help="Positions in one mesh period; default 64, 24 for --root-stress.", show_default=False
        ),
    ] = None,
    periods: Annotated[
        int | None,
        typer.Option(
            "--periods", help="Mesh periods; default 1, or until all pitch errors have passed.", show_default=False
        ),
    ] = None,
    load_factors: Annotated[
        str | None,
        typer.Option(
            "--load-factors", help="Also solve at these multiples of the load: '0.1,0.5,2'.", show_default=False
        ),
    ] = None,
    over: Annotated[
        list[str] | None,
        typer.Option(
            "--over",
            help="Map over 'torque=500 N m:2000 N m:4' and 'misalignment=-20 um:20 um:5' (first, last, how many; or a list with "
            "colons); may be given twice, or both with a comma.",
            show_default=False,
        ),
    ] = None,
    csv: Annotated[
        Path | None, typer.Option("--csv", help="Write the points of --over to this table.", show_default=False)
    ] = None,
    optimise: Annotated[
        str | None,
        typer.Option(
            "--optimise",
            help="Find these flank modifications for the smallest mean peak to peak of the transmission error over --over: "
            "'tip_relief,tip_relief_length,wheel.crowning'.",
            show_default=False,
        ),
    ] = None,
    bounds: Annotated[
        list[str] | None,
        typer.Option("--bounds", help="Bounds of one of them: 'tip_relief=0 um:60 um'.", show_default=False),
    ] = None,
    tolerance: Annotated[
        list[str] | None,
        typer.Option(
            "--tolerance",
            help="Tolerance of one of them, up and down: 'tip_relief=5 um'. Default: a tenth of its bounds.",
            show_default=False,
        ),
    ] = None,
    weights: Annotated[
        str | None, typer.Option("--weights", help="Weights of the torques of --over: '1,2,1'.", show_default=False)
    ] = None,
    pressure_limit: Annotated[
        str | None,
        typer.Option(
            "--pressure-limit", help="Largest contact pressure of --optimise: '1200 MPa'.", show_default=False
        ),
    ] = None,
    evaluations: Annotated[
        int | None,
        typer.Option("--evaluations", help="Flanks that --optimise tries; default 60 for each.", show_default=False),
    ] = None,
    samples: Annotated[
        int | None,
        typer.Option("--samples", help="Flanks of the tolerance band of --optimise; 0 for none.", show_default=False),
    ] = None,
    root_stress: Annotated[
        bool,
        typer.Option("--root-stress", help="Follow the stress in the tooth roots of both gears over the mesh cycle."),
    ] = False,
    harmonics: Annotated[int, typer.Option("--harmonics", min=0, help="Mesh orders that are listed.")] = 5,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot",
            help="Draw the curves and the contact to this PNG or SVG.",
            show_default=False,
            callback=picture_name,
        ),
    ] = None,
    vtk: Annotated[
        Path | None,
        typer.Option(
            "--vtk",
            help="Write both tooth meshes with deflection, stress and pressure into this folder.",
            show_default=False,
            callback=vtk_folder,
        ),
    ] = None,
    at: Annotated[float, typer.Option("--at", help="Position in mesh periods that --vtk writes.")] = 0.0,
    json: JsonOption = None,
) -> None:
    """Print stiffness, transmission error, load sharing and pressure of one mesh over its cycle."""
    import rotorgear as rg

    checked = rg.load(model)
    if root_stress:
        refuse_beside(
            "--root-stress", stiffness=stiffness, accuracy=accuracy, periods=periods, load_factors=load_factors
        )
        refuse_beside("--root-stress", vtk=vtk, over=over, optimise=optimise, csv=csv)
        with progress_bar("root stress") as progress:
            roots = rg.root_stress(
                checked,
                mesh,
                torque=torque,
                preset=preset,
                body=body,
                positions=24 if positions is None else positions,
                progress=progress,
            )
        console().print(roots.table())
        write_json(roots.to_dict(), json)
        if plot:
            console().print(f"drawn: {rg.plot.save(rg.plot.root_stress(roots), plot)}")
        return
    if optimise is not None:
        refuse_beside(
            "--optimise", stiffness=stiffness, accuracy=accuracy, periods=periods, load_factors=load_factors, vtk=vtk
        )
        refuse_beside("--optimise", csv=csv, plot=plot)
        with progress_bar("optimise") as progress:
            best = rg.optimise_flanks(
                checked,
                mesh,
                variables=words_of(optimise),
                over=parse_over(over or []),
                bounds={name: text.split(":") for name, text in pairs_of("--bounds", bounds).items()},
                tolerance=pairs_of("--tolerance", tolerance),
                weights=None if weights is None else parse_factors(weights, "--weights"),
                pressure_limit=pressure_limit,
                samples=64 if samples is None else samples,
                evaluations=evaluations,
                torque=torque,
                preset=preset,
                body=body,
                positions=64 if positions is None else positions,
                progress=progress,
            )
        console().print(best.table())
        write_json(best.to_dict(), json)
        return
    for name, given in {
        "--bounds": bounds,
        "--tolerance": tolerance,
        "--weights": weights,
        "--pressure-limit": pressure_limit,
        "--evaluations": evaluations,
        "--samples": samples,
    }.items():
        if given is not None:
            raise AnalysisError(f"{name} belongs to --optimise: give that too.")
    if over:
        refuse_beside(
            "--over", stiffness=stiffness, accuracy=accuracy, periods=periods, load_factors=load_factors, vtk=vtk
        )
        with progress_bar("mesh") as progress:
            points = rg.mesh_map(
                checked,
                mesh,
                over=parse_over(over),
                torque=torque,
                preset=preset,
                body=body,
                positions=64 if positions is None else positions,
                progress=progress,
            )
        console().print(points.table())
        write_json(points.to_dict(), json)
        if csv:
            from rotorgear.export.csv_file import write_csv

            console().print(f"wrote {write_csv(map_rows(points), csv)}")
        if plot:
            console().print(f"drawn: {rg.plot.save(rg.plot.mesh_map(points), plot)}")
        return
    if csv:
        raise AnalysisError("--csv writes the points of --over: give --over too.")
    with progress_bar("mesh") as progress:
        result = rg.mesh(
            checked,
            mesh,
            stiffness=stiffness,
            torque=torque,
            preset=preset,
            body=body,
            accuracy=accuracy,
            positions=64 if positions is None else positions,
            periods=periods,
            load_factors=parse_factors(load_factors),
            progress=progress,
        )
    console().print(result.table(harmonics=harmonics))
    write_json(result.to_dict(max(harmonics, 8)), json)
    if plot:
        console().print(f"drawn: {rg.plot.save(rg.plot.mesh(result), plot)}")
    if vtk:
        from rotorgear.analysis.teeth.tooth_field import tooth_fields
        from rotorgear.export.tooth_vtk import write_tooth_vtk

        with progress_bar("vtk") as progress:
            fields = tooth_fields(
                checked, result.mesh, torque=torque, preset=result.preset, body=body, at=at, progress=progress
            )
        for path in write_tooth_vtk(fields, vtk):
            console().print(f"wrote {path}")


def refuse_beside(option: str, **given: object) -> None:
    """AnalysisError for options that an option does not go with."""
    for name, value in given.items():
        if value is not None:
            raise AnalysisError(f"--{name.replace('_', '-')} does not go with {option}.")


def pairs_of(option: str, texts: list[str] | None) -> dict[str, str]:
    """Texts by name from 'name=text', several of them with commas or in several options.

    Raises:
        AnalysisError: something else.
    """
    found = {}
    for text in ",".join(texts).split(",") if texts else ():
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not name or not value:
            raise AnalysisError(f"{option}: got '{text}', expected a name and its value, such as tip_relief=5 um")
        found[name] = value
    return found


def parse_over(texts: list[str]) -> dict[str, list[float]]:
    """Values in SI by axis from texts such as 'torque=500 N m:2000 N m:4,misalignment=0 um:10 um:20 um'.

    Raises:
        AnalysisError: no such axis, or values that are none.
    """
    from rotorgear.quantity import QuantityError, parse_quantity

    found: dict[str, list[float]] = {}
    for text in ",".join(texts).split(",") if texts else ():
        name, equals, values = (part.strip() for part in text.partition("="))
        dimension = {"torque": "torque", "misalignment": "length"}.get(name)
        if not equals or dimension is None:
            raise AnalysisError(f"--over: got '{text}', expected torque=... or misalignment=...")
        if name in found:
            raise AnalysisError(f"--over: '{name}' is given twice.")
        parts = [part.strip() for part in values.split(":")]
        count = int(parts.pop()) if len(parts) == 3 and parts[2].isdigit() else None
        try:
            numbers = [parse_quantity(part, dimension) for part in parts]
        except QuantityError as error:
            raise AnalysisError(
                f"--over {name}: got '{values}', expected {error}, such as '500 N m:2000 N m:4'"
            ) from None
        if count is None:
            found[name] = numbers
        elif 2 <= count <= 1000:
            first, last = numbers
            found[name] = [first + (last - first) * i / (count - 1) for i in range(count)]
        else:
            raise AnalysisError(f"--over {name}: got {count} values, expected 2 to 1000")
    return found


def map_rows(points: MeshMap) -> Iterator[dict[str, float]]:
    """One row a point of a map, in the order of its table."""
    for i, torque in enumerate(points.pinion_torque):
        for j, misalignment in enumerate(points.misalignment):
            orders = {f"ste_order_{n + 1}_m": float(value) for n, value in enumerate(points.ste_harmonics[i, j])}
            yield {
                "pinion_torque_n_m": float(torque),
                "misalignment_m": float(misalignment),
                "ste_peak_to_peak_m": float(points.ste_peak_to_peak[i, j]),
                **orders,
                "largest_pressure_pa": float(points.largest_pressure[i, j]),
                "face_load_factor": float(points.face_load_factor[i, j]),
                "mean_stiffness_n_per_m": float(points.mean_stiffness[i, j]),
            }


def parse_factors(text: str | None, option: str = "--load-factors") -> tuple[float, ...]:
    """Positive factors from a list with commas.

    Raises:
        AnalysisError: something else.
    """
    if text is None:
        return ()
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise AnalysisError(f"{option}: got '{text}', expected factors with commas, such as 0.1,0.5,2") from None
