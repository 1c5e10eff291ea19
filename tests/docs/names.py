"""Checks that the classes, members and files which comments name exist: a reader who looks for one finds it.

    names.py SOURCE-FOLDER

It reads the comments of host, include and kernels. A name of two or more capitalised parts (LightMaps), a qualified
name (LightMaps::fill), any name between backquotes and a file name (tree.cpp, host/tree.cpp) are looked for in the code
of the project.
"""

import pathlib
import re
import sys

COMMENTED = ("host", "include", "kernels")
CODE = (*COMMENTED, "tests", "bench", "python")
C_LIKE = {".cpp", ".hpp", ".h", ".cl", ".clh", ".js"}
# Names from outside, and one that stands for any name.
OUTSIDE = {"FreeType", "MaterialX", "McTaggart", "NAME.cl", "color.h", "color_map", "oidn.h"}
# Text in quotes is kept whole, so that "//" in it begins no comment.
TOKEN = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'|//[^\n]*|/\*.*?\*/', re.DOTALL)
NAME = re.compile(r"(?<![\w.])(?:\w+::)+~?\w+|(?<![\w.])[A-Z][a-z0-9]+(?:[A-Z][a-z0-9]*)+\b|(?<=`)[A-Za-z_]\w*(?=`)")
FILE = re.compile(r"(?<![\w<>])[\w./-]*\w\w\.(?:cpp|hpp|clh|cl|h|js)\b(?!\()")


def split(file):
    """The code of a file, and its comments with their line numbers."""
    text = file.read_text(encoding="utf-8")
    if file.suffix not in C_LIKE:
        return re.sub(r"(?m)(?:^|\s)#.*", "", text), []
    comments = [(text.count("\n", 0, token.start()) + 1, token.group())
                for token in TOKEN.finditer(text) if token.group().startswith("/")]
    return TOKEN.sub(lambda token: " " if token.group().startswith("/") else token.group(), text), comments


def exists(name, words, owners, files):
    """Whether code has the name; a member has to stand in a file that declares its class."""
    if name in OUTSIDE or name.startswith("std::"):
        return True
    if FILE.fullmatch(name):
        return any(file.endswith("/" + name.lstrip("./")) for file in files)
    *scopes, member = re.split(r"::~?", name)
    if not all(scope in words for scope in scopes) or member not in words:
        return False
    return not scopes or scopes[-1] not in owners or member in owners[scopes[-1]]


def faults(source):
    sources = [file for folder in CODE for file in sorted((source / folder).rglob("*"))
               if file.suffix in C_LIKE | {".py", ".txt", ".cmake", ".in"} and file.name != "names.py"]
    files = {"/" + str(file.relative_to(source)) for file in sources}
    words, owners, comments = set(), {}, []
    for file in sources:
        code, said = split(file)
        here = set(re.findall(r"\w+", code))
        words |= here
        for owner in re.findall(r"\b(?:class|struct|enum class|enum)\s+(\w+)[^;{()]*\{", code):
            owners.setdefault(owner, set()).update(here)
        if file.relative_to(source).parts[0] in COMMENTED:
            comments += [(file.relative_to(source), line, text) for line, text in said]
    for file, line, text in comments:
        for pattern in (NAME, FILE):
            for found in pattern.finditer(text):
                if not exists(found.group(), words, owners, files):
                    yield f"{file}:{line + text.count(chr(10), 0, found.start())}: '{found.group()}' does not exist"


found = list(faults(pathlib.Path(sys.argv[1])))
print("\n".join(found))
sys.exit(bool(found))
