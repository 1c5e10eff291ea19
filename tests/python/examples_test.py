"""The scripts in python/examples, and what they print."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"


def run(name, *arguments):
    environment = {**os.environ, "MPLBACKEND": "Agg", "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(
        [sys.executable, ROOT / "python" / "examples" / name, *map(str, arguments)],
        env=environment, stdout=subprocess.PIPE, text=True, check=True,
    ).stdout


def test_own_photons():
    told = run("own_photons.py")
    # 400 lm on 4 m2.
    assert float(re.search(r"within the border: ([0-9.]+) lx", told)[1]) == pytest.approx(100, rel=0.02)
    assert re.search(r"lux: \[ *[0-9.]+ +[0-9.]+ +0\. *\]", told)


def test_nearest_points():
    told = run("nearest_points.py")
    assert re.search(r"found: \[8 [1-7] 0\]", told)  # of 27, and of the eighth of that in a corner
    assert float(re.search(r"nearest: ([0-9.]+)", told)[1]) == pytest.approx(0.554, rel=0.03)


def test_own_scene(tmp_path):
    told = run("own_scene.py", tmp_path)
    assert "absorbed: [1. 1.]" in told  # the room is closed
    assert {file.name for file in tmp_path.iterdir()} == {"room.exr", "room.png", "evening.png"}


def test_relight_sliders(tmp_path):
    told = run("relight_sliders.py", SCENES / "living-room" / "living-room.gltf", tmp_path)
    assert "desk_lamp: 470 lumens" in told and "mixed (240, 320, 3)" in told
    assert (tmp_path / "mood.png").stat().st_size > 1_000


def test_lux_table(tmp_path):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("contourpy")
    run("lux_table.py", SCENES / "living-room" / "living-room.gltf", tmp_path)
    table = pandas.read_csv(tmp_path / "lux.csv")
    assert 24 < len(table) <= 48  # 8 x 6 points, 0.62 m apart, but for those in furniture
    assert "Living room" in (tmp_path / "lux.html").read_text()
    lamps = table.drop(columns=["x", "y", "z", "lux", "error"])
    assert lamps.sum(axis=1).to_numpy() == pytest.approx(table["lux"].to_numpy(), rel=1e-4)
