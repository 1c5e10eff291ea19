"""Errors are those of the command, line by line."""

import os
import subprocess

import pytest

import photile
from photile import converters
from photile.report import command

COMMAND = os.environ["PHOTILE_COMMAND"]


@pytest.fixture
def picture(lamps):
    return photile.render(lamps, size=(2, 2), quality="draft", photons_emitted=100)


@pytest.mark.parametrize("name, read, subcommand", [("missing.obj", photile.load, "info"),
                                                    ("damaged.gltf", photile.load, "info"),
                                                    ("without_layers.png", photile.relight, "relight")])
def test_the_line_is_that_of_the_command(tmp_path, picture, name, read, subcommand):
    picture.save(tmp_path / "without_layers.png")
    (tmp_path / "damaged.gltf").write_text("{")
    with pytest.raises(photile.InputError) as error:
        read(tmp_path / name)
    run = subprocess.run([COMMAND, subcommand, tmp_path / name], stderr=subprocess.PIPE, text=True)
    assert str(error.value) == run.stderr.strip().splitlines()[-1].split("error: ", 1)[1]


def test_each_is_an_error_of_python_too():
    assert issubclass(photile.InputError, ValueError)
    assert issubclass(photile.OutputError, OSError)
    assert issubclass(photile.DeviceMemoryError, MemoryError)
    assert issubclass(photile.KernelBuildError, photile.DeviceError)


def test_a_folder_that_is_not_there(tmp_path, picture):
    with pytest.raises(photile.OutputError, match="nowhere"):
        picture.save(tmp_path / "nowhere" / "a.exr")


def test_a_device_that_is_not_there(lamps):
    with pytest.raises(photile.DeviceError, match="no such device"):
        photile.render(lamps, device="no such device")
    assert photile.devices()[0]["name"]


@pytest.mark.parametrize("write", [command.write, lambda file, content: converters.write_files({file: content})])
def test_a_file_that_is_overwritten_keeps_its_permissions(tmp_path, write):
    file = tmp_path / "private.json"
    file.touch(0o600)
    write(file, b"new")
    assert file.read_bytes() == b"new" and file.stat().st_mode & 0o777 == 0o600
