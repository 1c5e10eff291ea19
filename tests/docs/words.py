"""Checks that pages, help and messages use the words of the field: a reader of pbrt, Embree or Radiance needs no
dictionary for them.

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
PRIVATE = re.compile(r"\b(" + "|".join(f"(?:{word})" for word in WORDS) + r")\b", re.IGNORECASE)
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


def field_word(private):
    return next(field for word, field in WORDS.items() if re.fullmatch(word, private, re.IGNORECASE))


def faults(source):
    files = [source / "README.md", *sorted((source / "docs").glob("*.md"))]
    files += sorted((source / "host").rglob("*.cpp"))
    for file in files:
        for number, line in sentences(file):
            for found in PRIVATE.findall(line):
                yield f"{file.relative_to(source)}:{number}: '{found}'; say {field_word(found)}"


def main():
    found = list(faults(pathlib.Path(sys.argv[1])))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
