"""Runs a file of tests by pytest. Without what one of them needs: says so, and ends as CTest's skips do,
unless a test fails."""

import sys
from pathlib import Path

try:
    import numpy  # noqa: F401
    import pytest
except ImportError as missing:
    print(f"skipped: {missing}; apt-get install python3-pytest python3-numpy")
    sys.exit(77)



class Skips:
    """Whether a test was skipped, or a whole file."""

    found = False

    def pytest_runtest_logreport(self, report):
        self.found = self.found or report.skipped

    pytest_collectreport = pytest_runtest_logreport


file = (Path(__file__).parent / sys.argv[1]).resolve()
skips = Skips()
options = ["-q", "-p", "no:cacheprovider", "-rs", f"--rootdir={file.parent}", *sys.argv[2:]]
sys.dont_write_bytecode = True
failed = pytest.main([*options, str(file)], plugins=[skips])
if failed == pytest.ExitCode.NO_TESTS_COLLECTED and skips.found:
    failed = 0
sys.exit(failed or (77 if skips.found else 0))
