"""What pictures and long tables were made from, and whether that is what stands here now.

A picture of docs/pictures/ is drawn by the command that docs/made.toml names, which also names the commands of values that take
hours. A table that takes long is a console block of `$ python -m ...` marked `<!-- run long -->` or `<!-- made -->`.
Nobody repeats them at every commit, so docs/made.json keeps two words for each: the commit at which it was made, and a digest of
what it shows:

* the words of the command, and the files that they name: models with the meshes and lists that these name, blocks of the page
  that are marked as files;
* a script or module of the repository, modules that the words after it name in its folder, and those outside of the package that
  they import: the definition of its rows, its rules of judging and its way of printing; the models whose names stand in them as
  texts; the files that a module lists as INPUTS;
* of a picture of `rotorgear VERB`, the modules of rotorgear/plots/ that draw it; of what all pictures share, the colours and
  other constants.

The package itself is left out: with it every commit would ask for hours of runs. That its numbers are still those of the pages is
for the tests that repeat a few of them. Comments, docstrings and the layout of a model file do not count.
"""

from __future__ import annotations

import ast
import hashlib
import json
import re
import shlex
import subprocess
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from machinery.snippets import ROOT, marked_blocks, pages

RECORD = "docs/made.json"
COMMANDS = "docs/made.toml"
_SHARED = "rotorgear/plots/figure.py"
# The module of rotorgear/plots/ that draws the result of a verb, where its name is another.
_PLOTS = {
    "accuracy": "convergence",
    "compare": "correlation",
    "critical": "critical_map",
    "gear": "gear_mesh",
    "mesh-map": "mesh",
    "modal": "mode_pictures",
    "optimise": "design",
    "root-stress": "mesh",
    "scatter": "design",
}


@dataclass(frozen=True)
class Made:
    """A picture or a long table.

    Attributes:
        name: file of the picture, page and module of the table, or the file of values (.json) that the command writes.
        page: the name of the page whose blocks the command needs, or that shows the table.
        command: what makes it.
        left: for a picture, the file that the command leaves where it runs; "" where it writes the picture itself.
        by_hand: whether docs/update.py cannot make it.
    """

    name: str
    page: str
    command: str
    left: str = ""
    by_hand: bool = False

    @property
    def is_picture(self) -> bool:
        """Whether it is a picture, which docs/update.py can draw again."""
        return self.name.endswith((".png", ".svg"))


def pictures(root: Path = ROOT) -> list[Made]:
    """The pictures that docs/made.toml tells how to draw, and the files of values whose command it names."""
    found = []
    for page, commands in tomllib.loads((root / COMMANDS).read_text(encoding="utf-8")).items():
        for command, drawn in commands.items():
            left = drawn if isinstance(drawn, dict) else dict.fromkeys(drawn, "")
            by_program = command.startswith(("rotorgear ", "python "))
            found += [
                Made(name, page, command, file, name.endswith(".json") or not by_program) for name, file in left.items()
            ]
    return found


def tables(root: Path = ROOT) -> list[Made]:
    """The blocks of the pages that a long command of the repository prints."""
    return [
        Made(
            f"{page.stem}: {' '.join(block.argument.split()[2:])}",
            page.stem,
            block.argument,
            by_hand=block.verb == "made",
        )
        for page in pages(root)
        for block in marked_blocks(page)
        if block.argument.startswith("python -m ") and (block.long or block.verb == "made")
    ]


def stale(root: Path = ROOT) -> list[str]:
    """A sentence for each picture and table that was made from something else than stands here now."""
    record = _record(root)
    found = []
    for made in [*pictures(root), *tables(root)]:
        commit, _, digest = record.get(made.name, "").partition(" ")
        if digest == digest_of(inputs(made, root)):
            continue
        since = f"was made at {commit} from other" if commit else "has no record of being made from the present"
        again = f"python docs/update.py {made.name if made.is_picture else f'--long {made.page}'}"
        if made.name.endswith(".json"):
            again = f"{made.command}, then  python docs/update.py --same {made.name}"
        elif made.by_hand:
            again = f"{made.command}, put what it shows on docs/{made.page}.md, then  python docs/update.py --same '{made.name}'"
        found.append(f"{made.name} {since} {', '.join(_changed(commit, made, root))}: run  {again}  and look at it")
    return found


def record(names: Iterable[str], root: Path = ROOT) -> None:
    """Write down that some pictures and tables show what stands here now, and forget those that are gone."""
    now = {made.name: made for made in [*pictures(root), *tables(root)]}
    old = _record(root)
    kept = {name: old[name] for name in now if name in old}
    kept |= {name: f"{_commit(root)} {digest_of(inputs(now[name], root))}" for name in names}
    text = json.dumps(dict(sorted(kept.items())), indent=0, ensure_ascii=False)
    (root / RECORD).write_text(text + "\n", encoding="utf-8", newline="\n")


def inputs(made: Made, root: Path = ROOT) -> dict[str, str]:
    """What a picture or table is made from: texts by the path of their file, and the command itself.

    Raises:
        ValueError: a module that the repository does not have, or a result that no block of the page makes.
    """
    words = shlex.split(made.command)
    found = {"its command": " ".join(words)}
    page = root / "docs" / f"{made.page}.md"
    blocks = (
        {block.argument: block.text for block in marked_blocks(page) if block.verb == "file"} if page.exists() else {}
    )
    for word in words[1:]:
        if word in blocks:
            found[f"{word} of {made.page}.md"] = _plain(word, blocks[word].encode())
        elif (root / word).is_file() and not word.startswith("docs/pictures/"):
            found |= _file(root / word, root)
    if words[:2] == ["python", "-m"]:
        start = _module_file(words[2], root, "__main__.py")
        if start is None:
            raise ValueError(f"{made.command}: there is no module {words[2]} in the repository")
        found |= _file(start, root)
        for file in (start.parent / f"{word}.py" for word in words[3:]):
            found |= _file(file, root) if file.is_file() else {}
    elif words[0] == "rotorgear":
        drawn = "time_comparison" if "--time" in words and words[1] == "compare" else _PLOTS.get(words[1], words[1])
        found |= _file(root / "rotorgear" / "plots" / f"{drawn}.py", root)
    elif words[0] != "python":  # sheet.plot(), of the block with sheet = rg.bearing(...)
        made_by = re.compile(rf"\b{made.command.partition('.')[0]} = rg\.(\w+)\(")
        code = [block.text for block in marked_blocks(page) if made_by.search(block.text)]
        if not code:
            raise ValueError(f"{made.command}: no block of {made.page}.md has its result")
        verb = made_by.findall(code[-1])[-1].replace("_", "-")
        found |= {"its block": code[-1]}
        found |= _file(root / "rotorgear" / "plots" / f"{_PLOTS.get(verb, verb)}.py", root)
    return found


def digest_of(texts: dict[str, str]) -> str:
    """A short digest of texts by name."""
    return hashlib.sha256(json.dumps(texts, sort_keys=True).encode()).hexdigest()[:10]


def _file(start: Path, root: Path) -> dict[str, str]:
    """A file and all that it names, plain, by their paths."""
    found: dict[str, str] = {}
    waiting = [start]
    while waiting:
        file = waiting.pop()
        name = file.relative_to(root).as_posix()
        if name not in found:
            content = file.read_bytes()
            found[name] = _plain(name, content)
            waiting += _named_by(file, content, root)
    return found


@cache
def _plain(name: str, content: bytes) -> str:
    """The text of a file without what changes nothing: comments, docstrings, the layout of a model file."""
    text = content.decode("utf-8", errors="replace").replace("\r\n", "\n")
    if name.endswith(".toml"):
        return json.dumps(tomllib.loads(text), sort_keys=True, default=str)
    if not name.endswith(".py"):
        return text
    lines = text.splitlines()
    if name == _SHARED:
        constants = [node for node in ast.parse(text).body if isinstance(node, ast.Assign)]
        lines = [line for node in constants for line in lines[node.lineno - 1 : node.end_lineno]]
        return "\n".join(lines)
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node) is not None:
            said = node.body[0]
            lines[said.lineno - 1 : said.end_lineno] = [""] * (said.end_lineno - said.lineno + 1)  # type: ignore[operator]
    return "\n".join(line.rstrip() for line in lines if line.strip() and not line.lstrip().startswith("#"))


@cache
def _named_by(file: Path, content: bytes, root: Path) -> list[Path]:
    """Files that a file is read with: the meshes and lists of a model; modules, models and INPUTS of a module."""
    if file.suffix == ".toml":
        texts = [text for text in _texts(tomllib.loads(content.decode())) if len(text) < 200 and "\n" not in text]
        return [file.parent / text for text in texts if (file.parent / text).is_file()]
    found: list[Path] = []
    if file.suffix == ".py":
        models = {model.stem: model for model in (root / "models").glob("*.toml")}
        for node in ast.walk(ast.parse(content)):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                stem = node.value.removeprefix("models/").removesuffix(".toml")
                found += [models[stem]] if stem in models else []
            elif isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "INPUTS":
                found += [one for pattern in ast.literal_eval(node.value) for one in sorted(root.glob(pattern))]
            elif isinstance(node, (ast.Import, ast.ImportFrom)):
                found += _imported(node, root)
    return found


def _imported(node: ast.Import | ast.ImportFrom, root: Path) -> Iterator[Path]:
    """Files of the modules that a line imports: those of the repository, of the package those that draw."""
    of = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
    names = [".".join([*of, one.name]) for one in node.names]
    for name in [*of, *names]:
        if name.startswith("rotorgear.plots.") or not name.startswith(("rotorgear", "machinery.snippets")):
            file = _module_file(name, root, "__init__.py")
            if file:
                yield file


def _module_file(name: str, root: Path, of_package: str) -> Path | None:
    """The file of a module of the repository; of a package, the named file in it."""
    for top in (root, root / "docs"):
        place = top / name.replace(".", "/")
        for file in (place.with_suffix(".py"), place / of_package):
            if file.is_file():
                return file
    return None


def _texts(value: Any) -> Iterator[str]:
    """All texts in a tree of tables and lists."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, (dict, list)):
        for one in value.values() if isinstance(value, dict) else value:
            yield from _texts(one)


def _record(root: Path) -> dict[str, str]:
    """What docs/made.json tells."""
    file = root / RECORD
    return dict(json.loads(file.read_text(encoding="utf-8"))) if file.exists() else {}


@cache
def _commit(root: Path) -> str:
    """The short name of the commit that is checked out; "-" without git."""
    return _git(root, "rev-parse", "--short=8", "HEAD").strip() or "-"


def _changed(commit: str, made: Made, root: Path) -> list[str]:
    """The inputs that differ from those of a commit as git knows them, all of them where it does not know."""
    now = inputs(made, root)
    files = [name for name in now if (root / name).is_file()]
    then = {name: _git(root, "show", f"{commit}:{name}") for name in files} if commit else {}
    return [name for name, text in then.items() if _plain(name, text.encode()) != now[name]] or list(now)


def _git(root: Path, *words: str) -> str:
    """What git prints; "" where it is not there or refuses."""
    try:
        done = subprocess.run(["git", "-C", str(root), *words], capture_output=True, check=False)
    except OSError:
        return ""
    return done.stdout.decode("utf-8", errors="replace") if done.returncode == 0 else ""
