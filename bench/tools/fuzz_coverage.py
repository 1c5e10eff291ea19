#!/usr/bin/python3
"""The lines of each reader that the corpus of the fuzzer reaches.

    cmake --preset coverage && cmake --build --preset coverage
    bench/tools/fuzz_coverage.py [--more FOLDER]

Runs each target of tests/fuzz once on its corpus, counting lines by Clang (llvm-profdata and llvm-cov of
its version are needed). FOLDER holds folders of further inputs by the names of the targets, such as
build/soak.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FUZZER = ROOT / "build/coverage/tests/fuzz/photile_fuzz"
PROFILES = ROOT / "build/coverage/profiles"
READERS = ("host/formats/", "host/pictures/image/", "host/renderer/common/", "host/lighting/measuring/",
           "host/lighting/daylight/daylight_metrics", "host/lighting/daylight/sky_states", "host/apps/",
           "host/renderer/cache/light_map_contents")


def run(target, folders):
    """Reads all inputs of a target, and leaves a profile."""
    PROFILES.mkdir(parents=True, exist_ok=True)
    environment = {**os.environ, "PHOTILE_FUZZ_TARGET": target,
                   "LLVM_PROFILE_FILE": str(PROFILES / f"{target}.profraw")}
    subprocess.run([FUZZER, "-runs=0", *folders], env=environment, check=True, capture_output=True)


def lines_by_file():
    """(lines, reached) by file."""
    merged = PROFILES / "all.profdata"
    subprocess.run(["llvm-profdata", "merge", "-o", merged, *PROFILES.glob("*.profraw")], check=True)
    report = subprocess.run(["llvm-cov", "export", "--summary-only", FUZZER,
                             f"--instr-profile={merged}"],
                            check=True, capture_output=True, text=True).stdout
    lines = {}
    for file in json.loads(report)["data"][0]["files"]:
        name = file["filename"]
        name = name[name.find("/host/") + 1:] if "/host/" in name else name
        if name.startswith(READERS):
            lines[name] = (file["summary"]["lines"]["count"], file["summary"]["lines"]["covered"])
    return lines


def table(lines):
    """A row per file; those of which nobody reads anything at all are drawn by other commands."""
    rows = ["| file | lines | reached |", "|---|--:|--:|"]
    total = [0, 0]
    for name, (count, reached) in sorted(lines.items()):
        if reached == 0:
            continue
        rows.append(f"| `{name}` | {count} | {100 * reached / count:.0f}% |")
        total[0] += count
        total[1] += reached
    rows.append(f"| all of these | {total[0]} | {100 * total[1] / max(1, total[0]):.0f}% |")
    return "\n".join(rows) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--more", type=pathlib.Path)
    options = parser.parse_args()
    for corpus in sorted(path for path in (ROOT / "tests/fuzz/corpus").iterdir() if path.is_dir()):
        folders = [corpus, FUZZER.parent / "corpus" / corpus.name]
        if options.more and (options.more / corpus.name).is_dir():
            folders.append(options.more / corpus.name)
        run(corpus.name, folders)
    print(table(lines_by_file()))


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"fuzz_coverage.py: error: {error}")
