"""Commands of a page of docs/ that is an example: run in a copy of a scene's folder and put into the page
with what they print and the pictures that they leave. worked_example.py and worked_project.py use it."""

import argparse
import dataclasses
import hashlib
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

from tools.report_section import replace_section

ROOT = pathlib.Path(__file__).resolve().parents[2]
PICTURES = ROOT / "docs/pictures"
QUICK = {"render": "--quality draft --photons 5k -k 50 --size 48x32",
         "measure": "--rays 4 --repeats 2 --photons 5k",
         "daylight": "--rays 4 --repeats 2 --photons 5k --patches 145",
         "glare": "--rays 4 --repeats 2 --photons 5k --samples 1 --picture-size 32"}


@dataclasses.dataclass
class Step:
    """`pictures`: files that the command leaves, with their captions; a PDF's first pages become PNGs.
    `starts`: what begins the lines that are shown of what it prints. `files`: texts that the user writes
    first, shown; the name tells where."""
    purpose: str
    command: str = ""
    pictures: dict = dataclasses.field(default_factory=dict)
    starts: tuple = ()
    files: dict = dataclasses.field(default_factory=dict)


def arguments(description):
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("--photile", default=ROOT / "build/release/photile", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true",
                        help="few photons and rays: shows that the commands work, writes nothing")
    parser.add_argument("--work", type=pathlib.Path, metavar="FOLDER",
                        help="keep all files there, and run no command again that has run there")
    return parser.parse_args()


def fail(message):
    sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: {message}")


def output_of(photile, command, folder):
    """All that a command prints, line by line."""
    words = shlex.split(command)
    done = subprocess.run([photile, *words[1:]], cwd=folder, text=True, capture_output=True,
                          check=False)
    if done.returncode != 0:
        fail(f"{command}: {done.stderr.strip()}")
    return (done.stderr + done.stdout).splitlines()


def kept_output_of(photile, command, folder):
    """The same, from the folder where the same command has run there."""
    kept = folder / f"{hashlib.sha256(command.encode()).hexdigest()[:16]}.out"
    if not kept.is_file():
        kept.write_text("\n".join(output_of(photile, command, folder)))
    return kept.read_text().splitlines()


def quick(command):
    command = re.sub(r" --size \S+", "", command).replace(" --for 10s", " --for 1s")
    return " ".join([command, *(less for word, less in QUICK.items() if command.split()[1] == word)])


def shown(lines, starts):
    return [line for line in lines if any(line.strip().startswith(start) for start in starts)]


def wrapped(command, width=110):
    """As a shell has it over several lines."""
    lines, line = [], "    $"
    for word in command.split(" "):
        if len(line) + len(word) + 3 > width:
            lines.append(line + " \\")
            line = "         "
        line += " " + word
    return lines + [line]


def picture_in(folder, name):
    """A picture that a command left, or a page of a PDF: report.pdf gives report-1.png."""
    file = folder / name
    if "-" in name and (pdf := folder / (name.rsplit("-", 1)[0] + ".pdf")).is_file():
        page = name.rsplit("-", 1)[1].removesuffix(".png")
        subprocess.run(["pdftoppm", "-png", "-r", "120", "-f", page, "-l", page, "-singlefile", pdf,
                        file.with_suffix("")], check=True)
    if not file.is_file():
        fail(f"no command leaves {name}")
    return file


def run_page(page, script, steps, room, prefix, options, prepare=lambda folder: None):
    """Runs the steps in a copy of the folder `room`, to which `prepare` may add, and writes the part of the
    page that is the script's, and its pictures as docs/pictures/PREFIX-..., unless options.quick."""
    photile = options.photile.resolve()
    text = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.work or pathlib.Path(scratch)
        shutil.copytree(room, folder, dirs_exist_ok=True)
        prepare(folder)
        for step in steps:
            text += [step.purpose, ""] if step.purpose else []
            for name, content in step.files.items():
                (folder / name).write_text(content)
                text += [f"    $ cat {name}", *(f"    {line}" for line in content.splitlines()), ""]
            if step.command:
                lines = kept_output_of(photile, quick(step.command) if options.quick else step.command,
                                       folder)
                text += wrapped(step.command) + [f"    {line}" for line in shown(lines, step.starts)] + [""]
            for picture, caption in step.pictures.items():
                if options.quick and (folder / (picture.rsplit("-", 1)[0] + ".pdf")).is_file():
                    continue  # a page of a PDF: the command has checked that it is one
                file = picture_in(folder, picture)
                if not options.quick:
                    shutil.copy(file, PICTURES / f"{prefix}-{picture}")
                text += [f"![{caption}]({os.path.relpath(PICTURES, page.parent)}/{prefix}-{picture})", ""]
    if not options.quick:
        replace_section(page, script, "\n".join(text).strip("\n"))
