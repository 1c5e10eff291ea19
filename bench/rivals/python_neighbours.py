#!/usr/bin/python3
"""Lists of the k nearest photons by libraries of Python and by photile, in turns, in one process.

    PYTHONPATH=build/release/python bench/rivals/python_neighbours.py [-o FILE.json]

A million uniform points on a plane, as photile_bench_knn has them, and as many queries as it asks; both in
Morton order, and of every library the fastest of several sizes of leaf. Rivals are those of scipy, pykdtree
and open3d that can be imported: install them with pip. Rows are as those of photile_bench_knn
(docs/kernels/points.md); distances are compared with scipy's, and where one differs the exit code is 1.
"""

import argparse
import datetime
import importlib
import importlib.metadata
import json
import os
import pathlib
import platform
import statistics
import sys
import time

import numpy as np

import photile

LEAF_SIZES = (10, 20, 32, 64)
TRIAL = 64  # every so many blocks of queries choose the size of a leaf
ROUNDING, LEAST = 1e-5, 1e-12  # of squared distances in single precision


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--photons", type=int, default=1_000_000)
    parser.add_argument("--queries", type=int, default=524_288)
    parser.add_argument("-k", type=int, nargs="+", default=[50, 200])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    return parser.parse_args()


def plane(count, seed):
    """Uniform on a square metre, in Morton order of 10 bits an axis."""
    points = np.zeros((count, 3), np.float32)
    points[:, :2] = np.random.default_rng(seed).uniform(0, 1, (count, 2))
    code = np.zeros(count, np.uint32)
    for bit in range(10):
        for axis in range(2):
            code |= ((points[:, axis] * 1024).astype(np.uint32) >> bit & 1) << (2 * bit + axis)
    return points[np.argsort(code, kind="stable")]


def scipy_search(points, leaf):
    tree = importlib.import_module("scipy.spatial").cKDTree(points, leafsize=leaf)
    return lambda queries, k, radius: np.square(
        tree.query(queries, k, distance_upper_bound=radius, workers=-1)[0])


def pykdtree_search(points, leaf):
    tree = importlib.import_module("pykdtree.kdtree").KDTree(points, leafsize=leaf)
    return lambda queries, k, radius: tree.query(queries, k, distance_upper_bound=radius, sqr_dists=True)[0]


def open3d_search(points, leaf):
    """It has one size of leaf, and no bound on the distance of k neighbours."""
    if leaf != LEAF_SIZES[0]:
        return None
    core = importlib.import_module("open3d").core
    index = core.nns.NearestNeighborSearch(core.Tensor(points))
    index.knn_index()
    return lambda queries, k, radius: index.knn_search(core.Tensor(queries), k)[1].numpy()


RIVALS = {"scipy": scipy_search, "pykdtree": pykdtree_search, "open3d": open3d_search}


def at_its_best(make, points, queries, k, radius):
    """The fastest search of a library, the least of three tries each; None where it is missing."""
    try:
        searches = [search for search in (make(points, leaf) for leaf in LEAF_SIZES) if search]
    except ImportError:
        return None
    trial = queries[:len(queries) // 256 * 256].reshape(-1, 256, 3)[::TRIAL].reshape(-1, 3)
    return min(searches, key=lambda search: min(processor_seconds(search, trial, k, radius)[0] for _ in range(3)))


def processor_seconds(search, queries, k, radius):
    """(processor seconds of all threads, seconds, answers)"""
    begin, processor = time.monotonic(), time.process_time()
    answers = search(queries, k, radius)
    return time.process_time() - processor, time.monotonic() - begin, answers


def timing(samples):
    return {"median": statistics.median(samples), "min": min(samples), "max": max(samples),
            "samples": samples}


def measure(points, queries, k, repeats):
    """Rows of one k, and how many distances differ from scipy's."""
    maps = photile.PhotonMaps(points, neighbours=k)
    searches = {"uniform-grid, lists": lambda queries, k, radius: maps.nearest(queries, k=k).squared_distance}
    for name, make in RIVALS.items():
        searches[f"{name}, lists"] = at_its_best(make, points, queries, k, maps.radius)
    samples, answers = {name: [] for name in searches}, {}
    for turn in range(repeats + 1):
        for name, search in searches.items():
            if search is None:
                continue
            *seconds, answers[name] = processor_seconds(search, queries, k, maps.radius)
            if turn > 0:  # the first compiles, and touches memory for the first time
                samples[name].append(seconds)
    rows, different = [], 0
    for name, taken in samples.items():
        row = {"workload": "plane", "structure": name, "photons": len(points), "k": k, "radius": maps.radius,
               "queries": len(queries)}
        if not taken:
            rows.append({**row, "failure": "cannot be imported"})
            continue
        row["processor seconds"], row["seconds"] = (timing(list(part)) for part in zip(*taken))
        truth = answers.get("scipy, lists")
        if truth is not None:
            within = np.isfinite(truth)  # open3d goes on beyond the radius
            row["distances that differ"] = int(np.sum(~np.isclose(answers[name][within], truth[within],
                                                                  rtol=ROUNDING, atol=LEAST)))
            different += row["distances that differ"]
        rows.append(row)
    return rows, different


def main():
    given = arguments()
    points, queries = plane(given.photons, 1), plane(given.queries, 3)
    record = {"schema version": 2, "bench": "python_neighbours", "date": str(datetime.date.today()),
              "machine": {"processor": processor_name(), "hardware threads": os.cpu_count(),
                          "load average at start": os.getloadavg()[0]},
              "settings": {"quick": False, "repeats": given.repeats},
              "versions": {"python": platform.python_version(), "numpy": np.__version__}, "results": []}
    for name in RIVALS:
        try:
            record["versions"][name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            pass
    different = 0
    for k in given.k:
        rows, wrong = measure(points, queries, k, given.repeats)
        different += wrong
        for row in rows:
            print(json.dumps({name: value["median"] if isinstance(value, dict) else value
                              for name, value in row.items()}), flush=True)
        record["results"] += rows
    if given.output:
        given.output.write_text(json.dumps(record, indent=1) + "\n")
    if different:
        sys.exit(f"python_neighbours.py: {different} distances are not scipy's")


def processor_name():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


if __name__ == "__main__":
    main()
