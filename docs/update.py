"""Bring the docs up to date:  python docs/update.py

With names of pages or generators, only those, their long blocks too:  python docs/update.py mesh commands
With names of pictures, these are drawn again:  python docs/update.py bearing.png
With --check it changes nothing, and fails where something but seconds would change.
With --same it notes that pictures or tables still show what is right:  python docs/update.py --same bearing.png

Every number on a page is printed by a command beside it. This runs the marked blocks of all pages (the marks stand in
`machinery/snippets.py`), puts in what they print now, and writes the generated pages. A generator is a file
`docs/generate_*.py` with a function `pages() -> dict[str, str]`: the text of each page by its path from the top of the
repository. With `LONG = True` at its top it only runs with --long. So do the notebooks and the long blocks of pages, where
these are not named, and the pictures that are older than what they show (see `machinery/made.py`). A generator with
`site_pages()` adds whole pages to the site, of which the repository keeps a summary.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import shlex
import shutil
import sys
import tempfile
from collections.abc import Callable, Collection, Iterator
from functools import partial
from pathlib import Path
from types import ModuleType

from machinery.comparison import difference, texts_agree
from machinery.made import Made, pictures, record, stale, tables
from machinery.notebooks import notebooks, run_notebook
from machinery.snippets import (
    FOLDERS,
    ROOT,
    Block,
    SnippetError,
    marked_blocks,
    pages,
    rewritten,
    run_command,
    run_page,
)

DOCS = Path(__file__).resolve().parent


def generators(folder: Path = DOCS) -> list[Path]:
    """Return the generator files."""
    return sorted(folder.glob("generate_*.py"))


def load_generator(file: Path) -> ModuleType:
    """Return a generator file as a module.

    Raises:
        SnippetError: if it has no function `pages`.
    """
    spec = importlib.util.spec_from_file_location(file.stem, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[file.stem] = module  # dataclasses look their module up there
    spec.loader.exec_module(module)
    if not callable(getattr(module, "pages", None)):
        raise SnippetError(f"{file.name}: a generator needs a function pages() -> dict[str, str]")
    return module


def is_long(file: Path) -> bool:
    """Whether a generator takes so long that it only runs when asked for."""
    return bool(getattr(load_generator(file), "LONG", False))


def generated_changes(file: Path) -> Iterator[tuple[Path, str, str]]:
    """Yield (page, old text, new text) for each page of a generator that isn't what it makes now, seconds apart."""
    for name, text in load_generator(file).pages().items():
        page = ROOT / name
        old = page.read_text(encoding="utf-8") if page.exists() else ""
        if not texts_agree(old, text):
            yield page, old, text


def snippet_changes(page: Path, *, long: bool = True) -> Iterator[tuple[Path, str, str]]:
    """Yield (page, old text, new text) if what the blocks of a page print is not what it shows, seconds apart."""
    with tempfile.TemporaryDirectory() as directory:
        outcomes = list(run_page(page, Path(directory), long=long))
    old = page.read_text(encoding="utf-8")
    new = rewritten(page, outcomes)
    if new != old:
        yield page, old, new


def notebook_changes(file: Path) -> Iterator[tuple[Path, str, str]]:
    """Yield (file, old text, new text) if a notebook shows anything else than is kept in it, seconds and pixels apart."""
    with tempfile.TemporaryDirectory() as directory:
        new = run_notebook(file, Path(directory))
    old = file.read_text(encoding="utf-8")
    if new != old:
        yield file, old, new


def draw(wanted: Collection[Made]) -> None:
    """Draw pictures again, by the blocks of their page that say the command, or beside the models, or after all blocks.

    Raises:
        SnippetError: a command fails all the same.
    """
    for page, command in dict.fromkeys((made.page, made.command) for made in wanted):
        of_command = [made for made in wanted if (made.page, made.command) == (page, command)]
        block = Block(DOCS / f"{page}.md", 0, "console", "run", command, 0, True, "")
        runs = [one for one in marked_blocks(block.page) if command in " ".join([one.argument, *one.text.split()])]
        with tempfile.TemporaryDirectory() as directory:
            place = Path(directory)
            for folder in FOLDERS:
                shutil.copytree(ROOT / folder, place / folder)
            if runs:  # a later block may change the files that it reads
                list(run_page(block.page, place, long=runs[0].long))
            for blocks in () if runs else ("none", "quick", "all"):
                if blocks != "none":
                    list(run_page(block.page, place, long=blocks == "all"))
                try:
                    run_command(block, _with_paths(command, place), place)
                    break
                except SnippetError:
                    if blocks == "all":
                        raise
            for made in of_command:
                if made.left:
                    shutil.copyfile(place / made.left, DOCS / "pictures" / made.name)
                print(f"docs/pictures/{made.name}: drawn")
        record([made.name for made in of_command])


def _with_paths(command: str, directory: Path) -> str:
    """A command with the whole paths of the files of the repository that are not in a directory."""
    words = shlex.split(command)
    return shlex.join(
        str(ROOT / word) if (ROOT / word).is_file() and not (directory / word).exists() else word for word in words
    )


def write(page: Path, text: str) -> None:
    """Write a page beside its place and move it there."""
    page.parent.mkdir(parents=True, exist_ok=True)
    unfinished = page.with_suffix(".new")
    unfinished.write_text(text, encoding="utf-8", newline="\n")
    os.replace(unfinished, page)


def update(check: bool, long: bool, names: Collection[str] = ()) -> tuple[int, int]:
    """Update, or check, all pages or those of some names; return how many changed (or would), and how many could not be done."""
    changed = failed = 0
    jobs: list[tuple[Callable[[Path], Iterator[tuple[Path, str, str]]], Path]]
    jobs = [(generated_changes, file) for file in generators() if long or not is_long(file)]
    jobs += [(partial(snippet_changes, long=long or bool(names)), page) for page in pages()]
    jobs += [(notebook_changes, file) for file in notebooks() if long or file.stem in names]
    for changes, source in jobs:
        if names and source.stem.removeprefix("generate_") not in names:
            continue
        try:
            for page, old, new in changes(source):
                changed += 1
                print(f"{page.relative_to(ROOT)}: {'out of date' if check else 'updated'}")
                if check:
                    print(difference(old, new))
                else:
                    write(page, new)
            if source.suffix == ".md" and not check and (long or names):
                record([made.name for made in tables() if made.page == source.stem and not made.by_hand])
        except SnippetError as error:
            failed += 1
            print(error, file=sys.stderr)
    return changed, failed


def main() -> int:
    """Read the command line and update."""
    parser = argparse.ArgumentParser(
        description="Run the blocks of the docs, put in what they print, write the generated pages."
    )
    parser.add_argument(
        "--check", action="store_true", help="change nothing; fail where something but seconds would change"
    )
    parser.add_argument("--long", action="store_true", help="run the generators and blocks that take long, too")
    parser.add_argument("names", nargs="*", help="pages, generators or pictures, such as mesh, commands or bearing.png")
    parser.add_argument(
        "--same", action="store_true", help="note that the named pictures and tables still show what is right"
    )
    options = parser.parse_args()
    if options.same:
        unknown = set(options.names) - {made.name for made in (*pictures(), *tables())}
        if unknown:
            parser.error(f"no picture or long table of these names: {', '.join(sorted(unknown))}")
        record(options.names)
        return 0
    of_pictures = {made.name: made for made in pictures() if made.is_picture}
    names = [name for name in options.names if name not in of_pictures]
    changed = failed = 0
    if names or not options.names:
        changed, failed = update(options.check, options.long, names)
    old = [sentence.split()[0] for sentence in stale()]
    wanted = options.names or (old if options.long else [])
    try:
        draw([made for name, made in of_pictures.items() if name in wanted and not options.check])
    except SnippetError as error:
        failed += 1
        print(error, file=sys.stderr)
    for sentence in stale():
        print(sentence)
    return 1 if failed or (changed and options.check) else 0


if __name__ == "__main__":
    sys.exit(main())
