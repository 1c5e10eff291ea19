"""Tables of docs/measured/benchmarks.md."""

import statistics

RIVALS = ("nanoflann", "nanoflann, newer", "embree")
LISTS = ", lists"  # ends the names of rows that list the neighbours
TARGET_PHOTONS = 1_000_000


def table(header, rows):
    """Markdown; the first column is text, the others are numbers."""
    lines = ["| " + " | ".join(header) + " |", "|---|" + "--:|" * (len(header) - 1)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines)


def times(timing, scale=1e3, digits=3):
    """Median (least-largest), in milliseconds unless `scale` says otherwise."""
    low, middle, high = (f"{scale * timing[key]:.{digits}g}" if scale * timing[key] < 1000
                         else f"{scale * timing[key]:,.0f}" for key in ("min", "median", "max"))
    return f"{middle} ({low}-{high})"


def figure(ratio):
    """Two digits, or all before the point."""
    return f"{ratio:.2g}" if ratio < 100 else f"{ratio:.0f}"


def time_name(result):
    """The time that rows are compared by: where device and host are one processor, its seconds."""
    return "processor seconds" if result.get("device", {}).get("type") == "cpu" else "seconds"


def timed(result):
    """The rows of photile_bench_knn that have times, each with the one that counts as its "time"."""
    name = time_name(result)
    return [{**row, "time": row.get(name, row["seconds"])} for row in result["results"] if "seconds" in row]


def samples_a_query(row):
    return [sample / row["queries"] for sample in row["time"]["samples"]]


def ratio(row, base):
    """How many times as long a row takes as another of its case: the median of the rounds, in each of which
    both ran."""
    return statistics.median(a / b for a, b in zip(samples_a_query(row), samples_a_query(base)))


def best_rival(rows, lists=False):
    """Of the rows of one case the rival that takes least; None without any."""
    names = [name + LISTS * lists for name in RIVALS]
    rivals = [row for row in rows if row["structure"] in names]
    return min(rivals, key=lambda row: row["time"]["median"] / row["queries"], default=None)


def knn_text(result):
    versions = result["versions"]
    newer = versions.get("nanoflann, newer")
    given = (f"`nanoflann, newer` is {newer}" if newer else
             "without a newer one beside it (`-DPHOTILE_NANOFLANN=FOLDER`)")
    return f"""
{time_name(result).capitalize().replace("seconds", "microseconds")} for each query. All programs use all hardware threads and
answer the same queries in the order of the renderer: by oriented face, then along a Morton curve. They find the k nearest
photons within R (`automatic_radius`, twice the median distance to the k-th) on surfaces whose normals agree, and sum the
flux of k - 1 of them over the disc, for each light. Maps are those of `--set maps=auto`, the default.

- **Turns**: the programs of a case run in turns, {result["settings"].get("repeats", "some")} times each. A ratio is the median over the turns, so that
  other load slows both sides. Where the device is the processor of the host, times are processor seconds of all threads.
- **Rivals**: photons and queries are in Morton order, normals are read only where they differ, and code is compiled with
  `-march=native`. For nanoflann the fastest of leaves of 10, 20, 32 and 64 photons, with its own result set or with a
  heap, is chosen for each case. `nanoflann` is Debian's {versions.get("nanoflann", "")}, {given}.
  `embree` is rtcPointQuery with a heap.
- **Device**: times are those of `Estimator::estimate`, with the transfers in both directions.
- **Variants**: `uniform-grid-heap` searches the cells of the grid with a heap, `kdtree-2d-radix-N` searches a tree with
  leaves of N photons by the selection of the grid ([structure and selection](#structure-and-selection)).
- **Workloads**: *plane* has two triangles with uniform photons and 524,288 queries. Interiors have traced photons,
  diffuse surfaces, and the primary hits of the camera at 512 x 512. Slow cases answer every 2nd, 4th, ... block of 256
  queries.
- **Check**: at some hits radius and irradiance are compared with a search in double precision. A difference fails the
  bench.

The ratio is the time of the fastest rival of the case over that of the row. Larger is faster."""


PRODUCT_MAPS = "auto"  # of the setting maps; other rows show what it saves


def maps_label(row, key="maps of"):
    """What to add to the name of a row whose maps are not the default's, or ""."""
    return "" if row[key] == PRODUCT_MAPS else f", maps of each {row[key]}"


def near_target(photons):
    """Whether it is the number of photons that targets speak of; traced ones are about as many."""
    return abs(photons - TARGET_PHOTONS) <= 0.05 * TARGET_PHOTONS


def cases_of_a_million(result):
    """{(workload, photons): rows}, those of the number of photons nearest to a million."""
    cases = {}
    for row in timed(result):
        cases.setdefault(row["workload"], {}).setdefault(row["photons"], []).append(row)
    return {(workload, photons): counts[photons] for workload, counts in cases.items()
            for photons in [min(counts, key=lambda count: abs(count - TARGET_PHOTONS))]}


def knn(result):
    """The tables of a million photons; those of other numbers are in the plots and the data."""
    return "\n\n".join(f"**{workload}, {photons:,} photons**\n\n"
                       + knn_table([row for row in rows if LISTS not in row["structure"]])
                       for (workload, photons), rows in cases_of_a_million(result).items())


def knn_table(rows, lists=False):
    """A row a structure; those of a k are one case."""
    cases = {k: [row for row in rows if row["k"] == k] for k in sorted({row["k"] for row in rows})}
    lines = []
    for structure in dict.fromkeys(row["structure"] for row in rows):
        cells = [structure]
        for case in cases.values():
            row = next((row for row in case if row["structure"] == structure), None)
            base = best_rival(case, lists)
            cells += [times(row["time"], 1e6 / row["queries"]) if row else "",
                      figure(1 / ratio(row, base)) if row and base else ""]
        lines.append(cells)
    header = ["structure"]
    for k in cases:
        header += [f"k = {k}", "ratio"]
    return table(header, lines)


def lists(result, python):
    """Tables of lists of neighbours; `python`: what bench/rivals/python_neighbours.py wrote, or None."""
    parts = ["""Lists of the k neighbours, by `Estimator::nearest` for the grid. They stay in the order of the search;
`PhotonCloud::nearest` sorts them by distance on all threads."""]
    for (workload, photons), rows in cases_of_a_million(result).items():
        chosen = [row for row in rows if LISTS in row["structure"]]
        if chosen:
            parts.append(f"**{workload}, {photons:,} photons**\n\n" + knn_table(chosen, True))
    if python:
        versions = ", ".join(f"{name} {version}" for name, version in python["versions"].items())
        parts.append(f"""Python libraries and photile's module, in turns in one process, on the points of the plane
(`bench/rivals/python_neighbours.py`; {versions}). Processor microseconds for each query, and the ratio to photile, which
lists the neighbours with their squared distances, nearest first.""")
        rows = [{**row, "time": row["processor seconds"]} for row in python["results"] if "seconds" in row]
        ks = sorted({row["k"] for row in rows})
        lines = []
        for name in dict.fromkeys(row["structure"] for row in rows):
            cells = [name.removesuffix(LISTS).replace("uniform-grid", "photile")]
            for k in ks:
                case = {row["structure"]: row for row in rows if row["k"] == k}
                cells += [times(case[name]["time"], 1e6 / case[name]["queries"]),
                          figure(ratio(case[name], case["uniform-grid" + LISTS]))]
            lines.append(cells)
        parts.append(table(["", *(head for k in ks for head in (f"k = {k}", "over photile"))], lines))
    return "\n\n".join(parts)


def parts_of_time(result):
    """What a caller of the grid waits for: kernels, and all else."""
    lines = []
    for (workload, _), rows in cases_of_a_million(result).items():
        for row in rows:
            if row["structure"].split(LISTS)[0] != "uniform-grid" or "kernel seconds" not in row:
                continue
            part = {name: 1e9 * row[f"{name}seconds"]["median"] / row["queries"]
                    for name in ("", "kernel ", "processor ", "system ")}
            lines.append([f"{workload}, {row['structure']}, k = {row['k']}",
                          *(f"{value:.0f}" for value in (part[""], part["kernel "], part[""] - part["kernel "],
                                                         part["processor "], part["system "]))])
    return ("Nanoseconds for each query of the grid. *In all* is the time that a caller waits: kernels, and the rest, which "
            "is the host and transfers. *Processor* is the time of all threads. *Operating system* is a part of it, mostly "
            "for memory that is touched for the first time.\n\n" + table(["case", "in all", "kernels", "the rest", "processor", "operating system"], lines))


def variants(result):
    """How nanoflann's leaves and sets compare: times of the trial over those of the best."""
    columns = {}
    for (workload, _), rows in cases_of_a_million(result).items():
        for row in rows:
            if "variants" in row and LISTS not in row["structure"]:
                least = row["variants"][0]["seconds"]
                columns[f"{row['structure']}: {workload}, {row['k']}"] = {
                    one["variant"]: one["seconds"] / least for one in row["variants"]}
    names = sorted({name for column in columns.values() for name in column})
    lines = [[head, *(f"{column[name]:.2f}" for name in names)] for head, column in columns.items()]
    return ("Time of each variant of nanoflann over that of the fastest, on a part of the queries.\n\n"
            + table(["case, k", *names], lines))


def paper(result):
    settings = result["settings"]
    rows = [["the paper, classic, on its GPU", "150", "140", "290", "", "not stated", "not stated"],
            ["the paper, one map per triangle, on its GPU", "14", "140", "154", "", "not stated",
             "not stated"]]
    for row in result["results"]:
        search, total = row["search kernels"]["median"], row["estimate kernels"]["median"]
        integration = f"{1e3 * (total - search):.3g}" if total > search else "not separable"
        rows.append([row["structure"] + maps_label(row), times(row["search kernels"]), integration,
                     times(row["estimate kernels"]), times(row["estimate"]), times(row["maps"]),
                     times(row["groups"]) if "groups" in row else "none"])
    text = (f"Table 1 of Graglia et al. 2012, in milliseconds, on a generated hall: "
            f"{settings['triangles']:,} triangles, {settings['photons']:,} photons, "
            f"{settings['hits']:,} hits. The paper does not state k; here k = {settings['k']}, "
            f"R = {1000 * settings['radius']:.0f} mm. photile searches and sums in one kernel. *kNN* is "
            "another kernel that searches and writes lists, *integration* the difference to the total. Compare *total* "
            "with the paper. Maps of each triangle are those of the paper; the other grids are the default, `--set "
            "maps=auto`. *With transfers* is the time that a caller waits.")
    header = ["", "kNN", "integration", "total", "with transfers", "build", "groups"]
    return text + "\n\n" + table(header, rows)


BUILD_COLUMNS = ("uniform-grid", "kdtree-2d", "kdtree-3d", "kdtree-global",
                 "kdtree-left-balanced", "wide-bvh", "hashed-grid", "nanoflann", "embree",
                 "naive")


def build(result):
    rows = [[f"{row['workload']}, {row['photons']:,}{maps_label(row)}",
             f"{row['references'] / row['photons']:.1f}", f"{row['device bytes'] / 1e6:.0f}",
             times(row["groups"])] + [times(row[name]) if name in row else ""
                                      for name in BUILD_COLUMNS]
            for row in result["results"]]
    text = (f"Milliseconds, with R for k = {result['settings']['k']}. *References* is the number of records in uniform grids for "
            "each photon, with the copies in neighbouring maps. *Groups*, with the time of finding and joining patches, is "
            "needed by all structures but those over all photons. Maps are those of `--set maps=auto`, the default, unless "
            "a row says otherwise. Uniform and hashed grids are built on the device, the other structures on the host, "
            "nanoflann on one thread. *naive* tests each photon with all triangles, on all threads, and is scaled from a "
            "sample of the photons.")
    return text + "\n\n" + table(["workload, photons", "references", "MB", "groups",
                                  *BUILD_COLUMNS], rows)


def relight(result):
    rows = result["results"]
    copy = rows[0]["bytes per second"]
    lines = [[row["operation"], times(row["seconds"]), f"{row['bytes'] / 1e6:.0f}",
              f"{row['bytes per second'] / 1e9:.1f}", f"{100 * row['bytes per second'] / copy:.0f}%"]
             for row in rows]
    settings = result["settings"]
    text = (f"{settings['width']} x {settings['height']}, {settings['lights']} lights. "
            "`combine_layers` reads each layer once and writes the picture, as the window does. `mix_layers`, which makes the "
            "picture of the EXR, also writes each layer and its illuminance at the power of the light, on one thread.")
    return text + "\n\n" + table(["operation", "ms", "MB moved", "GB/s", "of copy"], lines)
