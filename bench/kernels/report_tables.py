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
             "a newer nanoflann was not at hand: `-DPHOTILE_NANOFLANN=FOLDER` takes its header")
    return f"""
{time_name(result).capitalize().replace("seconds", "microseconds")} a query; all hardware threads, the same queries, in
the order of the renderer: by oriented face, then along a Morton curve. All find the k nearest photons within R
(`automatic_radius`, twice the median distance to the k-th) on surfaces whose normals agree, and sum the flux of k - 1
over the disc, per light. Maps are those of `--set maps=auto`, the default.

- **In turns**: all of a case run once, then all again, {result["settings"].get("repeats", "some")} times. A ratio is the median of those of the rounds, so
  that other programs slow both sides of it; on a device that is the host's processor the seconds are those of the
  processor, of all threads together.
- **Rivals at their best**: photons and queries are in Morton order, normals are looked up only where they differ, code
  is compiled with `-march=native`. Of nanoflann's 3D tree the fastest of leaves of 10, 20, 32 and 64, with its own set
  of results or with a heap, is chosen for each case. `nanoflann` is Debian's {versions.get("nanoflann", "")}, {given}.
  `embree` is rtcPointQuery with a heap.
- Times on the device are those of `Estimator::estimate`: transfers in and out are in them.
- `uniform-grid-heap` has the cells of the grid and a heap, `kdtree-2d-radix-N` a tree with leaves of N and the grid's
  selection: [structure and selection](#structure-and-selection).
- *plane*: two triangles, uniform photons, 524,288 queries. Interiors: traced photons, the primary
  hits of the camera at 512 x 512, every surface diffuse. Slow cases answer every 2nd, 4th, ... block
  of 256 queries.
- Radius and irradiance are compared with a search in double precision at some hits, and where one differs the bench
  fails.

The ratio is the time of the best rival of the case over that of the row: more is better, below 1 is slower."""


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
    parts = ["""The neighbours themselves: of the grid by `Estimator::nearest`. All lists stay in the order of the search;
`PhotonCloud::nearest` sorts its own by distance on all threads."""]
    for (workload, photons), rows in cases_of_a_million(result).items():
        chosen = [row for row in rows if LISTS in row["structure"]]
        if chosen:
            parts.append(f"**{workload}, {photons:,} photons**\n\n" + knn_table(chosen, True))
    if python:
        versions = ", ".join(f"{name} {version}" for name, version in python["versions"].items())
        parts.append(f"""By libraries of Python and photile's module, in turns in one process, on the points of the plane;
`bench/rivals/python_neighbours.py`; {versions}. Processor microseconds a query, and how many times as long as
photile's lists, nearest first, and their squared distances.""")
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
    return ("Nanoseconds a query of the grid: what a caller waits, of which kernels run, and host and transfers take the "
            "rest; seconds of the processor, of which the operating system's are above all memory that is touched for the "
            "first time.\n\n" + table(["case", "in all", "kernels", "the rest", "processor", "operating system"], lines))


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
    return ("The variants of nanoflann, over the best of each case; the trial is on some of the queries.\n\n"
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
            f"R = {1000 * settings['radius']:.0f} mm. photile searches and sums in one kernel, so "
            "*kNN* is another kernel, which only searches and writes out what it found, and "
            "*integration* the difference, where there is one: only *total* is the paper's frame. "
            "Maps of each triangle are the paper's; the other grids are those of the default, "
            "`--set maps=auto`. "
            "*With transfers* is what a caller waits for.")
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
    text = (f"Milliseconds, R for k = {result['settings']['k']}. References are records of the "
            "uniform grids a photon, duplicates in neighbouring maps included; groups, in which "
            "finding and joining patches is counted, come before all maps but the structures over all photons. "
            "Maps are those of `--set maps=auto`, the default, unless a row says otherwise. nanoflann "
            "builds on one thread; uniform and hashed grids are built on the device, the trees of photile on "
            "the host. naive tests each photon with all triangles, on all threads of the host, and is "
            "scaled from a sample of the photons.")
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
            "`combine_layers` reads each layer once and writes the picture: the live path. "
            "`mix_layers`, which makes the EXR's picture, also writes each layer and its illuminance "
            "at the light's power into new memory, on one thread.")
    return text + "\n\n" + table(["operation", "ms", "MB moved", "GB/s", "of copy"], lines)
