"""How large what comes from others may be: one table, which SECURITY.md prints."""

from __future__ import annotations

from typing import NamedTuple

_MB = 1_000_000
# Letters of a name, of a quantity and of any other text in a model; an unreadable line takes as long as a whole model otherwise.
LONGEST_TEXT = 1000
# Letters of a number with its unit.
LONGEST_QUANTITY = 200
# Parts of a key between dots; Python's reader of TOML takes time by their square.
MOST_DOTS = 64
# Rows of a table: more points are no measurement of a flank, of a load or of a rig.
MOST_ROWS = 200_000
# Elements of XML, or values of JSON: a gearbox with all its contact results has some ten thousands.
MOST_ELEMENTS = 500_000
# Components of a gearbox.
MOST_COMPONENTS = 10_000
# Files in an archive, or members of a relation.
MOST_MEMBERS = 1000
# Numbers in all channels of a record over time.
MOST_SAMPLES = 20_000_000
# Numbers that a set of a mesh lists.
MOST_LISTED = 8_000_000


class Bound(NamedTuple):
    """Files of a kind: what they are, the largest in bytes (unpacked, too), and what else is bounded in them."""

    title: str
    most_bytes: int
    also: str


MODEL = Bound(
    "model, campaigns (TOML)", 8 * _MB, f"{LONGEST_TEXT} letters in a text or name, {MOST_DOTS} dots in a row in a key"
)
TABLE = Bound(
    "rig lines, sensors, cuts, limits, measured flanks, loads over time (CSV)",
    32 * _MB,
    f"{MOST_ROWS:,} rows, {LONGEST_TEXT:,} letters in a cell",
)
REXS = Bound(
    "REXS (XML, JSON, zip of one)",
    32 * _MB,
    f"{MOST_ELEMENTS:,} elements, {MOST_COMPONENTS:,} components, {LONGEST_TEXT} letters in a text, "
    f"{MOST_MEMBERS} files in the archive; no document type",
)
UNIVERSAL = Bound("universal files (UFF)", 500 * _MB, "a set has the values that its header says")
RECORD = Bound(
    "records over time (CSV, MDF4, TDMS, WAV)",
    500 * _MB,
    f"{MOST_SAMPLES:,} numbers in all channels; formulas in MDF4 are not run",
)
MESH = Bound("meshes", 1000 * _MB, f"{MOST_LISTED:,} numbers in a set; formats that name other files are not read")
MATRICES = Bound(
    "matrices (npz)", 400 * _MB, f"{MOST_MEMBERS} arrays, none larger than its place in the file; no Python objects"
)
RESULT = Bound(
    "results and chunks (HDF5)",
    1_000_000 * _MB,
    "no data set larger than the file; no links to other files, no data kept outside of it",
)
ALL = (MODEL, TABLE, REXS, UNIVERSAL, RECORD, MESH, MATRICES, RESULT)


def printed() -> str:
    """The table as SECURITY.md prints it."""
    rows = [f"| {one.title} | {one.most_bytes // _MB:,} MB | {one.also} |" for one in ALL]
    return "\n".join(["| files | at most | and |", "|---|---|---|", *rows])
