#!/usr/bin/python3
"""Says what changed from one JSON file of a bench to another, beyond the noise.

    bench/tools/compare.py BEFORE.json AFTER.json

Rows belong together where all that was not measured in them is the same: workload, structure, number of
photons, k. A time has changed where the ranges of its repeats do not overlap; the factor is that of
the medians. What differs between the runs (machine, device, driver, settings) comes first, since the
times are then those of other things.
"""

import argparse
import json
import pathlib
import sys

# What is about a run, and may differ without a time being another's.
ABOUT = ("machine", "device", "versions", "settings", "commit")
# Results that are neither times nor what was measured.
COUNTS = ("references", "nodes", "device bytes", "queries")


def is_time(value):
    return isinstance(value, dict) and {"median", "min", "max"} <= value.keys()


def key_of(row):
    """What was measured: every plain value but counts of what was found."""
    return tuple(sorted((name, value) for name, value in row.items()
                        if isinstance(value, (str, int)) and name not in COUNTS
                        and not name.endswith("that differ")))


def words_of(key):
    return ", ".join(str(value) if isinstance(value, str) else f"{name} {value}"
                     for name, value in key)


def with_range(time):
    return f"{time['median']:.4g} [{time['min']:.4g}, {time['max']:.4g}]"


def for_as_many_queries(time, of, requested):
    """What as many queries as `requested` has would take: slow cases answer fewer."""
    ratio = requested.get("queries", 1) / (of.get("queries", 1) or 1) if "queries" in of else 1
    return {part: ratio * time[part] for part in ("median", "min", "max")}


def change(before, after):
    """1 where the time is longer beyond the noise, -1 where it is shorter, else 0."""
    if after["min"] > before["max"]:
        return 1
    return -1 if after["max"] < before["min"] else 0


def compare(before, after):
    """Lines that say what changed, and the number of times compared."""
    lines, compared = [], 0
    rows = {key_of(row): row for row in before["results"]}
    for row in after["results"]:
        key = key_of(row)
        old = rows.pop(key, None)
        if old is None:
            lines.append(f"only after: {words_of(key)}")
            continue
        for name, time in row.items():
            if not is_time(time) or not is_time(old.get(name)):
                continue
            compared += 1
            earlier = for_as_many_queries(old[name], old, row)
            direction = change(earlier, time)
            if direction != 0:
                ratio = max(time["median"], earlier["median"]) / min(time["median"],
                                                                     earlier["median"])
                lines.append(f"{ratio:.2f} x {'slower' if direction > 0 else 'faster'}: "
                             f"{words_of(key)}, {name} {with_range(earlier)} -> "
                             f"{with_range(time)} s")
    lines += [f"only before: {words_of(key)}" for key in rows]
    return lines, compared


def differences(before, after):
    """Lines for what the runs have not in common."""
    lines = []
    for part in ABOUT:
        old, new = before.get(part), after.get(part)
        if isinstance(old, dict) and isinstance(new, dict):
            names = [name for name in {**old, **new} if name != "load average at start"]
            lines += [f"{part}, {name}: {old.get(name)} -> {new.get(name)}" for name in names
                      if old.get(name) != new.get(name)]
        elif old != new:
            lines.append(f"{part}: {old} -> {new}")
    return lines


def read(path):
    try:
        content = json.loads(path.read_text())
    except (OSError, ValueError) as error:
        sys.exit(f"compare.py: error: {path}: {error}; give a file that a bench wrote with -o")
    if not isinstance(content, dict) or not isinstance(content.get("results"), list):
        sys.exit(f"compare.py: error: {path}: has no results; give a file that a bench wrote with -o")
    return content


def compare_files(before_file, after_file):
    """Prints what `compare` and `differences` found."""
    before, after = read(before_file), read(after_file)
    if before.get("bench") != after.get("bench"):
        sys.exit(f"compare.py: error: {before_file} is of the bench {before.get('bench')}, "
                 f"{after_file} of {after.get('bench')}; compare files of one bench")
    for line in differences(before, after):
        print(f"not the same: {line}")
    lines, compared = compare(before, after)
    for line in lines:
        print(line)
    changed = sum(" x " in line for line in lines)
    print(f"{changed} of {compared} times changed beyond the noise")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    given = parser.parse_args()
    compare_files(given.before, given.after)


if __name__ == "__main__":
    main()
