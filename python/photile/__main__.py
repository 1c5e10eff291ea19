"""``python3 -m photile COMMAND ...``, or ``python3 FOLDER COMMAND ...`` where photile's compiled module is not
installed: ``photile import``, ``layout`` and ``outlook`` start it."""

import importlib
import sys
import types

if __name__ == "__main__":
    if not __package__:  # started as a folder: a package without what __init__.py needs
        package = types.ModuleType("photile")
        own = sys.path.pop(0)
        package.__path__ = [own, *(f"{folder}/photile" for folder in sys.path)]  # the module lies elsewhere
        sys.modules[package.__name__] = package
    command, modules = sys.argv[1:2], {"import": "importing", "layout": "layout", "outlook": "outlook_command"}
    if not command or command[0] not in modules:
        sys.exit(f"photile: error: name a command: {', '.join(modules)}")
    sys.exit(importlib.import_module("photile.command_line").exit_code(
        lambda: importlib.import_module(f"photile.{modules[command[0]]}").main(sys.argv[2:])))
