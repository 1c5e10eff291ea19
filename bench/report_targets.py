"""What was aimed at, and what the results say."""

from report_tables import REFERENCE, near_target, seconds_per_query, table

HOST_SEARCHES = ("nanoflann", "nanoflann-heap", "nanoflann-morton", "embree")


def knn_seconds(results, workload, structure, k):
    """A query's median at a million photons, or None."""
    for row in results["knn"]["results"]:
        if ((row["workload"], row["structure"], row["k"]) == (workload, structure, k)
                and near_target(row["photons"]) and "seconds" in row):
            return seconds_per_query(row)
    return None


def speedups(results):
    """(what, ratio or None, least) for each pair."""
    cases = [("plane", 50, REFERENCE, 20), ("plane", 200, REFERENCE, 40),
             ("living-room", 50, REFERENCE, 10), ("classroom", 50, REFERENCE, 10),
             ("plane", 50, "kdtree-2d", 4), ("plane", 50, "kdtree-3d", 10),
             ("plane", 50, "kdtree-global", 10), ("living-room", 50, "kdtree-2d", 4),
             ("living-room", 50, "kdtree-3d", 10), ("living-room", 50, "kdtree-global", 10)]
    for workload, k, rival, least in cases:
        ours = knn_seconds(results, workload, "uniform-grid", k)
        theirs = knn_seconds(results, workload, rival, k)
        ratio = theirs / ours if ours and theirs else None
        yield f"{workload}, 1M photons, k = {k}: times faster than {rival}", ratio, least


def at_least(name, value, least, form):
    if value is None:
        return [name, f"at least {form(least)}", "not measured", ""]
    verdict = "reached" if value >= least else f"missed by a factor of {least / value:.2g}"
    return [name, f"at least {form(least)}", form(value), verdict]


def at_most(name, value, most, form):
    if value is None:
        return [name, f"at most {form(most)}", "not measured", ""]
    verdict = "reached" if value <= most else f"missed by a factor of {value / most:.2g}"
    return [name, f"at most {form(most)}", form(value), verdict]


def build_ratios(results):
    for row in results["build"]["results"]:
        if near_target(row["photons"]):
            ours = row["groups"]["median"] + row["uniform-grid"]["median"]
            yield (f"{row['workload']}, 1M photons: groups and maps over nanoflann's index build",
                   ours / row["nanoflann"]["median"])


def paper_milliseconds(results):
    for row in results["paper"]["results"]:
        if row["structure"] == "uniform-grid":
            return 1e3 * row["estimate kernels"]["median"]
    return None


def relight_share(results):
    rate = {row["operation"]: row["bytes per second"] for row in results["relight"]["results"]}
    return 100 * rate["combine_layers"] / rate["copy"]


def table_rows(results):
    def times(x):
        return f"{x:.3g} x"
    rows = [at_least(name, ratio, least, times) for name, ratio, least in speedups(results)]
    rows += [at_most(name, ratio, 0.25, times) for name, ratio in build_ratios(results)]
    rows.append(at_most("the paper's frame, kNN and integration", paper_milliseconds(results), 50,
                        lambda x: f"{x:.3g} ms"))
    rows.append(at_least("relighting, of copy bandwidth", relight_share(results), 60,
                         lambda x: f"{x:.0f}%"))
    return rows


def fastest_host_rows(results):
    """How much faster than the best rival of all, which nobody set an aim for."""
    for workload in ("plane", "living-room", "classroom"):
        for k in (50, 200):
            ours = knn_seconds(results, workload, "uniform-grid", k)
            rivals = {name: knn_seconds(results, workload, name, k) for name in HOST_SEARCHES}
            rivals = {name: seconds for name, seconds in rivals.items() if seconds}
            if not ours or not rivals:
                continue
            best = min(rivals, key=rivals.get)
            yield [f"{workload}, 1M photons, k = {k}: times faster than the fastest on the host, "
                   f"{best}", "none", f"{rivals[best] / ours:.3g} x", ""]


def write_table(results, provisional):
    """`provisional`: the numbers cannot carry a verdict, so none is given."""
    rows = table_rows(results)
    if provisional:
        rows = [[name, aim, value, "open" if verdict else ""]
                for name, aim, value, verdict in rows]
    return table(["", "aim", "result", ""], rows + list(fastest_host_rows(results)))
