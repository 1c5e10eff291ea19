"""Runs the tests that pass arrays with numpy 2, in a virtual environment that it makes with packages of
PyPI. Where they cannot be had it says so, and ends as CTest's skips do.

    numpy_2.py ENVIRONMENT-FOLDER
"""

import subprocess
import sys
from pathlib import Path

PACKAGES = ["numpy>=2,<3", "pytest"]
TESTS = ["measuring", "photon_maps", "photons", "pictures", "scenes"]

environment = Path(sys.argv[1])
python = environment / "bin" / "python"


def succeeds(*command):
    return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


def has_packages():
    return python.exists() and succeeds(
        python, "-c", "import numpy, pytest, sys; sys.exit(numpy.__version__.split('.')[0] != '2')")


if not has_packages():
    if not succeeds(sys.executable, "-m", "venv", "--clear", environment):
        print("skipped: no virtual environment can be made; apt-get install python3-venv")
        sys.exit(77)
    if not succeeds(python, "-m", "pip", "install", "--quiet", *PACKAGES):
        print("skipped: pip finds no numpy 2; PyPI is not reachable")
        sys.exit(77)
    if not has_packages():
        sys.exit(f"numpy_2.py: {environment} has no numpy 2 after its installation")

run = Path(__file__).with_name("run.py")
sys.exit(max(subprocess.run([python, run, f"{name}_test.py"]).returncode for name in TESTS))
