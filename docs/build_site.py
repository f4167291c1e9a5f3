"""Build the site from these pages:  python docs/build_site.py [FOLDER] [--long]

Where a generator (docs/generate_*.py) has a function `site_pages`, the repository keeps the summary that its `pages` makes, and
the site shows the whole page, made anew; one that takes minutes (`LONG = True`) only with --long.
mkdocs-material (extra `site`) makes it; formulas become MathML, which browsers show by themselves. The site needs no network and
no server: its search works where index.html is opened from a disk, too. Links to files of the repository outside of docs/ lead to
copies of them as texts, those to folders to lists of their files. Every warning is an error.
"""

from __future__ import annotations

import argparse
import html
import logging
import re
import shutil
import sys
import tempfile
from pathlib import Path

from machinery.notebooks import notebooks, write_page
from update import generators, load_generator

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
# The pages by what a reader wants; a page that is not listed here is a mistake, which the test of the site finds.
NAVIGATION: dict[str, tuple[str, ...]] = {
    "Start": ("index", "first_gearbox", "gallery", "errors", "rotordynamicist", "gear_engineer"),
    "Analyses": ("static", "modal", "response", "transient", "sweep"),
    "Parts": ("mesh", "bevel", "planetary", "bearings", "casings", "model_file"),
    "Design": ("app", "report", "rig"),
    "Files and Python": ("commands", "python", "api", "rexs", "coming_from"),
    "Trust": ("accuracy", "validation", "measured"),
    "Theory": ("theory_structure", "theory_parts", "theory_motions", "conventions"),
    "Development": ("CONTRIBUTING",),
}
# The page that stands beside docs/; other files there are shown as texts.
_BESIDE = "CONTRIBUTING.md"
# What lets a page that is opened from a disk search; the plugin would fetch it from elsewhere.
_SHIM = "iframe-worker.js"
# A wider page, and tables with narrow cells: what they hold is short.
_STYLE = """
.md-grid { max-width: 72rem; }
.md-typeset table:not([class]) th, .md-typeset table:not([class]) td { min-width: 0; padding: 0.4em 0.7em; }
.md-typeset table:not([class]) td:last-child { min-width: 10rem; }
.md-typeset td code { word-break: normal; }
.md-typeset td:first-child code { white-space: nowrap; }
.md-typeset math[display="block"] { overflow-x: auto; padding: 0.4em 0; }
"""
_BLOCK = re.compile(r"^\$\$(.+?)\$\$", re.MULTILINE | re.DOTALL)
_INLINE = re.compile(r"(?<![\w$\\])\$(?![\s\d$(])([^$\n]+?)(?<!\s)\$(?![\w$])")
_CODE = re.compile(r"^ *(`{3,}).*?^ *\1[^\n]*$|`[^`\n]+`", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\]\((?P<target>\.\./[^)#\s]+)(?P<anchor>#[^)\s]*)?\)")
_FILE_BLOCK = re.compile(r"^( *)<!-- file: (\S+) -->\n( *`{3,}\w*)$", re.MULTILINE)
_NOTEBOOK = re.compile(r"\]\(notebooks/(\w+)\.ipynb\)")


def staged(text: str) -> str:
    """A page as the site takes it: formulas as MathML, files with their names, links to pages of notebooks and to copies."""

    def outside(link: re.Match[str]) -> str:
        target = link["target"].removeprefix("../").rstrip("/")
        return f"]({target}{link['anchor'] or ''})" if target == _BESIDE else f"]({_copy(target)})"

    text = _FILE_BLOCK.sub(r'\3 title="\2"', text)
    return _LINK.sub(outside, with_formulas(_NOTEBOOK.sub(r"](\1.md)", text)))


def with_formulas(text: str) -> str:
    """Formulas between dollars as MathML; code stays as it is."""
    from latex2mathml.converter import convert

    kept: list[str] = []

    def keep(code: re.Match[str]) -> str:
        kept.append(code[0])
        return f"\0{len(kept) - 1}\0"

    text = _CODE.sub(keep, text)
    text = _BLOCK.sub(lambda found: "\n" + convert(" ".join(found[1].split()), display="block") + "\n", text)
    # In a span: at the begin of a line Markdown takes <math> for a block of its own.
    text = _INLINE.sub(lambda found: f"<span>{convert(found[1])}</span>", text)
    return re.sub(r"\0(\d+)\0", lambda number: kept[int(number[1])], text)


def whole_pages(*, long: bool = False) -> dict[str, str]:
    """The pages of which the repository keeps a summary, by their file's name."""
    found: dict[str, str] = {}
    for file in generators():
        generator = load_generator(file)
        if hasattr(generator, "site_pages") and (long or not getattr(generator, "LONG", False)):
            found |= {Path(name).name: text for name, text in generator.site_pages().items()}
    return found


def stage(folder: Path, *, long: bool = False) -> None:
    """Put the pages and what they link to into a folder."""
    shutil.copytree(DOCS / "pictures", folder / "pictures")
    pages = {page.name: page.read_text(encoding="utf-8") for page in DOCS.glob("*.md")} | whole_pages(long=long)
    pages |= {f"{file.stem}.md": write_page(file, folder) for file in notebooks()}
    beside = re.sub(r"\]\((?!https?:|#|docs/)([^)\s]+)\)", r"](../\1)", (ROOT / _BESIDE).read_text(encoding="utf-8"))
    pages[_BESIDE] = beside.replace("](docs/", "](").replace("](../../", "](../")
    linked = {
        link["target"].removeprefix("../").rstrip("/") for text in pages.values() for link in _LINK.finditer(text)
    }
    for target in sorted(linked - {_BESIDE}):
        path = ROOT / target
        if path.is_dir():
            listed = "\n".join(str(file.relative_to(ROOT)) for file in sorted(path.rglob("*")) if _shown(file))
            _write(folder / _copy(target), f"{target}, in the repository:\n\n{listed}\n")
        elif path.exists():
            place = folder / _copy(target)
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, place)
    for name, text in pages.items():
        _write(folder / name, staged(text))
    shutil.copy(DOCS / "machinery" / "iframe-worker.js", folder / _SHIM)
    _write(folder / "style.css", _STYLE)


def _copy(target: str) -> str:
    """Where the copy of a file, or the list of a folder, stands in the site."""
    return f"files/{target.replace('/', '_') if (ROOT / target).is_dir() else target}.txt"


def _shown(file: Path) -> bool:
    return file.is_file() and not any(part.startswith((".", "__pycache__")) for part in file.parts)


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _python() -> dict[str, object]:
    """How the page of public names shows Python."""
    return {
        "paths": [str(ROOT)],
        "inventories": [],
        "options": {
            "extensions": ["machinery.declared_fields"],
            "docstring_section_style": "table",
            "heading_level": 3,
            "line_length": 90,
            "members_order": "source",
            "separate_signature": True,
            "show_root_heading": True,
            "show_signature_annotations": True,
            "show_source": False,
            "signature_crossrefs": True,
        },
    }


def settings(source: Path, target: Path) -> dict[str, object]:
    """What mkdocs is told."""
    from pymdownx.slugs import slugify

    nav = [
        {title: [f"{page}.md" for page in names if (source / f"{page}.md").exists()]}
        for title, names in NAVIGATION.items()
    ]
    return {
        "site_name": "rotorgear",
        "site_description": "Finite-element rotor-gear analysis",
        "docs_dir": str(source),
        "site_dir": str(target),
        "use_directory_urls": False,  # pages open from a disk, too
        # No fonts from elsewhere: the site works without a network.
        "theme": {
            "name": "material",
            "font": False,
            "features": ["navigation.tabs", "navigation.top", "content.code.copy"],
        },
        "extra": {"polyfills": [_SHIM], "generator": False},
        "extra_css": ["style.css"],
        # `offline` writes the index of the search as a script.
        "plugins": [
            "search",
            "offline",
            {"mkdocstrings": {"enable_inventory": False, "handlers": {"python": _python()}}},
        ],
        # Anchors as the forge makes them, which the links of the pages are written for.
        "markdown_extensions": [
            {"toc": {"slugify": slugify(case="lower"), "permalink": True, "toc_depth": 3}},
            "tables",
            "admonition",
            "pymdownx.superfences",
            "pymdownx.highlight",
        ],
        "nav": nav,
        "strict": True,
        "validation": {"nav": {"omitted_files": "ignore"}, "links": {"anchors": "warn", "not_found": "warn"}},
    }


def unlisted() -> list[str]:
    """Pages that the navigation does not lead to."""
    listed = {page for names in NAVIGATION.values() for page in names}
    return sorted(page.stem for page in [*DOCS.glob("*.md"), *notebooks()] if page.stem not in listed)


def build(target: Path, *, long: bool = False) -> None:
    """Build the site in a folder.

    Raises:
        RuntimeError: a page that no menu leads to. mkdocs.exceptions.Abort: a warning.
    """
    from mkdocs.commands.build import build as make
    from mkdocs.config import load_config

    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")

    if unlisted():
        raise RuntimeError(f"pages without a place in NAVIGATION of docs/build_site.py: {', '.join(unlisted())}")
    with tempfile.TemporaryDirectory() as scratch:
        source = Path(scratch) / "docs"
        source.mkdir()
        stage(source, long=long)
        config = Path(scratch) / "mkdocs.yml"
        config.write_text("site_name: rotorgear\n", encoding="utf-8")
        made = load_config(str(config), **settings(source, target))
        make(made)


def main() -> int:
    """Read the command line and build."""
    parser = argparse.ArgumentParser(description="Build the site from the pages of docs/.")
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "site", help="where to (default: site)")
    parser.add_argument("--long", action="store_true", help="make the whole pages that take minutes, too")
    options = parser.parse_args()
    folder = options.folder.resolve()
    try:
        import latex2mathml  # noqa: F401
        import mkdocs  # noqa: F401
        import mkdocstrings  # noqa: F401
    except ImportError as missing:
        print(f"docs/build_site.py needs {missing.name}: pip install -e '.[site]'", file=sys.stderr)
        return 2
    build(folder, long=options.long)
    print(f"wrote {html.escape(str(folder / 'index.html'))}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
