"""Metadata of the package that are made when it is built: its page, with links that work there, and its addresses."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

ROOT = Path(__file__).resolve().parents[2]
# A link or picture of Markdown to a file of the repository; the first group is "!" of a picture.
_RELATIVE = re.compile(r"(?P<picture>!?)\[(?P<text>[^\]]*)\]\((?!https?://|#|mailto:)(?P<target>[^)\s]+)\)")
# Marks of the docs tests, which say nothing to a reader.
_MARKS = re.compile(r"<!--.*?-->\n?", re.DOTALL)


def page(readme: str, repository: str) -> str:
    """The README for the page of the package: links to files of the repository are absolute.

    Args:
        readme: text of README.md.
        repository: its address; "": links become their words, and pictures go, since they would lead nowhere.
    """

    def absolute(link: re.Match[str]) -> str:
        if not repository:
            return "" if link["picture"] else link["text"]
        view = "raw" if link["picture"] else "blob"
        return f"{link['picture']}[{link['text']}]({repository.rstrip('/')}/{view}/main/{link['target']})"

    return re.sub(r"\n{3,}", "\n\n", _RELATIVE.sub(absolute, _MARKS.sub("", readme)))


def addresses(repository: str) -> dict[str, str]:
    """Addresses of the project below that of its repository; none without one."""
    if not repository:
        return {}
    base = repository.rstrip("/")
    return {
        "Homepage": base,
        "Documentation": f"{base}/blob/main/docs/index.md",
        "Changelog": f"{base}/blob/main/CHANGELOG.md",
        "Issues": f"{base}/issues",
        "Source": base,
    }


class CustomMetadataHook(MetadataHookInterface):
    """Puts them into the metadata."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Add the page and the addresses."""
        repository = str(self.config.get("repository", ""))
        readme = (ROOT / "README.md").read_text(encoding="utf-8")
        metadata["readme"] = {"content-type": "text/markdown", "text": page(readme, repository)}
        metadata["urls"] = addresses(repository)
