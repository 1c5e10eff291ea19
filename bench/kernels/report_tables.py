"""Tables of docs/benchmarks.md."""

REFERENCE = "nanoflann"
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


def knn_text():
    return """
Microseconds a query; all hardware threads, the same queries, in the order of the renderer: by oriented
face, then along a Morton curve. All find the k nearest photons within R (`automatic_radius`,
twice the median distance to the k-th) on surfaces whose normals agree, and sum the flux of k - 1 over
the disc, per light. Maps are those of `--set maps=auto`, the default.

- Times on the device are those of `Estimator::estimate`: transfers in and out are in them.
- `nanoflann` is a 3D tree over all photons with leaves of 10 and its own result set,
  `nanoflann-heap` the same with a heap, `nanoflann-morton` with queries in Morton order over the
  whole scene. `embree` is rtcPointQuery with a heap. They are compiled with `-march=native`.
- *plane*: two triangles, uniform photons, 524,288 queries. Interiors: traced photons, the primary
  hits of the camera at 512 x 512, every surface diffuse. Slow cases answer every 2nd, 4th, ... block
  of 256 queries.
- Every run compares results with nanoflann's and fails where one differs: irradiance on the plane
  (within 0.01%), elsewhere the distance to the k-th photon.

The ratio is nanoflann's time over that of the row: more is better, below 1 is slower."""


PRODUCT_MAPS = "auto"  # of the setting maps; other rows show what it saves


def maps_label(row, key="maps of"):
    """What to add to the name of a row whose maps are not the default's, or ""."""
    return "" if row[key] == PRODUCT_MAPS else f", maps of each {row[key]}"


def near_target(photons):
    """Whether it is the number of photons that targets speak of; traced ones are about as many."""
    return abs(photons - TARGET_PHOTONS) <= 0.05 * TARGET_PHOTONS


def knn(result):
    """The tables of a million photons; those of other numbers are in the plots and the data."""
    parts = []
    rows = result["results"]
    for workload in dict.fromkeys(row["workload"] for row in rows):
        counts = list(dict.fromkeys(r["photons"] for r in rows if r["workload"] == workload))
        photons = next((count for count in counts if near_target(count)), max(counts))
        chosen = [r for r in rows if r["workload"] == workload and r["photons"] == photons]
        parts.append(f"**{workload}, {photons:,} photons**\n\n" + knn_table(chosen))
    return "\n\n".join(parts)


def seconds_per_query(row):
    return row["seconds"]["median"] / row["queries"]


def knn_table(rows):
    ks = sorted({row["k"] for row in rows})
    by_key = {(row["structure"], row["k"]): row for row in rows}
    lines = []
    for structure in dict.fromkeys(row["structure"] for row in rows):
        cells = [structure]
        for k in ks:
            row = by_key.get((structure, k), {})
            if "seconds" not in row:
                cells += ["failed" if "failure" in row else "", ""]
                continue
            ratio = seconds_per_query(by_key[REFERENCE, k]) / seconds_per_query(row)
            cells += [times(row["seconds"], 1e6 / row["queries"]), figure(ratio)]
        lines.append(cells)
    header = ["structure"]
    for k in ks:
        header += [f"k = {k}", "ratio"]
    return table(header, lines)


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


def frame(result):
    rows = []
    for row in result["results"]:
        total = row["total"]["median"]
        cells = [f"{row['width']} x {row['height']}{maps_label(row, 'maps')}"]
        for stage in ("primary hits", "estimate", "film"):
            cells += [times(row[stage]), f"{100 * row[stage]['median'] / total:.0f}%"]
        rows.append([*cells, times(row["total"]), f"{1 / total:.1f}"])
    settings = result["settings"]
    text = (f"The living room, diffuse, {settings['lights']} lights, {settings['photons']:,} photons, "
            f"k = {settings['k']}, one sample a pixel; photon maps stay. Milliseconds and shares.")
    return text + "\n\n" + table(["size", "primary hits", "", "estimate", "", "film", "", "total",
                                  "frames a second"], rows)


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
