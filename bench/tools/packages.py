"""Debian's packages of Python modules that scripts need."""

import importlib.util
import pathlib
import sys

PACKAGES = {"matplotlib": "python3-matplotlib", "numpy": "python3-numpy",
            "OpenImageIO": "python3-openimageio"}


def require(*modules):
    """Ends the script with what to install where a module is missing; called before the imports."""
    missing = [PACKAGES[module] for module in modules if importlib.util.find_spec(module) is None]
    if missing:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: Python's modules of the Debian packages "
                 f"{', '.join(missing)} are missing; install them, and run it with /usr/bin/python3")
