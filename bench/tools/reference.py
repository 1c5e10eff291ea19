#!/usr/bin/python3
"""The tables in docs/reference are what the program prints and its source holds, the programs those of docs/examples.

    reference.py PHOTILE SOURCE_FOLDER [--write]

Between <!-- begin: NAME --> and <!-- end --> of a page stands, by NAME:

    photile COMMAND --help              the options of a command; without COMMAND the list of commands
    photile options --help              those that commands share with photile render
    photile settings --markdown         what --set sets; photile qualities --markdown: what --quality sets
    docs/examples/FILE                  that program
    host/.../en12464_1.csv              the targets of that standard
    host/apps/command/command_line.hpp  the exit codes

Without --write a part that differs, and a command that has none, is a fault.
"""

import pathlib
import re
import subprocess
import sys

PAGES = "docs/reference"
BLOCK = re.compile(r"(<!-- begin: (photile\b.*?|docs/examples/\S+|host/\S+) -->\n).*?(<!-- end -->\n)", re.DOTALL)
# Titles of photile render whose options other commands share.
COMMON = ("Picture", "Photons", "Estimate", "Settings", "Scene", "Lights", "Device", "Run")
COLUMN = 30  # of the help, where what an option does begins
WIDEST = 40  # of names that stay on one line
DEFAULT = re.compile(r"=([a-z0-9.][^|=]*)$")
EXIT_CODE = re.compile(r"^  (\w+) = (\d+), +///< (.*)$", re.MULTILINE)


def printed(photile, *words):
    return subprocess.run([photile, *words], check=True, text=True, capture_output=True).stdout


def options_of(photile, command):
    """(title, names and value, default, what it does) of each option of a command, in the order of its help."""
    lines = printed(photile, command, "--help").splitlines()
    title, found = "Options", []
    for number, line in enumerate(lines):
        if re.fullmatch(r"[A-Z][a-z ]*:", line):
            title = line[:-1]
        elif line.startswith("  -"):
            text = lines[number + 1] if number + 1 < len(lines) else ""
            left, does = (line, text.strip()) if text.startswith(" " * COLUMN) else (line[:COLUMN], line[COLUMN:])
            found.append((title, *parted(left.strip(), does)))
    return [option for option in found if "--help" not in option[1]]


def parted(left, does):
    """Of "-o,--output FILE ... REQUIRED" the names with the value, the default, and what the option does."""
    for word, of in (("Excludes", "not together with"), ("Needs", "only with")):
        others = re.search(rf" {word}:((?: --?[\w-]+)+)$", left)
        if others:
            left = left[:others.start()]
            does += f"; {of} " + ", ".join(f"`{name}`" for name in others[1].split())
    required = left.endswith(" REQUIRED")
    left = re.sub(r" x \d$", "", left.removesuffix(" REQUIRED")).removesuffix(" ...")
    words = re.search(r"(\w*):\{(.*)\}", left)
    if words:
        left = left.replace(words[0], words[1] or words[2].replace(",", "|"))
        if words[1] and not all(word in does for word in words[2].split(",")):
            does += f": {words[2].replace(',', ', ')}"
    default = DEFAULT.search(left)
    names = left[:default.start()] if default else left
    return names.replace(",-", "`, `-"), "required" if required else default[1] if default else "", does


def cell(text):
    return text.replace("|", "\\|").replace("<grid>", "GRID")


def table(options):
    lines, title = ["| option | meaning | default |", "|---|---|---|"], None
    for option in options:
        if option[0] != title:
            title = option[0]
            lines.append(f"| **{title}** | | |")
        names = option[1] if len(option[1]) <= WIDEST else option[1].replace("|", "` | `")  # where lines may break
        lines.append(f"| `{cell(names)}` | {cell(option[3])} | {cell(option[2])} |")
    return "\n".join(lines) if options else ""


def options_text(photile, command):
    """A command's own options as a table, those that it shares with photile render as a line."""
    options = options_of(photile, command)
    if command == "render":
        return table([option for option in options if option[0] not in COMMON])
    common = {(names, does): default for title, names, default, does in options_of(photile, "render") if title in COMMON}
    own = [option for option in options if (option[1], option[3]) not in common]
    shared = [(names.split("`")[0].split()[0], default if common[names, does] != default else "")
              for _, names, default, does in options if (names, does) in common]
    listed = ", ".join(f"`{name}` ({default})" if default else f"`{name}`" for name, default in shared)
    line = f"[Common options](options.md), with the default where it differs: {listed}." if shared else ""
    return "\n\n".join(part for part in (table(own), line) if part)


def commands_of(photile):
    return re.findall(r"^  ([a-z]+) +(\S.*)$", printed(photile, "--help").split("Subcommands:")[1], re.MULTILINE)


def program_text(photile, words):
    if words[-1] == "--markdown":
        settings, _, qualities = printed(photile, "settings", "--markdown").partition("\n\n")
        return (qualities if words[0] == "qualities" else settings).strip("\n")
    if words[0] == "options":
        return table([option for option in options_of(photile, "render") if option[0] in COMMON])
    if words[0] != "--help":
        return options_text(photile, words[0])
    rows = [f"| `{name}` | {cell(does)} |" for name, does in commands_of(photile)]
    return "\n".join(["| command | what it does |", "|---|---|", *rows])


def targets_text(text):
    """The rows of a table of targets, and lines of areas between them."""
    heading, *rows = [line.split(";") for line in text.removeprefix('R"(').splitlines()[:-1]]
    lines = ["<!-- not measured -->", "", f"| {' | '.join(heading[:-1])} |", "|---|--:|---|" + "--:|" * 7]
    for row in rows:
        if len(row) == 1:
            lines.append(f"| **{row[0]}** |" + " |" * (len(heading) - 2))
            continue
        name, *values, confirmed = row + [""] * (len(heading) - len(row))
        lines.append(f"| `{name}`{'' if confirmed else '*'} | {' | '.join(values)} |")
    return "\n".join(lines)


def source_text(file):
    text = file.read_text(encoding="utf-8")
    if file.parent.name == "examples":
        return f"```{file.suffix[1:]}\n{text}```"
    if file.name == "command_line.hpp":
        rows = [f"| {code} | {name} | {meaning} |" for name, code, meaning in EXIT_CODE.findall(text)]
        return "\n".join(["| code | name | meaning |", "|--:|---|---|", *rows])
    return targets_text(text)


def main():
    photile, source = sys.argv[1], pathlib.Path(sys.argv[2])
    wrong, shown = [], set()
    for page in sorted((source / PAGES).glob("*.md")):
        text = page.read_text(encoding="utf-8")

        def of_program(match):
            words = match[2].split()
            if words[0] == "photile":
                shown.add(words[1])
            part = program_text(photile, words[1:]) if words[0] == "photile" else source_text(source / match[2])
            return f"{match[1]}\n{part}\n\n{match[3]}"

        new = BLOCK.sub(of_program, text)
        if new != text and "--write" in sys.argv:
            page.write_text(new, encoding="utf-8")
        elif new != text:
            wrong.append(f"{page.relative_to(source)}: a part is not what the program has; write it by "
                         f"bench/tools/reference.py PHOTILE {source} --write")
    wrong += [f"{PAGES}: no page has the options of photile {name}" for name, _ in commands_of(photile)
              if name not in shown]
    print("\n".join(wrong) or "the reference is what the program prints")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
