"""Programs of tests with some of the host's files changed, built from the objects of a finished build.

Only the objects that hold a changed file are compiled again, from a copy of host/, and linked before the
archives, whose own objects of these files are then not taken: seconds in place of a build of the tree.
"""

import json
import pathlib
import re
import shlex
import shutil
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROOMS = ("renderer", "formats", "lighting")
LIBRARY = tuple(f"host/{room}/CMakeFiles/photile_{room}.dir/" for room in ROOMS)
# What programs are linked from: the library, and what of host/apps stands on it.
ARCHIVES = (*LIBRARY, *(f"host/{folder}.dir/" for folder in (
    "lighting/CMakeFiles/photile_report", "apps/CMakeFiles/photile_tools",
    "apps/command/CMakeFiles/photile_app", "apps/view/CMakeFiles/photile_view")))
# Compiles in a third of the time of -O3. Warnings are those of the build.
LIBRARY_OPTIONS = ["-O1", "-w"]


class DoesNotCompile(Exception):
    """The compiler's output."""


def output_of(command, folder):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise DoesNotCompile(done.stderr or done.stdout)
    return done.stdout


class Builder:
    """Objects and programs in `work`, from those of the build folder `build`."""

    def __init__(self, build, work):
        self.build = build
        self.work = work
        self.host = work / "host"
        self.commands = {}  # object -> the words of its command
        for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
            words = shlex.split(entry["command"])
            self.commands[words[words.index("-o") + 1]] = words
        self.copy_sources()
        self.header = self._precompiled_header()

    def copy_sources(self):
        shutil.rmtree(self.host, ignore_errors=True)
        shutil.copytree(ROOT / "host", self.host)

    def _precompiled_header(self):
        """That of the library, for the options of this build."""
        header = self.work / "cmake_pch.hxx"
        built = pathlib.Path(f"{header}.gch")
        if built.is_file() and built.stat().st_mtime > (self.build / "compile_commands.json").stat().st_mtime:
            return header
        shutil.copyfile(self.build / LIBRARY[0] / "cmake_pch.hxx", header)
        words = list(next(words for object_, words in self.commands.items()
                          if object_.startswith(LIBRARY[0] + "Unity")))
        del words[words.index("-include"):]
        output_of([*words, *LIBRARY_OPTIONS, "-x", "c++-header", str(header), "-o", f"{header}.gch"],
                  self.build)
        return header

    def objects_with(self, folders):
        """The archives' objects that hold source files of folders of the parts of host/."""
        requested = re.compile(rf"{ROOT}/host/\w+/({'|'.join(folders)})/")
        return [object_ for object_, words in self.commands.items() if object_.startswith(ARCHIVES)
                and any(map(requested.match, self._sources(words[-1])))]

    def test_objects(self, folders):
        return [object_ for object_ in self.commands
                if object_.startswith(tuple(f"tests/{folder}/" for folder in folders))]

    def objects_that_read(self, file, folders):
        """The archives' objects, and those of the tests of folders, that a file is part of."""
        text = output_of(["ninja", "-t", "deps"], self.build)
        path = f"    {ROOT / file}\n"
        candidates = {block.split(":", 1)[0] for block in text.split("\n\n") if path in block + "\n"}
        requested = {object_ for object_ in self.commands if object_.startswith(ARCHIVES)}
        return sorted(candidates & (requested | set(self.test_objects(folders))))

    @staticmethod
    def _sources(source):
        """The files that a unity source includes, or the file itself."""
        if "/Unity/" not in source:
            return [source]
        return re.findall(r'#include "([^"]+)"', pathlib.Path(source).read_text(encoding="utf-8"))

    def compile(self, object_, options=(), variant="common"):
        """The object again, from the copies; returns its path."""
        words = list(self.commands[object_])
        source = pathlib.Path(words[-1])
        out = self.work / variant / object_
        out.parent.mkdir(parents=True, exist_ok=True)
        changed = source
        if "/Unity/" in str(source):
            changed = out.with_suffix(".unity.cpp")
            changed.write_text(source.read_text(encoding="utf-8")
                               .replace(f"{ROOT}/host/", f"{self.host}/"), encoding="utf-8")
        elif source.is_relative_to(ROOT / "host"):
            changed = self.host / source.relative_to(ROOT / "host")
        words = [word.replace(f"-I{ROOT}/host", f"-I{self.host}") for word in words[:-1]]
        words[words.index("-o") + 1] = str(out)
        if object_.startswith(LIBRARY):
            words = [str(self.header) if word.endswith("cmake_pch.hxx") else word for word in words]
            words[-1:] = [*LIBRARY_OPTIONS, *options, "-c"]
        else:
            words[-1:] = ["-w", *options, "-c"]
        output_of([*words, str(changed)], self.build)
        return out

    @staticmethod
    def _archive(object_):
        return re.sub(r"CMakeFiles/(\w+)\.dir/.*", r"lib\1.a", object_)

    def link(self, target, objects, variant="common"):
        """The program `target` of the build with objects (name -> path) in place of the build's."""
        command = output_of(["ninja", "-t", "commands", "-s", target], self.build)
        words = shlex.split(command.strip().splitlines()[-1].split("&&")[1])
        words = [str(objects.get(word, word)) for word in words]
        program = self.work / variant / target
        program.parent.mkdir(parents=True, exist_ok=True)
        place = words.index("-o")
        words[place:place + 2] = [*(str(path) for name, path in sorted(objects.items())
                                    if name.startswith(LIBRARY) or self._archive(name) in words),
                                  "-o", str(program)]
        output_of(words, self.build)
        return program
