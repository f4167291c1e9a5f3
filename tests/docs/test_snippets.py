"""The docs say what the program prints: every marked block is run, and every generated page is made again."""

from __future__ import annotations

from pathlib import Path

import pytest
import update
from machinery.comparison import difference, lines_agree, merged, numbers_agree, texts_agree
from machinery.snippets import ROOT, SnippetError, marked_blocks, pages, rewritten, run_page
from update import generated_changes, generators, is_long

GENERATORS = [
    pytest.param(file, id=file.stem, marks=[pytest.mark.long] if is_long(file) else []) for file in generators()
]
WITH_BLOCKS = [page for page in pages() if marked_blocks(page)]
HINT = "run  python docs/update.py  and read the change"


@pytest.mark.parametrize("page", WITH_BLOCKS, ids=lambda page: str(page.relative_to(ROOT)))
def test_the_blocks_of_a_page_print_what_it_shows(page: Path, tmp_path: Path) -> None:
    for outcome in run_page(page, tmp_path, long=False):
        assert outcome.agrees, f"{outcome.block.place}: {HINT}\n{difference(outcome.block.text, outcome.printed)}"


@pytest.mark.long
@pytest.mark.parametrize(
    "page",
    [page for page in WITH_BLOCKS if any(block.long for block in marked_blocks(page))],
    ids=lambda page: str(page.relative_to(ROOT)),
)
def test_the_long_blocks_of_a_page_print_what_it_shows(page: Path, tmp_path: Path) -> None:
    for outcome in run_page(page, tmp_path):
        assert outcome.agrees, f"{outcome.block.place}: {HINT}\n{difference(outcome.block.text, outcome.printed)}"


@pytest.mark.parametrize("generator", GENERATORS)
def test_a_generated_page_is_up_to_date(generator: Path) -> None:
    for page, old, new in generated_changes(generator):
        pytest.fail(f"{page.relative_to(ROOT)}: {HINT}\n{difference(old, new)}")


@pytest.mark.parametrize(
    ("page", "printed"),
    [
        ("mode 7  361.2 Hz", "mode 7      361.2 Hz"),
        ("361.21 Hz", "361.22 Hz"),
        ("2.0000001e8 N/m", "2.0000002e8 N/m"),
        ("63 modes in 0.42 s", "63 modes in 11.3 s"),
        ("1.53 ms of CPU", "6.5 ms of CPU"),
        ('"seconds": 0.42,', '"seconds": 1.7e-3,'),
        ("─────", "────────"),
        ("branch_a ... 71 %", "branch_a torsion, 71 %"),
        ("-0.0 %", "0.0 %"),
    ],
)
def test_lines_that_say_the_same_agree(page: str, printed: str) -> None:
    assert lines_agree(page, printed)


@pytest.mark.parametrize(
    ("page", "printed"),
    [
        ("63 modes in 0.42 s", "64 modes in 0.42 s"),
        ("361.21 Hz", "361.23 Hz"),
        ("0.2 %", "0.3 %"),
        ("361.2 Hz", "361.3 Hz"),
        ("-12.5 %", "12.5 %"),
        ("12.5 rad/s", "12.6 rad/s"),
        ("5.1 s/m", "5.2 s/m"),
        ("11 ms", "12 ms"),
        ("3 shafts", "3 gears"),
        ("wheel_1", "wheel_2"),
        ("4 sections", "5 sections"),
        ("... 71 %", "torsion, 72 %"),
        ("361.2", ""),
    ],
)
def test_lines_that_say_something_else_do_not_agree(page: str, printed: str) -> None:
    assert not lines_agree(page, printed)


def test_numbers_agree_to_a_millionth_or_in_their_digits() -> None:
    assert numbers_agree("1234567.8", "1234568.9")
    assert not numbers_agree("1234567.8", "1234570.9")
    assert not numbers_agree("1234567", "1234568")
    assert numbers_agree("0.012345", "0.012346")
    assert not numbers_agree("0.0012", "0.0013")
    assert numbers_agree("2e8", "2.0e8")


def test_a_line_of_dots_stands_for_any_lines() -> None:
    printed = "head\n1 a\n2 b\n3 c\nfoot"
    assert texts_agree("head\n...\nfoot", printed)
    assert texts_agree("...\n2 b\n...", printed)
    assert texts_agree("head\n1 a\n...\n2 b\n3 c\nfoot", printed)
    assert not texts_agree("head\n...\n2 b\nfoot", printed)
    assert not texts_agree("head\n1 a", printed)
    assert not texts_agree(printed, "head\n...\nfoot")


def test_new_output_keeps_the_gaps_of_the_page() -> None:
    printed = "head\n1 a 5.5\n2 b 6.5\n3 c 7.5\nfoot 9"
    assert merged("old head\n...\nfoot 8", printed) == "head\n...\nfoot 9"
    assert merged("head\n...\n2 b 6.4\n...\nfoot 8", printed) == "head\n...\n2 b 6.5\n...\nfoot 9"
    assert merged("head\n1 a 5.4\n...", printed) == "head\n1 a 5.5\n..."
    assert merged("head\n...\n2 z 6.4\n...\nfoot 8", printed) is None
    assert merged("anything", printed) == printed


PAGE = """# A page

<!-- file: parts/one.txt -->
```toml
teeth = 29
```

```python
raise SystemExit("an unmarked block is not run")
```

<!-- run -->
```python
from pathlib import Path
teeth = int(Path("parts/one.txt").read_text().split("=")[1])
print(teeth)
```

1. In a list:

   <!-- run -->
   ```python
   print(f"{teeth / 7:.4f}\\nand more")
   ```
   <!-- output -->
   ```text
   4.1000
   ...
   ```

<!-- run -->
```console
$ python -c "print(2.5, 'mm')"
2.5 mm
```

<!-- run exit=3 -->
```console
$ python -c "raise SystemExit(3)"

$ python -c "print('gone'); raise SystemExit(3)"
wrong

$ python -c "print('same'); raise SystemExit(3)"
same
```
The end.
"""


@pytest.fixture
def page(tmp_path: Path) -> Path:
    file = tmp_path / "page.md"
    file.write_text(PAGE, encoding="utf-8")
    return file


def test_blocks_run_in_order_in_one_directory_with_shared_variables(page: Path, tmp_path: Path) -> None:
    outcomes = list(run_page(page, tmp_path / "run"))
    assert (tmp_path / "run" / "parts" / "one.txt").read_text(encoding="utf-8") == "teeth = 29\n"
    assert [(outcome.block.line, outcome.agrees) for outcome in outcomes] == [(26, False), (32, True), (38, False)]
    assert outcomes[0].printed == "4.1429\nand more"


def test_long_blocks_and_their_outputs_are_left_to_the_long_tests(page: Path, tmp_path: Path) -> None:
    text = PAGE.replace("   <!-- run -->\n", "   <!-- run long -->\n").replace(
        "<!-- run -->\n```console", "<!-- run long -->\n```console"
    )
    page.write_text(text, encoding="utf-8")
    assert [block.long for block in marked_blocks(page)] == [False, False, True, True, True, False]
    assert [outcome.block.line for outcome in run_page(page, tmp_path / "quick", long=False)] == [38]
    assert [outcome.block.line for outcome in run_page(page, tmp_path / "all")] == [26, 32, 38]


def test_an_update_changes_the_outputs_that_differ_and_nothing_else(page: Path, tmp_path: Path) -> None:
    expected = PAGE.replace("4.1000", "4.1429").replace("wrong", "gone")
    page.write_text(rewritten(page, list(run_page(page, tmp_path / "one"))), encoding="utf-8")
    assert page.read_text(encoding="utf-8") == expected
    assert all(outcome.agrees for outcome in run_page(page, tmp_path / "two"))


def test_outputs_stand_in_their_blocks_where_the_page_was_edited_while_they_ran(page: Path, tmp_path: Path) -> None:
    outcomes = list(run_page(page, tmp_path / "one"))
    page.write_text(
        "# Another head\n\nand a sentence.\n\n" + PAGE.replace("1. In a list", "\n1. In the list"), encoding="utf-8"
    )
    expected = page.read_text(encoding="utf-8").replace("4.1000", "4.1429").replace("wrong", "gone")
    assert rewritten(page, outcomes) == expected


def test_an_output_whose_block_was_edited_while_it_ran_is_refused(page: Path, tmp_path: Path) -> None:
    outcomes = list(run_page(page, tmp_path / "one"))
    page.write_text(PAGE.replace("4.1000", "4.2000"), encoding="utf-8")
    with pytest.raises(SnippetError, match="edited while the page ran"):
        rewritten(page, outcomes)


def test_a_page_whose_code_was_edited_while_it_ran_is_refused(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    code = (
        f"from pathlib import Path\npage = Path({str(page)!r})\npage.write_text(page.read_text().replace('AND', 'OR'))"
    )
    page.write_text(
        f"<!-- run -->\n```python\n{code}\n```\n<!-- file: a.txt -->\n```text\nAND\n```\n", encoding="utf-8"
    )
    with pytest.raises(SnippetError, match="edited while they ran"):
        list(run_page(page, tmp_path / "run"))


def test_blanks_at_the_ends_of_lines_go_and_what_was_made_elsewhere_stays(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    made = "<!-- made -->\n```console\n$ python -m nowhere\n9   \n```\n"
    command = "$ python -c \"print('a  b  ')\""
    page.write_text(f"{made}<!-- run -->\n```console\n{command}\na b   \n```\n", encoding="utf-8")
    outcomes = list(run_page(page, tmp_path / "run"))
    assert [outcome.agrees for outcome in outcomes] == [False]
    assert rewritten(page, outcomes).splitlines() == [
        *made.splitlines(),
        *page.read_text().splitlines()[5:8],
        "a b",
        "```",
    ]


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("<!-- run -->\n\n```python\n```\n", "no fenced block"),
        ("<!-- run -->", "no fenced block"),
        ("<!-- run -->\n```text\n```\n", "python or console"),
        ("<!-- run -->\n```console\nrotorgear\n```\n", "start with"),
        ("<!-- output -->\n```text\n1\n```\n", "python block before"),
        ("<!-- file: ../away.toml -->\n```toml\n```\n", "inside the directory"),
        ("<!-- run exit=1 -->\n```python\n```\n", "commands only"),
        ("<!-- made -->\n```text\n1\n```\n", "needs a console block of one command"),
        ("<!-- run: rotorgear models -->\n```text\n```\n", "where a reader sees it"),
        ("<!-- file long: a.toml -->\n```toml\n```\n", "long is for run"),
        ("<!-- run -->\n```console\n$ rm -r .\n```\n", "rotorgear and python"),
        ("<!-- run -->\n```console\n$ python -c 'raise SystemExit(1)'\n```\n", "ended with code 1, expected 0"),
        ("<!-- run -->\n```python\n1 / 0\n```\n", "ZeroDivisionError"),
    ],
)
def test_a_block_that_can_not_be_what_its_mark_says_is_refused(tmp_path: Path, text: str, complaint: str) -> None:
    page = tmp_path / "page.md"
    page.write_text(text, encoding="utf-8")
    with pytest.raises(SnippetError, match=complaint):
        list(run_page(page, tmp_path))


def test_update_rewrites_what_is_out_of_date_and_then_finds_nothing_more(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    generator = tmp_path / "generate_list.py"
    generator.write_text(
        "def pages():\n    return {'docs/list.md': '# List\\n\\n1.5 made in 3 s\\n'}\n", encoding="utf-8"
    )
    page = tmp_path / "page.md"
    page.write_text('<!-- run -->\n```console\n$ python -c "print(7)"\n6\n```\n', encoding="utf-8")
    monkeypatch.setattr(update, "ROOT", tmp_path)
    monkeypatch.setattr(update, "generators", lambda: generators(tmp_path))
    monkeypatch.setattr(update, "pages", lambda: pages(tmp_path))
    monkeypatch.setattr(update, "notebooks", list)

    assert update.update(check=True, long=False) == (2, 0)
    assert not (tmp_path / "docs" / "list.md").exists()
    assert update.update(check=False, long=False) == (2, 0)
    assert (tmp_path / "docs" / "list.md").read_text(encoding="utf-8") == "# List\n\n1.5 made in 3 s\n"
    assert page.read_text(encoding="utf-8").splitlines()[3] == "7"

    (tmp_path / "docs" / "list.md").write_text("# List\n\n1.5 made in 99 s\n", encoding="utf-8")
    assert update.update(check=True, long=False) == (0, 0)

    generator.write_text(
        "LONG = True\n" + generator.read_text(encoding="utf-8").replace("1.5", "2.5"), encoding="utf-8"
    )
    assert update.update(check=True, long=False) == (0, 0)
    assert update.update(check=True, long=True) == (1, 0)

    page.write_text("<!-- run -->\n```console\n$ gone\n6\n```\n", encoding="utf-8")
    assert update.update(check=True, long=False) == (0, 1)
    assert "can't run 'gone'" in capsys.readouterr().err
