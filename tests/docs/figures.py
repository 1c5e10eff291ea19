#!/usr/bin/python3
"""The figures of README.md and of the pages are those of docs/figures.json, which bench/figures.py writes.

Usage: figures.py SOURCE_FOLDER

- A comment <!-- figure: NAME --> stands behind the numbers of that figure: each is its value, to the digits given.
- In the sections of README.md that tell what is fast, accurate or not, every number has one.
- No figure is older than what it measures by more than 200 commits. A commit that the history does not have is
  looked for by its date; without a history (an archive) this is not checked.
"""

import json
import pathlib
import re
import subprocess
import sys

OLDEST = 200  # commits
SECTIONS = ("Three figures", "When not to use it")
MARKER = re.compile(r"<!-- figure: ([\w.]+) -->")
NUMBER = re.compile(r"(?<![\w.,])(\d[\d,]*(?:\.\d+)?)(?![\w]|[.,]\d)")
# Numbers that say what was measured, or name something.
PLAIN = re.compile(r"k = \d+(?: and \d+)?|\d+x\d+|[HR]\d00|\d[\d,]* (?:photons|triangles|paths|seeds)|within \d+%"
                   r"|`[^`]*`|\]\([^)]*\)")


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


def check(source):
    """What is wrong, in a line each."""
    figures = json.loads((source / "docs/figures.json").read_text(encoding="utf-8"))
    wrong = []
    for page in [source / "README.md", *sorted((source / "docs").glob("*.md"))]:
        text = page.read_text(encoding="utf-8")
        for paragraph in re.split(r"\n\s*\n|\n(?=- )", text):
            check_text(page.name, " ".join(paragraph.split()), figures, wrong)
    for title, paragraph in sections((source / "README.md").read_text(encoding="utf-8")):
        told = check_text("README.md", paragraph, figures, [])
        for end, number in numbers(MARKER.sub(lambda match: " " * len(match[0]), paragraph)):
            if end not in told:
                wrong.append(f"README.md, {title}: {number} is no figure of docs/figures.json: "
                             f"...{paragraph[max(0, end - 40):end + 20]}...")
    for name, figure in figures.items():
        behind = commits_behind(source, figure)
        if behind > OLDEST:
            wrong.append(f"docs/figures.json: {name} is {behind} commits older than what it measures; "
                         f"{figure['command']} measures it anew")
    return wrong


def main():
    wrong = check(pathlib.Path(sys.argv[1]))
    print("\n".join(wrong))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
