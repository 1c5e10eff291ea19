"""Honeybee's files of records that are known."""

import io
import json
import pathlib

import numpy as np

from conftest import grid_of
from photile_report import honeybee

HOURS = 8760


def test_each_grid_has_a_res_of_its_own_listed_in_grids_info():
    desk = {**grid_of("desk 1", [250.5, 500], 2, 1), "identifier": "desk_1"}
    desk["blank"] = [{"reason": "inside a solid", "before": 1}]
    floor = {**grid_of("floor", [100], 1, 1), "identifier": "floor"}
    files = dict(honeybee.files({"grids": [desk, floor]}, pathlib.Path()))
    assert files["desk_1.res"] == b"250.5\nnan\n500\n" and files["floor.res"] == b"100\n"
    assert json.loads(files["grids_info.json"]) == [
        {"name": name, "identifier": identifier, "full_id": identifier, "group": "", "count": count}
        for name, identifier, count in (("desk 1", "desk_1", 3), ("floor", "floor", 1))]
    assert files["grid_summary.csv"] == (
        b"Sensor Grid,Sensor Grid ID,Mean,Minimum,Maximum,Uniformity Ratio\n"
        b"desk_1,desk_1,375.25,250.5,500,66.76\nfloor,floor,100,100,100,100\n")


def files_of_year(folder, states):
    """Two points; those of each profile have its number as the thousands, and the hour below."""
    profiles = [1000 * number + np.arange(2 * HOURS, dtype=np.float32).reshape(2, HOURS) % HOURS / 100
                for number in range(2 * (1 + states))]
    (folder / "values").write_bytes(b"".join(each.tobytes() for each in profiles))
    files = dict(honeybee.files(
        {"hours": HOURS, "up": [3, 4, 8759], "sun": True, "states": states, "state_of_hour": [0] * HOURS,
         "grids": [{"name": "desk", "identifier": "desk", "count": 2}]}, folder))
    assert files["desk.ill"] == 2 * b"0.0300 0.0400 87.59\n"
    assert files["desk_direct.ill"] == 2 * b"1000 1000 1088\n"
    assert files["sun-up-hours.txt"] == b"3.5\n4.5\n8759.5\n"
    names = [f"blinds/{state}_blinds" for state in range(states)] or ["__static_apertures__/default"]
    arrays = [f"{name}/{kind}/desk.npy" for name in names for kind in ("total", "direct")]
    for name, profile in zip(arrays, profiles[2:] or profiles):
        stored = np.load(io.BytesIO(files[name]))
        assert stored.dtype == np.float32 and np.array_equal(stored, profile[:, [3, 4, 8759]])
    return files


def test_a_year_has_lines_and_arrays_of_the_hours_with_the_sun_up_in_each_state_of_blinds(tmp_path):
    files = files_of_year(tmp_path, 0)
    assert json.loads(files["grids_info.json"])[0]["light_path"] == [["__static_apertures__"]]
    assert json.loads(files["grid_states.json"]) == {} and "states_schedule.json" not in files
    files = files_of_year(tmp_path, 2)
    assert json.loads(files["grid_states.json"]) == {"desk": {"blinds": ["0_blinds", "1_blinds"]}}
    schedule = json.loads(files["states_schedule.json"])["blinds"]
    assert len(schedule["schedule"]) == HOURS and not schedule["is_static"]


def test_numbers_have_four_digits_or_all_before_the_point():
    row = np.array([[4e-5, 6e-5, 0.5, 1.23456, 12.3456, 123.456, 1234.56, 12345.6]], np.float32)
    assert honeybee._lines(row) == b"0 0.0001 0.5000 1.235 12.35 123.5 1235 12346\n"
