"""Values that are none are refused by an error of photile's that names the field."""

import numpy as np
import pytest

import photile

NAN = float("nan")
Material, Light, Camera = photile.Material, photile.Light, photile.Camera
FLOOR = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
LAMP = Light("lamp", 100, position=(0.2, 0.2, 1))


def scene(**parts):
    return photile.Scene(**{"triangles": FLOOR, "lights": [LAMP], **parts})


def measure(of=None, **options):
    fast = {"points": [[0.2, 0.2, 0.5]], "rays": 4, "repeats": 2, "integrator": "path"}
    return photile.measure(of or scene(), **{**fast, **options})


def render(**options):
    fast = {"size": (2, 2), "quality": "draft", "integrator": "path", "samples_per_pixel": 1}
    return photile.render(scene(), **{**fast, **options})


def check(field, make):
    with pytest.raises(photile.Error, match=field) as error:
        make()
    assert "\n" not in str(error.value)


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
    ("emissive_scale", NAN), ("emissive_scale", -1), ("emissive_scale", "x"),
    ("lumen_per_watt", NAN), ("environment_scale", 0), ("environment_rotation", NAN),
    ("up", 3), ("sun", "a"), ("sky", ("x",)), ("panels", {"x": 1}), ("temperatures", {"x": None}),
    ("site", (1, 2)), ("time", "noon"), ("north", NAN), ("reflectance", {"x": 2}), ("hide", "nothing"),
    ("luminaires", ["x.ies"]), ("luminaires", [{"file": "x.ies", "lumens": NAN}]), ("luminaires", [{"file": "x.ies"}])])
def test_of_a_file(tmp_path, name, value):
    file = tmp_path / "room.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    field = {"sky": "x", "panels": "area light", "temperatures": "temperature", "reflectance": "share",
             "luminaires": "luminaire", "hide": "nothing"}.get(name, name)
    check(field, lambda: photile.load(file, **{name: value}))


@pytest.mark.parametrize("name, value", [
    ("photons_emitted", "x"), ("photons_emitted", None), ("photons_emitted", 10**400),
    ("radius", NAN), ("quality", 3), ("size", "x"), ("size", (10**12, 1)),
    ("lumen_per_watt", "x"), ("lumen_per_watt", NAN), ("integrator", 4), ("camera", b"x"),
    ("seed", "\udcff"), ("seed", np.zeros((2, 2))), ("samples_per_pixel", np.array([["a"]])),
    ("neighbours", 0), ("seed", -1), ("maps", "octree"), ("photons", 5), ("quality", "best"), ("integrator", "bdpt"),
    ("camera", "cellar"), ("camera", 3)])
def test_of_a_rendering(name, value):
    message = {"maps": "is not one of", "photons": "no such setting"}.get(name, name)
    check(message, lambda: render(**{name: value}))


@pytest.mark.parametrize("name, value", [
    ("rays", "x"), ("rays", 1.5), ("repeats", None), ("maintenance", -5), ("maintenance", 0),
    ("maintenance", NAN), ("lumen_per_watt", NAN), ("points", "x"), ("normals", "x"),
    ("points", [[1, 2], [3]]), ("points", [[0, 10**400, 0]]), ("normals", [[0, 10**400, 0]]),
    ("points", [0, 0, 0]), ("points", [[0, 0, np.inf]]), ("normals", [[0, 0, 0]]), ("normals", [[0, 0, 1]] * 2),
    ("repeats", 1), ("rays", 0), ("integrator", "guess")])
def test_of_a_measurement(name, value):
    check(name, lambda: measure(**{name: value}))


@pytest.mark.parametrize("name, value", [
    ("corner", "x"), ("corner", (0, NAN, 0)), ("along", (1, 2)), ("across", (0, 10**400, 0)), ("columns", 0),
    ("columns", NAN), ("rows", None), ("rows", 1.5)])
def test_of_a_grid(name, value):
    room = {"corner": (0, 0, 0), "along": (1, 0, 0), "across": (0, 1, 0), "columns": 2, "rows": 2}
    check(name, lambda: photile.grid(**{**room, name: value}))


@pytest.mark.parametrize("message, call", [
    ("nothing is asked for", photile.grids), ("table", lambda of: photile.grids(of, "table+1")),
    ("wall_band", lambda of: photile.grids(of, "floor", wall_band=-1)),
    ("inside", lambda of: photile.grids(of, inside=1)),
    ("length 0", lambda of: photile.glare(of, [[0] * 6])), ("6", lambda of: photile.glare(of, [[0, 0, 0]])),
    ("cellar", lambda of: photile.glare(of, "cellar")), ("ratings", lambda of: photile.glare(of, 0, ratings=["x"])),
    ("grids makes some", lambda of: photile.daylight(of, [], "a.epw")),
    ("patches", lambda of: photile.daylight(of, [], "a.epw", patches=5)),
    ("no.epw", lambda of: photile.daylight(of, photile.Grid.of_points([[0, 0, 1]]), "no.epw")),
    ("windows", lambda of: photile.view_out(of, [[0, 0, 1]])), ("site", lambda of: photile.sun_hours(of, "2026-03-01")),
    ("2026-13", lambda of: photile.sun_hours(of, "2026-13-01", site=(0, 0, 0))), ("no.json", lambda of: measure(
        of, mood="evening", moods="no.json")), ("lamps_to", lambda of: photile.daylight(of, [], "a.epw", lamps_to=0)),
    ("direct light alone", lambda of: photile.write_report("a.html", measure(of), target="escape-route")),
    ("per cent", lambda of: measure(of, target="office-desk", daylight_factor=True)),
    ("results", lambda of: photile.write_report("a.html", 3)), ("progress", lambda of: measure(of, progress=3)),
    ("there are none", lambda of: photile.write_report("a.html"))])
def test_of_lighting(message, call):
    check(message, lambda: call(scene()))


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
    for name, value in (("photons", "x"), ("photons", 0), ("photons", -1), ("seed", -1), ("quota", 3),
                        ("quota", "fair"), ("max_path_length", 10**30)):
        check(name, lambda: photile.trace(scene(), **{name: value}))
    for name, value in (("radius", "x"), ("radius", NAN), ("neighbours", "x"), ("flux", "x")):
        check(name, lambda: photile.PhotonMaps([[0, 0, 0]], **{name: value}))


def test_of_changes_and_displays():
    picture = render()
    check("lamp", lambda: picture.mix({"lamp": None}))
    check("exposure", lambda: picture.display(exposure="x"))
    check("view", lambda: picture.display(view=3))


@pytest.mark.parametrize("message, parts", [
    ("triangles", {"triangles": "x"}), (r"\(n, 3, 3\)", {"triangles": np.zeros((2, 3))}), ("unit", {"unit": 3}),
    ("horsepower", {"unit": "horsepower"}), ("lights", {"lights": [3]}), ("normals", {"normals": np.zeros((5, 3))}),
    ("uv", {"uv": np.zeros((12, 3, 3))}), ("triangle_materials", {"triangle_materials": [[1, 2], [3]]}),
    ("triangle_materials", {"triangle_materials": [1]}), ("foam", {"materials": [Material("m", interaction="foam")]}),
    ("'m'", {"materials": [Material("m", texture=np.zeros((2, 2), np.uint8))]}),
    ("index 12", {"lights": [Light("a", 1, "area", triangles=[12])]}), ("'a'", {"lights": [Light("a", 1, "area")]}),
    ("'a'", {"lights": [Light("a", NAN)]}), ("candle", {"lights": [Light("a", 1, "candle")]})])
def test_of_a_scene(message, parts):
    check(message, lambda: scene(**parts))


def test_numbers_of_numpy_are_numbers():
    render(max_specular_depth=np.int64(5), integrator="photon-map", radius=np.float32(0.5),
           photons_emitted=np.uint32(100))
