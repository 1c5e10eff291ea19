#!/usr/bin/python3
"""What many cores and a card are worth: the default picture of the living room on some of the cores of this machine, and
frames by the paper's method.

    bench/kernels/workstation.py --record NAME [--cores N...] [--card SELECTOR]    # writes results/workstations/NAME.json
    bench/kernels/workstation.py --docs      # writes the tables of docs/measured/cores.md and devices.md from all of these

Kernels come from the cache. With --card the picture is rendered once more with all cores and that device, and
photile_bench_frame, which has to be built, times frames on it.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from kernels.report_tables import table
from tools import measured
from tools.report_section import replace_section

RESULTS = measured.ROOT / "results/workstations"
PAGES = measured.ROOT / "docs/measured"
RELEASE = measured.ROOT / "build/release"
STAGES = ("trace photons", "primary hits", "light maps", "radiance estimate")
SCENE = measured.ROOT / "scenes/living-room/living-room.gltf"
PARTS = ("primary hits", "estimate", "kernels", "film", "total")


def row_of(cores, stats):
    """A row of the record, of what --stats wrote."""
    device = stats["devices"][0]
    name = f"PoCL {device['driver_version'].split('+')[0]}" if device["type"] == "cpu" else device["name"]
    seconds = {stage["stage"]: [round(stage[key], 3) for key in ("seconds", "processor_seconds")]
               for stage in stats["stages"] if stage["stage"] in STAGES}
    return {"cores": cores, "device": name, "seconds": round(stats["total_seconds"], 2),
            "processor seconds": round(stats["total_processor_seconds"], 2), "stages": seconds}


def rendered(folder, cores, device):
    for size in ("16x16", "576x384"):  # the first compiles
        command = ["taskset", "-c", f"0-{cores - 1}", RELEASE / "photile", "render", SCENE, "--device", device,
                   "--size", size, "-o", folder / "room.exr", "--stats", folder / "stats.json", "--quiet"]
        subprocess.run(command, check=True)
    return row_of(cores, json.loads((folder / "stats.json").read_text()))


def frames(folder, device):
    command = [RELEASE / "bench/photile_bench_frame", "--device", device, "--output", folder / "frame.json"]
    subprocess.run(command, check=True)
    return frames_of(json.loads((folder / "frame.json").read_text()))


def frames_of(bench):
    """Median milliseconds of the maps that are the default."""
    return [{"size": f"{row['width']}x{row['height']}", **{part: 1e3 * row[part]["median"] for part in PARTS}}
            for row in bench["results"] if row["maps"] == "auto"]


def record(name, cores, card):
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        now = measured.now()
        result = {"processor": now["machine"], "commit": now["commit"], "date": now["date"],
                  "pictures": [rendered(folder, count, "cpu") for count in cores]}
        if card:
            result["pictures"].append(rendered(folder, max(cores), card))
            result["card"], result["frames"] = result["pictures"][-1]["device"], frames(folder, card)
    RESULTS.mkdir(parents=True, exist_ok=True)
    (RESULTS / f"{name}.json").write_text(json.dumps(result, indent=1) + "\n")


def tables():
    pictures, drawn = [], []
    for file in sorted(RESULTS.glob("*.json")):
        result = json.loads(file.read_text())
        about = [result["processor"], result["date"], result["commit"]]
        for row in result["pictures"]:
            wall, used = row["stages"]["light maps"]
            busy = row["processor seconds"] / row["seconds"] / row["cores"]
            pictures.append([f"{row['cores']}, {row['device']}", f"{row['seconds']:.1f}", f"{row['processor seconds']:.0f}",
                             f"{100 * busy:.0f}%", f"{wall:.1f}", f"{100 * used / wall / row['cores']:.0f}%", *about])
        for row in result.get("frames", []):
            drawn.append([f"{row['size']}, {result['card']}", *(f"{row[part]:.1f}" for part in PARTS), *about])
    where = ["host", "date", "commit"]
    return {"cores.md": table(["cores, device", "wall, s", "processor, s", "busy", "light maps: wall, s", "busy", *where],
                              pictures),
            "devices.md": table(["frame", "rays, ms", "estimate", "of which kernels", "film", "all", *where], drawn)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--record", metavar="NAME")
    parser.add_argument("--cores", type=int, nargs="+", default=[os.cpu_count()])
    parser.add_argument("--card", metavar="SELECTOR")
    parser.add_argument("--docs", action="store_true")
    options = parser.parse_args()
    if options.record:
        record(options.record, options.cores, options.card)
    elif options.docs:
        files = sorted(RESULTS.glob("*.json"), key=lambda file: json.loads(file.read_text())["date"])
        for page, text in tables().items():
            replace_section(PAGES / page, "kernels/workstation.py", text, files[0], card="hosts of many cores and their cards")
    else:
        parser.error("give --record or --docs")


if __name__ == "__main__":
    main()
