#!/usr/bin/python3
"""What bench/device_report.sh has found, as a file of results/ and as a page to post; and the table of
docs/measured/devices.md, of all files.

    bench/kernels/report_device.py FOLDER [--name NAME] [--results FOLDER] [--quick]
    bench/kernels/report_device.py --docs     # writes the table of docs/measured/devices.md
    bench/kernels/report_device.py --check    # exits with 1 where it is another one
"""

import argparse
import json
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from kernels import report_kernels
from kernels.report_tables import table
from tools.report_section import read_section, replace_section

RESULTS = ROOT / "results"
PAGE = ROOT / "docs/measured/devices.md"
SCRIPT = "kernels/report_device.py"
# Variables by which a runtime works in another way.
SETTINGS = re.compile(r"(POCL_WORK_GROUP_METHOD|POCL_VECTORIZER\w*|CL_CONFIG_\w+|RUSTICL_ENABLE)=")


def load(file):
    """The JSON of a file, or None where the part that writes it has failed."""
    try:
        return json.loads(file.read_text())
    except (OSError, ValueError):
        return None


def runtime_of(device):
    """Name and version: of PoCL those that its platform states, of others the driver's."""
    pocl = re.search(r"PoCL ([\d.]+)", device["platform_version"])
    return f"PoCL {pocl[1]}" if pocl else f"{device['platform']} {device['driver_version'].split()[-1]}"


def chip_of(device):
    """PoCL puts kind and target before the processor's name."""
    return re.sub(r"^(pthread|basic|cpu-minimal|cpu)-([a-z0-9-]+-(?=[A-Z]))?", "", device["name"]).strip()


def slug(text):
    return re.sub(r"[^a-z0-9.]+", "-", text.lower().replace("(r)", "").replace("(tm)", "")).strip("-")


def verdicts(file):
    """Whether each section of a test passed, else each case: by its name. A run that ended by a signal has told of
    those before."""
    text = file.read_text(errors="replace") if file.exists() else ""
    found = {}
    for case in re.split(r"<TestCase ", text)[1:]:
        sections = re.findall(r'<Section name="([^"]*)".*?<OverallResults successes="\d+" failures="(\d+)"', case, re.DOTALL)
        if sections:
            found.update({name: failures == "0" for name, failures in sections})
        else:
            name = re.match(r'name="([^"]*)"', case)[1]
            found[name] = 'OverallResult success="true"' in case
    return found


def collect(folder, quick):
    """The content of a file of results/: shapes as `page` reads them."""
    devices = load(folder / "device.log")
    if not devices:
        sys.exit(f"report_device.py: error: {folder}/device.log names no device; nothing is written")
    device = next(one for one in devices if one["selected"])
    result = {"schema version": 1, "runtime": runtime_of(device), "quick": quick}
    result["device"] = {name: value for name, value in device.items() if name not in ("id", "selected", "test_result")}
    result["settings"] = sorted(line for line in map("=".join, os.environ.items()) if SETTINGS.match(line))
    result["parts"] = {}
    for file in sorted((folder / "parts").iterdir(), key=lambda file: file.stat().st_mtime):
        name, code, seconds = file.read_text().split()
        result["parts"][name] = {"exit code": int(code), "seconds": int(seconds)}
        if code != "0":
            log = (folder / f"{name}.log").read_text(errors="replace").strip()
            result["parts"][name]["says"] = log.splitlines()[-1][:300] if log else ""
    for name in ("maps", "kinds", "structures"):
        found = verdicts(folder / f"{name}.xml")
        result[name] = {"passed": sum(found.values()), "failed": [case for case in found if not found[case]]}
    if compared := load(folder / "compare.json"):
        result["picture"] = compared["picture"]
    if bench := load(folder / "kernels.json"):
        result.update({name: bench[name] for name in ("date", "commit", "machine")})
        result["limits"] = bench["settings"]["limits"]
        result["structures timed"] = [least(row) for row in report_kernels.rows_of(bench, "structure")]
        result["kernels"] = {row["kernel"]: row["seconds"]["min"] for row in report_kernels.rows_of(bench, "kernel")
                             if (row["workload"], row["k"]) == ("plane", 50)}
    return result


def write(result, file):
    """A line for each member and each structure, so that changes are seen."""
    members = []
    for name, value in result.items():
        if name == "structures timed":
            rows = ",\n  ".join(json.dumps(row) for row in value)
            members.append(f' "{name}": [\n  {rows}]')
        else:
            members.append(f' "{name}": {json.dumps(value)}')
    file.write_text("{\n" + ",\n".join(members) + "\n}\n")


def least(row):
    """A row with the least seconds of each time: what other programs add is not the device's."""
    return {name: least(value) if isinstance(value, dict) and "min" not in value
            else value["min"] if isinstance(value, dict) else value for name, value in row.items()}


def split(times, scale):
    """kernels, transfers, host, processor: of one unit each."""
    host = max(times["all"] - times["kernels"] - times["transfers"], 0)
    return [f"{scale * seconds:.3g}" for seconds in (times["kernels"], times["transfers"], host, times["processor"])]


def structures_table(result):
    lines = []
    for row in result["structures timed"]:
        if "failure" in row:
            lines.append([f"`{row['structure']}`", row["failure"], *[""] * 8])
            continue
        lines.append([f"`{row['structure']}`", f"{row['compile']:.2f}", *split(row["build"], 1e3),
                      *split(row["estimate"], 1e9 / row["hits"])])
    return table(["structure", "compile, s", "build, ms: kernels", "transfers", "host", "processor",
                  "estimate, ns a hit: kernels", "transfers", "host", "processor"], lines)


def kinds_table(result, names):
    """Kinds of kernels by k; an empty cell: it did not come so far."""
    named = {re.fullmatch(r"(.*), k = (\d+)", name): passed for name, passed in names.items()}
    cells = {match.groups(): passed for match, passed in named.items() if match}
    if not cells:
        return "No kernel came to an end."
    ks = sorted({int(k) for _, k in cells})
    return table(["kernel"] + [f"k = {k}" for k in ks],
                 [[kind] + [{True: "right", False: "**wrong**", None: ""}[cells.get((kind, str(k)))] for k in ks]
                  for kind in dict.fromkeys(kind for kind, _ in cells)])


def page(result, folder):
    device = result["device"]
    lines = [f"# photile on {chip_of(device)}, {result['runtime']}", ""]
    facts = {"device": device["name"], "platform": f"{device['platform']}, {device['platform_version']}",
             "driver": device["driver_version"], "OpenCL": device["version"],
             "compute units, clock": f"{device['compute_units']}, {device['clock_mhz']} MHz as the device says",
             "memory": f"{device['global_memory_bytes'] / 2**30:.1f} GiB, {device['max_allocation_bytes'] / 2**30:.1f} GiB "
                       f"a buffer, {device['local_memory_bytes'] >> 10} KiB local",
             "work-groups, lanes": f"up to {device['max_work_group_size']}, {device['lanes'] or 'not told'}",
             "denormals, exact division": f"{device['denormals']}, {device['exact_division']}",
             "settings": ", ".join(f"`{line}`" for line in result["settings"]) or "none",
             "extensions": " ".join(device["extensions"].split())}
    if machine := result.get("machine"):
        facts["host"] = (f"{machine['processor']}, {machine['hardware threads']} threads, load "
                         f"{machine['load average at start']:.1f} before the bench")
        facts["photile"] = f"{result['commit']}, {result['date']}"
    lines += ["| | |", "|---|---|", *(f"| {name} | {value} |" for name, value in facts.items()), ""]
    lines += ["## Parts", "", "| part | ended with | seconds | |", "|---|--:|--:|---|"]
    lines += [f"| {name} | {part['exit code']} | {part['seconds']} | {part.get('says', '')} |"
              for name, part in result["parts"].items()]
    lines += ["", "## Right", "", "Against sums in double precision, with guards before and behind every buffer. "
              f"Maps: {outcome(result['maps'])}. Neighbours in every structure: {outcome(result['structures'])}. "
              f"Picture: {picture_text(result)}.", "", kinds_table(result, verdicts(folder / "kinds.xml"))]
    if result.get("structures timed"):
        structure = result["structures timed"][0]
        lines += ["", "## Time", "", f"A square metre with {structure['photons']:,} photons, {structure['hits']:,} hits, "
                  f"k = {structure['k']}; the least of the repeats. Host: all that is neither kernels nor transfers. Processor: of the host, "
                  "all threads; where that is the device, other programs disturb it least.",
                  "", structures_table(result)]
        bench = load(folder / "kernels.json")
        lines += ["", "## Beside the limits", "", report_kernels.roofline(bench), "", report_kernels.build_kernels(bench)]
    # Links lead nowhere from where the page is posted.
    return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", "\n".join(lines)) + "\n"


def outcome(checked):
    total = checked["passed"] + len(checked["failed"])
    return f"{checked['passed']} of {total}" if total else "not run"


def picture_text(result):
    if "picture" not in result:
        return "not compared"
    error = result["picture"]["relative_error"]
    return "equal" if error == 0 else f"{100 * error:.2g}%"


def docs_table():
    lines = []
    for file in sorted(RESULTS.glob("*.json")):
        result = load(file)
        settings = "".join(f", `{line}`" for line in result["settings"])
        cells = [f"{result['runtime']}{settings}", chip_of(result["device"]),
                 " / ".join(outcome(result[name]) for name in ("maps", "kinds", "structures")), picture_text(result)]
        grid = next((row for row in result.get("structures timed", []) if row["structure"] == "uniform-grid"), {})
        if result["quick"] or "compile" not in grid:
            cells += [""] * 6
        else:
            # A runtime that times no kernels (docs/kernels/runtimes.md) has no limits either.
            timed = grid["estimate"]["kernels"] > 1e-3 * grid["estimate"]["all"]
            copied, operations = (f"{result['limits'][name] / 1e9:.0f}" if timed else ""
                                  for name in ("copied bytes per second", "operations per second"))
            on = "processor" if result["device"]["type"] == "cpu" else "all"
            cells += [f"{grid['compile']:.1f}", f"{1e3 * grid['build'][on]:.0f}",
                      f"{1e9 / grid['hits'] * grid['estimate']['kernels']:.0f}" if timed else "",
                      f"{1e9 / grid['hits'] * grid['estimate'][on]:.0f}", copied, operations]
        lines.append([*cells, result.get("date") or ""])
    return table(["runtime", "device", "right: maps / kinds / structures", "picture beside PoCL's", "compile, s", "build, ms",
                  "a hit, ns: kernels", "all", "copies, GB/s", "1e9 operations/s", "date"], lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, nargs="?")
    parser.add_argument("--name")
    parser.add_argument("--results", type=pathlib.Path, default=RESULTS)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--docs", action="store_true")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    if arguments.check:
        if read_section(PAGE, SCRIPT) != docs_table():
            sys.exit("docs/measured/devices.md: its table is not that of results/; write it by bench/kernels/report_device.py "
                     "--docs")
        return
    if arguments.docs:
        # The block is as old as its oldest row.
        dated = {file: load(file).get("date") for file in RESULTS.glob("*.json")}
        replace_section(PAGE, SCRIPT, docs_table(), min((file for file in dated if dated[file]), key=dated.get),
                        card="NVIDIA H100 and H200")
        return
    if not arguments.folder:
        parser.error("give the folder of a report, --docs or --check")
    result = collect(arguments.folder, arguments.quick)
    name = arguments.name or slug(f"{chip_of(result['device'])}-{result['runtime']}")
    arguments.results.mkdir(parents=True, exist_ok=True)
    write(result, arguments.results / f"{name}.json")
    written = arguments.folder.parent / f"{name}.md"
    written.write_text(page(result, arguments.folder))
    print(f"wrote {arguments.results / name}.json and {written}")


if __name__ == "__main__":
    main()
