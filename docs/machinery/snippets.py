"""The marked code blocks of a Markdown page: found, run, and compared with what they printed before.

A mark is an HTML comment on the line before a fenced block:

    <!-- run -->                  a `python` block is run; the python blocks of a page share their variables
                                  a `console` block is run: lines `$ command`, each followed by what it prints
    <!-- output -->               the block is what the python block before it prints
    <!-- run exit=2 -->           a `console` block whose commands end with this code
    <!-- run long -->             a block of seconds to minutes on which no other depends: run with the long tests, and where its
                                  page is brought up to date
    <!-- made -->                 a `console` block of one command that is never run from here: it takes hours or other programs,
                                  or prints times; `made.py` tells where what it once printed is older than its script
    <!-- file: gearbox.toml -->   the block is written to this file

A reader does not see the marks, so that a command stands in its block.

The blocks of a page run in order, in one directory that starts with copies of `models/` and `validation/measured/`. Commands are
`rotorgear` and `python`. How texts are compared stands in `comparison.py`.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from machinery.comparison import merged, texts_agree
from machinery.session import PythonSession

ROOT = Path(__file__).resolve().parents[2]
# What the directory starts with.
FOLDERS = ("models", "validation/measured")
PRINT_WIDTH = 100
LONGEST_RUN = 300  # seconds
LONGEST_LONG_RUN = 3600

_FENCE = re.compile(r"^( *)(`{3,}|~{3,})\s*([\w-]*)[^`]*$")
_MARK = re.compile(r"^\s*<!--\s*(run|output|file|made)\b(\s+long)?(?:\s+exit=(\d+))?\s*(?::\s*(.*?))?\s*-->\s*$")


_COMMAND = re.compile(r"^\$ (.*(?:\\\n.*)*)$", re.MULTILINE)


class SnippetError(Exception):
    """A block can't be run, or didn't end as its mark says."""


@dataclass(frozen=True)
class Block:
    """A marked block: its page, the line of its fence (from 1), its language, its mark, and its text.

    The argument is the file to write, or the command of a console block that has one. An output of a long block is long, as
    that is. Blocks that differ in nothing but their line are equal.
    """

    page: Path
    line: int = field(compare=False)
    language: str
    verb: str
    argument: str
    exit_code: int
    long: bool
    text: str

    @property
    def place(self) -> str:
        """Where the block stands, for messages."""
        return f"{self.page.name}:{self.line}"


@dataclass(frozen=True)
class Outcome:
    """A block that was run: `new` is what its text should be now, None where its gaps can't be found again."""

    block: Block
    printed: str
    new: str | None

    @property
    def agrees(self) -> bool:
        """Whether the page tells what was printed."""
        return self.new == self.block.text


def pages(root: Path = ROOT) -> list[Path]:
    """Return the pages of the project: the Markdown files at its top and below docs/."""
    return sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md")])


def marked_blocks(page: Path) -> list[Block]:
    """Return the marked blocks of a page, in order.

    Raises:
        SnippetError: for a mark with no block right below it, or one that doesn't fit its block.
    """
    lines = page.read_text(encoding="utf-8").splitlines()
    blocks = []
    mark: re.Match[str] | None = None
    k = 0
    while k < len(lines):
        fence = _FENCE.match(lines[k])
        if mark and not fence:
            raise SnippetError(f"{page.name}:{k}: there is no fenced block on the line below this mark")
        if fence:
            end = _end_of_block(lines, k, fence[2])
            if mark:
                text = "\n".join(line.removeprefix(fence[1]) for line in lines[k + 1 : end])
                long = blocks[-1].long if mark[1] == "output" and blocks else bool(mark[2])
                commands = _COMMAND.findall(text) if fence[3] == "console" else []
                argument = mark[4] or (commands[0] if len(commands) == 1 else "")
                blocks.append(Block(page, k + 1, fence[3], mark[1], argument, int(mark[3] or 0), long, text))
                _check_mark(blocks, mark[4] or "")
            k = end
        mark = None if fence else _MARK.match(lines[k])
        k += 1
    if mark:
        raise SnippetError(f"{page.name}:{len(lines)}: there is no fenced block on the line below this mark")
    return blocks


def _end_of_block(lines: list[str], start: int, fence: str) -> int:
    for k in range(start + 1, len(lines)):
        if lines[k].strip().startswith(fence) and not lines[k].strip().strip(fence[0]):
            return k
    return len(lines)


def _check_mark(blocks: list[Block], given: str) -> None:
    """Refuse a mark that would do nothing, or not what it seems to."""
    block = blocks[-1]
    runs = block.verb in ("run", "made")
    wrong = {
        "a command stands in its console block, where a reader sees it: $ ...": runs and bool(given),
        "run needs a python or console block": block.verb == "run" and block.language not in ("python", "console"),
        "a console block needs lines that start with '$ '": runs
        and block.language == "console"
        and not block.text.startswith("$ "),
        "a file needs a name inside the directory": block.verb == "file" and not _is_inside(block.argument),
        "made needs a console block of one command": block.verb == "made" and not block.argument,
        "output takes no argument": block.verb == "output" and bool(block.argument),
        "long is for run only": block.long and block.verb in ("file", "made"),
        "exit= is for commands only": bool(block.exit_code) and (block.verb != "run" or block.language == "python"),
        "output needs a marked python block before it": block.verb == "output"
        and not any(b.language == "python" for b in blocks[:-1]),
    }
    for sentence, is_wrong in wrong.items():
        if is_wrong:
            raise SnippetError(f"{block.place}: {sentence}")


def _is_inside(name: str) -> bool:
    path = Path(name)
    return bool(name) and not path.is_absolute() and ".." not in path.parts


def run_page(page: Path, directory: Path, *, long: bool = True) -> Iterator[Outcome]:
    """Run the marked blocks of a page in a directory, with or without long ones; yield each block that shows an output.

    Raises:
        SnippetError: where a block fails, or the blocks of the page are others when the last one has run.
    """
    at_first = marked_blocks(page)
    blocks = [block for block in at_first if block.verb != "made" and (long or not block.long)]
    directory.mkdir(parents=True, exist_ok=True)
    for folder in FOLDERS if blocks else ():
        if (ROOT / folder).is_dir():
            shutil.copytree(ROOT / folder, directory / folder, dirs_exist_ok=True)
    printed = ""
    with PythonSession(directory, environment()) as session:
        for block in blocks:
            if block.verb == "file":
                target = directory / block.argument
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_text(block.text + "\n", encoding="utf-8")
            elif block.verb == "output":
                yield _outcome(block, block.text, printed)
            elif block.language == "console":
                yield _console(block, directory)
            else:
                ok, printed = session.run(block.text)
                if not ok:
                    raise SnippetError(f"{block.place}: this block fails:\n{printed}")
    if marked_blocks(page) != at_first:
        raise SnippetError(f"{page.name}: its blocks were edited while they ran; run them again")


def _outcome(block: Block, page: str, printed: str) -> Outcome:
    new = page if texts_agree(page, printed) else merged(page, printed)
    return Outcome(block, printed, None if new is None else "\n".join(line.rstrip() for line in new.split("\n")))


def _console(block: Block, directory: Path) -> Outcome:
    """Run the commands of a console block, each with the output below it."""
    chunks = _COMMAND.split(block.text)[1:]
    all_printed: list[str] = []
    new: list[str | None] = []
    for command, shown in zip(chunks[::2], chunks[1::2], strict=True):
        text = shown.rstrip("\n")
        printed = run_command(block, command, directory)
        outcome = _outcome(block, text.removeprefix("\n"), printed)
        all_printed += [f"$ {command}", printed]
        lines_after = shown[len(text) :]
        new.append(None if outcome.new is None else f"$ {command}\n{outcome.new}".rstrip("\n") + lines_after)
    whole = None if None in new else "".join(filter(None, new))
    return Outcome(block, "\n".join(all_printed), whole)


def run_command(block: Block, command: str, directory: Path) -> str:
    """Return what a command prints, errors included, as a reader sees them at a terminal.

    Raises:
        SnippetError: it is none of rotorgear or python, takes too long, or ends with another code than its block says.
    """
    words = shlex.split(command.replace("\\\n", " "))
    programs = {
        "rotorgear": [sys.executable, "-m", "rotorgear"],
        "python": [sys.executable],
        "python3": [sys.executable],
    }
    longest = LONGEST_LONG_RUN if block.long else LONGEST_RUN
    if not words or words[0] not in programs:
        raise SnippetError(f"{block.place}: can't run '{command}': commands on a page are rotorgear and python")
    try:
        run = subprocess.run(
            [*programs[words[0]], *words[1:]],
            cwd=directory,
            env=environment(),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=longest,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise SnippetError(f"{block.place}: '{command}' was not done in {longest} s") from None
    printed = run.stdout.decode("utf-8", errors="replace").replace("\r\n", "\n")
    if run.returncode != block.exit_code:
        raise SnippetError(
            f"{block.place}: '{command}' ended with code {run.returncode}, expected {block.exit_code}:\n{printed}"
        )
    return printed.rstrip()


def environment() -> dict[str, str]:
    """Return the environment of the blocks: this clone, one thread, no colours, no windows, a fixed print width."""
    fixed = {
        "PYTHONPATH": str(ROOT),
        "PYTHONUTF8": "1",
        "COLUMNS": str(PRINT_WIDTH),
        "NO_COLOR": "1",
        "TERM": "dumb",
        "MPLBACKEND": "Agg",
        "PYVISTA_OFF_SCREEN": "true",
    }
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    unwanted = ("FORCE_COLOR", "COLORTERM", "PYTHONWARNINGS")
    return {**{key: value for key, value in os.environ.items() if key not in unwanted}, **fixed, **threads}


def rewritten(page: Path, outcomes: list[Outcome]) -> str:
    """Return the text of a page with the outputs that were printed now; what was edited around its blocks meanwhile stays.

    Raises:
        SnippetError: where an output with gaps changed so much that its gaps can't be found again, or a block is gone.
    """
    text = page.read_text(encoding="utf-8")
    lines = text.splitlines()
    places = _places_now(page, [outcome.block for outcome in outcomes])
    for outcome, start in reversed(list(zip(outcomes, places, strict=True))):
        if outcome.agrees:
            continue
        if outcome.new is None:
            raise SnippetError(
                f"{outcome.block.place}: place the '...' of this block by hand; printed was:\n{outcome.printed}"
            )
        indent = " " * (len(lines[start - 1]) - len(lines[start - 1].lstrip()))
        old = len(outcome.block.text.splitlines())
        lines[start : start + old] = [(indent + line).rstrip() for line in outcome.new.splitlines()]
    return "\n".join(lines) + ("\n" if text.endswith("\n") else "")


def _places_now(page: Path, blocks: list[Block]) -> list[int]:
    """The lines of blocks as their page stands now, which may have been edited since they were read."""
    now = iter(marked_blocks(page))
    places = []
    for block in blocks:
        same = next((one for one in now if one == block), None)
        if same is None:
            raise SnippetError(f"{block.place}: this block was edited while the page ran; run it again")
        places.append(same.line)
    return places
