#!/usr/bin/python3
"""Where the time of an estimate goes: samples of all threads with perf, by stage of the kernel.

    bench/kernels/profile.py [--quick] [--output FILE] [--benches FOLDER]

Needs the Debian packages linux-perf and binutils, and PoCL, whose kernels are shared objects with
symbols. Where perf is missing or may not sample, the file says why in place of results.
"""

import argparse
import collections
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASES = (
    ("plane, k = 50", ["--workload", "plane", "-k", "50"]),
    ("plane, k = 200", ["--workload", "plane", "-k", "200"]),
    ("plane, k = 1000", ["--workload", "plane", "-k", "1000"]),
    ("living-room, k = 50", ["--workload", "living-room", "-k", "50"]),
    ("living-room, k = 200", ["--workload", "living-room", "-k", "200"]),
    ("classroom, k = 200", ["--workload", "classroom", "-k", "200"]),
    ("the paper's frame", ["--workload", "waved-hall", "--photons", "4000000", "--side", "500"]),
)
SHARED = pathlib.Path(os.environ.get("PHOTILE_SHARED_SCENES", ROOT.parent / "shared/scenes"))
QUICK = ["--photons", "2000", "--side", "64", "--cells", "8", "--seconds", "0.5"]
SAMPLES_PER_SECOND = 997

# Functions of kernels/estimate by what they do. A sample counts for the innermost of the functions
# inlined at its address that is listed here.
STAGES = {
    "squared_distances": "distances of the candidates",
    "filter_distances": "normals of the candidates",
    "store_chunks": "distances of the candidates",
    "keep_chunks": "distances of the candidates",
    "next_chunks": "distances of the candidates",
    "count_chunks": "counting",
    "count_pass": "counting",
    "add_counters": "counting",
    "counted": "counting",
    "edge_above": "selection",
    "select_nearest": "selection",
    "reach_for": "block of cells",
    "block_within": "block of cells",
    "records_in": "block of cells",
    "project": "block of cells",
    "cell_of": "block of cells",
    "find_neighbourhood": "selection",
    "last_tied_photon": "ties",
    "begin_near": "sums of flux",
    "add_near_chunks": "sums of flux",
    "add_chunk": "sums of flux",
    "list_near": "sums of flux",
    "add_listed": "sums of flux",
    "end_near": "sums of flux",
    "add_reflected": "sums of flux",
    "add_record": "sums of flux",
    "begin_sums": "sums of flux",
    "end_sums": "sums of flux",
    "estimate_hit": "sums of flux",
    "estimate_by_selection": "hits in, estimates out",
}
KERNEL_PREFIX = "_pocl_kernel_"  # PoCL's names of a kernel: this, and "_workgroup..." behind


class NoProfile(Exception):
    """Why there can be none."""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="tiny sizes: a smoke test")
    parser.add_argument("-o", "--output", type=pathlib.Path)
    parser.add_argument("--benches", type=pathlib.Path, default=ROOT / "build/release/bench",
                        help="folder of photile_profiled_estimate")
    return parser.parse_args()


def record(command, folder):
    """Runs the command under perf; returns (file of samples, begin and end of what counts)."""
    data = folder / "perf.data"
    environment = dict(os.environ, POCL_CACHE_DIR=str(folder), POCL_EXTRA_BUILD_FLAGS="-g")
    run = subprocess.run(
        ["perf", "record", "-e", "cpu-clock", "-F", str(SAMPLES_PER_SECOND), "-k", "CLOCK_MONOTONIC",
         "-o", data, "--", *command], env=environment, capture_output=True, text=True, check=False)
    if not data.exists() or data.stat().st_size == 0:
        raise NoProfile("perf may not sample here: " + run.stderr.strip().splitlines()[0])
    if run.returncode != 0:
        sys.exit(f"bench/kernels/profile.py: error: {run.stderr.strip()}")
    begin, end = (float(value) for value in run.stdout.split())
    return data, begin, end


def samples(data, begin, end):
    """(symbol, offset in it, shared object) of each sample between the two times."""
    text = subprocess.run(["perf", "script", "-i", data, "-F", "time,ip,sym,symoff,dso"],
                          capture_output=True, text=True, check=True).stdout
    for line in text.splitlines():
        time, _, rest = line.strip().partition(": ")
        if not begin <= float(time) <= end:
            continue
        where, _, shared_object = rest.rpartition(" (")
        symbol, _, offset = where.strip().partition(" ")[2].rpartition("+0x")
        yield symbol, int(offset, 16) if symbol else 0, shared_object.rstrip(")")


def functions_at(shared_object, places):
    """The functions inlined at each (symbol, offset), innermost first."""
    table = subprocess.run(["nm", shared_object], capture_output=True, text=True, check=True).stdout
    address = {line.split()[2]: int(line.split()[0], 16)
               for line in table.splitlines() if len(line.split()) == 3}
    known = [place for place in places if place[0] in address]
    requested = sorted({address[symbol] + offset for symbol, offset in known})
    answer = subprocess.run(["addr2line", "-a", "-f", "-i", "-e", shared_object],
                            input="\n".join(hex(a) for a in requested), capture_output=True,
                            text=True, check=True).stdout
    inlined = collections.defaultdict(list)
    current = None
    for index, line in enumerate(answer.splitlines()):
        if line.startswith("0x"):
            current, first = int(line, 16), index
        elif (index - first) % 2 == 1:  # function names and source lines take turns
            inlined[current].append(line)
    return {(symbol, offset): inlined[address[symbol] + offset] + [symbol]
            for symbol, offset in known}


def stage_of(functions):
    for function in functions:
        name = function
        if name.startswith(KERNEL_PREFIX):
            name = name[len(KERNEL_PREFIX):].partition("_workgroup")[0]
        if name in STAGES:
            return STAGES[name]
    return functions[-1]


def stages(folder, data, begin, end):
    """Samples by stage; compiled kernels are below the folder."""
    counts = collections.Counter()
    in_kernels = collections.defaultdict(collections.Counter)
    for symbol, offset, shared_object in samples(data, begin, end):
        if pathlib.Path(shared_object).is_relative_to(folder):
            in_kernels[shared_object][symbol, offset] += 1
        elif "kernel" in shared_object:
            counts["operating system"] += 1
        else:
            counts["host: transfers, OpenCL runtime"] += 1
    for shared_object, places in in_kernels.items():
        functions = functions_at(shared_object, places)
        for place, count in places.items():
            counts[stage_of(functions.get(place, [place[0]]))] += count
    return counts


def profile(options):
    if not shutil.which("perf") or not shutil.which("addr2line"):
        raise NoProfile("perf is not installed (Debian packages linux-perf and binutils)")
    rows = []
    for name, case in CASES:
        if "classroom" in case and not (SHARED / "classroom").is_dir():
            continue
        with tempfile.TemporaryDirectory(prefix="photile-profile-") as folder:
            command = [options.benches / "photile_profiled_estimate", *case,
                       *(QUICK if options.quick else [])]
            counts = stages(folder, *record(command, pathlib.Path(folder)))
        total = sum(counts.values())
        shares = {stage: count / total for stage, count in counts.most_common()}
        rows.append({"case": name, "samples": total, "shares": shares})
        print(json.dumps(rows[-1]), flush=True)
    return rows


def main():
    options = arguments()
    result = {"bench": "profile", "settings": {"quick": options.quick}, "results": []}
    try:
        result["results"] = profile(options)
    except NoProfile as reason:
        result["missing"] = str(reason)
        print(f"no profile: {reason}")
    if options.output:
        options.output.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
