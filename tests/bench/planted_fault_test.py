#!/usr/bin/python3
"""Every bench that times an estimate notices one that is wrong: with 17 times the flux each ends with
exit code 1 and a line, and without with 0.

    planted_fault_test.py FOLDER_OF_BENCHES
"""

import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
FILE, RIGHT, WRONG = "estimate/estimate_hit.clh", "1.0f / area", "17.0f / area"
GRID = ("--structure", "uniform-grid")


def fail(text):
    sys.exit(f"planted_fault_test.py: error: {text}")


def write_points(file, count, seed):
    dice = random.Random(seed)
    file.write_text("".join(f"{dice.random()},{dice.random()},0\n" for _ in range(count)))


def run(command, kernels):
    extra = ["--kernel", kernels] if kernels else []
    return subprocess.run([*command, *extra], capture_output=True, text=True, check=False)


def main():
    benches = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        kernels = folder / "kernels"
        shutil.copytree(SOURCE / "kernels", kernels)
        text = (kernels / FILE).read_text()
        if text.count(RIGHT) != 1:
            fail(f"{FILE} has {RIGHT!r} {text.count(RIGHT)} times, not once")
        (kernels / FILE).write_text(text.replace(RIGHT, WRONG))
        photons, queries = folder / "photons.csv", folder / "queries.csv"
        write_points(photons, 2000, 1)
        write_points(queries, 100, 2)
        cases = [("knn", "--workloads", "plane", *GRID), ("knn", "--workloads", "living-room", *GRID),
                 ("knn", "--points", photons, "--queries", queries, *GRID),
                 ("strategies",), ("kernels",), ("paper",), ("area",)]
        for name, *options in cases:
            command = [benches / f"photile_bench_{name}", "--quick", *options]
            right, wrong = run(command, None), run(command, kernels)
            if right.returncode != 0:
                fail(f"{command}: exit code {right.returncode}: {right.stderr}")
            if wrong.returncode != 1 or "differ from the search in double precision" not in wrong.stderr:
                fail(f"{command} with 17 times the flux: exit code {wrong.returncode}: {wrong.stderr}")
    print(f"{len(cases)} benches notice 17 times the flux")


if __name__ == "__main__":
    main()
