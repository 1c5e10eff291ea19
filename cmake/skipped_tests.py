#!/usr/bin/python3
"""Says how many tests of a run were skipped, and why: a line for each reason.

    cmake/skipped_tests.py RESULTS     (of ctest --output-junit RESULTS)
"""

import re
import sys
import xml.etree.ElementTree as tree

# As tests of C++, of scripts and of pytest say it.
REASON = re.compile(r"^\s*skipped: *(.+)|^SKIPPED \[\d+\] [^ ]+ (.+)", re.MULTILINE)


def skipped(results):
    """The names of skipped tests by their reasons, and the number of all tests."""
    cases = tree.parse(results).findall(".//testcase")
    names = {}
    for case in cases:
        if case.find("skipped") is None:
            continue
        found = REASON.findall(case.findtext("system-out", ""))
        reasons = {(one or other).strip() for one, other in found} or {"it gives no reason"}
        names.setdefault("; ".join(sorted(reasons)), []).append(case.get("name"))
    return names, len(cases)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    names, count = skipped(sys.argv[1])
    print(f"{sum(map(len, names.values()))} of {count} tests were skipped" + (":" if names else ""))
    for reason, tests in sorted(names.items()):
        print(f"  {', '.join(tests)}: {reason}")


if __name__ == "__main__":
    main()
