"""Reads a model file (TOML) and writes its JSON Schema for editors."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from rotorgear.errors import ModelError, Problem
from rotorgear.files.bounds import LONGEST_TEXT, MODEL
from rotorgear.files.read import UnreadableError, read_text
from rotorgear.files.toml import long_texts, tables_of
from rotorgear.model.model import SCHEMA_VERSION, Model
from rotorgear.model.named_files import with_named_files
from rotorgear.model.parts.problems import address, shown
from rotorgear.model.spreads import scatter_problems
from rotorgear.quantity import nearest


def load(path: str | Path) -> Model:
    """Read a model from a TOML file.

    Args:
        path: of the file, with the ending .toml or any other.

    Returns:
        The model, checked.

    Raises:
        ModelError: the file can't be read, is no TOML, or holds mistakes; all of them at once.
    """
    path = Path(path)
    try:
        text = read_text(path, MODEL.most_bytes)
    except UnreadableError as error:
        if not error.missing:
            raise _refused(path, f"can't be read: {error.reason}", "a model file is plain text") from None
        names = sorted(item.name for item in path.parent.glob("*.toml")) if path.parent.is_dir() else []
        guess = nearest(path.name, names)
        hint = f"did you mean '{path.parent / guess}'?" if guess else ""
        raise _refused(path, "there is no such file", hint) from None
    return loads(text, path.name, path.parent)


def loads(text: str, source: str = "model", folder: str | Path = ".") -> Model:
    """Read a model from the text of a file.

    Args:
        text: in TOML.
        source: what errors call it.
        folder: where files that it names lie; the current one by default.

    Returns:
        The model, checked.

    Raises:
        ModelError: the text is no TOML, or holds mistakes; all of them at once.
    """
    try:
        data = tables_of(text)
    except ValueError as error:  # a TOMLDecodeError, or a number of thousands of digits
        raise ModelError([_syntax_problem(source, str(error), text)], source) from None
    long = [
        Problem(address(place), "", f"a text or name of up to {LONGEST_TEXT} letters") for place in long_texts(data)
    ]
    if long:
        raise ModelError(long, source)
    with_named_files(data, lambda name: str(Path(folder) / name))
    try:
        model = Model(**data)
    except ModelError as error:
        raise ModelError(error.problems, source) from None
    problems = scatter_problems(model) if model.scatter else []
    if problems:
        raise ModelError(problems, source)
    model.remember(text, folder)
    return model


def _refused(path: Path, text: str, hint: str = "") -> ModelError:
    return ModelError([Problem(str(path), "", text, hint)], path.name)


def _syntax_problem(source: str, message: str, text: str) -> Problem:
    """What the TOML reader says, with the line that it stumbled over and the likeliest remedy."""
    found = re.search(r"\(at line ([0-9]+), column [0-9]+\)", message)
    line = text.split("\n")[int(found[1]) - 1][:LONGEST_TEXT].strip() if found else ""
    quoted = f": {shown(line)}" if line else ""
    if re.search("overwrite|twice|mutate|redefine|immutable|extend", message):
        hint = "a table or a key stands once only"
    elif re.search(r"[=\[,]\s*[+-]?[0-9.]+([eE][+-]?[0-9]+)?\s*[A-Za-z°]", line):
        hint = 'a number with its unit stands in quotes: "20 mm"'
    else:
        hint = "[tables], and key = value with texts in quotes"
    return Problem(source, "", f"not valid TOML: {message}{quoted}", hint)


def schema() -> dict[str, Any]:
    """Return the JSON Schema of the model file, for editors with completion and checking."""
    data = Model.model_json_schema()
    data["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    data["$id"] = f"model-{SCHEMA_VERSION}.schema.json"
    data["title"] = "rotorgear model"
    return data
