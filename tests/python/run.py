"""Runs a file of tests by pytest. Without pytest or numpy: says so, and ends as CTest's skips do."""

import sys
from pathlib import Path

try:
    import numpy  # noqa: F401
    import pytest
except ImportError as missing:
    print(f"skipped: {missing}; apt-get install python3-pytest python3-numpy")
    sys.exit(77)

folder = Path(__file__).parent
options = ["-q", "-p", "no:cacheprovider", "-rs", f"--rootdir={folder}", *sys.argv[2:]]
sys.dont_write_bytecode = True
sys.exit(pytest.main([*options, str(folder / sys.argv[1])]))
