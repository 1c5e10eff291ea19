"""What was aimed at, and what the results say."""

from kernels.report_kernels import ESTIMATE, build_bytes, estimate_cost
from kernels.report_tables import LISTS, PRODUCT_MAPS, best_rival, near_target, ratio, table, timed

BEST = "the best rival"


def speedup(results, workload, k, rival, lists=False):
    """How many times as long a rival takes as the grid at a million photons, or None."""
    case = {row["structure"]: row for row in timed(results["knn"])
            if (row["workload"], row["k"]) == (workload, k) and near_target(row["photons"])}
    ours = case.get("uniform-grid" + LISTS * lists)
    theirs = best_rival(case.values(), lists) if rival == BEST else case.get(rival)
    return ratio(theirs, ours) if ours and theirs else None


def speedup_at_the_limits(results, workload, k, rival, lists=False):
    """What the speedup would be if a hit took what the sum in docs/kernels/cost.md takes at the limits of
    the device, all cores busy; None where nothing was measured."""
    if results["knn"]["device"]["type"] != "cpu":
        return None
    case = {row["structure"]: row for row in timed(results["knn"])
            if (row["workload"], row["k"]) == (workload, k) and near_target(row["photons"])}
    theirs = best_rival(case.values(), lists) if rival == BEST else case.get(rival)
    if not theirs:
        return None
    limits = results["kernels"]["settings"]["limits"]
    size, operations = estimate_cost(k)
    floor = max(size / limits["cached bytes per second"],
                operations / limits["operations per second"])
    cores = results["knn"]["device"]["compute units"]
    return theirs["time"]["median"] / theirs["queries"] / (cores * floor)


def speedups(results):
    """(what, ratio or None, the ratio at the limits or None, least, workload, k) for each pair."""
    cases = [("plane", 50, BEST, 18), ("plane", 200, BEST, 35), ("plane", 1000, BEST, 50),
             ("living-room", 50, BEST, 10), ("living-room", 200, BEST, 25),
             ("classroom", 50, BEST, 10), ("classroom", 200, BEST, 25),
             ("plane", 50, "kdtree-2d", 4), ("plane", 50, "kdtree-3d", 10),
             ("plane", 50, "kdtree-global", 10), ("living-room", 50, "kdtree-2d", 4),
             ("living-room", 50, "kdtree-3d", 10), ("living-room", 50, "kdtree-global", 10)]
    for workload, k, rival, least in cases:
        yield (f"{workload}, 1M photons, k = {k}: times faster than {rival}",
               speedup(results, workload, k, rival),
               speedup_at_the_limits(results, workload, k, rival), least, workload, k)
    for workload in ("plane", "living-room"):
        yield (f"{workload}, 1M photons, lists of k = 50: times faster than {BEST}",
               speedup(results, workload, 50, BEST, True),
               speedup_at_the_limits(results, workload, 50, BEST, True), 5, "lists of " + workload, 50)


def verdict(short):
    """`short`: the aim over the result, or the other way round: 1 where it is just reached."""
    if short <= 1:
        return "reached"
    return f"missed by {100 * (short - 1):.1g}%" if short < 1.1 else f"missed by a factor of {short:.2g}"


def at_least(name, value, least, form):
    if value is None:
        return [name, f"at least {form(least)}", "not measured", ""]
    return [name, f"at least {form(least)}", form(value), verdict(least / value)]


def at_most(name, value, most, form):
    if value is None:
        return [name, f"at most {form(most)}", "not measured", ""]
    return [name, f"at most {form(most)}", form(value), verdict(value / most)]


MOST_BUILD = {"plane": 0.25, "living-room": 0.3}  # of nanoflann's index


def build_ratios(results):
    for row in results["build"]["results"]:
        if near_target(row["photons"]) and row["maps of"] == PRODUCT_MAPS:
            ours = row["groups"]["median"] + row["uniform-grid"]["median"]
            yield (f"{row['workload']}, 1M photons: groups and maps over nanoflann's index build",
                   ours / row["nanoflann"]["median"], row["workload"])


def paper_milliseconds(results):
    for row in results["paper"]["results"]:
        if (row["structure"], row["maps of"]) == ("uniform-grid", PRODUCT_MAPS):
            return 1e3 * row["estimate kernels"]["median"]
    return None


def relight_share(results):
    rate = {row["operation"]: row["bytes per second"] for row in results["relight"]["results"]}
    return 100 * rate["combine_layers"] / rate["copy"]


def shares(results, case):
    """The largest stages of a profiled estimate, or "": lists are not profiled."""
    for row in results["profile"]["results"]:
        if row["case"] == case:
            largest = sorted(row["shares"].items(), key=lambda item: -item[1])[:3]
            return ", ".join(f"{stage} {100 * share:.0f}%" for stage, share in largest)
    return ""


def build_shares(results, workload):
    """The largest parts of groups and maps: groups, kernels."""
    k = results["kernels"]["settings"]["k"]
    parts = {f"`{row['kernel']}`": row["seconds"]["median"]
             for row in results["kernels"]["results"]
             if row["measured"] == "kernel" and row["workload"] == workload and row["k"] == k
             and row["kernel"] != ESTIMATE}
    for row in results["build"]["results"]:
        if (row["workload"], row["maps of"]) == (workload, PRODUCT_MAPS) and near_target(
                row["photons"]):
            parts["groups"] = row["groups"]["median"]
    largest = sorted(parts.items(), key=lambda item: -item[1])[:3]
    return ", ".join(f"{name} {1e3 * seconds:.0f} ms" for name, seconds in largest)


def build_at_the_limits(results, workload):
    """Groups as they are and maps at the speed of copying, over nanoflann's index build."""
    limits = results["kernels"]["settings"]["limits"]
    k = results["kernels"]["settings"]["k"]
    moved = sum(build_bytes(row) or 0 for row in results["kernels"]["results"]
                if row["measured"] == "kernel" and row["workload"] == workload and row["k"] == k)
    for row in results["build"]["results"]:
        if (row["workload"], row["maps of"]) == (workload, PRODUCT_MAPS) and near_target(
                row["photons"]):
            return ((row["groups"]["median"] + moved / limits["copied bytes per second"])
                    / row["nanoflann"]["median"])
    return None


def start_seconds(results):
    """(slowest kernel to compile, start with compiled kernels), medians, of all variants. A kernel
    is compiled in its program: the slowest program is added to the slowest kernel."""
    rows = results["startup"]["results"]
    compiled = max(sum(max(timing["median"] for timing in row[kind].values())
                       for kind in ("programs", "kernels"))
                   for row in rows if row["cache"] == "empty")
    started = max(row["open"]["median"] + row["prepare"]["median"] for row in rows
                  if row["cache"] == "full")
    return compiled, started


def million_triangle_groups(results):
    """Seconds of the groups of the largest mesh of about a million triangles, or None."""
    for row in results.get("scale", {}).get("results", []):
        if "failure" not in row and 0.9e6 < row["triangles"] < 2e6:
            return next(stage["seconds"] for stage in row["stages"]
                        if stage["stage"] == "neighbour groups")
    return None


def table_rows(results):
    """[what, aim, result, verdict, result at the limits of the device, where the time goes] each."""
    def times(x):
        return f"{x:.3g} x"

    def seconds(x):
        return f"{x:.2g} s"
    rows = []
    for name, faster, limit, least, workload, k in speedups(results):
        rows.append(at_least(name, faster, least, times)
                    + ["" if limit is None else times(limit), shares(results, f"{workload}, k = {k}")])
    for name, share, workload in build_ratios(results):
        limit = build_at_the_limits(results, workload)
        rows.append(at_most(name, share, MOST_BUILD[workload], times)
                    + ["" if limit is None else times(limit), build_shares(results, workload)])
    rows.append(at_most("the paper's frame, kNN and integration", paper_milliseconds(results), 50,
                        lambda x: f"{x:.3g} ms") + ["", shares(results, "the paper's frame")])
    rows.append(at_least("relighting, of copy bandwidth", relight_share(results), 60,
                         lambda x: f"{x:.0f}%") + ["", ""])
    compiled, started = start_seconds(results)
    rows.append(at_most("the kernel that takes longest to compile", compiled, 2, seconds) + ["", ""])
    rows.append(at_most("a start with compiled kernels: device and kernels", started, 0.1, seconds)
                + ["", "clang's preprocessor: see [starting](#starting)"])
    if "scale" in results:
        rows.append(at_most("groups of a mesh of a million triangles", million_triangle_groups(results),
                            10, seconds) + ["", "see [scale](#scale)"])
    return rows


def write_table(results, provisional):
    """`provisional`: the numbers cannot carry a verdict, so none is given."""
    rows = table_rows(results)
    for row in rows:
        if row[3] == "reached":
            row[4] = row[5] = ""
    if provisional:
        rows = [[name, aim, value, "open" if verdict else "", limit, why]
                for name, aim, value, verdict, limit, why in rows]
    return table(["", "aim", "result", "", "at the limits", "where the time goes"], rows) + """

*At the limits*: the result if a hit of one light among evenly spread photons ran at the
[limits](#beside-the-limits-of-the-device) of the device, and if each kernel of the build moved its bytes as fast as memory
is copied. Groups keep their time."""
