"""Checks that pages, help and messages, and the names in the renderer, the public headers and the kernels, use the
words of the field: a reader of pbrt, Embree or Radiance needs no dictionary for them.

    words.py SOURCE-FOLDER
"""

import pathlib
import re
import sys

# A word that nobody else uses, and what the field says.
WORDS = {
    r"looks? at (?:the |a |near )?(?:lamps?|lights?)": "light sample; shadow ray",
    r"(?:lamp|light) pieces?": "light clusters",
    r"straight from (?:the |a )?(?:lamps?|lights?|luminaires?)": "direct",
    r"dark parts?": "unlit regions",
    r"lone edges?": "boundary edges",
    r"crowding": "density ratio",
    r"likeness(?:es)?": "similarity",
    r"blotch(?:es)?": "low-frequency noise",
    r"parted glass": "path splitting",
    r"octets?": "eight-wide vectors",
    r"sided triangles?": "oriented faces",
    r"dark sides?": "unlit sides",
    r"node sight": "visibility",
}
# Words of which no name in host/renderer, include or kernels is made.
NAMES = {
    "look": "light sample, query",
    "lamp": "light; a product with a photometric file is a luminaire",
    "chance": "selection probability",
    "blend": "bilinear weights",
    "sight": "visibility",
    "lift": "ray offset",
    "clearance": "ray offset, empty radius",
    "lone": "boundary",
    "sheet": "smooth component",
    "facet": "coplanar region",
    "sided": "oriented face",
    "crowding": "density ratio",
    "straight": "direct, unscattered",
    "parted": "split",
    "hole": "cutout",
    "pooling": "mixdown",
    "octet": "eight-wide vector",
    "spent": "consumed",
    "likeness": "similarity",
    "blotches": "low-frequency noise",
    "receiver": "shading point",
    "place": "position, index, slot",
    "wanted": "requested",
    "wish": "request",
}
# Names that mean what these words mean in the field.
NAMED_SO = {"look_at", "two_sided", "in_place", "place_camera", "contact_sheet_width", "lamp_efficacy",
            "LineOfSight"}
QUOTED = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def sentences(file):
    """Numbered lines: of a page but for code and the names of files and tests, of a program its text between quotes."""
    text = file.read_text(encoding="utf-8")
    code = False
    for number, line in enumerate(text.splitlines(), 1):
        if file.suffix != ".md":
            if not line.lstrip().startswith(("//", "#")):
                yield number, " ".join(words for words in QUOTED.findall(line) if " " in words)
            continue
        code ^= line.startswith("```")
        if not code and not line.startswith("| "):
            yield number, re.sub(r"`[^`]*`", "", line)


def names(file):
    """Numbered names of a source file, without comments, text and included files."""
    text = file.read_text(encoding="utf-8")
    text = re.sub(r"/\*.*?\*/", lambda comment: "\n" * comment.group().count("\n"), text, flags=re.DOTALL)
    for number, line in enumerate(text.splitlines(), 1):
        line = QUOTED.sub("", line.split("//")[0])
        if not line.lstrip().startswith("#include"):
            for name in re.findall(r"[A-Za-z_]\w*", line):
                yield number, name


def private_names(source):
    """Each name that is made of a word that nobody else uses."""
    for room in ("host/renderer", "include", "kernels"):
        for file in sorted(file for file in (source / room).rglob("*")
                           if file.suffix in (".cpp", ".hpp", ".h", ".cl", ".clh")):
            for number, name in names(file):
                for word in re.findall(r"[A-Z]?[a-z]+", name):
                    said = NAMES.get(word.lower(), NAMES.get(word.lower().removesuffix("s")))
                    if said and name.rstrip("_") not in NAMED_SO:
                        yield f"{file.relative_to(source)}:{number}: '{name}'; say {said}"


def faults(source):
    pages, programs = sorted((source / "docs").rglob("*.md")), sorted((source / "host").rglob("*.cpp"))
    for file in [source / "README.md", *pages, *programs]:
        for number, line in sentences(file):
            for word, field in WORDS.items():
                for found in re.finditer(rf"\b(?:{word})\b", line, re.IGNORECASE):
                    yield f"{file.relative_to(source)}:{number}: '{found.group()}'; say {field}"
    yield from private_names(source)


found = list(faults(pathlib.Path(sys.argv[1])))
print("\n".join(found))
sys.exit(bool(found))
