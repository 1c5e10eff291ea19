"""lengths.py SOURCE-FOLDER: how long pages are, without what scripts and the program write, is bounded."""

import pathlib
import re
import sys

SHELVES = ("guide", "kernels", "method", "reference")
PAGE, ALL, DECISION = 1500, 35_000, 300  # words at most
WRITTEN = re.compile(r"^<!-- begin: .*? -->\n.*?^<!-- end -->$", re.MULTILINE | re.DOTALL)


def words(page):
    return len(WRITTEN.sub("", page.read_text(encoding="utf-8")).split())


def faults(docs):
    pages = {page: words(page) for shelf in SHELVES for page in sorted((docs / shelf).rglob("*.md"))}
    most = dict.fromkeys(pages, PAGE) | dict.fromkeys(sorted((docs / "decisions").glob("[0-9]*.md")), DECISION)
    for page, bound in most.items():
        if words(page) > bound:
            yield f"{page.relative_to(docs.parent)}: {words(page)} words, of {bound} at most"
    if sum(pages.values()) > ALL:
        shelves = ", ".join(f"{shelf} {sum(pages[page] for page in pages if docs / shelf in page.parents):,}"
                            for shelf in SHELVES)
        yield f"the four shelves have {sum(pages.values()):,} words, of {ALL:,} at most: {shelves}"
    yield from (f"docs/{page.name}: pages stand on a shelf" for page in sorted(docs.glob("*.md"))
                if page.name != "README.md")


found = list(faults(pathlib.Path(sys.argv[1]).resolve() / "docs"))
print("\n".join(found) or "no page is too long")
sys.exit(bool(found))
