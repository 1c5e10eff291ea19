#!/usr/bin/python3
"""How much of a command's time one thread alone has work, stage by stage, and what that leaves of more cores.

    bench/kernels/parallel.py [--program FILE] [--threads N] [-o FILE.json] [--write] [-- COMMAND OF PHOTILE...]

Without a command it measures those of COMMANDS; --write puts their sums, and the rivals' of docs/measured/quality.md by
their wall seconds, into docs/measured/cores.md. The states of all threads are read every few milliseconds. A thread
that waits for a processor counts as one with work, and so does one of TBB that looks for work and waits for a
processor meanwhile: beside other work on the machine the figures come out too low. The time on n cores is forecast by Amdahl's law: the
processor seconds that were spent while one thread alone was runnable, and the others divided by n. Stages are those
that the command reports on stderr; what it does between them is counted apart.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import measured  # noqa: E402
from tools.report_section import replace_section  # noqa: E402

SECONDS_BETWEEN_SAMPLES = 0.004
CORES = (4, 16, 64)
STAGE = re.compile(r"^([a-z][a-z ]+): ([\d.]+) (s|min)\b")
BETWEEN = "between stages"
# Of docs/measured/quality.md, about as good as `good`.
RIVALS = (("photile", "`--quality good`"), ("photile, paths denoised", "64 spp"), ("Mitsuba, denoised", "128 spp"),
          ("Cycles, denoised", "64 spp"))
LIVING_ROOM = "scenes/living-room/living-room.gltf"
COMMANDS = {
    "living room, good": ["render", LIVING_ROOM, "--size", "288x192"],
    "living room, draft": ["render", LIVING_ROOM, "--size", "288x192", "--quality", "draft"],
    "living room, paths": ["render", LIVING_ROOM, "--size", "288x192", "--integrator", "path"],
    "office by day, good": ["render", "scenes/office/office.gltf", "--size", "288x192", "--sky", "perez=700,120",
                            "--site", "52.5,13.4,1", "--time", "2026-03-21T10:00"],
    "Cornell box, published": ["publish", "scenes/cornell-box/cornell-box.gltf", "--quality", "draft"],
}


def runnable(process):
    """The number of threads that run or wait for a processor."""
    count = 0
    for thread in os.listdir(f"/proc/{process}/task"):
        try:
            state = pathlib.Path(f"/proc/{process}/task/{thread}/stat").read_text(encoding="utf-8")
            count += state[state.rindex(")") + 2] == "R"
        except OSError:
            pass  # the thread has ended
    return count


def processor_seconds(process):
    fields = pathlib.Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def sampled(command):
    """[(time, runnable threads, processor seconds so far)] of a run, and [(stage, begin, end)]."""
    stages, samples, lines = [], [], []
    running = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def read():
        for line in running.stderr:
            lines.append(line)
            stage = STAGE.match(line)
            if stage and "left" not in line:
                now = time.monotonic()
                taken = float(stage[2]) * (60 if stage[3] == "min" else 1)
                stages.append((stage[1], now - taken, now))

    reader = threading.Thread(target=read)
    reader.start()
    while running.poll() is None:
        try:
            samples.append((time.monotonic(), runnable(running.pid), processor_seconds(running.pid)))
        except (OSError, IndexError):
            break  # the process has ended
        time.sleep(SECONDS_BETWEEN_SAMPLES)
    reader.join()
    if running.wait() != 0:
        sys.exit("".join(lines[-5:]))
    return samples, stages


def row_of(name, samples):
    """Seconds of consecutive samples, each of which stands for the time until the next."""
    wall = alone = used = 0.0
    for (begin, threads, before), (end, _, after) in samples:
        wall += end - begin
        alone += after - before if threads <= 1 else 0
        used += after - before
    return forecast(name, wall, used, alone)


def forecast(name, wall, used, alone):
    row = {"stage": name, "wall seconds": wall, "processor seconds": used, "processor seconds of one thread alone": alone}
    for cores in CORES:
        row[f"seconds on {cores} cores"] = alone + max(0.0, used - alone) / cores
    return row


def measure(command):
    samples, stages = sampled(command)
    pairs = list(zip(samples, samples[1:]))
    names = list(dict.fromkeys(stage for stage, _, _ in stages))

    def stage_at(moment):
        return next((stage for stage, begin, end in stages if begin <= moment < end), BETWEEN)

    rows = [row_of(name, [pair for pair in pairs if stage_at(pair[0][0]) == name]) for name in [*names, BETWEEN]]
    return [*rows, row_of("all", pairs)]


def rivals():
    """Rows of the kitchen of docs/measured/quality.md."""
    results = json.loads((measured.ROOT / "docs/measured/quality/quality.json").read_text(encoding="utf-8"))["results"]
    for row in results:
        if row["view"] == "kitchen 256x192" and (row["tool"], row["setting"]) in RIVALS:
            wall, used = row["first"]["seconds"], row["first"]["processor"]
            yield forecast(f"kitchen, {row['tool']}, {row['setting']}", wall, used, max(0.0, 2 * wall - used))


def line(name, row):
    used, alone = row["processor seconds"], row["processor seconds of one thread alone"]
    part = 2 * alone / (used + alone) if used else 0
    return (f"| {name} | {row['wall seconds']:.2f} | {used:.2f} | {alone:.2f} | {part:.1%} |"
            + "".join(f" {row[f'seconds on {cores} cores']:.2f} |" for cores in CORES))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=measured.ROOT / "build/release/photile")
    parser.add_argument("--threads", type=int, default=0, help="of the host; 0 = all cores")
    parser.add_argument("-o", "--output", help="file for all rows")
    parser.add_argument("--write", action="store_true", help="write docs/measured/cores.md")
    parser.add_argument("command", nargs="*", help="of photile, without its output")
    options = parser.parse_args()
    commands = {" ".join(options.command): options.command} if options.command else COMMANDS
    results = []
    print("| command | stage | wall, s | processor, s | of one thread alone | part of the time on 2 cores |"
          + "".join(f" {cores} cores, s |" for cores in CORES))
    print("|---|---|" + "--:|" * (4 + len(CORES)))
    for name, command in commands.items():
        with tempfile.TemporaryDirectory() as folder:
            output = "page.html" if command[0] == "publish" else "picture.exr"
            rows = measure([options.program, *command, "--threads", str(options.threads),
                            "-o", f"{folder}/{output}"])
        for row in rows:
            print(line(f"{name} | {row['stage']}", row), flush=True)
        results.append({"command": name, "rows": rows})
    if options.write:
        head = ("| command | wall, s, on 2 cores | processor, s | of one thread alone | part of the time on 2 cores |"
                + "".join(f" {cores} cores, s |" for cores in CORES))
        rows = [head, "|---|" + "--:|" * (4 + len(CORES)),
                *(line(result["command"], result["rows"][-1]) for result in results),
                *(line(row["stage"], row) for row in rivals())]
        replace_section(measured.ROOT / "docs/measured/cores.md", "kernels/parallel.py", "\n".join(rows))
    if options.output:
        pathlib.Path(options.output).write_text(
            json.dumps({**measured.now(), "cores": os.cpu_count(), "threads": options.threads, "results": results},
                       indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
