#!/usr/bin/env python3
"""Pages of `photile publish` in Chromium, beside `photile render` and `photile measure`.

Usage: page_test.py cornell_box|living_room|office|controls|display|many_lights PHOTILE SOURCE_FOLDER
"""

import base64
import datetime
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.parse

try:
    import numpy as np
    import OpenImageIO as oiio
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
except ImportError as error:
    print(f"skipped: {error}; apt-get install python3-numpy python3-openimageio python3-selenium")
    sys.exit(77)

PHOTILE, SOURCE = sys.argv[2], pathlib.Path(sys.argv[3])
CHROMIUM, DRIVER = "/usr/bin/chromium", "/usr/bin/chromedriver"
SIZE = (320, 200)  # pixels of the page and of pictures

# Limits. A picture's squared error relative to what is seen, as `photile compare` has it; the mean;
# lux beside those of a picture, of every click, and beside measured ones, of nine clicks in ten, for
# light maps blur light at the borders of shadows, in pictures, too (docs/method/light-maps.md); how many
# standard errors lux may differ more; main thread of a frame, ms.
LARGEST_REL_MSE = 0.003
LARGEST_MEAN = 0.005
LARGEST_LUX = 0.01
STANDARD_ERRORS = 3
LARGEST_FRAME_MS = 4

COUNT_FRAMES = """
page.frames = 0;
const frame = page.frame.bind(page);
page.frame = (time) => {
  ++page.frames;
  frame(time);
};
"""
KEY_CODES = {"ArrowLeft": 37, "ArrowRight": 39, "Escape": 27, "Delete": 46, "F2": 113, "PageDown": 34, "{": 219,
             "]": 221}

BASE64 = """
const base64 = (array) => {
  const bytes = new Uint8Array(array.buffer);
  let text = '';
  for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
  return btoa(text);
};
"""
# What the canvas shows, rows from below.
SHOWN = BASE64 + """
page.renderer.draw(page.walker);
const {gl, canvas: {width, height}} = page.renderer, shown = new Uint8Array(4 * width * height);
gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, shown);
"""
# Paints all that is not matt black, lamps included, and leaves reflections out, and back: pixels that do
# not change see matt surfaces alone. Normal maps, which a page leaves out, count as not matt.
SHOW_MATT_ONLY = """
const [matt, bumpy] = arguments;
const {renderer} = page;
page.whole ??= {materials: renderer.materials, emitters: renderer.emitters};
renderer.materials = matt ? renderer.floatTexture(3, room.materials.length, Float32Array.from(
    room.materials.flatMap((m, i) => {
      const known = m.specular.every((part) => part === 0) && !bumpy.includes(i);
      return [...(known ? m.diffuse : [0, 0, 0]), m.alpha, 0, 0, 0, 1, 0, 0, 0, 0];
    }))) : page.whole.materials;
const lamps = room.emitters.length + 1;
renderer.emitters = matt ? renderer.floatTexture(lamps, 1, new Float32Array(4 * lamps)) : page.whole.emitters;
renderer.drawsProbe = matt;
renderer.probeIsOld = false;
"""
# Of so many frames from light maps, and whether each mixes them anew: milliseconds of the main thread.
FRAME_TIMES = """
return Array.from({length: arguments[0]}, () => {
  page.renderer.dropRest();
  Object.assign(page, {dirty: true, lightIsOld: arguments[1]});
  page.frame(performance.now());
  page.renderer.gl.finish();
  return page.frameTime;
});"""
# A new state of a light by its slider, as a user moves it.
SET_POWER = """
const [name, factor] = arguments;
const i = room.lights.findIndex((light) => light.name === name);
const slider = document.getElementById('light' + i);
slider.step = 'any';
slider.value = sliderOfPower(factor * room.lights[i].power, room.lights[i].power);
slider.dispatchEvent(new Event('input'));
page.frame(performance.now());
"""
CLICK = """
const [x, y] = arguments;
const hit = page.meet(x, y);
if (!hit) return null;
const [a, b, c] = page.surfaces.corners(hit.triangle);
const {lux, error} = page.illuminance(hit);
const normal = normalized(cross(subtract(b, a), subtract(c, a)));
return {place: add(hit.place, scaled(normal, 1e-5)), normal, lux, error};
"""


def photile(*arguments):
    result = subprocess.run([PHOTILE, *map(str, arguments)], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return result.stdout


class Browser:
    def __init__(self):
        options = Options()
        for argument in ("--headless=new", "--no-sandbox", "--use-angle=swiftshader",
                         "--enable-unsafe-swiftshader", "--force-device-scale-factor=1"):
            options.add_argument(argument)
        options.binary_location = CHROMIUM
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(DRIVER), options=options)
        self.driver.set_script_timeout(300)
        self.run_command = self.driver.execute_cdp_cmd
        self.run_command("Emulation.setDeviceMetricsOverride",
                         {"width": SIZE[0], "height": SIZE[1], "deviceScaleFactor": 1, "mobile": False})
        self.run_command("Emulation.setFocusEmulationEnabled", {"enabled": True})
        # The page must do without a network.
        self.run_command("Network.enable", {})
        self.run_command("Network.emulateNetworkConditions",
                         {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0})

    def open(self, url, state=""):
        self.driver.get("about:blank")
        self.driver.get(url + (f"#{state}" if state else ""))
        self.until("return document.getElementById('loading') === null")
        self.run(COUNT_FRAMES)

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def until(self, script, *arguments, seconds=90):
        """What the script returns once that is true."""
        for _ in range(20 * seconds):
            value = self.run(script, *arguments)
            if value:
                return value
            time.sleep(0.05)
        loading = self.run("return document.getElementById('loading')?.textContent")
        raise AssertionError(f"never: {script}, of {arguments}" + (f"; the page says: {loading}" if loading else ""))

    def radiance(self, samples=4, mode=1):
        """Of each pixel; of mode 2 what V's colours stand for."""
        text = self.run(BASE64 + "const [width, height, ...how] = arguments;"
                                 "return base64(page.renderer.radiance(page.walker, width, height, ...how));",
                        *SIZE, samples, mode)
        return np.frombuffer(base64.b64decode(text), np.float32).reshape(SIZE[1], SIZE[0], 3)

    def hold(self, key, seconds, modifiers=0, code=None):
        """Holds a key down; `code` is its place on the keyboard, where that is not a letter, a digit or its name."""
        code = code or (key if len(key) > 1 else f"Digit{key}" if key.isdigit() else f"Key{key.upper()}")
        event = {"key": key, "code": code, "windowsVirtualKeyCode": KEY_CODES.get(key, ord(key[0].upper())),
                 "modifiers": modifiers}
        if len(key) == 1 and not modifiers:
            event["text"] = key
        self.run_command("Input.dispatchKeyEvent", {"type": "keyDown", **event})
        if seconds > 0:
            self.wait(seconds)
        event.pop("text", None)
        self.run_command("Input.dispatchKeyEvent", {"type": "keyUp", **event})
        self.rest()

    def wait(self, seconds):
        """For so long, and for five frames at least: a busy machine may draw few."""
        first = self.run("return page.frames")
        time.sleep(seconds)
        self.until("return page.frames >= arguments[0]", first + 5)

    def press(self, key, modifiers=0, code=None):
        self.hold(key, 0, modifiers, code)

    def drag(self, *points, button="left", modifiers=0):
        """Presses a button at the first of these points of the page, and lets it go at the last."""
        kinds = ["Pressed", *["Moved"] * (len(points) - 1), "Released"]
        for kind, (x, y) in zip(kinds, [*points, points[-1]]):
            self.run_command("Input.dispatchMouseEvent",
                             {"type": f"mouse{kind}", "x": x, "y": y, "button": button, "clickCount": 1,
                              "modifiers": modifiers,
                              "buttons": 0 if kind == "Released" else {"left": 1, "right": 2}[button]})
            time.sleep(0.05)

    def click(self, x, y):
        self.drag((x, y))

    def turn_wheel(self, **more):
        self.run_command("Input.dispatchMouseEvent",
                         {"type": "mouseWheel", "x": 100, "y": 100, "deltaX": 0, "deltaY": -100, **more})
        self.rest()

    def touch(self, *steps, seconds=0):
        """Fingers at the points of each step, which they hold for so long in the end."""
        for kind, points in [*zip(("Start", "Move"), steps), ("End", [])]:
            if kind == "End" and seconds:
                self.wait(seconds)
            self.run_command("Input.dispatchTouchEvent",
                             {"type": f"touch{kind}",
                              "touchPoints": [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]})
        self.rest()

    def rest(self):
        """Waits until nothing moves any more."""
        time.sleep(0.1)
        self.until("return !page.scheduled")

    def viewer(self):
        return self.run("const {eye, yaw, pitch, angle, flies} = page.walker; return {eye, yaw, pitch, angle, flies}")

    def pose(self):
        viewer = self.viewer()
        return [*viewer["eye"], viewer["yaw"], viewer["pitch"]]

    def shown(self):
        """8 bits of red, green and blue of each pixel of the canvas."""
        return pixels_of(self.run(SHOWN + "return base64(shown);"), np.uint8).astype(float)

    def choose_preset(self, name=None):
        """By its button: the first is of the lamps as they were published."""
        self.run("[...document.querySelectorAll('#presets button')].find((button, i) => "
                 "arguments[0] === null ? i === 0 : button.textContent === arguments[0]).click();"
                 "page.frame(performance.now())", name)

    def saved(self, folder, pattern, save):
        """The file of such a name that `save` makes the page save."""
        for old in folder.glob(pattern):
            old.unlink()
        self.run_command("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(folder)})
        save()
        for _ in range(600):
            for file in folder.glob(pattern):
                if file.stat().st_size > 0:
                    time.sleep(0.2)
                    return file
            time.sleep(0.05)
        raise AssertionError(f"{pattern} was not saved")


def pixels_of(text, kind):
    """Red, green and blue of the page's pixels, which a script read from below."""
    return np.frombuffer(base64.b64decode(text), kind).reshape(SIZE[1], SIZE[0], 4)[::-1, :, :3]


def channels_of(file, requested="RGB"):
    picture = oiio.ImageInput.open(str(file))
    names = picture.spec().channelnames
    channels = [names.index(channel) for channel in requested]
    return np.asarray(picture.read_image(format=oiio.FLOAT))[:, :, channels].astype(float)


def compare_pixels(what, page, reference, counted):
    """Pixels that see a lamp or are next to one are left out, as in `photile compare`."""
    light = reference @ [0.2126, 0.7152, 0.0722]
    lamp = light > 20 * np.median(light[light > 0])
    wide = np.pad(lamp, 1)
    lamp = np.any([np.roll(wide, shift, (0, 1)) for shift in
                   [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]], axis=0)[1:-1, 1:-1]
    counts = ~lamp & (light > 0) & counted
    mean = reference[counts].mean()
    error = ((page - reference) ** 2 / (reference ** 2 + 0.01 * mean ** 2))[counts].mean()
    ratio = page[counts].mean() / mean
    print(f"{what}: relMSE {error:.5f}, mean {ratio:.4f}, of {100 * counts.mean():.0f}% of the pixels", flush=True)
    assert counts.mean() > 0.25, what
    assert error <= LARGEST_REL_MSE, what
    assert abs(ratio - 1) <= LARGEST_MEAN, what


def compare(what, browser, reference, bumpy=()):
    """Matt surface on the page beside a picture."""
    page = browser.radiance().astype(float)
    browser.run(SHOW_MATT_ONLY, True, list(bumpy))
    matt = browser.radiance().astype(float)
    browser.run(SHOW_MATT_ONLY, False, [])
    compare_pixels(what, page, reference, np.abs(matt - page).max(axis=2) <= 1e-5 * page.max(axis=2))


def at_point(pixels, x, y):
    """Between the middles of pixels."""
    left, top = int(x - 0.5), int(y - 0.5)
    across, down = x - 0.5 - left, y - 0.5 - top
    return np.array([1 - down, down]) @ pixels[top:top + 2, left:left + 2] @ np.array([1 - across, across])


def check_clicks(browser, folder, scene, rendered, errors, more):
    """Lux at ten places beside those of a picture with its standard errors, and beside measured ones."""
    clicks = []
    for i in range(200):
        x, y = (0.05 + 0.9 * (0.754877 * i % 1)) * SIZE[0], (0.05 + 0.9 * (0.569840 * i % 1)) * SIZE[1]
        click = browser.run(CLICK, x, y)
        if click and click["lux"] > 0:
            click["rendered"], click["error of the picture"] = at_point(rendered, x, y), at_point(errors, x, y)
            clicks.append(click)
        if len(clicks) == 10:
            break
    assert len(clicks) == 10
    points = folder / "clicks.pts"
    points.write_text("".join(
        " ".join(f"{number:.7g}" for number in click["place"] + click["normal"]) + "\n" for click in clicks))
    table = folder / "clicks.json"
    photile("measure", scene, "--points", points, "-o", table, "-q", *more)
    measured = [value for grid in json.loads(table.read_text())["grids"] for value in grid["sensors"]]
    beyond = 0
    for click, sensor in zip(clicks, measured):
        lux, error = sensor["lux"], sensor["standard_error"]
        allowed = LARGEST_LUX * lux + STANDARD_ERRORS * np.hypot(error, click["error"])
        print(f"lux {click['lux']:.1f} +- {click['error']:.1f}, in the picture {click['rendered']:.1f} +- "
              f"{click['error of the picture']:.1f}, measured {lux:.1f} +- {error:.1f}", flush=True)
        of_both = np.hypot(click["error"], click["error of the picture"])
        assert abs(click["lux"] - click["rendered"]) <= LARGEST_LUX * lux + STANDARD_ERRORS * of_both
        beyond += abs(click["lux"] - lux) > allowed
    assert beyond <= 1, f"{beyond} of 10 clicks are off"


def room_in(folder, name, views, moods, lamps=()):
    """A copy of a bundled scene with cameras by their places and what they look at, moods, and nodes
    for lamps. The file, and the numbers of its materials with normal maps."""
    shutil.copytree(SOURCE / "scenes" / name, folder, dirs_exist_ok=True)
    file = folder / f"{name}.gltf"
    scene = json.loads(file.read_text())
    for number, (place, target) in enumerate(views):
        x, y, z = (there - here for here, there in zip(place, target))
        yaw, pitch = math.atan2(-x, -z) / 2, math.atan2(y, math.hypot(x, z)) / 2
        turn = [math.cos(yaw) * math.sin(pitch), math.sin(yaw) * math.cos(pitch), -math.sin(yaw) * math.sin(pitch),
                math.cos(yaw) * math.cos(pitch)]
        scene["cameras"].append({"type": "perspective", "name": f"added {number}",
                                 "perspective": {"yfov": 0.9, "znear": 0.01}})
        scene["nodes"].append({"name": f"added {number}", "camera": len(scene["cameras"]) - 1,
                               "translation": list(place), "rotation": turn})
        scene["scenes"][scene.get("scene", 0)]["nodes"].append(len(scene["nodes"]) - 1)
    for name, place in lamps:  # that shine downwards
        scene["nodes"].append({"name": name, "translation": list(place), "rotation": [-0.5 ** 0.5, 0, 0, 0.5 ** 0.5]})
        scene["scenes"][scene.get("scene", 0)]["nodes"].append(len(scene["nodes"]) - 1)
    file.write_text(json.dumps(scene))
    file.with_suffix(".moods.json").write_text(json.dumps({"photile_moods": 1, "moods": moods}))
    bumpy = [i for i, material in enumerate(scene["materials"]) if "normalTexture" in material]
    return file, bumpy


def check_views(browser, folder, scene, bumpy, dimmed, mood, lights=()):
    """The page's pictures from three cameras beside rendered ones: as published, with two sliders moved
    and by a preset.

    dimmed: what two lights are multiplied by
    lights: options of all commands
    """
    page = folder / "page.html"
    photile("publish", scene, "-o", page, "-q", *lights)
    browser.open(page.as_uri())
    pictures = [folder / f"view{camera}.exr" for camera in range(3)]
    for camera, picture in enumerate(pictures):
        photile("render", scene, "--camera", camera, "-o", picture, "-q", "--size", "%dx%d" % SIZE, *lights)

    def compare_views(what, relit=()):
        for camera, picture in enumerate(pictures):
            shown = picture
            if relit:
                shown = folder / "relit.exr"
                photile("relight", picture, *relit, "-o", shown)
            browser.run("page.walker.stand(room.cameras[arguments[0]])", camera)
            compare(f"{what}, view {camera}", browser, channels_of(shown), bumpy)

    compare_views("as published")
    for name, factor in dimmed.items():
        browser.run(SET_POWER, name, factor)
    compare_views("dimmed", [part for name, factor in dimmed.items() for part in ("--light", f"{name}=x{factor}")])
    browser.choose_preset(mood)
    compare_views("by a preset", ["--mood", mood, "--moods", scene.with_suffix(".moods.json")])
    browser.choose_preset()
    browser.run("page.walker.stand(room.cameras[0])")
    return pictures


CORNELL_VIEWS = [((0.1, 0.42, -0.3), (0.35, 0.15, 0.35)), ((0.47, 0.5, 0.03), (0.2, 0.0, 0.4))]
CORNELL_MOOD = {"evening": {"lamp": {"power": 3000, "unit": "lm", "on": True, "kelvin": 2700},
                            "front": {"power": 150, "unit": "lm", "on": True}}}


def test_cornell_box(browser, folder):
    scene, _ = room_in(folder, "cornell-box", CORNELL_VIEWS, CORNELL_MOOD, [("front", (0.28, 0.54, 0.08))])
    front = ["--area-light", "front=0.2x0.1,1500"]
    pictures = check_views(browser, folder, scene, (), {"lamp": 0.3, "front": 1.6}, "evening", front)
    browser.run(SET_POWER, "front", 0)
    errors = folder / "errors.exr"
    photile("render", scene, "--camera", 0, "-o", folder / "again.exr", "--errors", errors, "-q", "--size",
            "%dx%d" % SIZE, *front)
    lux, lux_errors = (channels_of(file, ["Illuminance_lamp.Y"])[:, :, 0] for file in (pictures[0], errors))
    check_clicks(browser, folder, scene, lux, lux_errors, ["--photons", "2M", *front, "--light", "front=off"])
    # Controls have names.
    unnamed = browser.run("""
return [...document.querySelectorAll('button, input, select')].filter((control) =>
  !control.textContent.trim() && !control.labels?.length && !control.getAttribute('aria-label')).map((c) => c.outerHTML);
""")
    assert not unnamed, unnamed


def test_living_room(browser, folder):
    dim = {name: {"power": 0, "unit": "lm", "on": False} for name in
           ("daylight", "ceiling_panel", "picture_spot", "desk_lamp")}
    scene, bumpy = room_in(folder, "living-room", [((1.0, 1.6, 3.9), (4.5, 0.6, 1.0))], {"evening": dim})
    check_views(browser, folder, scene, bumpy, {"daylight": 0.2, "floor_lamp": 1.5}, "evening")


def test_office(browser, folder):
    moods = {"presentation": {"window_row": {"power": 1500, "unit": "lm", "on": True},
                              "inner_row": {"power": 6000, "unit": "lm", "on": True, "kelvin": 3000}}}
    scene, bumpy = room_in(folder, "office", [((3.0, 1.6, 4.6), (3.2, 0.8, 0.5))], moods)
    panels = folder / "lamps.json"
    panels.write_text(json.dumps([{"name": name, "file": "panel.ies", "position": [3, 2.795, z], "count": [3, 1],
                                   "spacing": [2, 0]} for name, z in (("window_row", 3.75), ("inner_row", 1.25))]))
    check_views(browser, folder, scene, bumpy, {"window_row": 0.2, "inner_row": 1.5}, "presentation",
                ["--luminaires", panels])


def write_obj(file, quads, materials):
    """The corners of quads, and the lines of MTL, by the materials' names."""
    lines, count = [f"mtllib {file.stem}.mtl"], 0
    for material, faces in quads.items():
        lines.append(f"usemtl {material}")
        for corners in faces:
            lines += ["v %g %g %g" % corner for corner in corners]
            lines.append("f " + " ".join(str(count + i) for i in (1, 2, 3, 4)))
            count += 4
    file.with_suffix(".mtl").write_text("".join(f"newmtl {name}\n{text}\n" for name, text in materials.items()))
    file.write_text("\n".join(lines) + "\n")
    return file


def obj_room(folder):
    """A hall of 6 x 3 x 5 m with a table, two lamps under its ceiling, and a mood. Its file."""
    quads = {"grey": [[(0, 0, 0), (0, 0, 5), (6, 0, 5), (6, 0, 0)], [(0, 3, 0), (6, 3, 0), (6, 3, 5), (0, 3, 5)],
                      [(0, 0, 0), (6, 0, 0), (6, 3, 0), (0, 3, 0)], [(0, 0, 5), (0, 3, 5), (6, 3, 5), (6, 0, 5)],
                      [(0, 0, 0), (0, 3, 0), (0, 3, 5), (0, 0, 5)], [(6, 0, 0), (6, 0, 5), (6, 3, 5), (6, 3, 0)],
                      [(4, 0.8, 1), (4, 0.8, 2), (5, 0.8, 2), (5, 0.8, 1)]],
             "left": [[(1, 2.9, 2), (2, 2.9, 2), (2, 2.9, 3), (1, 2.9, 3)]],
             "right": [[(4, 2.9, 2), (5, 2.9, 2), (5, 2.9, 3), (4, 2.9, 3)]]}
    (folder / "hall.moods.json").write_text(json.dumps({"photile_moods": 1, "moods": {
        "left alone": {"right": {"power": 0, "unit": "lm", "on": False}}}}))
    return write_obj(folder / "hall.obj", quads, {"grey": "Kd 0.5 0.5 0.5", "left": "Kd 0 0 0\nKe 100 90 80",
                                                  "right": "Kd 0 0 0\nKe 80 90 100"})


STAND = """
page.walker.flies = false;
page.walker.stand({position: arguments[0], forward: arguments[1], angle: 1});
page.wake();
"""
MIDDLE, NORTH = [3, 1.6, 2.5], [0, 0, -1]


def near(value, requested, tolerance):
    assert np.all(np.abs(np.asarray(value, float) - requested) <= tolerance), (value, requested)


def check_keyboard(browser):
    browser.run(STAND, MIDDLE, NORTH)
    browser.hold("w", 0.5)
    eye = browser.viewer()["eye"]
    assert 0.1 < MIDDLE[2] - eye[2] < 2.2, eye
    near(eye[:2], MIDDLE[:2], 1e-3)
    browser.hold("w", 4)  # to the wall, which a body as wide as Walker's does not enter
    near(browser.viewer()["eye"], [3, 1.6, 0.22], 0.01)
    walked = browser.run(STAND + """
const {walker} = page, speed = document.getElementById('speed');
speed.value = -2;
speed.dispatchEvent(new Event('input'));
walker.keys.add('KeyW');
for (let i = 0; i < 20; ++i) walker.advance(0.1);
walker.keys.clear();
speed.value = 0;
speed.dispatchEvent(new Event('input'));
return arguments[0][2] - walker.eye[2];""", MIDDLE, NORTH)
    near(walked, 2 * 1.4 / 4, 0.02)
    browser.run(STAND, MIDDLE, NORTH)
    browser.hold("ArrowRight", 0.3)
    viewer = browser.viewer()
    assert 0.1 < viewer["yaw"] < 1.5 and viewer["eye"] == MIDDLE, viewer
    browser.hold("e", 0.3)
    near(browser.viewer()["eye"][1], 1.9, 0.25)
    browser.run(STAND, MIDDLE, NORTH)
    browser.press("f")
    browser.hold("e", 0.5)
    viewer = browser.viewer()
    assert viewer["flies"] and viewer["eye"][1] > 1.8, viewer
    assert browser.run("return document.getElementById('fly').getAttribute('aria-pressed')") == "true"
    browser.press("1")
    near(browser.viewer()["eye"], browser.run("return room.cameras[0].position"), 1e-6)
    browser.press("f")
    for hidden in (True, False):
        browser.press("F2")
        assert browser.run("return document.getElementById('panel').hidden") == hidden
    browser.press("h")
    assert browser.run("return document.getElementById('about').open")
    text = browser.run("return document.getElementById('frames').textContent")
    assert "320 × 200" in text and "draw calls: " in text and "ms of JavaScript" in text, text
    for mixes, read in ((True, 3), (False, 1)):  # two lights and their mix, or the mix alone
        texels, size = browser.run("""
Object.assign(page, {dirty: true, lightIsOld: arguments[0]});
page.frame(performance.now());
page.tellFrames();
const {width, height} = room.atlas;
return [document.getElementById('frames').textContent, width * height];""", mixes)
        near(float(texels.split("light maps: ")[1].split(";")[0].replace(",", "")), read * size, 5e-3 * read * size)
    browser.press("Escape")
    assert not browser.run("return document.getElementById('about').open")
    # A slider has the keys while it has the focus: it moves, and nobody walks.
    browser.run(STAND, MIDDLE, NORTH)
    browser.run("page.panel.unfold(true); document.getElementById('light0').focus()")
    browser.press("ArrowLeft")
    assert browser.run("return page.lights.states[0].power < room.lights[0].power")
    assert browser.viewer()["eye"] == MIDDLE
    browser.choose_preset()
    browser.run("page.canvas.focus(); page.panel.unfold(false)")


def check_orbit(browser):
    """The right button turns around what was in the middle of the view, which stays there: on foot and in flight."""
    for flies in (False, True):
        browser.run(STAND, MIDDLE, [0.6, 0, -0.8])
        browser.run("page.walker.flies = arguments[0]", flies)
        place = browser.run("return page.meet(160, 100).place")
        browser.drag((160, 100), (200, 20), button="right")
        browser.rest()
        near(browser.run("return page.meet(160, 100).place"), place, 0.02)
        eye = browser.viewer()["eye"]
        assert math.dist(eye, MIDDLE) > 0.3, eye
        if flies:
            near(math.dist(eye, place), math.dist(MIDDLE, place), 0.02)
        else:
            near(eye[1], 2.2, 0.01)  # nobody who walks is taller
    assert browser.run("return document.querySelectorAll('#rings i').length") == 0
    browser.run(STAND, MIDDLE, NORTH)
    browser.turn_wheel(modifiers=2)
    assert browser.viewer()["angle"] == 1  # that is the browser's zoom


def check_slow_frames(browser):
    """Frames that take long while something moves are followed by ones of fewer pixels; at rest all are drawn."""
    widths = browser.run("""
const widths = [];
page.movingShare = 1;
for (let i = 0; i < 3; ++i) {
  page.fitFrames(true, 200);
  page.renderer.draw(page.walker);
  widths.push(page.canvas.width);
}
page.wake();
return widths;""")
    assert widths == [224, 157, 110], widths
    browser.until("return page.canvas.width === arguments[0]", SIZE[0], seconds=10)
    browser.rest()


def check_mouse(browser):
    browser.run(STAND, MIDDLE, NORTH)
    browser.drag((150, 100), (130, 110))
    browser.rest()
    viewer = browser.viewer()  # what was under the pointer stays there, near the middle
    near([viewer["yaw"], viewer["pitch"]], [20 / SIZE[1], 10 / SIZE[1]], 1e-6)
    browser.turn_wheel()
    near(browser.viewer()["angle"], math.exp(-0.08), 1e-6)
    check_orbit(browser)
    browser.run(STAND, MIDDLE, [0, -0.8, -0.6])
    browser.click(160, 100)
    text = browser.run("return document.getElementById('reading').textContent")
    assert " lx" in text and "±" in text and "left" in text and "right" in text, text
    lux, luminance = (float(line.split()[0].replace(",", "")) for line in text.split("\n")[:2])
    near(luminance / lux, 0.5 / np.pi, 0.01 * luminance / lux)  # as the walls reflect half
    browser.press("Escape")
    assert browser.run("return document.getElementById('reading').hidden")


def check_touch(browser):
    browser.run_command("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
    browser.run(STAND, MIDDLE, NORTH)
    browser.touch([(180, 100)], [(220, 100)])  # beside the pad
    near(browser.viewer()["yaw"], -40 / SIZE[1], 1e-6)
    browser.run(STAND, MIDDLE, NORTH)
    browser.touch([(180, 80), (220, 80)], [(180, 120), (220, 120)])
    near(browser.viewer()["eye"], [3, 1.6, 2.5 - 2 * 40 * 2.5 / SIZE[1]], 1e-3)
    browser.run(STAND, MIDDLE, [0, -0.8, -0.6])
    browser.touch([(160, 100)])
    assert " lx" in browser.run("return document.getElementById('reading').textContent")
    assert not browser.run("return document.getElementById('reading').hidden")
    browser.run("page.points.removeAll(); document.getElementById('pad').style.display = 'block'")
    x, y, width = browser.run("""
const box = document.getElementById('pad').getBoundingClientRect();
return [box.left + box.width / 2, box.top + box.height / 2, box.width];""")
    browser.run(STAND, MIDDLE, NORTH)
    browser.touch([(x + 0.4 * width, y)], seconds=0.5)
    eye = browser.viewer()["eye"]
    assert eye[0] > 3.2 and abs(eye[2] - 2.5) < 0.1, eye
    browser.run("document.getElementById('pad').style.display = ''")
    browser.run_command("Emulation.setTouchEmulationEnabled", {"enabled": False})


def check_plan(browser):
    """T shows the storey to scale, cut below its ceiling; what is moved there comes to steps, lines and middles."""
    browser.run(STAND, MIDDLE, NORTH)
    browser.press("t")
    *storey, pixel = browser.run("const {floor, ceiling, cut, walls, metresAcross} = page.plan; "
                                 "return [floor, ceiling, cut, walls.getTotalLength(), metresAcross]")
    near(storey, [0, 3, 1.6 + 0.9 * 1.4, 2 * (6 + 5)], 1e-2)
    place_of = "return page.placeOf(arguments[0])"
    low, high, top = (np.array(browser.run(place_of, place)) for place in ([0, 0, 0], [6, 0, 5], [0, 3, 0]))
    near(high - low, np.array([6, 5]) / pixel, 0.1)
    near(top, low, 0.1)
    table = [4.5, 0.8, 1.5]
    x, y = browser.run(place_of, table)
    browser.click(x, y)
    near(browser.run("return page.points.all[0].place"), table, pixel)
    browser.run("page.points.removeAll()")
    browser.drag((x, y), (x + 20, y + 10))
    near(browser.run(place_of, table), [x + 20, y + 10], 0.1)
    under = "return [...page.plan.pointAt(100, 100, 0), page.plan.metres]"
    before = browser.run(under)
    browser.turn_wheel()
    near(browser.run(under), [*before[:3], before[3] * math.exp(-0.08)], 1e-3)
    near(browser.run("""
const {plan} = page;
plan.metres = 2;  // 8 pixels are 8 cm
return [[3.03, 2.46, 0, 9, 9], [1.3, 1.1, 0, 1.33, 4], [1.3, 1.1, 0.5, 1.83, 4], [1.2, 1.1, 0, 1.33, 4]].map(
    ([x, z, aside, otherX, otherZ]) => plan.snap(
        [x, 2.9, z], [[-aside, 0, 0], [aside, 0, 0]], [[otherX, 2.9, otherZ]], 0.25).place);"""), [[3, 2.9, 2.5], [1.33, 2.9, 1], [1.33, 2.9, 1], [1.25, 2.9, 1]], 1e-6)
    browser.press("t")
    assert browser.viewer()["eye"] == MIDDLE and not browser.run("return page.plan.on")


def check_gamepad(browser):
    browser.run(STAND, MIDDLE, NORTH)
    browser.run("""
navigator.getGamepads = () => [{connected: true, axes: [0, -1, 0.5, 0]}];
window.dispatchEvent(new Event('gamepadconnected'));
""")
    browser.wait(0.5)
    browser.run("navigator.getGamepads = () => []")
    browser.rest()
    viewer = browser.viewer()
    assert viewer["eye"][2] < 2.3 and 0.05 < viewer["yaw"] < 2, viewer


def check_link(browser, page):
    browser.run(STAND, [2, 1.5, 3], [0.6, 0, -0.8])
    browser.run(SET_POWER, "left", 0.5)
    browser.run("page.lights.setKelvin(1, 2700); page.lights.states[1].solo = true; page.setExposure(1.5);"
                "document.getElementById('link').click()")
    time.sleep(0.2)
    state = browser.run("return location.hash.slice(1)")
    before = browser.pose()
    browser.open(page, state)
    browser.rest()  # nobody sinks to the knees meanwhile, or rises
    near(browser.pose(), before, 1e-4)
    power, kelvin, stops = browser.run(
        "return [page.lights.states[0].power / room.lights[0].power, page.lights.states[1].kelvin, page.stops]")
    near([power, kelvin, stops], [0.5, 2700, 1.5], 1e-3)
    assert browser.run("return page.lights.states.map((state) => state.solo)") == [False, True]
    sound = '{"eye":[2,1.5,3],"look":[0,0,1],"ev":1,"lights":{"left":[1,1,2700]},"day":null}'
    for old, new in (("{", "{damaged"), ("[0,0,1]", "[0,0]"), ("1,1,2700", "1e999,1,0"), ("1,1,2700", '"1",1,0'),
                     ("[1,1,2700]", "null"), ("2700", "[1,1]"), ("2700", "[1,1,1e999]"), ("2700", '"red"'),
                     ("null", "[1]"), ("null", '["a","b"]'), ("[2,1.5,3]", "[2,1.5,1e300]")):
        browser.open(page, urllib.parse.quote(sound.replace(old, new, 1)))
        told = browser.run("return document.getElementById('message').textContent")
        assert "damaged" in told, (old, new, told)


def saved_picture(browser, folder):
    return channels_of(browser.saved(folder, "*.png", lambda: browser.press("p")))


def neutral_srgb(colour):
    """Khronos PBR Neutral (https://github.com/KhronosGroup/ToneMapping, 2024), and the curve of sRGB."""
    smallest = min(colour)
    colour = np.asarray(colour) - (smallest - 6.25 * smallest ** 2 if smallest < 0.08 else 0.04)
    peak = max(colour)
    if peak > 0.76:
        lower = 1 - 0.24 ** 2 / (peak + 0.24 - 0.76)
        part = 1 - 1 / (0.15 * (peak - lower) + 1)
        colour = colour * lower / peak * (1 - part) + lower * part
    return np.where(colour <= 0.0031308, 12.92 * colour, 1.055 * np.maximum(colour, 1e-9) ** (1 / 2.4) - 0.055)


def check_pictures(browser, folder):
    """What P saves is the picture by the display transform, and V's colours are the legend's."""
    browser.run(STAND, [3, 1.6, 4], [0, -0.6, -0.8])
    browser.rest()
    radiance = browser.radiance()
    white = browser.run("return room.display.white.map((part) => page.renderer.exposure / page.renderer.unit / part)")
    picture = saved_picture(browser, folder)
    assert picture.shape[:2] == (SIZE[1], SIZE[0]), picture.shape
    places = [(40, 150), (160, 100), (280, 160), (100, 120)]
    for x, y in places:
        near(picture[y, x], neutral_srgb(np.array(white) * radiance[y, x].astype(float)), 3 / 255)
    browser.press("v")
    middles = np.array(browser.run("""
return [...document.querySelectorAll('#legend span')].map(
    ({textContent: text}) => parseFloat(text.replace(',', '')) * (text.endsWith('k') ? 1000 : 1));"""))
    assert not browser.run("return document.getElementById('legend').hidden")
    near(middles / middles[0], np.arange(1, 16, 2), 1e-6)
    assert middles[0] == float(f"{middles[0]:.1g}"), middles  # round
    colours = saved_picture(browser, folder)
    palette = np.array(browser.run("return page.renderer.colours")) / 255
    top = 2 * (middles[3] + middles[0])
    lux = [browser.run(CLICK, x + 0.5, y + 0.5)["lux"] for x, y in places]

    def check_colours(share_of):
        for value, (x, y) in zip(lux, places):
            near(colours[y, x], palette[int(round(255 * np.clip(share_of(value / top), 0, 1)))], 8 / 255)

    check_colours(lambda share: share)
    choose = """
const [field, value] = arguments;
document.getElementById(field).value = value;
document.getElementById(field).dispatchEvent(new Event('input'));"""
    browser.run(choose, "palette", browser.run("return room.palettes.findIndex(({name}) => name === 'viridis')"))
    colours = saved_picture(browser, folder)
    palette = np.array(browser.run("return page.renderer.colours")) / 255
    assert np.abs(palette[[0, 255]] - [[0.267, 0.005, 0.329], [0.993, 0.906, 0.144]]).max() < 0.01  # of matplotlib
    check_colours(lambda share: share)
    browser.run(choose, "contours", 1)
    colours = saved_picture(browser, folder)
    check_colours(lambda share: (np.floor(share * 8) + 0.5) / 8)
    # Isolines and bands lie over the picture, around the middles of the steps.
    top = 0.9 * top
    browser.run(choose, "top", top)
    share = np.array(browser.run("return page.renderer.seenLux(page.walker)"))
    assert len(share) == 96 * 64 and 0.01 < (share > top).mean() < 0.2
    steps = browser.radiance(1, 2)[:, :, 0] * browser.run("return room.lux") / top * 8
    off = np.abs(steps % 1 - 0.5)
    for contours, drawn, left in ((2, None, 0.25), (3, 0.08, 0.12)):
        browser.run(choose, "contours", contours)
        colours = saved_picture(browser, folder)
        changed = np.abs(colours - picture).max(axis=2) > 0.02
        if drawn:
            assert changed[(off < drawn) & (steps < 8)].mean() > 0.97
        assert 0.01 < changed.mean() < 0.3 and changed[off > left].mean() < 0.01
        on = changed & (off < 0.1)
        near(np.abs(colours[on] - palette[np.clip(np.round(255 * steps[on] / 8), 0, 255).astype(int)]).mean(), 0, 0.02)
    browser.run(choose, "palette", 0)
    browser.run(choose, "top", "")
    browser.run(choose, "contours", 0)
    browser.press("v")
    assert browser.run("return document.getElementById('legend').hidden")


def check_coats(browser):
    """A rough coat reflects no more than the mean of what lights its surface; a smooth one has highlights."""
    browser.run(STAND, [1.5, 1.6, 4.7], [0, -0.9, -0.45])  # where the floor reflects a lamp
    rough, smooth = browser.run("""
const {renderer, walker} = page, {materials} = renderer;
renderer.makeProbe();
renderer.updateProbe();
const brightest = [0.25, 0.01].map((alpha) => {
  renderer.materials = renderer.floatTexture(3, room.materials.length, Float32Array.from(
      room.materials.flatMap(() => [0, 0, 0, 0, 0.9, 0.9, 0.9, alpha, 1, 1, 0, 0])));
  const [seen, lit] = [1, 2].map((mode) => renderer.radiance(walker, 96, 64, 1, mode));
  return Math.max(...seen.filter((_, i) => i % 3 === 1).map((green, i) => Math.PI * green / lit[3 * i]));
});
Object.assign(renderer, {materials, probe: null});
return brightest;""")
    print(f"coats reflect {rough:.3f} and {smooth:.3f} of the mean of what lights them")
    assert 0.3 < rough < 1.1 and smooth > 2, (rough, smooth)  # the lamps' mean is not quite white


def check_hours(browser):
    hour = "return [page.lights.hour.day, 60 * room.hours.times[0] + 30 * page.lights.hour.time]"
    day, minutes = browser.run(hour)
    for key, modifiers, code, moved in (("]", 0, "BracketRight", (0, 15)), ("{", 8, "BracketLeft", (0, -45)),
                                        ("PageDown", 0, None, (1, -45))):
        browser.press(key, modifiers, code)
        near(browser.run(hour), [day + moved[0], minutes + moved[1]], 1e-6)
    # Between the 21sts the sky is mixed, over the end of the year, too; weather is not.
    skies = np.array(browser.run("return [...room.hours.luminances]")).reshape(12, 48, -1)
    dates = np.array([datetime.date(2026, month, 21).timetuple().tm_yday for month in range(1, 13)])
    choose = """
const date = document.getElementById('date');
room.hours.weather = arguments[1];
date.value = arguments[0];
date.dispatchEvent(new Event('input'));
return [page.lights.skyPowers(), document.querySelector('output[for=date]').textContent, page.stops];"""
    browser.run("page.panel.setHour(1, 20.5)")
    around = np.arange(-1, 13)
    for text, nearest in (("5 Jan", "21 Dec"), ("21 Mar", "21 Mar"), ("30 Apr", "21 Apr"), ("31 Dec", "21 Dec")):
        day = datetime.datetime.strptime(f"{text} 2026", "%d %b %Y").timetuple().tm_yday
        place = np.interp(day, dates[around % 12] + 365 * (around // 12), around)
        before, part = int(np.floor(place)), place % 1
        expected = (1 - part) * skies[before % 12, 20:22] + part * skies[(before + 1) % 12, 20:22]
        powers, shown, stops = browser.run(choose, day, False)
        assert shown == text, (shown, text)
        near(powers, expected.mean(axis=0), 1e-6 * expected.max())
        powers, shown, _ = browser.run(choose, day, True)
        assert shown == nearest, (shown, nearest)
        near(powers, skies[round(place) % 12, 20:22].mean(axis=0), 1e-6 * expected.max())
    browser.run("document.getElementById('follow').click(); page.setExposure(2)")
    assert browser.run(choose, 172, False)[2] == 2
    browser.run("document.getElementById('follow').click()")
    near(browser.run(choose, 173, False)[2], stops, 0.1)


def check_points(browser, folder, scene, *options):
    """Clicks stay as rings and rows, and `photile measure` finds the saved ones where they are, with the same lux."""
    browser.run("page.stand(0); page.wake()")
    browser.rest()
    places = [(150, 90), (90, 110), (240, 120)]
    for place in places:
        browser.click(*place)
    rings = browser.run("return [...document.querySelectorAll('#rings i')].map((ring) => [ring.textContent, "
                        "parseFloat(ring.style.left), parseFloat(ring.style.top)])")
    assert [ring[0] for ring in rings] == ["1", "2", "3"], rings
    near([ring[1:] for ring in rings], places, 1)
    # Targets are listed by areas as the reference has them.
    offered = browser.run("return [...document.querySelectorAll('#target optgroup, #target optgroup option')].map("
                          "(one) => one.label)")
    listed = re.findall(r"^\| (?:\*\*(.+)\*\*|`(.+)`\*? \| \d+ \| [^|]+ \| (\d+)) \|",
                        (SOURCE / "docs/reference/targets.md").read_text(), re.MULTILINE)
    assert len(listed) > 100 and offered == [area or f"{lux} lx {name.replace('-', ' ')}" for area, name, lux in listed]
    rows = "return [...document.querySelectorAll('#points li')].map((row) => row.textContent)"
    browser.run("document.querySelectorAll('#points .drop')[1].click()")
    full, error = browser.run("const {lux, error} = page.points.read(page.points.all[0]); return [lux[0], error[0]]")
    browser.run("""
document.getElementById('maintenance').value = 0.8;
document.getElementById('target').value = '';
document.getElementById('lux').value = arguments[0];
document.getElementById('target').dispatchEvent(new Event('input'));""", 0.9 * full)
    first, second = browser.run(rows)
    assert first.startswith("1") and second.startswith("3") and "below" in first, (first, second)
    assert browser.run("return document.querySelectorAll('#rings i').length") == 2

    def saved_points(kind):
        return browser.saved(folder, f"points.{kind}", lambda: browser.run(
            "document.getElementById(arguments[0]).click()", f"save-{kind}"))

    table = saved_points("csv").read_text().splitlines()
    assert table[0] == ("point,x,y,z,dx,dy,dz,lux,standard_error,lux left,standard_error left,lux right,"
                        "standard_error right,lux sky,standard_error sky"), table[0]
    points = [list(map(float, line.split(","))) for line in table[1:]]
    near(points[0][7:9], [0.8 * full, 0.8 * error], 0.01 * error)
    photile("measure", scene, "--points", saved_points("pts"), "-o", folder / "points.json", "-q", "--photons", "1M",
            *options)
    sensors = json.loads((folder / "points.json").read_text())["grids"][0]["sensors"]
    for point, sensor in zip(points, sensors, strict=True):
        print(f"lux {point[7]:.1f} +- {point[8]:.1f}, measured {0.8 * sensor['lux']:.1f}")
        near(point[1:4], sensor["position"], 1e-6)
        near(point[7], 0.8 * sensor["lux"], 0.03 * point[7] + 4 * np.hypot(point[8], sensor["standard_error"]))
    browser.run("document.getElementById('no-points').click()")
    assert browser.run(rows) == [] and browser.run("return document.getElementById('points').hidden")


def check_lamps(browser):
    """Solo leaves one lamp alight, and a colour keeps the power."""
    weights = "return page.lights.weights()"
    left, right = browser.run(weights)
    solo = "document.querySelectorAll('.solo')[arguments[0]].click()"
    browser.run("page.lights.states[0].on = false")
    browser.run(solo, 0)
    near(browser.run(weights), [left, [0, 0, 0]], 1e-12)  # though it is off
    browser.run(solo, 0)
    near(browser.run(weights), [[0, 0, 0], right], 1e-12)
    browser.run("page.lights.states[0].on = true")
    browser.run("""
const picker = document.querySelector('input[type=color]');
picker.value = '#ff8040';
picker.dispatchEvent(new Event('input', {bubbles: true}));
picker.dispatchEvent(new Event('change', {bubbles: true}));""")
    colour = np.array([255, 128, 64]) / 255
    linear = np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)
    emitted = linear * browser.run("return room.lights[0].color")
    near(browser.run(weights)[0], left[0] * linear / (emitted @ [0.2126, 0.7152, 0.0722]), 1e-9 * left[0])
    assert browser.run("return document.querySelector('input[type=color]').value") == "#ff8040"
    browser.run("document.querySelector('.colour button').click()")
    near(browser.run(weights)[0], left, 1e-12)


def check_undo(browser):
    """Each change of the lamps is taken back and made again: a drag of a slider is one."""
    browser.run("page.panel.unfold(true); document.getElementById('light0').scrollIntoView({block: 'center'})")
    start = browser.run("return page.lights.states[0].power")
    x, y, width = browser.run("""
const box = document.getElementById('light0').getBoundingClientRect();
return [box.left, box.top + box.height / 2, box.width];""")
    browser.drag(*((x + share * width, y) for share in (0.8, 0.7, 0.5, 0.3)))
    dimmed = browser.run("return page.lights.states[0].power")
    assert dimmed < 0.5 * start, (dimmed, start)
    browser.run("document.querySelectorAll('.solo')[1].click(); page.canvas.focus()")

    def press(key, shift=0):
        browser.press(key, 2 + shift)
        return browser.run("const {lights} = page; return [lights.states[0].power, lights.anySolo, "
                           "document.querySelectorAll('.solo')[1].getAttribute('aria-pressed')]")

    assert press("z") == [dimmed, False, "false"]
    assert press("z") == [start, False, "false"]
    assert press("y") == [dimmed, False, "false"]
    assert press("z", 8) == [dimmed, True, "true"]
    browser.choose_preset()
    assert press("z") == [dimmed, True, "true"]
    browser.choose_preset()
    browser.run("page.panel.unfold(false)")


def check_presets(browser):
    for name, states in (("left alone", [True, False]), (None, [True, True])):
        browser.choose_preset(name)
        assert browser.run("return page.lights.states.map((state) => state.on)") == states


def test_controls(browser, folder):
    page = folder / "hall.html"
    scene, made = obj_room(folder), ["--quality", "draft", "--photons", "50k", "--texel", "0.2", "-q"]
    photile("publish", scene, "-o", page, "--eye", "3,1.6,4.5", "--look-at", "3,2,0", *made)
    browser.open(page.as_uri())
    assert browser.run("return [room.cameras[0].name, ...room.cameras[0].position]") == ["view", 3, 1.6, 4.5]
    for check in (check_keyboard, check_slow_frames, check_mouse, check_touch, check_plan, check_gamepad, check_presets,
                  check_lamps, check_undo):
        check(browser)
    check_pictures(browser, folder)
    check_coats(browser)
    check_link(browser, page.as_uri())
    photile("publish", scene, "-o", page, "--set", "up=z", *made, "--sky", "patches=145", "--site", "52.5,13.4,1")
    browser.open(page.as_uri())
    check_hours(browser)
    check_points(browser, folder, scene, "--set", "up=z")


# What the canvas shows of a frame, and its light.
FRAME = "page.setExposure(arguments[0]);" + SHOWN + """
const light = new Float32Array(4 * width * height);
gl.bindFramebuffer(gl.FRAMEBUFFER, page.renderer.screen.pixels);
gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, light);
gl.bindFramebuffer(gl.FRAMEBUFFER, null);
return [base64(shown), base64(light)];
"""


def check_transform(browser, folder, stops):
    """The canvas shows the light of a frame as `photile relight` shows a picture of that light."""
    shown, light = map(pixels_of, browser.run(FRAME, stops), (np.uint8, np.float32))
    file, png = folder / "frame.exr", folder / "frame.png"
    names = ["R", "G", "B", *(f"ViewLayer.Combined_room.{channel}" for channel in "RGB")]
    spec = oiio.ImageSpec(SIZE[0], SIZE[1], len(names), oiio.FLOAT)
    spec.channelnames = names
    spec.attribute("photile.white", " ".join(map(str, browser.run("return room.display.white"))))
    output = oiio.ImageOutput.create(str(file))
    assert output.open(str(file), spec)
    output.write_image(np.ascontiguousarray(np.concatenate([light, light], 2)))
    output.close()
    photile("relight", file, "-o", png, "--set", "auto_exposure=off", "--exposure", stops)
    expected = np.round(255 * channels_of(png))
    difference = np.abs(shown - expected)
    print(f"{stops:+} stops: {100 * (difference > 0).mean():.2f}% of the values differ, by {difference.max()} at most")
    assert difference.max() <= 1
    assert expected.max() > 250 and expected.min() < 200  # of lamps, and of the room


def automatic_exposure(light):
    """The rule of docs/reference/pictures.md."""
    luminance = light @ [0.2126, 0.7152, 0.0722]
    luminance = np.sort(luminance[luminance > 0])
    luminance = luminance[luminance >= luminance[-1 - len(luminance) // 10] / 1000]
    median, tenth = np.median(luminance), len(luminance) // 10
    lit = luminance[luminance >= median / 20]
    surfaces = lit[lit <= 20 * median]
    counted = lit[:max(len(surfaces), len(lit) - tenth)]
    return min(0.36 / np.exp(np.log(counted).mean()), 2.5 / surfaces[-1 - len(surfaces) // 10])


def test_display(browser, folder):
    """A page shows a warm room with the white and the exposure of `photile render`, by the same transform."""
    scene = obj_room(folder)
    # A pane before the far wall lets 0.7 through and reflects a little, as the glass of IFC does.
    (folder / "hall.mtl").write_text((folder / "hall.mtl").read_text().replace("Ke 80 90 100", "Ke 100 60 25") +
                                     "newmtl pane\nKd 0.1 0.2 0.3\nd 0.3\n")
    scene.write_text(scene.read_text() + "v 2 0.5 0.5\nv 4 0.5 0.5\nv 4 2.5 0.5\nv 2 2.5 0.5\n"
                                         "usemtl pane\nf -4 -3 -2 -1\n")
    made = ["--quality", "draft", "--photons", "50k", "-q"]
    page, rendered = folder / "hall.html", folder / "hall.exr"
    photile("publish", scene, "-o", page, "--texel", "0.1", *made)
    browser.open(page.as_uri())
    camera = browser.run("return room.cameras[0]")
    photile("render", scene, "-o", rendered, *made)
    display = browser.run("return room.display")
    white = oiio.ImageInput.open(str(rendered)).spec().getattribute("photile.white")
    near(np.array(display["white"]) / np.array(list(map(float, white.split()))), 1, 0.003)
    assert display["white"][0] > 1.1 > 0.8 > display["white"][2], display
    near(display["exposure"] / automatic_exposure(channels_of(rendered).reshape(-1, 3)), 1, 0.01)
    # Of other lamps the white is the same.
    other = folder / "other.html"
    photile("publish", scene, "-o", other, "--texel", "0.1", *made, "--light", "*=2000K", "--light", "left=off")
    browser.open(other.as_uri())
    near(np.array(browser.run("return room.display.white")) / display["white"], 1, 0.003)

    browser.open(page.as_uri())
    at = ["--eye", "3,1.6,4.5", "--look-at", "3,2.275,0"]
    photile("render", scene, "-o", rendered, "-o", folder / "hall.png", "--size", "%dx%d" % SIZE,
            "--field-of-view", math.degrees(camera["angle"]), *at, *made)
    browser.run("page.walker.stand({...room.cameras[0], position: [3, 1.6, 4.5], forward: normalized([0, 0.15, -1])})")
    browser.rest()
    for stops in (-3, 0, 2.5):
        check_transform(browser, folder, stops)
    # Through the pane, whose image is in the middle, as beside it.
    page_light, light = browser.radiance().astype(float), channels_of(rendered)
    for what, part in (("behind the pane", np.s_[125:155, 135:185]), ("beside it", np.s_[125:155, 60:90])):
        ratio = page_light[part].mean((0, 1)) / light[part].mean((0, 1))
        print(f"{what}: {ratio} of the light of the picture")
        near(ratio, 1, 0.04)


def room_of_lights(folder, count):
    """A floor under rows of 16 small lamps."""
    quads = {"floor": [[(-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2)]]}
    materials = {"floor": "Kd 0.5 0.5 0.5"}
    for i in range(count):
        x, z = -1.9 + 3.8 * (i % 16) / 16, -1.9 + 3.8 * (i // 16) / 16
        quads[f"lamp{i}"] = [[(x, 2, z), (x + 0.05, 2, z), (x + 0.05, 2, z + 0.05), (x, 2, z + 0.05)]]
        materials[f"lamp{i}"] = "Kd 0 0 0\nKe 100 100 100"
    return write_obj(folder / f"lights{count}.obj", quads, materials)


def test_many_lights(browser, folder):
    """A frame costs the same with two lights and with 256."""
    draws = {}
    for count in (2, 256):
        scene = room_of_lights(folder, count)
        page = folder / f"lights{count}.html"
        photile("publish", scene, "-o", page, "--quality", "draft", "--photons", "100k", "--texel", "0.1", "-q")
        browser.open(page.as_uri())
        assert browser.run("return room.lights.length") == count
        time = np.median(browser.run(FRAME_TIMES, 60, False))
        draws[count] = browser.run("return page.renderer.drawCalls")
        print(f"{count} lights: {draws[count]} draw calls, {time:.2f} ms of main thread a frame")
        assert time < LARGEST_FRAME_MS
    assert draws[2] == draws[256]


def main(tests, kind=Browser):
    """Runs the test that the command line names in a browser, whose pages have to report nothing."""
    if not (pathlib.Path(CHROMIUM).exists() and pathlib.Path(DRIVER).exists()):
        print("skipped: no chromium with its driver; apt-get install chromium chromium-driver")
        sys.exit(77)
    browser = kind()
    try:
        with tempfile.TemporaryDirectory() as folder:
            tests[f"test_{sys.argv[1]}"](browser, pathlib.Path(folder))
        messages = [entry["message"] for entry in browser.driver.get_log("browser")]
        assert not messages, messages
    finally:
        browser.driver.quit()


if __name__ == "__main__":
    main(globals())
