#!/usr/bin/python3
"""What several processes cost over one, at equal work on one machine; the table of docs/clusters.md.

    bench/kernels/mpi.py [SCENE=PATHS]... [--ranks 1 2 4 8] [--repeats N] [--write]

Renders each scene by photile on its own, then by mpirun with each number of ranks, with one thread each where there
are as many ranks as cores: processes of one machine share its cores, so that nothing here becomes quicker. Every
figure is of the run whose processor seconds are the median. --write puts the table into docs/clusters.md.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
import OpenImageIO as oiio

ROOT = pathlib.Path(__file__).resolve().parents[2]
PHOTILE = ROOT / "build/release/photile"
PAGE = ROOT / "docs/clusters.md"
BEGIN, END = "<!-- bench/kernels/mpi.py begins -->", "<!-- bench/kernels/mpi.py ends -->"
SETTINGS = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none",
            "OMPI_MCA_btl": "self,vader", "OMPI_MCA_plm": "isolated"}
COLUMNS = ("scene, paths", "quality", "ranks", "processor s", "over one", "seconds", "MB of a rank, most",
           "photons sent of stored", "bytes sent a stored photon", "bytes a hit sent", "MB sent",
           "photons held, largest over mean", "same bits")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=["scenes/living-room/living-room.gltf=4M"])
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 4, 8])
    parser.add_argument("--qualities", nargs="+", default=["draft", "hits", "good"])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--write", action="store_true")
    return parser.parse_args()


def picture(file):
    return oiio.ImageBuf(str(file)).get_pixels(oiio.FLOAT)


def measured(scene, paths, quality, ranks, folder):
    """A run; 0 ranks: photile on its own."""
    record, file = folder / "record.json", folder / f"{quality}.{ranks}.exr"
    words = [str(PHOTILE), "render", str(ROOT / scene), "-o", str(file), "--photons", paths, "--set", "passes=1",
             "--size", "256x192", "--stats", str(record), "-q"]
    words += ["--quality", "draft", "--set", "light_maps=off"] if quality == "hits" else ["--quality", quality]
    cores = len(os.sched_getaffinity(0))
    words += ["--threads", str(max(1, cores // max(1, ranks)))]
    if ranks > 0:
        words = ["mpirun", "-n", str(ranks)] + words
    begin = time.monotonic()
    process = subprocess.Popen(words, env=os.environ | SETTINGS)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"mpi.py: error: {' '.join(words)}: ended with {process.returncode}")
    content = json.loads(record.read_text())
    stages = {stage["stage"]: stage for stage in content["stages"]}
    return {"seconds": time.monotonic() - begin, "processor": usage.ru_utime + usage.ru_stime, "file": file,
            "memory": content["peak_host_bytes"], "stored": content["photons_stored"],
            "stages": {name: stage["seconds"] for name, stage in stages.items()},
            "exchange": stages.get("exchange", {}).get("figures", {})}


def row_of(scene, paths, quality, ranks, run, one, first):
    figures = run["exchange"]
    alone = ranks == 0
    memory = run["memory"] if alone else figures["host bytes of a process, most"]
    # Estimates at hits have an order of their own where processes share them.
    expected = first if quality == "hits" else one
    same = "" if alone or run is expected else str(bool(np.array_equal(picture(run["file"]), picture(expected["file"]))))
    sent = {} if alone else {
        "photons": f"{figures['photons sent'] / run['stored']:.2f}",
        "photon": f"{figures['bytes sent per stored photon']:.1f}",
        "hit": f"{figures['bytes per hit sent']:.1f}" if figures["hits sent"] else "-",
        "all": f"{figures['bytes sent'] / 1e6:.0f}",
        "balance": f"{figures['photons held, largest over mean']:.2f}"}
    return [f"{pathlib.Path(scene).stem}, {paths}", quality, "none" if alone else str(ranks),
            f"{run['processor']:.1f}", f"{run['processor'] / one['processor']:.2f}", f"{run['seconds']:.1f}",
            f"{memory / 1e6:.0f}", *(sent.get(name, "-") for name in ("photons", "photon", "hit", "all", "balance")),
            {"True": "yes", "False": "NO", "": "-"}[same]]


def main():
    options = arguments()
    lines = ["| " + " | ".join(COLUMNS) + " |", "| --- | --- |" + " --: |" * (len(COLUMNS) - 2)]
    print("\n".join(lines))
    with tempfile.TemporaryDirectory() as name:
        for word in options.scenes:
            scene, paths = word.rsplit("=", 1)
            for quality in options.qualities:
                one = first = None
                for ranks in (0, 1):  # kernels are compiled
                    measured(scene, "20k", quality, ranks, pathlib.Path(name))
                for ranks in [0, *options.ranks]:
                    runs = [measured(scene, paths, quality, ranks, pathlib.Path(name)) for _ in range(options.repeats)]
                    middle = statistics.median_low([run["processor"] for run in runs])
                    run = next(run for run in runs if run["processor"] == middle)
                    one = one or run
                    if ranks > 0:
                        first = first or run
                    lines.append("| " + " | ".join(row_of(scene, paths, quality, ranks, run, one, first)) + " |")
                    print(lines[-1], flush=True)
                    print({stage: round(seconds, 2) for stage, seconds in run["stages"].items()}, run["exchange"],
                          file=sys.stderr, flush=True)
    if options.write:
        text = PAGE.read_text()
        before, rest = text.split(BEGIN)
        PAGE.write_text(before + BEGIN + "\n" + "\n".join(lines) + "\n" + END + rest.split(END)[1])


main()
