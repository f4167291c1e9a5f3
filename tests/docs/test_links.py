"""Every relative link and picture of the docs leads to a file here and, after a #, to one of its headings."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path
from urllib.parse import unquote

import pytest
from machinery.snippets import ROOT, pages

_TARGETS = (
    re.compile(
        r"\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+[\"'][^)]*)?\)"
    ),  # [text](target "title"), also ![...]
    re.compile(r"!\[[^\]]*\]\(\s*<?([^)\s>]+)>?(?:\s+[\"'][^)]*)?\)"),  # a picture inside the text of a link
    re.compile(r"^ {0,3}\[[^\]]+\]:\s*<?([^\s>]+)>?", re.MULTILINE),  # [name]: target
    re.compile(r"<(?:img|a|source)\b[^>]*?\b(?:src|href|srcset)\s*=\s*[\"']([^\"']+)[\"']", re.IGNORECASE),
)
_HEADING = re.compile(r"^ {0,3}#{1,6}\s+(.*?)\s*#*\s*$", re.MULTILINE)
_ANCHOR = re.compile(r"<[a-z]+\b[^>]*?\b(?:id|name)\s*=\s*[\"']([^\"']+)[\"']", re.IGNORECASE)
_OUTSIDE = re.compile(r"[a-z][a-z0-9+.-]*:|//", re.IGNORECASE)


def prose(text: str) -> str:
    """Return a page without its code blocks, inline code and comments."""
    text = re.sub(r"^ *(`{3,}|~{3,}).*?(?:^ *\1[`~]*\s*$|\Z)", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    return re.sub(r"(`+)(?!`)(?:.*?[^`])\1(?!`)", "", text)


def slug(heading: str) -> str:
    """Return the anchor that the forge makes of a heading: lower case, no punctuation, a hyphen for each blank."""
    shown = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").replace("*", "")
    return re.sub(r"[^\w\- ]", "", shown.lower()).strip().replace(" ", "-")


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page; the second of two equal headings gets -1."""
    text = page.read_text(encoding="utf-8")
    without_code = re.sub(r"^ *(`{3,}|~{3,}).*?(?:^ *\1[`~]*\s*$|\Z)", "", text, flags=re.MULTILINE | re.DOTALL)
    found: set[str] = set(_ANCHOR.findall(without_code))
    seen: Counter[str] = Counter()
    for heading in _HEADING.findall(without_code):
        name = slug(heading)
        found.add(f"{name}-{seen[name]}" if seen[name] else name)
        seen[name] += 1
    return found


def links(page: Path) -> list[str]:
    """Return the targets of a page that lie in this repository."""
    text = prose(page.read_text(encoding="utf-8"))
    found = dict.fromkeys(target for pattern in _TARGETS for target in pattern.findall(text))
    return [target for target in found if not _OUTSIDE.match(target)]


def exists(path: Path, root: Path) -> bool:
    """Whether a file stands below `root` in exactly this spelling, also on a disk that ignores upper and lower case."""
    try:
        parts = path.relative_to(root).parts
    except ValueError:
        return False
    here = root
    for part in parts:
        if not here.is_dir() or part not in {entry.name for entry in here.iterdir()}:
            return False
        here /= part
    return True


def broken_links(page: Path, root: Path = ROOT) -> list[str]:
    """List the links of a page that lead nowhere, each with the reason."""
    broken = []
    for target in links(page):
        name, _, anchor = unquote(target).partition("#")
        name = name.partition("?")[0]
        start = root if name.startswith("/") else page.parent
        goal = Path(start / name.lstrip("/")).resolve() if name else page.resolve()
        if not exists(goal, root.resolve()):
            broken.append(f"{target}: there is no such file")
        elif anchor and goal.suffix == ".md" and anchor not in anchors(goal):
            broken.append(f"{target}: there is no such heading")
    return broken


@pytest.mark.parametrize("page", pages(), ids=lambda page: str(page.relative_to(ROOT)))
def test_the_links_of_a_page_lead_somewhere(page: Path) -> None:
    assert broken_links(page) == []


def test_the_pages_that_every_reader_looks_for_are_there() -> None:
    there = {str(page.relative_to(ROOT).as_posix()) for page in pages()}
    assert {"README.md", "CHANGELOG.md", "CONTRIBUTING.md", "docs/conventions.md"} <= there


def test_a_link_that_leads_nowhere_is_found(tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "picture.png").touch()
    (tmp_path / "docs" / "other.md").write_text(
        "# The `axes` & signs\n## Twice\n## Twice\n```\n# no heading\n```\n", encoding="utf-8"
    )
    page = tmp_path / "README.md"
    page.write_text(
        "# Top\n[a](docs/other.md) [b](docs/other.md#the-axes--signs 'title') [c](docs/other.md#twice-1) [d](#top)\n"
        "[![f](docs/picture.png)](https://example.org/nowhere) <img width=3 src='docs/picture.png'>\n"
        "[e](docs/) [g][h] `[code](gone.md)`\n"
        "```\n[code](gone.md)\n```\n<!-- [comment](gone.md) -->\n[h]: docs/other.md\n",
        encoding="utf-8",
    )
    assert broken_links(page, tmp_path) == []
    wrong = [
        "docs/gone.md",
        "docs/Other.md",
        "docs/other.md#twice-2",
        "docs/other.md#no-heading",
        "#bottom",
        "../outside.md",
    ]
    page.write_text(
        "# Top\n" + "\n".join(f"[x]({target})" for target in wrong) + "\n![y](no.png)\n[z]: no.md\n<img src='no.svg'>",
        encoding="utf-8",
    )
    assert [line.split(": ")[0] for line in broken_links(page, tmp_path)] == [*wrong, "no.png", "no.md", "no.svg"]
