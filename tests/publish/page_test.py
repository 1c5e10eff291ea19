#!/usr/bin/env python3
"""Pages of `photile publish` in Chromium, beside `photile render` and `photile measure`.

Usage: page_test.py cornell_box|many_lights PHOTILE SOURCE_FOLDER
"""

import base64
import json
import pathlib
import subprocess
import sys
import tempfile
import time

try:
    import numpy as np
    import OpenImageIO as oiio
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

CHROMIUM, DRIVER = "/usr/bin/chromium", "/usr/bin/chromedriver"
SIZE = (320, 200)  # pixels of the page and of pictures

# Limits. A picture's squared error relative to what is seen, as `photile compare` has it; the mean;
# lux beside those of a picture, of every click, and beside measured ones, of nine clicks in ten, for
# light maps blur light at the borders of shadows, in pictures, too (docs/light-maps.md); how many
# standard errors lux may differ more; main thread of a frame, ms.
LARGEST_REL_MSE = 0.003
LARGEST_MEAN = 0.005
LARGEST_LUX = 0.01
STANDARD_ERRORS = 3
LARGEST_FRAME_MS = 4

RADIANCE = """
const [width, height] = arguments;
const bytes = new Uint8Array(page.renderer.radiance(page.walker, width, height, 4).buffer);
let text = '';
for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
return btoa(text);
"""
# A new state of a light, by what a user's slider and switch do.
SET_POWER = """
const [name, factor] = arguments;
const i = room.lights.findIndex((light) => light.name === name);
page.lights.states[i].power = factor * room.lights[i].power;
page.lights.states[i].on = factor > 0;
page.changed('light');
page.frame(performance.now());
"""
CLICK = """
const [x, y] = arguments;
const hit = page.meet(x, y);
if (!hit) return null;
const [a, b, c] = page.surfaces.corners(hit.triangle);
const {lux, error} = page.illuminance(hit);
return {place: hit.place, normal: normalized(cross(subtract(b, a), subtract(c, a))), lux, error};
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
        # The page must do without a network.
        self.run_command("Network.enable", {})
        self.run_command("Network.emulateNetworkConditions",
                         {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0})

    def open(self, file):
        self.driver.get(file.as_uri())
        for _ in range(600):
            if not self.run("return document.getElementById('loading')"):
                return
            time.sleep(0.1)
        raise AssertionError("the page did not open: " +
                             self.run("return document.getElementById('loading').textContent"))

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def radiance(self):
        text = self.run(RADIANCE, *SIZE)
        return np.frombuffer(base64.b64decode(text), np.float32).reshape(SIZE[1], SIZE[0], 3)

    def messages(self):
        return [entry["message"] for entry in self.driver.get_log("browser")]


def channels_of(file, wanted):
    picture = oiio.ImageInput.open(str(file))
    names = picture.spec().channelnames
    channels = [names.index(channel) for channel in wanted]
    return np.asarray(picture.read_image(format=oiio.FLOAT))[:, :, channels].astype(float)


def radiance_of(file):
    return channels_of(file, "RGB")


def compare(what, page, reference):
    """Pixels that see a lamp or are next to one are left out, as in `photile compare`."""
    page = page.astype(float)
    light = reference @ [0.2126, 0.7152, 0.0722]
    lamp = light > 20 * np.median(light[light > 0])
    wide = np.pad(lamp, 1)
    lamp = np.any([np.roll(wide, shift, (0, 1)) for shift in
                   [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]], axis=0)[1:-1, 1:-1]
    counts = ~lamp & (light > 0)
    mean = reference[counts].mean()
    error = ((page - reference) ** 2 / (reference ** 2 + 0.01 * mean ** 2))[counts].mean()
    ratio = page[counts].mean() / mean
    print(f"{what}: relMSE {error:.5f}, mean {ratio:.4f}")
    assert error <= LARGEST_REL_MSE, what
    assert abs(ratio - 1) <= LARGEST_MEAN, what


def check_clicks(browser, folder, scene, rendered, more):
    """Lux at ten places beside those of a picture, and beside measured ones."""
    clicks = []
    for i in range(200):
        x, y = (0.05 + 0.9 * (0.754877 * i % 1)) * SIZE[0], (0.05 + 0.9 * (0.569840 * i % 1)) * SIZE[1]
        click = browser.run(CLICK, x, y)
        if click and click["lux"] > 0:
            click["rendered"] = rendered[int(y), int(x)]
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
        print(f"lux {click['lux']:.1f} +- {click['error']:.1f}, in the picture {click['rendered']:.1f}, measured "
              f"{lux:.1f} +- {error:.1f}")
        assert abs(click["lux"] - click["rendered"]) <= LARGEST_LUX * lux + STANDARD_ERRORS * click["error"]
        beyond += abs(click["lux"] - lux) > allowed
    assert beyond <= 1, f"{beyond} of 10 clicks are off"


def test_cornell_box(browser, folder):
    scene = SOURCE / "scenes/cornell-box/cornell-box.gltf"
    page, picture = folder / "box.html", folder / "box.exr"
    photile("publish", scene, "-o", page, "-q")
    photile("render", scene, "-o", picture, "-q", "--size", "%dx%d" % SIZE)
    browser.open(page)
    compare("as published", browser.radiance(), radiance_of(picture))
    photile("relight", picture, "--light", "lamp=x0.3", "-o", folder / "dimmed.exr")
    browser.run(SET_POWER, "lamp", 0.3)
    compare("dimmed", browser.radiance(), radiance_of(folder / "dimmed.exr"))
    browser.run(SET_POWER, "lamp", 1)
    check_clicks(browser, folder, scene, channels_of(picture, ["Illuminance_lamp.Y"])[:, :, 0],
                 ["--photons", "2M"])
    # A link keeps the light.
    browser.run(SET_POWER, "lamp", 0.5)
    state = browser.run("return page.state")
    browser.driver.get("about:blank")
    browser.driver.get(page.as_uri() + "#" + state)
    for _ in range(300):
        if not browser.run("return document.getElementById('loading')"):
            break
        time.sleep(0.1)
    power = browser.run("return page.lights.states[0].power / room.lights[0].power")
    assert abs(power - 0.5) < 1e-3, power
    # Controls have names.
    unnamed = browser.run("""
return [...document.querySelectorAll('button, input, select')].filter((control) =>
  !control.textContent.trim() && !control.labels?.length && !control.getAttribute('aria-label')).map((c) => c.outerHTML);
""")
    assert not unnamed, unnamed


def test_many_lights(browser, folder):
    """A frame costs the same with two lights and with 256."""
    draws = {}
    for count in (2, 256):
        scene = folder / f"lights{count}.obj"
        lines, faces = ["v -2 0 -2", "v 2 0 -2", "v 2 0 2", "v -2 0 2"], ["usemtl floor", "f 4 3 2 1"]
        materials = ["newmtl floor\nKd 0.5 0.5 0.5"]
        for i in range(count):
            x, z = -1.9 + 3.8 * (i % 16) / 16, -1.9 + 3.8 * (i // 16) / 16
            first = len(lines) + 1
            lines += [f"v {x} 2 {z}", f"v {x + 0.05} 2 {z}", f"v {x + 0.05} 2 {z + 0.05}", f"v {x} 2 {z + 0.05}"]
            faces += [f"usemtl lamp{i}", f"f {first} {first + 1} {first + 2} {first + 3}"]
            materials.append(f"newmtl lamp{i}\nKd 0 0 0\nKe 100 100 100")
        (folder / f"lights{count}.mtl").write_text("\n".join(materials) + "\n")
        scene.write_text("\n".join([f"mtllib lights{count}.mtl", *lines, *faces]) + "\n")
        page = folder / f"lights{count}.html"
        photile("publish", scene, "-o", page, "--quality", "draft", "--photons", "100k", "--texel", "0.1", "-q")
        browser.open(page)
        assert browser.run("return room.lights.length") == count
        times = browser.run("""
const times = [];
for (let i = 0; i < 60; ++i) {
  page.walker.turn(0.01, 0);
  page.dirty = true;
  page.frame(performance.now());
  times.push(page.frameTime);
  page.renderer.gl.finish();
}
return times.sort((a, b) => a - b);
""")
        draws[count] = browser.run("return page.renderer.drawCalls")
        print(f"{count} lights: {draws[count]} draw calls, {times[30]:.2f} ms of main thread a frame")
        assert times[30] < LARGEST_FRAME_MS
    assert draws[2] == draws[256]


def main():
    if not (pathlib.Path(CHROMIUM).exists() and pathlib.Path(DRIVER).exists()):
        print("skipped: no chromium with its driver; apt install chromium chromium-driver")
        return 77
    browser = Browser()
    try:
        with tempfile.TemporaryDirectory() as folder:
            {"cornell_box": test_cornell_box, "many_lights": test_many_lights}[sys.argv[1]](
                browser, pathlib.Path(folder))
        messages = browser.messages()
        assert not messages, messages
    finally:
        browser.driver.quit()
    return 0


if __name__ == "__main__":
    PHOTILE, SOURCE = sys.argv[2], pathlib.Path(sys.argv[3])
    sys.exit(main())
