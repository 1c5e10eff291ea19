#!/usr/bin/python3
"""The documentation as a site: mkdocs builds it without a warning, and each link of it leads somewhere.

    site_test.py SOURCE-FOLDER SITE-FOLDER; without mkdocs the test is skipped.
"""

import functools
import html.parser
import pathlib
import shutil
import subprocess
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """Where a page's links lead, and the names that others can link to."""

    def __init__(self, file):
        super().__init__()
        self.links, self.names = [], set()
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.names.add(value)
            if (tag, name) in (("a", "href"), ("img", "src"), ("link", "href"), ("script", "src")) and value:
                self.links.append(value)


@functools.cache
def page(file):
    return Page(file)


def faults(site):
    """Of the pages that mkdocs writes: those of docs/pages are programs of their own."""
    own = site / "pages"
    for file in sorted(file for file in site.rglob("*.html") if own not in file.parents and file.name != "404.html"):
        for link in page(file).links:
            url = urllib.parse.urlsplit(link)
            if url.scheme or url.netloc:
                continue
            target = (file.parent / urllib.parse.unquote(url.path)).resolve() if url.path else file
            if target.is_dir():
                target /= "index.html"
            name = urllib.parse.unquote(url.fragment)
            if not target.is_file():
                yield f"{file.relative_to(site)}: {link}: no such page or picture"
            elif name and target.suffix == ".html" and name not in page(target).names:
                yield f"{file.relative_to(site)}: {link}: no such heading"


def main():
    source, site = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    mkdocs = shutil.which("mkdocs")
    if mkdocs is None:
        print("skipped: there is no mkdocs; apt-get install mkdocs")
        sys.exit(77)
    built = subprocess.run([mkdocs, "build", "--strict", "--quiet", "--clean", "-f", source / "cmake/site/mkdocs.yml",
                            "-d", site], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    found = [built.stdout] if built.returncode else list(faults(site))
    print("\n".join(found) or "all links of the site lead somewhere")
    sys.exit(bool(found))


main()
