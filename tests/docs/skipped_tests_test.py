#!/usr/bin/python3
"""What cmake/skipped_tests.py says of a run of CTest."""

import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "cmake/skipped_tests.py"
SKIP = '<skipped message="SKIP_RETURN_CODE=77"/>'


def said(*cases):
    with tempfile.TemporaryDirectory() as folder:
        results = pathlib.Path(folder) / "results.xml"
        results.write_text(f"<testsuite>{''.join(cases)}</testsuite>")
        return subprocess.run([SCRIPT, results], capture_output=True, text=True, check=True).stdout


def case(name, skip, output):
    return (f'<testcase name="{name}" status="{"notrun" if skip else "run"}">{SKIP if skip else ""}'
            f"<system-out>{output}</system-out></testcase>")


class SkippedTests(unittest.TestCase):
    def test_each_reason_is_told_with_its_tests(self):
        lines = said(
            case("scene/a", False, "all is well\nskipped: not this"),
            case("publish/a", True, "skipped: no chromium"),
            case("publish/b", True, "skipped: no chromium"),
            case("python/c", True, "sss\nSKIPPED [1] c_test.py:3: could not import 'mypy'\n"),
            case("maps/d", True, "d_test.cpp:3: warning:\n  skipped: no shared scenes"),
            case("maps/e", True, "")).splitlines()
        self.assertEqual(lines[0], "5 of 6 tests were skipped:")
        self.assertEqual(set(lines[1:]), {
            "  publish/a, publish/b: no chromium",
            "  python/c: could not import 'mypy'",
            "  maps/d: no shared scenes",
            "  maps/e: it gives no reason"})

    def test_none(self):
        self.assertEqual(said(case("scene/a", False, "")), "0 of 1 tests were skipped\n")


if __name__ == "__main__":
    unittest.main()
