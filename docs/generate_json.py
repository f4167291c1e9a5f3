"""Writes docs/json.md from the declarations of the results: the rules, and what each command's output holds.

The site shows the whole page: every key with its unit and meaning.
"""

from __future__ import annotations

from rotorgear.results.kinds import keys_of, kinds
from rotorgear.results.result import ModelResult

HEAD = """# JSON output

`--json FILE` writes the result of a command as one JSON object; `result.to_dict()` is the same in Python. A test compares the
keys with what the commands write, in both directions.

* **A field has one name.** A key is the name of the field in Python, in tables of `result.rows()` and in the HDF5 file of
  `--save`, with its unit behind it where it has one: `largest_pressure` in Pa is `largest_pressure_pa`. Some keys keep the
  shorter name that they have had since version 0.1, such as `ste_m` of a transmission error.
* **Numbers are in the unit that their key names**, SI but for `_rpm`, `_deg`, `_hz` and `_percent`; a key without a unit is a
  share, a ratio, a count, or says its unit in its meaning. What is stored as rad/s and rad is written as rpm and degrees.
* **A number that is not known is `null`**, and so is one that is not finite.
* **Lists go along axes.** `[]` stands for the entries of a list, and a word in capitals for names of your model, which are the
  keys of an object. Modes are counted from 1 in `mode_number`; lists over modes begin with mode 1.
* **What every result says** stands in each object: see the first table.

The whole list of keys with units and meanings is made with the site, from the declarations of the results in
`rotorgear/results/`: `python docs/build_site.py` builds it.
"""
_WHOLE = """# JSON output

`--json FILE` writes the result of a command as one JSON object; `result.to_dict()` is the same in Python. Numbers are in the
unit that their key names; a key without a unit is a share, a ratio or a count. A number that is not known is `null`. Modes are
counted from 1 in `mode_number`; lists over modes begin with mode 1.

Below, `[]` stands for the entries of a list, and a word in capitals for names of your model. This page is made from the
declarations of the results in `rotorgear/results/`; a test compares it with what the commands write, in both directions.
"""
# So many fields of a result stand in the summary.
_MAIN = 8
# Heading, words before the table, and the kinds of results with what stands before their keys.
SECTIONS: tuple[tuple[str, str, tuple[tuple[str, str], ...]], ...] = (
    (
        "modal",
        "`rotorgear modal MODEL --json modal.json`. With `--rig`, the keys of the [comparison](#compare) stand below\n"
        "`comparison`.",
        (("modal", ""),),
    ),
    ("compare", "`rotorgear compare MODEL RIG --json compare.json` writes these keys.", (("compare", ""),)),
    (
        "compare shapes",
        "`rotorgear compare MODEL --shapes FILE --json compare.json`. [The rig](rig.md) says what the numbers mean.",
        (("compare_shapes", ""),),
    ),
    (
        "compare frequency responses",
        "`rotorgear compare MODEL --frf FILE --json compare.json`.",
        (("compare_frf", ""),),
    ),
    (
        "compare order cuts",
        "`rotorgear compare MODEL --orders FILE --json compare.json`.",
        (("compare_orders", ""),),
    ),
    ("sensors", "`rotorgear sensors MODEL --json sensors.json`.", (("sensors", ""),)),
    (
        "update",
        "`rotorgear update MODEL --rig FILE --json update.json`. [Updating by a rig](rig.md) says what the numbers mean.",
        (("update", ""),),
    ),
    (
        "mesh",
        "`rotorgear mesh MODEL --mesh NAME --json mesh.json`. Stiffness and transmission error are transverse, of all helices\n"
        "together where `helix[]` doesn't stand before them. What a stiffness model doesn't know is `null`, and `helix[]` is\n"
        "empty without loaded contact.",
        (("mesh", ""),),
    ),
    (
        "mesh map",
        "`rotorgear mesh-map MODEL --over torque=... --json map.json`. Lists of lists are by torque and misalignment.",
        (("mesh_map", ""),),
    ),
    (
        "mesh optimum",
        "`rotorgear optimise-flanks MODEL --variables ... --json best.json`. Lists of lists are by torque and misalignment.",
        (("mesh_optimum", ""),),
    ),
    (
        "root stress",
        "`rotorgear root-stress MODEL --json roots.json`.",
        (("root_stress", ""),),
    ),
    (
        "mesh accuracy",
        "`rotorgear accuracy MODEL --analysis mesh --json study.json`, of one helix.",
        (("mesh_convergence", ""),),
    ),
    (
        "campbell",
        "`rotorgear campbell MODEL --json campbell.json`. Lists of lists are by branch and speed; `null` where a branch\n"
        "does not oscillate or is out of reach.",
        (("campbell", ""),),
    ),
    (
        "critical",
        "`rotorgear critical MODEL --map --json critical.json`. Lists are by critical speed, ascending; `map` is there with\n"
        "`--map` only.",
        (("critical", ""), ("critical_map", "map.")),
    ),
    (
        "standards",
        "`rotorgear standards MODEL --json standards.json`. [Rules of standards](report.md#rules-of-standards) says what is "
        "compared.",
        (("standards", ""),),
    ),
    (
        "static",
        "`rotorgear static MODEL --json static.json`. Lists over the contacts of a mesh have two entries for a herringbone gear\n"
        "with two nodes, first the helix at the smaller z. Vectors are x, y, z.",
        (("static", ""),),
    ),
    (
        "response",
        "`rotorgear response MODEL --json response.json`. All amplitudes are half of peak to peak. Lists of lists are by\n"
        "order and speed; `MESH[]` by contact, order and speed.",
        (("response", ""),),
    ),
    (
        "frf",
        "`rotorgear frf MODEL --inputs A --outputs B --fmax 1000 --json frf.json`. Receptances are lists by response, force and\n"
        "frequency.",
        (("frf", ""),),
    ),
    (
        "check",
        "`rotorgear check MODEL --json check.json`. What a lumped gear doesn't know is `null`, and so is what needs a\n"
        "speed where none is given.",
        (("check", ""),),
    ),
    (
        "transient",
        "`rotorgear transient MODEL --json transient.json`. `spectrum` with `--spectrum`, `rig` with `--rig`. Histories are\n"
        "in the HDF5 file of `--save`.",
        (("transient", ""), ("spectral_lines", "spectrum."), ("rig_spectrum", "rig.")),
    ),
    (
        "sweep",
        "`rotorgear sweep MODEL --over ADDRESS=VALUES --json sweep.json`. What failed or makes no sense is `null`. Sections and\n"
        "trajectories are in the HDF5 file of `--save`.",
        (("sweep", ""),),
    ),
    (
        "orbits",
        "`rotorgear orbits MODEL --over ADDRESS=FROM:TO --json orbits.json`. Lists over points follow branches; coefficients\n"
        "of all harmonics are in the HDF5 file of `--save`.",
        (("orbits", ""),),
    ),
    (
        "scatter",
        "`rotorgear scatter MODEL --free ADDRESS --json scatter.json`. The samples themselves are in the HDF5 file of `--save`.",
        (("scatter", ""),),
    ),
    (
        "optimise",
        "`rotorgear optimise MODEL --free ADDRESS --json optimise.json`. [Layout](report.md#layout) says what is done.",
        (("optimise", ""),),
    ),
    (
        "sweep accuracy",
        "`rotorgear accuracy MODEL --analysis sweep --json accuracy.json`.",
        (("sweep_convergence", ""),),
    ),
    (
        "gear",
        "`rotorgear gear MODEL --json gear.json`. The [page on gears](mesh.md#the-gear-sheet) says what the numbers mean.",
        (("gear", ""),),
    ),
    (
        "bearing",
        "`rotorgear bearing MODEL NAME --json bearing.json`. The [page on bearings](bearings.md) says how the numbers are found.",
        (("bearing", ""),),
    ),
    (
        "casing",
        "`rotorgear casing MODEL --json casing.json`. The [page on casings](casings.md) says how the numbers are found.",
        (("casing", ""),),
    ),
    (
        "export",
        "`rotorgear export MODEL --state-space FILE ... --json system.json`. The matrices are in the file.",
        (("state_space", ""),),
    ),
    (
        "import",
        "`rotorgear import FILE -o gearbox.toml --json import.json`. The [page on REXS](rexs.md) says what is assumed when.",
        (("import", ""),),
    ),
    (
        "accuracy",
        "`rotorgear accuracy MODEL --json accuracy.json`. What is infinite or makes no sense is `null`.",
        (("convergence", ""),),
    ),
    (
        "tooth field",
        "`rotorgear mesh MODEL --vtk FOLDER` writes the stresses of the teeth for ParaView; `to_dict()` holds the largest\n"
        "and the contact pressure.",
        (("tooth_field", ""),),
    ),
)


def pages() -> dict[str, str]:
    """Return the summary by its path: the rules, what every result says, and a line for each command."""
    common = {path: (path, unit, text) for path, unit, text in keys_of(ModelResult)}
    shared = "".join(row(*key) for path, key in common.items() if path != "analysis")
    lines = []
    for heading, _, parts in SECTIONS:
        for kind, prefix in parts:
            cls = kinds()[kind]
            about = (cls.__doc__ or "").strip().split("\n")[0].replace("|", "\\|")
            own = dict.fromkeys(path.partition(".")[0] for path, _, _ in keys_of(cls) if path not in common)
            fields = [f"`{prefix}{name}`" for name in own if not name.startswith(("analysis", "facts"))]
            more = f" and {len(fields) - _MAIN} more" if len(fields) > _MAIN else ""
            lines.append(f"| {heading} | {about} | {', '.join(fields[:_MAIN])}{more} |\n")
    parts_of_page = [
        HEAD,
        f"## What every result says\n\n| key | unit | value |\n|---|---|---|\n{shared}",
        f"## What each command writes\n\n| output | what it holds | main fields |\n|---|---|---|\n{''.join(lines)}",
    ]
    return {"docs/json.md": "\n".join(parts_of_page)}


def site_pages() -> dict[str, str]:
    """Return the whole page by its path."""
    return {"docs/json.md": "\n".join([_WHOLE, *(section(*parts) for parts in SECTIONS)])}


def section(heading: str, words: str, parts: tuple[tuple[str, str], ...]) -> str:
    """The section of one command."""
    rows = "".join(row(*key) for kind, prefix in parts for key in keys_of(kinds()[kind], prefix))
    return f"## {heading}\n\n{words}\n\n| key | unit | value |\n|---|---|---|\n{rows}"


def row(path: str, unit: str, text: str) -> str:
    """A line of the table; a vertical bar would end the cell."""
    cell = text.replace("|", "\\|")
    return f"| `{path}` | {unit} | {cell} |\n"
