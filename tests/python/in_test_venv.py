"""Runs files of tests by the virtual environment that cmake/fetch.sh test-packages makes, which has numpy 2
and the libraries of Honeybee and IFC. Where there is none it says so, and ends as CTest's skips do.

    in_test_venv.py ENVIRONMENT-FOLDER NAME...
"""

import subprocess
import sys
from pathlib import Path

environment = Path(sys.argv[1])
if not (environment / "complete").exists():
    print("skipped: no numpy 2, honeybee-radiance and ifcopenshell; cmake/fetch.sh test-packages brings them")
    sys.exit(77)
python, run = environment / "bin" / "python", Path(__file__).with_name("run.py")
sys.exit(max(subprocess.run([python, run, f"{name}_test.py"]).returncode for name in sys.argv[2:]))
