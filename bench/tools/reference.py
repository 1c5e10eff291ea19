#!/usr/bin/python3
"""The tables in docs/reference are what the program prints and its source holds, the programs those of docs/examples.

    reference.py PHOTILE SOURCE_FOLDER [--write]

A page has the table of a command between <!-- begin: photile COMMAND --help --> and <!-- end -->. Without COMMAND it is
the list of commands, with "render: common options" the table of the options that commands share; with --markdown in
place of --help it is the table of settings, or "settings: qualities". Between <!-- begin: docs/examples/FILE --> and
<!-- end --> is that program, after <!-- begin: host/lighting/measuring/requirements.cpp --> its table. Without --write a part that differs, and a command that has none, is a fault.
"""

import pathlib
import re
import subprocess
import sys

PAGES = "docs/reference"
BLOCK = re.compile(r"(<!-- begin: photile (.*?) ?(--help|--markdown) -->\n)(.*?)(<!-- end -->\n)", re.DOTALL)
TARGETS = "host/lighting/measuring/requirements.cpp"
TARGET_ROW = re.compile(r'\{"([a-z-]+)", "table (\d+)", "([^"]+)",\s*([\d., \n]+?)(,\s*unconfirmed)?\}')
TARGET_BLOCK = re.compile(rf"(<!-- begin: {re.escape(TARGETS)} -->\n).*?(<!-- end -->\n)", re.DOTALL)
EXAMPLE = re.compile(r"(<!-- begin: (docs/examples/\S+) -->\n).*?(<!-- end -->\n)", re.DOTALL)
# Titles of photile render whose options other commands share; their table is that of `photile render`.
COMMON = ("Picture", "Photons", "Estimate", "Settings", "Scene", "Lights", "Device", "Run")
COLUMN = 30  # of the help, where what an option does begins
DEFAULT = re.compile(r"=([a-z0-9.][^|=]*)$")


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


def row(names, default, does):
    return f"| `{cell(names)}` | {cell(does)} | {cell(default)} |"


def rows_of(options):
    lines = ["| option | meaning | default |", "|---|---|---|"]
    title = None
    for option in options:
        if option[0] != title:
            title = option[0]
            lines.append(f"| **{title}** | | |")
        lines.append(row(*option[1:]))
    return lines


def table_of(photile, command):
    """Of a command: its own options as a table, those that it shares with photile render as a line."""
    options = options_of(photile, command)
    if command == "render":
        own, shared = [option for option in options if option[0] not in COMMON], []
    else:
        common = {(names, does): default for title, names, default, does in options_of(photile, "render")
                  if title in COMMON}
        own = [option for option in options if (option[1], option[3]) not in common]
        shared = [(names.split("`")[0].split()[0], "" if common[names, does] == default else default)
                  for _, names, default, does in options if (names, does) in common]
    lines = rows_of(own) if own else []
    if shared:
        listed = ", ".join(f"`{name}` ({default})" if default else f"`{name}`" for name, default in shared)
        lines += ["", f"[Common options](options.md), in brackets the default where it is another: {listed}."]
    return "\n".join(lines).strip("\n")


def common_of(photile):
    return "\n".join(rows_of([option for option in options_of(photile, "render") if option[0] in COMMON]))


def commands_of(photile):
    return re.findall(r"^  ([a-z]+) +(\S.*)$", printed(photile, "--help").split("Subcommands:")[1], re.MULTILINE)


def block(photile, command, option):
    """What belongs between the comments of a page."""
    if option == "--markdown":
        settings, _, qualities = printed(photile, "settings", option).partition("\n\n")
        return (qualities if command == "settings: qualities" else settings).strip("\n")
    if command == "render: common options":
        return common_of(photile)
    if command:
        return table_of(photile, command)
    rows = [f"| `{name}` | {cell(does)} |" for name, does in commands_of(photile)]
    return "\n".join(["| command | what it does |", "|---|---|", *rows])


def targets(source):
    """Names of activities and what EN 12464-1 requires for them; * = not confirmed."""
    lines = ["<!-- not measured -->", "", "| name | table | activity | Em | Uo | UGR | Ra | Ez | Ewall | Eceiling |", "|---|" + "--:|" * 9]
    lines[-1] = lines[-1].replace("--:|--:|", "--:|---|", 1)
    for name, table, activity, numbers, unconfirmed in TARGET_ROW.findall((source / TARGETS).read_text(encoding="utf-8")):
        values = [number.strip() for number in numbers.split(",")]
        lines.append("| " + " | ".join([f"`{name}`{'*' if unconfirmed else ''}", table, activity, *values]) + " |")
    return "\n".join(lines)


def main():
    photile, source = sys.argv[1], pathlib.Path(sys.argv[2])
    wrong, shown = [], set()
    for page in sorted((source / PAGES).glob("*.md")):
        text = page.read_text(encoding="utf-8")

        def of_program(match):
            shown.add(match[2])
            return f"{match[1]}\n{block(photile, match[2], match[3])}\n\n{match[5]}"

        def example(match):
            file = source / match[2]
            return f"{match[1]}\n```{file.suffix[1:]}\n{file.read_text(encoding='utf-8')}```\n\n{match[3]}"

        new = EXAMPLE.sub(example, BLOCK.sub(of_program, text))
        new = TARGET_BLOCK.sub(lambda match: f"{match[1]}\n{targets(source)}\n\n{match[2]}", new)
        if new != text and "--write" in sys.argv:
            page.write_text(new, encoding="utf-8")
        elif new != text:
            wrong.append(f"{page.relative_to(source)}: a table is not what the program prints; write it by "
                         f"bench/tools/reference.py PHOTILE {source} --write")
    wrong += [f"{PAGES}: no page has the options of photile {name}" for name, _ in commands_of(photile)
              if name not in shown]
    print("\n".join(wrong) or "all options stand in the reference")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
