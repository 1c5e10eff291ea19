#!/usr/bin/python3
"""Runs the commands of a transcript and compares what they print with what the transcript says.

    transcript_test.py PHOTILE TRANSCRIPT...

With PHOTILE_RENEW_TRANSCRIPT=1 the answers are written anew, to be read in review. A transcript is text:

    # Comments, and blank lines between cases.
    == what the case shows
    > box/                              copies the files of inputs/box
    > note.txt                          a file of the lines that follow
    | its first line
    > note.txt = b"\\xff" * 3            a file of these bytes, an expression of Python
    > note.txt += b"more"
    > box.obj "usemtl wall" -> "usemtl brick"
    > square.gltf /nodes/0/mesh = 4     a member of a JSON file
    > square.gltf /nodes/0/mesh gone
    > link.obj symlink box.obj          also: hardlink FILE, folder, fifo
    $ photile info box.obj
      a line of standard output
    ! a line of standard error
    [3]                               the exit code, unless it is 0
    + out.exr                         the files that are new (+), changed (~) or gone (-): a refusal leaves none
    --
    > box.mtl = b""                     another variation of the case: the files above its first command, anew
    $ photile info box.obj

Of `photile ... | grep WORD|WORD` the lines with one of the words are compared. Variables of the environment stand before
`photile`; `\\n` in a word is the end of a line. `...` in an answer stands for what depends on the machine. A command that
refuses a file takes no more than 256 MiB beside its files.
"""

import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

INPUTS = pathlib.Path(__file__).parent / "inputs"
RENEW = os.environ.get("PHOTILE_RENEW_TRANSCRIPT") == "1"
MOST_BYTES = 256 << 20
MOST_CHARACTERS = 1000


class Step:
    """A command with the files that are written before it, and what it answers."""

    def __init__(self):
        self.files, self.command, self.answer = [], None, []


def member(document, pointer):
    """What holds the member that a JSON pointer names, and the member's key."""
    keys = pointer[1:].split("/")
    for i, key in enumerate(keys):
        if isinstance(document, list):
            key = len(document) if key == "-" else int(key)
        if i + 1 == len(keys):
            return document, key
        if isinstance(document, dict):
            document.setdefault(key, {})
        document = document[key]


def change_json(file, pointer, value):
    document = json.loads(file.read_text())
    holder, key = member(document, pointer)
    if value is None:
        del holder[key]
    elif key == len(holder) and isinstance(holder, list):
        holder.append("@")
    else:
        holder[key] = "@"
    # The value as it stands: it may be no JSON, or a number that Python would write otherwise.
    file.write_text(json.dumps(document).replace('"@"', value or "", 1))


def evaluated(text):
    return eval(text, {"__builtins__": {"range": range, "str": str, "bytes": bytes}})


def write(folder, line, lines):
    """Writes what a line after '>' says."""
    name, _, rest = line.partition(" ")
    file = folder / name
    if name.endswith("/") and not rest:
        shutil.copytree(INPUTS / name, folder, dirs_exist_ok=True)
        return
    file.parent.mkdir(parents=True, exist_ok=True)
    how, _, what = rest.partition(" ")
    if not rest:
        file.write_text("".join(text + "\n" for text in lines))
    elif how == "=":
        file.write_bytes(evaluated(what))
    elif how == "+=":
        file.write_bytes(file.read_bytes() + evaluated(what))
    elif how.startswith("/"):
        change_json(file, how, None if what == "gone" else what.removeprefix("= "))
    elif how == "symlink":
        file.symlink_to(what)
    elif how == "hardlink":
        file.hardlink_to(folder / what)
    elif how == "folder":
        file.mkdir()
    elif how == "fifo":
        os.mkfifo(file)
    else:
        old, new = (evaluated(part).encode() for part in rest.split(" -> "))
        if old not in file.read_bytes():
            sys.exit(f"transcript_test.py: error: {name} has no {old!r}")
        file.write_bytes(file.read_bytes().replace(old, new, 1))


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def run(photile, folder, command):
    """The lines that a command answers."""
    before = contents(folder)
    command, _, only = command.partition(" | grep ")
    words = [word.replace("\\n", "\n") for word in shlex.split(command)]
    at = words.index("photile")
    environment = dict(os.environ, **dict(word.split("=", 1) for word in words[:at]))
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
        child = subprocess.Popen([photile, *words[at + 1:]], cwd=folder, env=environment, stdout=output,
                                 stderr=errors, stdin=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = code = os.waitstatus_to_exitcode(status)
        texts = []
        for stream in (output, errors):
            stream.seek(0)
            texts.append(stream.read().decode(errors="backslashreplace").replace(str(folder), "FOLDER"))
    answer = [("  " + line).rstrip() for line in texts[0].splitlines() if re.search(only, line)]
    answer += ["! " + line.rstrip() for line in texts[1].splitlines()]
    if code:
        answer.append(f"[{code}]")
    answer = [line if len(line) < MOST_CHARACTERS else f"a line of {len(line)} characters" for line in answer]
    after = contents(folder)
    for name in sorted(before | after):
        if before.get(name) != after.get(name):
            answer.append(("+" if name not in before else "-" if name not in after else "~") + " " + name)
    if code == 3 and usage.ru_maxrss * 1024 > MOST_BYTES + 2 * sum(map(len, before.values())):
        answer.append(f"it takes {usage.ru_maxrss} KiB")
    return answer


def matches(expected, line):
    return re.fullmatch(".*".join(map(re.escape, expected.split("..."))), line) is not None


def checked(photile, steps, common):
    """Runs the steps of a variation in a folder of their own; returns what they answer."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(os.path.realpath(name))
        for line, lines in common:
            write(folder, line, lines)
        answers = []
        for step in steps:
            for line, lines in step.files:
                write(folder, line, lines)
            found = run(photile, folder, step.command)
            answers.append([old if old is not None and matches(old, line) else line for old, line in
                            zip(step.answer + [None] * len(found), found)])
        return answers


def variations(lines):
    """The cases of a transcript, as (title, number of the line, files above the first command, steps)."""
    found, title, common, step = [], "", [], None
    for number, line in enumerate(lines, 1):
        if line.startswith(("> ", "$ ")) and step.command is not None:
            step = Step()
            found[-1][3].append(step)
        if line.startswith("== "):
            title, common, step = line[3:], [], Step()
            found.append((title, number, common, [step]))
        elif line == "--":
            if found[-1][3][0].command is None:  # all that came was for those that follow
                common.extend(found.pop()[3][0].files)
            step = Step()
            found.append((title, number, common, [step]))
        elif line.startswith("> "):
            step.files.append((line[2:], []))
        elif line.startswith("| ") or line == "|":
            step.files[-1][1].append(line[2:])
        elif line.startswith("$ "):
            step.command = line[2:]
        elif line and not line.startswith("#"):
            step.answer.append(line)
    return found


def main():
    photile, failures, commands = os.path.realpath(sys.argv[1]), 0, 0
    for name in sys.argv[2:]:
        lines = pathlib.Path(name).read_text().splitlines()
        cases = variations(lines)
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            answers = list(pool.map(lambda case: checked(photile, case[3], case[2]), cases))
        renewed = []
        for (title, number, _, steps), found in zip(cases, answers):
            renewed += found
            commands += len(found)
            for step, answer in zip(steps, found):
                if answer != step.answer and not RENEW:
                    failures += 1
                    print(f"{name}:{number}: {title}\n$ {step.command}")
                    print("".join(f"  expected: {line}\n" for line in step.answer)
                          + "".join(f"  found:    {line}\n" for line in answer))
        if RENEW:
            written, answers = [], iter(renewed)
            for line in lines:
                if line.startswith("$ "):
                    written += [line, *next(answers)]
                elif not line or line == "--" or line.startswith(("== ", "> ", "| ", "#")) or line == "|":
                    written.append(line)
            pathlib.Path(name).write_text("".join(line + "\n" for line in written))
    if failures:
        sys.exit(f"transcript_test.py: error: {failures} of {commands} commands answer otherwise; renew the "
                 "transcript with PHOTILE_RENEW_TRANSCRIPT=1 and read what changes")
    print(f"{commands} commands answer as the transcript says")


main()
