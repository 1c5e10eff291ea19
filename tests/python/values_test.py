"""Values that are none are refused by an error of photile's that names the field."""

import numpy as np
import pytest

import photile

NAN = float("nan")
Material, Light, Camera = photile.Material, photile.Light, photile.Camera
FLOOR = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
LAMP = Light("lamp", 100, position=(0.2, 0.2, 1))


def scene(**parts):
    return photile.Scene(FLOOR, **{"lights": [LAMP], **parts})


def measure(of=None, **options):
    fast = {"points": [[0.2, 0.2, 0.5]], "rays": 4, "repeats": 2, "integrator": "path"}
    return photile.measure(of or scene(), **{**fast, **options})


def render(**options):
    fast = {"size": (2, 2), "quality": "draft", "integrator": "path", "samples_per_pixel": 1}
    return photile.render(scene(), **{**fast, **options})


def check(field, make):
    with pytest.raises(photile.Error, match=field):
        make()


@pytest.mark.parametrize("name, value", [
    ("diffuse", "red"), ("diffuse", (1, 2)), ("roughness", None), ("interaction", 5), ("opacity", "x"),
    ("texture", "no"), ("specular", (1e300, 0, 0)), ("roughness", -1), ("roughness", 1.5),
    ("texture", float("inf"))])
def test_of_a_material(name, value):
    check("material.*m", lambda: scene(materials=[Material(**{"name": "m", name: value})]))


@pytest.mark.parametrize("name, value", [
    ("power", "x"), ("power", NAN), ("kind", 3), ("color", (1, 1)), ("position", (0, 0)),
    ("direction", "down"), ("outer_angle", None), ("group", 4), ("triangles", "abc")])
def test_of_a_light(name, value):
    check("light 'l'", lambda: scene(lights=[Light(**{"name": "l", "power": 1, name: value})]))


@pytest.mark.parametrize("name, value", [
    ("position", (0, 0)), ("target", (1,)), ("up", None), ("up", (0, NAN, 0)), ("field_of_view", "x"),
    ("field_of_view", NAN), ("aspect_ratio", "x"), ("aspect_ratio", NAN), ("position", (10**400, 0, 0)),
    ("field_of_view", 10**400)])
def test_of_a_camera(name, value):
    camera = Camera(**{"position": (0, 0, 1), "target": (1, 0, 0), name: value})
    check("camera 'camera'", lambda: scene(cameras=[camera]))
    check("camera 'camera'", lambda: render(camera=camera))


@pytest.mark.parametrize("name, value", [
    ("emissive_scale", NAN), ("emissive_scale", -1), ("emissive_scale", "x"), ("lumen_per_watt", NAN),
    ("environment_scale", 0), ("environment_rotation", NAN), ("up", 3), ("sun", "a"), ("sky", ("x",)),
    ("panels", {"x": 1}), ("temperatures", {"x": None})])
def test_of_a_file(tmp_path, name, value):
    file = tmp_path / "room.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    field = {"sky": "x", "panels": "area light", "temperatures": "temperature"}.get(name, name)
    check(field, lambda: photile.load(file, **{name: value}))


@pytest.mark.parametrize("name, value", [
    ("photons_emitted", "x"), ("photons_emitted", None), ("photons_emitted", 10**400), ("radius", NAN),
    ("quality", 3), ("size", "x"), ("size", (10**12, 1)), ("lumen_per_watt", "x"), ("lumen_per_watt", NAN),
    ("integrator", 4), ("camera", b"x"), ("seed", "\udcff"), ("seed", np.zeros((2, 2))),
    ("samples_per_pixel", np.array([["a"]]))])
def test_of_a_rendering(name, value):
    check(name, lambda: render(**{name: value}))


@pytest.mark.parametrize("name, value", [
    ("rays", "x"), ("rays", 1.5), ("repeats", None), ("maintenance", -5), ("maintenance", 0),
    ("maintenance", NAN), ("lumen_per_watt", NAN), ("points", "x"), ("normals", "x"),
    ("points", [[1, 2], [3]]), ("points", [[0, 10**400, 0]]), ("normals", [[0, 10**400, 0]])])
def test_of_a_measurement(name, value):
    check(name, lambda: measure(**{name: value}))


@pytest.mark.parametrize("name, value", [
    ("corner", "x"), ("corner", (0, NAN, 0)), ("along", (1, 2)), ("across", (0, 10**400, 0)),
    ("columns", 0), ("columns", NAN), ("rows", None), ("rows", 1.5)])
def test_of_a_grid(name, value):
    room = {"corner": (0, 0, 0), "along": (1, 0, 0), "across": (0, 1, 0), "columns": 2, "rows": 2}
    check(name, lambda: photile.grid(**{**room, name: value}))


def test_places_beyond_any_scene_are_refused():
    for far in (1e13, 1e30, 1e300):
        check("not within", lambda: measure(points=[[0, far, 0]]))
        check("within", lambda: scene(cameras=[Camera((0, far, 0), (1, 0, 0))]))
    for pixels in (np.zeros((2, 2, 4), np.uint8), np.zeros((2, 2), np.uint8), np.zeros((2, 2, 3))):
        check("pixels", lambda: photile.png_of(pixels))


def test_of_surroundings():
    for texel in (NAN, 1e-45, 0):
        texels = np.full((4, 8, 3), texel, np.float32)
        check("sky", lambda: measure(scene(lights=[Light("sky", kind="environment", texels=texels)])))
    check("sky", lambda: scene(lights=[Light("sky", kind="environment", texels="x")]))


def test_of_photons_and_maps():
    for name, value in (("photons", "x"), ("seed", -1), ("quota", 3), ("max_path_length", 10**30)):
        check(name, lambda: photile.trace(scene(), **{name: value}))
    for name, value in (("radius", "x"), ("radius", NAN), ("neighbours", "x"), ("flux", "x")):
        check(name, lambda: photile.PhotonMaps([[0, 0, 0]], **{name: value}))


def test_of_changes_and_displays():
    picture = render()
    check("lamp", lambda: picture.mix({"lamp": None}))
    check("exposure", lambda: picture.display(exposure="x"))
    check("view", lambda: picture.display(view=3))


def test_of_a_scene():
    check("triangles", lambda: photile.Scene("x", lights=[LAMP]))
    check("unit", lambda: scene(unit=3))
    check("lights", lambda: scene(lights=[3]))
    check("triangle_materials", lambda: scene(triangle_materials=[[1, 2], [3]]))


def test_numbers_of_numpy_are_numbers():
    render(max_specular_depth=np.int64(5), integrator="photon-map", radius=np.float32(0.5),
           photons_emitted=np.uint32(100))
