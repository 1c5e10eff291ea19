"""``python3 -m photile.report``, or ``python3 FOLDER`` where photile's compiled module is not
installed."""

import importlib
import importlib.util
import pathlib
import sys


def package() -> str:
    """The name of this folder as a package; a separate name where it was started as a folder."""
    if __package__:
        return __package__
    folder = pathlib.Path(__file__).resolve().parent
    spec = importlib.util.spec_from_file_location(
        "photile_report", folder / "__init__.py", submodule_search_locations=[str(folder)])
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return spec.name


if __name__ == "__main__":
    sys.exit(importlib.import_module(f"{package()}.command").main())
