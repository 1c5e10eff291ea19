"""Checks the documentation's links: files and headings that it names are there, and the index of its folder names each
page, as that of docs/ names each folder. The pages that sources name are there, too.

    links.py SOURCE-FOLDER
"""

import functools
import pathlib
import re
import sys

LINK = re.compile(r"\]\(\s*([^)\s]+)\s*\)")
MENTION = re.compile(r"\bdocs/[\w/.-]*\.md\b")
SOURCES = ("bench", "cmake", "host", "include", "kernels", "python", "scenes", "tests")
HEADING = re.compile(r"#{1,6} (.*)")


def prose(file):
    """Its lines but those of code between fences."""
    code = False
    for line in file.read_text(encoding="utf-8").splitlines():
        if line.startswith("```"):
            code = not code
        elif not code:
            yield line


@functools.cache
def anchors(file):
    """What GitHub calls the headings."""
    titles = (match[1] for match in map(HEADING.match, prose(file)) if match)
    shown = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title) for title in titles)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in shown}


def index_of(page):
    """The README.md that has to name a page: its folder's, or for that one the folder's above."""
    return (page.parent.parent if page.name == "README.md" else page.parent) / "README.md"


def faults(source):
    pages = sorted((source / "docs").rglob("*.md"))
    linked = {}
    for page in [source / "README.md", source / "CHANGELOG.md", source / "scenes/README.md", *pages]:
        linked[page] = set()
        for target in LINK.findall("\n".join(prose(page))):
            if target.startswith(("http:", "https:")):
                continue
            path, _, anchor = target.partition("#")
            file = (page.parent / path).resolve() if path else page
            linked[page].add(file)
            if not file.exists():
                yield f"{page.relative_to(source)}: {target}: no such file"
            elif anchor and file.suffix == ".md" and anchor not in anchors(file):
                yield f"{page.relative_to(source)}: {target}: no such heading"
    for page in pages:
        if page.resolve() not in linked.get(index_of(page), ()):
            yield f"{index_of(page).relative_to(source)}: names no {page.relative_to(source)}"


def mentions(source):
    """Pages that code names and that are not there: pages of tests/docs, and one that is written on demand, aside."""
    for file in sorted(file for folder in SOURCES for file in (source / folder).rglob("*")
                       if file.is_file() and file.suffix in (".cl", ".clh", ".cmake", ".cpp", ".cu", ".h", ".hpp", ".py",
                                                             ".sh", ".txt", ".yml")):
        if file.parent == source / "tests/docs" or "transcript" in file.parts or file.name == "radiance.py":
            continue
        for page in MENTION.findall(file.read_text(encoding="utf-8", errors="replace")):
            if not (source / page).is_file():
                yield f"{file.relative_to(source)}: {page}: no such page"


folder = pathlib.Path(sys.argv[1]).resolve()
wrong = [*faults(folder), *mentions(folder)]
print("\n".join(wrong) or "all links lead somewhere")
sys.exit(bool(wrong))
