"""The part of a page of docs/ that a script writes, between two comments, and its record in docs/blocks.json: what the
script has written, of which commit, when and where it was measured, and the files and folders whose later changes make it
old. tests/docs/figures.py refuses a part that is not the one recorded, and one that is old."""

import hashlib
import json
import re

from tools import measured

DOCS = measured.ROOT / "docs"
END = "<!-- end -->\n"
RECORD = re.compile(r"\A\n\*Measured by `bench/[^*]*\*\n")  # below a block of docs/measured
ALL = ["host", "kernels"]
MEASURES = {
    "kernels/kernel_registers.py": ["kernels"],
    "kernels/parallel.py": ["host/renderer", "kernels"],
    "kernels/report.py": ["host/renderer/estimate", "host/renderer/groups", "host/renderer/maps", "kernels"],
    "kernels/report_angle.py": ["host/renderer/groups", "kernels/estimate", "kernels/surface"],
    "kernels/report_area.py": ["kernels/estimate", "kernels/surface"],
    "kernels/report_borders.py": ["host/renderer/surface", "kernels/estimate", "kernels/surface"],
    "kernels/report_device.py": ["host/renderer", "kernels"],
    "kernels/workstation.py": ["host/renderer", "kernels"],
    "lighting/buildings.py": ["host/lighting/measuring", "python/photile"],
    "lighting/daylight.py": ["host/lighting/daylight"],
    "lighting/daylight_hours.py": ["host/lighting/daylight"],
    "lighting/glare.py": ["host/lighting", "host/renderer"],
    "lighting/honeybee.py": ["host/lighting/daylight"],
    "pictures/compare_areas.py": ["host/renderer", "kernels"],
    "pictures/gallery.py": ["host/renderer", "kernels"],
    "pictures/gloss_filter.py": ["host/renderer/render", "host/renderer/trace"],
    "pictures/live_times.py": ["host/apps/publish", "host/apps/serve", "host/apps/view"],
    "pictures/quality.py": ["host/renderer", "kernels"],
    "rivals/radiance.py": ["host/lighting/measuring", "host/renderer"],
}


def begin_of(script):
    return f"<!-- begin: bench/{script} -->\n"


def record_line(script, record):
    """What stands below a block of docs/measured: how, where, of which commit and when it was measured."""
    return (f"\n*Measured by `bench/{script}`, machine: {record['machine']}, commit {record['commit']}, "
            f"{record['date']}.*\n")


def read_section(page, script):
    """What stands between the comments of `script` in the file `page`."""
    return page.read_text().split(begin_of(script))[1].split(END, 1)[0].strip("\n")


def replace_section(page, script, text, results=None, partly=False, card=None):
    """Puts `text` between `<!-- begin: bench/SCRIPT -->` and `<!-- end -->` of the file `page`. It was measured now, or
    when the file `results` was, from which it is drawn; where only part of it is new, it stays as old as it was. `card`
    names devices that not every machine has: each row of the text states its date, and the text does not become old.
    Pages outside of docs/ have no records, and those of docs/measured state theirs."""
    begin = begin_of(script)
    before, rest = page.read_text().split(begin)
    page.write_text(before + begin + "\n" + text + "\n" + END + rest.split(END, 1)[1])
    if DOCS not in page.parents:
        return
    file = DOCS / "blocks.json"
    blocks = json.loads(file.read_text())
    name = f"{page.relative_to(DOCS)}: {script}"
    when = measured.of_file(results) if results else measured.now()
    if partly and name in blocks:
        when = {key: blocks[name][key] for key in when}
    blocks[name] = {"sha256": hashlib.sha256(read_section(page, script).encode()).hexdigest(), **when,
                    "measures": MEASURES.get(script, ALL), **({"card": card} if card else {})}
    file.write_text(json.dumps(dict(sorted(blocks.items())), indent=1) + "\n")
    if page.parent == DOCS / "measured":
        before, rest = page.read_text().split(begin)
        block, rest = rest.split(END, 1)
        page.write_text(before + begin + block + END + record_line(script, blocks[name]) + RECORD.sub("", rest))


def replace_page(page, script, text, results=None):
    """Writes all of `page`, a title and what follows it, as the part of `script`."""
    title, body = text.split("\n", 1)
    page.write_text(f"{title}\n\n{begin_of(script)}{END}")
    replace_section(page, script, body.strip("\n"), results)
