#!/usr/bin/python3
"""The figures of README.md and of the pages are those of docs/figures.json, which bench/figures.py writes, and what scripts
write into pages is what docs/blocks.json records (bench/tools/report_section.py).

Usage: figures.py SOURCE_FOLDER

- A comment <!-- figure: NAME --> stands behind the numbers of that figure: each is its value, to the digits given.
- In the sections of README.md that tell what is fast, accurate or not, every number has one.
- A table of which more than half is numbers stands in such a block, or has a comment <!-- not measured --> before it.
- Between <!-- begin: bench/SCRIPT --> and <!-- end --> is the text that was recorded; each such block has a record, and
  each record a block. In docs/measured the line below the block states the record.
- No figure or block is older than what it measures by more than 200 commits. A commit that the history does not
  have is looked for by its date. Where that is not there either, in an archive or a shallow clone, ages are not checked.
  What was measured on a card that not every machine has may be older: whoever cites it says the date beside it, and so
  does each row of a block.
"""

import hashlib
import json
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
from tools.report_section import record_line  # noqa: E402

OLDEST = 200  # commits
# Their tables are compared with what the command prints by tests/command.
LEFT_OUT = ("options.md", "settings.md")
SECTIONS = ("Three figures", "When not to use it")
DATE = re.compile(r"\b\d{4}-\d\d-\d\d\b")
MARKER = re.compile(r"<!-- figure: ([\w.]+) -->")
NUMBER = re.compile(r"(?<![\w.,])(\d[\d,]*(?:\.\d+)?)(?![\w]|[.,]\d)")
BLOCK = re.compile(r"^<!-- begin: bench/(\S+) -->\n(.*?)^<!-- end -->$", re.MULTILINE | re.DOTALL)
TABLE = re.compile(r"(?:^\|.*\n)+", re.MULTILINE)
MEASURED_CELL = re.compile(r"\W*\d[\d,.]*\W*(?:s|ms|ns|[kMG]B|[kM]|x|times)?(?: \(.*\))?")
# Numbers that say what was measured, or name something.
PLAIN = re.compile(r"k = \d+(?: and \d+)?|\d+x\d+|[HR]\d00|\d[\d,]* (?:photons|triangles|paths|seeds)|within \d+%"
                   r"|\d{4}-\d\d-\d\d|`[^`]*`|\]\([^)]*\)")


def sections(text):
    """Each paragraph or item of the sections above, without line breaks."""
    for part in re.split(r"^## ", text, flags=re.MULTILINE):
        title, _, body = part.partition("\n")
        if title.strip() in SECTIONS:
            for paragraph in re.split(r"\n\s*\n|\n(?=- )", body):
                yield title.strip(), " ".join(paragraph.split())


def numbers(text):
    """(end, text) of those that are not plain."""
    blanked = PLAIN.sub(lambda match: " " * len(match[0]), text)
    return [(match.end(), match[1]) for match in NUMBER.finditer(blanked)]


def agrees(text, value):
    """Whether the value, rounded to the digits of the text, is the text."""
    decimals = len(text.partition(".")[2])
    return abs(float(text.replace(",", "")) - value) <= 0.5000001 * 10.0**-decimals


def check_text(where, text, figures, wrong):
    """The markers of a paragraph; returns the ends of the numbers that they stand behind."""
    told = set()
    begin = 0
    text = re.sub(r"`[^`]*`", lambda span: " " * len(span[0]), text)
    for marker in MARKER.finditer(text):
        before = [number for number in numbers(text[:marker.start()]) if number[0] > begin]
        begin = marker.end()
        figure = figures.get(marker[1])
        if figure is None:
            wrong.append(f"{where}: there is no figure {marker[1]}")
            continue
        values = figure["values"]
        if "card" in figure and figure["date"] not in text:
            wrong.append(f"{where}: {marker[1]} was measured on {figure['date']}; say so beside it")
        of_marker = before[-len(values):]
        told |= {end for end, _ in of_marker}
        if len(of_marker) < len(values) or not all(
                agrees(number, value) for (_, number), value in zip(of_marker, values)):
            wrong.append(f"{where}: {' and '.join(number for _, number in of_marker)} for {marker[1]}, which is "
                         f"{' and '.join(f'{value:g}' for value in values)}")
    return told


def git(source, *arguments):
    done = subprocess.run(["git", "-C", source, *arguments], capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else ""


def commits_behind(source, figure):
    """How many commits lie between a figure and the last change of what it measures; 0 where nobody knows."""
    last = git(source, "log", "-1", "--format=%H", "--", *figure["measures"]) if figure["measures"] else ""
    commit = (git(source, "rev-parse", "--verify", "--quiet", f"{figure['commit']}^{{commit}}")
              or git(source, "rev-list", "-1", f"--before={figure['date']} 23:59:59 +0000", "HEAD"))
    count = git(source, "rev-list", "--count", f"{commit}..{last}") if last and commit else ""
    return int(count or 0)


def check_age(source, what, figure, remedy, wrong):
    behind = commits_behind(source, figure)
    if behind > OLDEST:
        wrong.append(f"{what} is {behind} commits older than what it measures; {remedy} measures it anew")


def pages(source):
    return sorted((source / "docs").rglob("*.md"))


def check_blocks(source, wrong):
    """What scripts have written into the pages is what they recorded, and none of it is old."""
    file = source / "docs/blocks.json"
    records = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
    blocks, stated = {}, {}
    for page in pages(source):
        text = page.read_text(encoding="utf-8")
        for block in BLOCK.finditer(text):
            name = f"{page.relative_to(source / 'docs')}: {block[1]}"
            blocks[name] = block[2].strip("\n")
            stated[name] = text[block.end() + 1:]
    for name in sorted(blocks.keys() | records.keys()):
        if name not in records:
            wrong.append(f"docs/{name} has written a block that docs/blocks.json does not record")
        elif name not in blocks:
            wrong.append(f"docs/blocks.json: {name} is recorded, but the page has no such block")
        else:
            if hashlib.sha256(blocks[name].encode()).hexdigest() != records[name]["sha256"]:
                wrong.append(f"docs/{name} has written another block than the one that is there; change the script, "
                             "not the block")
            line = record_line(name.split()[1], records[name])
            if name.startswith("measured/") and not stated[name].startswith(line):
                wrong.append(f"docs/{name}: the line below the block is not that of its record:{line}")
            if "card" in records[name]:
                undated = [row for row in blocks[name].splitlines()[2:] if not DATE.search(row)]
                wrong += [f"docs/{name}: measured on {records[name]['card']}, and no date in {row[:60]}" for row in undated]
                continue
            check_age(source, f"docs/{name}", records[name], f"bench/{name.split()[1]}", wrong)


def check_tables(page, text, wrong):
    """No table of measured numbers is written by hand."""
    by_hand = BLOCK.sub("", text)
    for table in TABLE.finditer(by_hand):
        cells = [cell.strip() for row in table[0].splitlines()[2:] for cell in row.split("|")[1:-1]]
        numbers_in = sum(MEASURED_CELL.fullmatch(cell) is not None for cell in cells)
        if 2 * numbers_in > len(cells) and not by_hand[:table.start()].endswith("<!-- not measured -->\n\n"):
            wrong.append(f"{page}: the table {table[0].splitlines()[0]} is of numbers, and no script wrote it")


def check(source):
    """What is wrong, in a line each."""
    figures = json.loads((source / "docs/figures.json").read_text(encoding="utf-8"))
    wrong = []
    for page in [source / "README.md", *pages(source)]:
        text = page.read_text(encoding="utf-8")
        name = str(page.relative_to(source))
        for paragraph in re.split(r"\n\s*\n|\n(?=- )", text):
            check_text(name, " ".join(paragraph.split()), figures, wrong)
        if page.name not in LEFT_OUT:
            check_tables(name, text, wrong)
    for title, paragraph in sections((source / "README.md").read_text(encoding="utf-8")):
        told = check_text("README.md", paragraph, figures, [])
        for end, number in numbers(MARKER.sub(lambda match: " " * len(match[0]), paragraph)):
            if end not in told:
                wrong.append(f"README.md, {title}: {number} is no figure of docs/figures.json: "
                             f"...{paragraph[max(0, end - 40):end + 20]}...")
    for name, figure in figures.items():
        if "card" not in figure:
            check_age(source, f"docs/figures.json: {name}", figure, figure["command"], wrong)
    check_blocks(source, wrong)
    return wrong


def main():
    source = pathlib.Path(sys.argv[1])
    wrong = check(source)
    if git(source, "rev-parse", "--is-shallow-repository") != "false":
        print("The history is shallow or missing: figures older than it are not looked for.")
    print("\n".join(wrong))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
