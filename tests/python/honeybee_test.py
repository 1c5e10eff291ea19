"""Honeybee's models as scenes: `one_room.hbjson` is a black room in millimetres, with a pane of glass
and two lamps of one photometric file, whose light on points has a closed form."""

import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from conftest import run_photile

import photile

pytest.importorskip("honeybee_radiance", reason="no honeybee-radiance; cmake/fetch.sh test-packages brings it")

model = Path(__file__).parent / "one_room.hbjson"
converted = partial(run_photile, "import")


def turn(axis, degrees):
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    if axis == "z":
        return np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
    return np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]])


def direct_lux(point, instance, factor):
    """From the lamp's intensities: 400 cd down, 200 cd at 45 degrees in C90, 0 at 90; else linear."""
    position = np.array([instance["point"][axis] for axis in "xyz"]) / 1000
    turned = (turn("z", instance["rotation"]) @ turn("y", instance["tilt"])
              @ turn("z", instance["spin"]))
    way = (np.array(point) - position) @ turned  # in the lamp's axes
    distance = np.linalg.norm(way)
    polar = np.degrees(np.arccos(-way[2] / distance))
    azimuth = abs(np.degrees(np.arctan2(way[1], way[0])))
    aside = 1 - abs(azimuth - 90) / 90  # how near to C90
    intensity = np.interp(polar, [0, 45, 90], [400, 400 - 200 * aside, 0])
    cosine = (position[2] - point[2]) / distance
    return factor * intensity * cosine / distance**2


def test_lamps_and_sensors_are_where_the_model_has_them(tmp_path):
    made = converted(model, "-o", tmp_path / "room.glb")
    assert made.returncode == 0 and made.stderr == ""
    command = made.stdout.split()
    assert command[0] == "photile"
    run_photile(*command[1:], "--integrator", "path", "--rays", "64", "--repeats", "2", "-q", check=True)
    measured = np.loadtxt(tmp_path / "room.results" / "desk.res")
    whole = json.loads(model.read_text())
    radiance = whole["properties"]["radiance"]
    (lamp,) = radiance["luminaires"]
    points = [np.array(sensor["pos"]) / 1000 for sensor in radiance["sensor_grids"][0]["sensors"]]
    expected = [sum(direct_lux(point, instance, lamp["light_loss_factor"])
                    for instance in lamp["luminaire_zone"]["instances"]) for point in points]
    # The lamps are squares of 5 cm at least 1.65 m away.
    assert measured == pytest.approx(expected, rel=0.005)
    radiance["sensor_grids"] = []  # then all rooms are measured
    (tmp_path / "a.hbjson").write_text(json.dumps(whole))
    words = converted(tmp_path / "a.hbjson", "-o", tmp_path / "a.glb").stdout.replace("'", "").split()
    assert "office: " in run_photile(*words[1:], "--integrator", "path", "--rays", "4", check=True).stdout


def even_sky_through(pane):
    """What a pane lets through of it, by what it lets through by angle and the angle within."""
    angle = np.radians(np.linspace(0.01, 89.99, 5001))
    within = np.arcsin(np.sin(angle) / 1.52)
    passed = pane(angle, within) * np.sin(2 * angle)
    return np.sum((passed[1:] + passed[:-1]) / 2 * np.diff(angle))  # by trapezia


def faces(angle, within):
    """What a face reflects of either polarisation."""
    return ((np.sin(angle - within) / np.sin(angle + within)) ** 2,
            (np.tan(angle - within) / np.tan(angle + within)) ** 2)


def glass_of_radiance(transmissivity):
    def passed(angle, within):
        t = transmissivity ** (1 / np.cos(within))
        return sum((1 - r) ** 2 * t / (1 - (r * t) ** 2) for r in faces(angle, within)) / 2
    return passed


def clear_glass_of_photile(angle, within):
    r = sum(faces(angle, within)) / 2
    return 1 - (r + (1 - r) ** 2 * r / (1 - r**2))


def test_surfaces_and_modifiers(tmp_path):
    assert converted(model, "-o", tmp_path / "a.glb").returncode == 0
    (listed,) = json.loads(run_photile("info", tmp_path / "a.glb", "--json").stdout)["rooms"]
    assert [listed] == json.loads((tmp_path / "a.rooms.json").read_text())
    facts = {"name": "office", "area": 12, "height": 2.5, "floor": 0, "inside": [2, 1.25, -1.5]}
    assert facts.items() <= listed.items()
    scene = photile.load(tmp_path / "a.glb", sky=("uniform", 1000))
    black, pane = scene.materials
    assert black.diffuse == (0, 0, 0) and black.specular == (0, 0, 0)
    areas = [scene.triangle_areas[scene.triangle_material == i].sum() for i in range(2)]
    assert areas == pytest.approx([2 * (4 * 3 + 4 * 2.5 + 3 * 2.5) - 2 * 1.2, 2 * 1.2])
    assert pane.interaction == "glass" and pane.thin
    assert pane.index_of_refraction == pytest.approx(1.52)
    expected = even_sky_through(glass_of_radiance(0.7)) / even_sky_through(clear_glass_of_photile)
    assert pane.transmission == pytest.approx([expected] * 3, rel=1e-3)
    # The fronts of a room's surfaces face into it.
    middle = np.array(scene.vertices)[scene.triangles].mean(axis=1)
    inwards = (np.array([2, 1.25, -1.5]) - middle) * scene.triangle_normals
    assert np.all(inwards[scene.triangle_material == 0].sum(axis=1) > 0)


def changed(change):
    data = json.loads(model.read_text())
    change(data["properties"]["radiance"])
    return json.dumps(data)


def test_what_is_no_model_is_refused_in_a_line(tmp_path):
    wrong = tmp_path / "wrong.hbjson"
    for text in ("{", "[]", '{"type": "Room"}', model.read_text().replace('"x"', '"w"'),
                 f"cos\nmkdir\n(V{tmp_path}/out\ntR.",  # a pickle that makes a folder
                 changed(lambda radiance: radiance["sensor_grids"].extend(radiance["sensor_grids"])),
                 changed(lambda radiance: radiance["luminaires"].extend(radiance["luminaires"])),
                 model.read_text().replace("2400}", "1e999}", 1),
                 model.read_text().replace("0.8", "NaN", 1)):
        wrong.write_text(text)
        made = converted(wrong, "-o", tmp_path / "out" / "a.glb")
        assert made.returncode == 3 and made.stdout == ""
        assert made.stderr.count("\n") == 1 and str(wrong) in made.stderr
        assert not (tmp_path / "out").exists()


def test_a_model_writes_into_its_folder_alone(tmp_path):
    bsdf = {"type": "BSDF", "identifier": str(tmp_path / "elsewhere"), "bsdf_data": "eJwDAAAAAAE=",
            "up_orientation": [0, 0, 1], "thickness": 0}
    file = tmp_path / "bsdf.hbjson"
    for name in (str(tmp_path / "elsewhere"), "blinds"):
        bsdf["identifier"] = name
        file.write_text(changed(lambda radiance: radiance["modifiers"].append(bsdf)))
        made = converted(file, "-o", tmp_path / "out.glb")
    assert not (tmp_path / "elsewhere.xml").exists()
    assert made.returncode == 0 and "modifier 'blinds': BSDF is not supported" in made.stderr
