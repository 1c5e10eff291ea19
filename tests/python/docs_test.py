"""Documentation and types of what is public."""

import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import photile

PACKAGE = Path(photile.__file__).parent


@pytest.mark.parametrize("name", sorted(photile.__all__))
def test_everything_public_is_documented(name):
    thing = getattr(photile, name)
    if not callable(thing):
        return
    assert inspect.getdoc(thing), name
    if not inspect.isclass(thing) or issubclass(thing, BaseException):
        return
    for member, value in vars(thing).items():
        if not member.startswith("_") and (callable(value) or isinstance(value, property)):
            assert inspect.getdoc(value), f"{name}.{member}"


@pytest.mark.parametrize("name", ["load", "trace", "render", "relight", "measure", "grids", "glare", "daylight",
                                  "sun_hours", "view_out", "write_report", "neighbours", "PhotonMaps", "Scene"])
def test_every_parameter_is_in_the_docstring(name):
    thing = getattr(photile, name)
    text = inspect.getdoc(thing)
    for parameter in inspect.signature(thing).parameters:
        assert re.search(rf"\b{parameter}\b", text), f"{name}: {parameter}"
    assert "Raises\n------" in text


def test_types_are_shipped():
    assert (PACKAGE / "py.typed").exists() and (PACKAGE / "_photile.pyi").exists()


def test_the_types_name_what_the_extension_has():
    types = (PACKAGE / "_photile.pyi").read_text()
    for name, value in vars(photile._photile).items():
        if name.startswith("__"):
            continue
        assert re.search(rf"^(class |def )?{name}\b", types, re.M), name
        for member in vars(value) if inspect.isclass(value) else ():
            if not member.startswith("_"):
                assert re.search(rf"    def {member}\b", types), f"{name}.{member}"


def test_types_agree():
    pytest.importorskip("mypy")
    run = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir=/dev/null", PACKAGE],
                         stdout=subprocess.PIPE, text=True)
    assert run.returncode == 0, run.stdout
