"""One build that holds many mutants of the host, of which PHOTILE_MUTANT chooses one.

A build for each would take longer than its tests. mutant_schemata.hpp has what the copies of the source
files call. Some sites cannot be chosen at run time (sizes of arrays, arguments of templates, what the
compiler computes): these are left out of the common build and built one by one.
"""

import hashlib
import json
import re
import shutil

from tools import mutant_builder
from tools.mutant_sites import changed

INFIX = {"<": "Less", "<=": "LessOrEqual", ">": "Greater", ">=": "GreaterOrEqual", "==": "Equal",
         "!=": "Unequal", "+": "Plus", "-": "Minus", "*": "Times", "/": "Over", "%": "Rest",
         "&": "BothBits", "|": "AnyBits", "<<": "ShiftUp", ">>": "ShiftDown", "+=": "Add",
         "-=": "Subtract", "*=": "Multiply", "/=": "Divide"}
HEADER = mutant_builder.ROOT / "bench/tools/mutant_schemata.hpp"


def operand_end(text, place, step, stops):
    """Where the operand of a logical operator ends, walking from `place` by `step` of +1 or -1."""
    opening, closing = ("([{", ")]}") if step > 0 else (")]}", "([{")
    depth = 0
    while 0 <= place < len(text):
        character = text[place]
        if character in opening:
            depth += 1
        elif character in closing:
            if depth == 0:
                return place
            depth -= 1
        elif depth == 0:
            if character in ",;?":
                return place
            two = text[place:place + 2] if step > 0 else text[max(place - 1, 0):place + 1]
            if two in stops:
                return place
            if character in "=:" and text[place - 1].isspace() and text[place + 1].isspace():
                return place
            if step < 0 and re.match(r"\breturn\b", text[place - 5:place + 1]):
                return place
        place += step
    return None


def logical(text, place, token, number):
    """Insertions (place, text) that make `a && b` a choice between it and `a || b`."""
    left = operand_end(text, place - 1, -1, ("||",) if token == "&&" else ())
    right = operand_end(text, place + 2, 1, ("&&", "||") if token == "&&" else ("||",))
    if left is None or right is None or "//" in text[left:right]:
        return None
    # Lines stay where they are, as the compiler names them.
    a, b = (" ".join(part.split()) for part in (text[left + 1:place], text[place + 2:right]))
    if "{" in a + b:
        return None  # a lambda or a list, whose text cannot stand twice
    return [(left + 1, f" (PHOTILE_CHOSEN({number}) ? (({a}) {changed(token)} ({b})) : ("),
            (right, "))")]


def insertions(text, place, token, number):
    """(place, length replaced, text) of a mutant's choice; None where there is no way."""
    if token in INFIX:
        between = f"PHOTILE_INFIX({INFIX[token]}, {number})"
        return [(place, len(token), f"{token} {between} {token}")]
    if token in ("&&", "||"):
        found = logical(text, place, token, number)
        return found and [(where, 0, new) for where, new in found]
    if token == "!":
        return [(place, 1, f"PHOTILE_CHOSEN({number}) ^ !")]
    if token in ("min", "max"):
        before = text[:place]
        scope = next((name for name in ("std::", "glm::") if before.endswith(name)), "")
        if not scope:
            return None
        choice = f"PHOTILE_EXTREME({number}, {scope}{token}, {scope}{changed(token)})"
        return [(place - len(scope), len(scope) + len(token), choice)]
    return [(place, len(token), f"(PHOTILE_CHOSEN({number}) ? {changed(token)} : {token})")]


def line_starts(text):
    starts = [0]
    for line in text.split("\n"):
        starts.append(starts[-1] + len(line) + 1)
    return starts


def instrument(text, numbered):
    """The text with the choices of sites (number -> site), and the numbers of those left out."""
    starts, edits, left_out = line_starts(text), [], set()
    lines = text.split("\n")
    for number, site in numbered.items():
        if "constexpr" in lines[site.line]:
            left_out.add(number)
            continue
        found = insertions(text, starts[site.line] + site.column, site.token, number)
        if found is None:
            left_out.add(number)
        else:
            edits += found
    # From the end, so that places stay; where two begin at one place, the insertion stays in front.
    for where, length, new in sorted(edits, key=lambda edit: (edit[0], edit[1]), reverse=True):
        text = text[:where] + new + text[where + length:]
    return text, left_out


class Schemata:
    """The common build of sites, numbered from 1, and the programs of tests linked with it."""

    def __init__(self, builder, sites, folders):
        self.builder = builder
        self.sites = dict(enumerate(sites, 1))
        self.alone = set()  # numbers of those that have to be built one by one
        self.objects = {}
        self.programs = {}
        texts = {file: (mutant_builder.ROOT / file).read_text(encoding="utf-8")
                 for file in sorted({site.file for site in sites})}
        self.numbered = {file: {number: site for number, site in self.sites.items() if site.file == file}
                         for file in texts}
        names = builder.objects_with(folders)
        if any(file.endswith(".hpp") for file in texts):
            names += builder.test_objects(folders)
        built_at = [(builder.build / name).stat().st_mtime for name in names]
        digest = hashlib.sha256(repr((sites, texts, names, built_at, HEADER.read_text())).encode()).hexdigest()
        kept = builder.work / "schemata.json"
        built = json.loads(kept.read_text(encoding="utf-8")) if kept.is_file() else {"digest": ""}
        if built["digest"] == digest:
            self.alone = set(built["alone"])
        for file, text in texts.items():
            self._write(file, text)
        if built["digest"] == digest:
            self.objects = {name: builder.work / "common" / name for name in names}
            return
        # What steps reach is told by the numbers of the sites.
        shutil.rmtree(builder.work / "reached", ignore_errors=True)
        for name in names:
            self.objects[name] = self._compile(name)
        kept.write_text(json.dumps({"digest": digest, "alone": sorted(self.alone)}), encoding="utf-8")

    def _write(self, file, text):
        kept = {number: site for number, site in self.numbered[file].items() if number not in self.alone}
        text, left_out = instrument(text, kept)
        self.alone |= left_out
        (self.builder.work / file).write_text(text, encoding="utf-8")

    def _compile(self, name):
        """Sites in lines that the compiler refuses are left out, until it refuses none."""
        for _ in range(8):
            try:
                return self.builder.compile(name, ["-Wno-narrowing", "-include", str(HEADER)])
            except mutant_builder.DoesNotCompile as failure:
                if not self._leave_out(str(failure)):
                    raise
        raise mutant_builder.DoesNotCompile(f"{name}: still refused after eight attempts")

    def _leave_out(self, output):
        """Whether there was a site in the lines that the compiler's output names."""
        before = set(self.alone)
        host = re.escape(str(self.builder.work)) + "/"
        found = re.findall(rf"{host}([^:\s]+):(\d+)", output)
        for file, line in found:
            numbered = self.numbered.get(file, {})
            self.alone |= {number for number, site in numbered.items() if site.line + 1 == int(line)}
        for file in {file for file, _ in found} & set(self.numbered):
            self._write(file, (mutant_builder.ROOT / file).read_text(encoding="utf-8"))
        return self.alone != before

    def program(self, target):
        if target not in self.programs:
            self.programs[target] = self.builder.link(target, self.objects)
        return self.programs[target]
