#!/usr/bin/python3
"""Says what changed from one JSON file of a bench to another, beyond the noise.

    bench/tools/compare.py BEFORE.json AFTER.json

Rows belong together where all that was not measured in them is the same: workload, structure, number of
photons, k. The samples of a time are paired in their order: those of `bench.py pairs` ran side by side. A time
has changed where so many pairs say so that chance would in one case of 16 at most (the sign test: all of five,
eight of nine); fewer than five pairs decide nothing. The factor is the median of those of the pairs. Where
device and host are one processor, its seconds stand for those that a caller waits. What differs between the
runs (machine, device, driver, settings) comes first, since the times are then those of other things.
"""

import argparse
import json
import math
import pathlib
import statistics
import sys

# What is about a run, and may differ without a time being another's.
ABOUT = ("machine", "device", "versions", "settings", "commit")
# Results that are neither times nor what was measured.
COUNTS = ("references", "nodes", "device bytes", "queries")
LEAST_PAIRS = 5
CHANCE = 1 / 16


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


def with_range(row, name):
    """A time, of one query where there are some: rows that are alike may have answered other numbers of them."""
    scale, unit = (1e6 / row["queries"], "us a query") if row.get("queries") else (1, "s")
    median, least, most = (scale * row[name][part] for part in ("median", "min", "max"))
    return f"{median:.4g} [{least:.4g}, {most:.4g}] {unit}"


def samples_a_query(row, name):
    """The samples of a time: a slow case may have answered fewer queries than its like."""
    time = row[name]
    return [sample / (row.get("queries") or 1) for sample in time.get("samples", [time["median"]])]


def chance(longer, shorter):
    """How likely pairs that differ by noise alone are to agree so well, in either direction."""
    pairs = longer + shorter
    return min(1, 2 * sum(math.comb(pairs, i) for i in range(min(longer, shorter) + 1)) / 2**pairs)


def change(pairs):
    """1 where the second of the pairs is longer beyond the noise, -1 where it is shorter, else 0."""
    longer = sum(second > first for first, second in pairs)
    shorter = sum(second < first for first, second in pairs)
    if longer + shorter < LEAST_PAIRS or chance(longer, shorter) > CHANCE:
        return 0
    return 1 if longer > shorter else -1


def times_of(row, one_processor):
    """The names of the times that count."""
    names = [name for name, value in row.items() if is_time(value)]
    if "processor seconds" not in names:
        return names
    if one_processor:
        return ["processor seconds"]
    return [name for name in names if name not in ("processor seconds", "system seconds")]


def compare(before, after, tells_all=False):
    """Lines that say what changed (`tells_all`: and what did not), the number of times compared, and of those with too
    few pairs."""
    lines, compared, few = [], 0, 0
    rows = {key_of(row): row for row in before["results"]}
    one_processor = (after.get("device") or {}).get("type") == "cpu"
    for row in after["results"]:
        key = key_of(row)
        old = rows.pop(key, None)
        if old is None:
            lines.append(f"only after: {words_of(key)}")
            continue
        for name in times_of(row, one_processor):
            if not is_time(old.get(name)):
                continue
            compared += 1
            pairs = list(zip(samples_a_query(old, name), samples_a_query(row, name)))
            few += len(pairs) < LEAST_PAIRS
            direction = change(pairs)
            ratio = statistics.median([second / first for first, second in pairs if first > 0] or [1])
            told = (f"{words_of(key)}, {name} {with_range(old, name)} -> {with_range(row, name)}, {len(pairs)} pairs")
            if direction != 0:
                lines.append(f"{max(ratio, 1 / ratio):.2f} x {'slower' if direction > 0 else 'faster'}: {told}")
            elif tells_all:
                lines.append(f"within the noise, {ratio:.2f} times: {told}")
    lines += [f"only before: {words_of(key)}" for key in rows]
    return lines, compared, few


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


def compare_files(before_file, after_file, tells_all=False):
    """Prints what `compare` and `differences` found."""
    before, after = read(before_file), read(after_file)
    if before.get("bench") != after.get("bench"):
        sys.exit(f"compare.py: error: {before_file} is of the bench {before.get('bench')}, "
                 f"{after_file} of {after.get('bench')}; compare files of one bench")
    for line in differences(before, after):
        print(f"not the same: {line}")
    lines, compared, few = compare(before, after, tells_all)
    for line in lines:
        print(line)
    changed = sum(" x " in line for line in lines)
    print(f"{changed} of {compared} times changed beyond the noise")
    if few:
        print(f"{few} have fewer than {LEAST_PAIRS} pairs, which decide nothing: use --repeats {LEAST_PAIRS} or "
              "more")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    given = parser.parse_args()
    compare_files(given.before, given.after)


if __name__ == "__main__":
    main()
