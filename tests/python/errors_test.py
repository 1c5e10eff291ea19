"""Errors are those of the command, line by line."""

import os
import subprocess

import pytest

import photile
from photile import converters
from photile.report import command

COMMAND = os.environ["PHOTILE_COMMAND"]


def line_of_the_command(*arguments):
    run = subprocess.run([COMMAND, *map(str, arguments)], stderr=subprocess.PIPE, text=True)
    lines = run.stderr.strip().splitlines()
    return lines[-1].split("error: ", 1)[1]


def test_the_line_of_a_missing_scene(tmp_path):
    file = tmp_path / "missing.obj"
    with pytest.raises(photile.InputError) as error:
        photile.load(file)
    assert str(error.value) == line_of_the_command("info", file)


def test_the_line_of_a_damaged_scene(tmp_path):
    file = tmp_path / "damaged.gltf"
    file.write_text("{")
    with pytest.raises(photile.InputError) as error:
        photile.load(file)
    assert str(error.value) == line_of_the_command("info", file)


def test_the_line_of_a_picture_without_layers(tmp_path):
    file = tmp_path / "a.png"
    scene = photile.Scene([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], lights=[photile.Light("lamp", 1, position=(0.2, 0.2, 1))])
    photile.render(scene, size=(2, 2), quality="draft", photons_emitted=100).save(file)
    with pytest.raises(photile.InputError) as error:
        photile.relight(file)
    assert str(error.value) == line_of_the_command("relight", file)


def test_each_is_an_error_of_python_too():
    assert issubclass(photile.InputError, ValueError)
    assert issubclass(photile.OutputError, OSError)
    assert issubclass(photile.DeviceMemoryError, MemoryError)
    assert issubclass(photile.KernelBuildError, photile.DeviceError)


def test_a_folder_that_is_not_there(tmp_path):
    scene = photile.Scene([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], lights=[photile.Light("lamp", 1, position=(0.2, 0.2, 1))])
    picture = photile.render(scene, size=(2, 2), quality="draft", photons_emitted=100)
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
