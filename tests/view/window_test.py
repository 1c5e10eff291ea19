#!/usr/bin/python3
"""Drives `photile view` in a real window by keys and mouse, and compares what it keeps with what
`photile render` gives.

    xvfb-run window_test.py PHOTILE
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np
import OpenImageIO as oiio

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SCENES = SOURCE / "scenes/cornell-box"
NAME = "cornell-box"
MOOD = {"photile_moods": 1, "moods": {"dim": {"lamp": {"power": 7, "unit": "lm", "kelvin": 3000}}}}
SETTINGS = ["--quality", "draft", "--photons", "100k", "--size", "480x360", "--samples", "4", "--quiet"]
PATIENCE = 120
# Buttons under "Display", with one lamp and one mood.
PICTURE, ILLUMINANCE = (18, 344), (97, 344)
PANEL = 300  # columns at the left of the picture
# Rows and columns of the picture that neither the reading nor the legend covers.
FREE = slice(230, 340), slice(15, 385)
LAMP_ROW = 198  # of the only lamp, under "Lights"


def fail(text):
    sys.exit(f"window_test.py: error: {text}")


def until(condition, what):
    """The first value of condition() that is true."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.2)
    fail(f"waited {PATIENCE} s for {what}")


class Picture:
    def __init__(self, file):
        source = oiio.ImageInput.open(str(file))
        if source is None:
            fail(f"{file}: {oiio.geterror()}")
        self.spec = source.spec()
        self.pixels = np.asarray(source.read_image(format="float")).reshape(
            self.spec.height, self.spec.width, self.spec.nchannels)
        source.close()

    @property
    def rgb(self):
        return self.pixels[:, :, :3]

    def beside_panel(self):
        """What a screenshot has of the picture."""
        return self.rgb[:, PANEL:]

    def has_size(self, width, height):
        return (self.spec.width, self.spec.height) == (width, height)

    def position(self):
        """Of the camera, in the world."""
        matrix = np.array(self.spec.getattribute("worldToCamera")).reshape(4, 4)  # row vectors
        return np.linalg.inv(matrix)[3, :3]

    def lamp(self):
        return json.loads(self.spec.getattribute("photile.lights"))[0]


class Window:
    """photile view, and the hands on its keyboard and mouse."""

    settings, finished = SETTINGS, "4 of 4 samples, 0.1M paths"

    def __init__(self, photile, scene, folder, *options):
        self.folder = folder
        self.process = subprocess.Popen(
            [photile, "view", scene, "--outputs", folder, "--set", "view=standard", *self.settings, *options],
            stderr=subprocess.PIPE, text=True)
        self.id = until(lambda: self.running() and self.find("photile"), "the window")
        self.finish()

    def finish(self):
        until(lambda: self.running() and self.find(self.finished),
              "the finished picture")

    def close(self):
        self.press("ctrl+q")
        if self.process.wait(PATIENCE) != 0:
            fail(f"closing ended with {self.process.returncode}: {self.process.stderr.read()}")

    def stop(self):
        """Ends it as a system does that shuts down."""
        self.process.terminate()
        if self.process.wait(PATIENCE) != 130:
            fail(f"a signal ended with {self.process.returncode}: {self.process.stderr.read()}")

    def running(self):
        if self.process.poll() is not None:
            fail(f"photile view ended with {self.process.returncode}: {self.process.stderr.read()}")
        return True

    @staticmethod
    def find(title):
        found = subprocess.run(["xdotool", "search", "--name", title], text=True,
                               capture_output=True, check=False)
        return found.stdout.split()[-1] if found.stdout.split() else None

    @staticmethod
    def hand(*arguments):
        subprocess.run(["xdotool", *map(str, arguments)], check=True)

    def drag(self, start, end, button=1):
        self.hand("mousemove", *start)
        time.sleep(0.3)
        self.hand("mousedown", button)
        time.sleep(0.3)
        for share in (0.25, 0.5, 0.75, 1):
            self.hand("mousemove", *(round(a + share * (b - a)) for a, b in zip(start, end)))
            time.sleep(0.1)
        time.sleep(0.3)
        self.hand("mouseup", button)

    def press(self, key, seconds=0.2):
        """Longer than a slow machine takes to draw the window: shorter presses go unseen. Modifiers
        are released last: S without Ctrl walks."""
        keys = key.split("+")
        for each in keys:
            self.hand("keydown", each)
        time.sleep(seconds)
        for each in reversed(keys):
            self.hand("keyup", each)
            time.sleep(0.2)

    def click(self, x, y):
        self.hand("mousemove", x, y)
        time.sleep(0.3)
        self.hand("mousedown", 1)
        time.sleep(0.5)
        self.hand("mouseup", 1)
        time.sleep(1)

    def keep(self, key, pattern):
        """Presses a key that keeps a picture, again where it goes unseen, and reads it."""
        before = set(self.folder.glob(pattern))

        def kept():
            self.press(key)
            end = time.monotonic() + 5
            while time.monotonic() < end:
                if set(self.folder.glob(pattern)) - before:
                    return set(self.folder.glob(pattern)) - before
                time.sleep(0.1)
            return None
        return Picture(until(lambda: self.running() and kept(), f"what {key} keeps").pop())

    def picture_when(self, condition, what):
        """The first kept picture of which condition(picture) is true. Coarse ones, of moving, are
        not kept."""
        def kept():
            self.finish()
            picture = self.keep("ctrl+s", "view-*.exr")
            return picture if condition(picture) else None
        return until(kept, what)


def same_exposure(screenshot, picture):
    """The screenshot is the picture, scaled and encoded as sRGB, where that is no more than white. On borders of
    lamps, which are, it is a mix: tests/image/colours_test.cpp."""
    shown = np.where(screenshot <= 0.04045, screenshot / 12.92, ((screenshot + 0.055) / 1.055)**2.4)
    unclipped = (shown.max(axis=2) < 0.98) & (shown.min(axis=2) > 0.02)
    if unclipped.mean() < 0.1:  # coloured lamps clip one primary in most of the room
        fail(f"only {unclipped.mean():.0%} of the screenshot is between black and white")
    # Of each primary its own: the white is balanced.
    scale = np.median(shown[unclipped] / picture[unclipped], axis=0)
    expected = scale * picture
    unclipped &= expected.max(axis=2) <= 1
    encoded = np.where(expected <= 0.0031308, 12.92 * expected,
                       1.055 * np.maximum(expected, 1e-9)**(1 / 2.4) - 0.055)
    return np.abs(encoded - screenshot)[unclipped].max() < 2 / 255


def shows_illuminance(photile, scene, window):
    """In false colour, the window shows what `render --illuminance` draws left of its legend."""
    drawing = window.folder / "lux.png"
    subprocess.run([photile, "render", scene, "--illuminance", drawing, *SETTINGS], check=True)
    expected = Picture(drawing).rgb[FREE]
    if len(np.unique(expected.reshape(-1, 3), axis=0)) < 100:
        fail("too few colours to compare")

    def shown():
        window.click(*ILLUMINANCE)
        shot = window.keep("F12", "screenshot-*.png")
        return np.abs(shot.beside_panel()[FREE] - expected).max() < 0.5 / 255
    until(shown, "the picture of illuminance")
    window.click(*PICTURE)


def display_answers():
    """xvfb-run may start its command a little before the screen in memory can be opened."""
    return subprocess.run(["xdotool", "getdisplaygeometry"], stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, check=False).returncode == 0


def refuses_without_a_display(photile, scene):
    environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
    done = subprocess.run([photile, "view", scene, "--quiet"], env=environment, text=True,
                          capture_output=True, check=False)
    if done.returncode == 0 or "no window can be opened" not in done.stderr:
        fail(f"without a display: {done.returncode}, {done.stderr}")


def main():
    photile = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for file in SCENES.glob(f"{NAME}.*"):
            shutil.copy(file, folder)
        scene = folder / f"{NAME}.gltf"
        (folder / f"{NAME}.moods.json").write_text(json.dumps(MOOD))
        refuses_without_a_display(photile, scene)
        until(display_answers, "the display")
        window = Window(photile, scene, folder)

        kept = window.keep("ctrl+s", "view-*.exr")
        subprocess.run([photile, "render", scene, "-o", folder / "expected.exr", *SETTINGS],
                       check=True)
        expected = Picture(folder / "expected.exr")
        if list(kept.spec.channelnames) != list(expected.spec.channelnames):
            fail("the kept picture has other channels than a rendered one")
        if not np.array_equal(kept.pixels, expected.pixels):
            fail("the kept picture is not the rendered one")

        shot = window.keep("F12", "screenshot-*.png")
        if not same_exposure(shot.beside_panel(), kept.rgb):
            fail("the window does not show the picture")
        window.press("F2")  # no panel
        window.picture_when(lambda each: each.has_size(480 + PANEL, 360), "a picture without a panel")
        window.press("F2")
        window.picture_when(lambda each: each.has_size(480, 360), "the picture beside the panel")
        window.hand("mousemove", PANEL + 400, 200, "click", 1)
        time.sleep(1)
        with_reading = window.keep("F12", "screenshot-*.png")
        right_top = (slice(0, 60), slice(160, 470))
        if np.allclose(with_reading.beside_panel()[right_top], shot.beside_panel()[right_top]):
            fail("a click shows no reading")

        shows_illuminance(photile, scene, window)

        window.hand("keydown", "w")
        time.sleep(0.7)
        window.hand("keyup", "w")
        at_first = kept.position()
        moved = window.picture_when(lambda each: np.linalg.norm(each.position() - at_first) > 0.01
                                    and each.spec.width == 480, "a step ahead")
        if abs(moved.position()[1] - at_first[1]) > 1e-6:
            fail("walking ahead left the floor")

        # The temperature beside the slider of the lamp, dragged from 6500 K. (Where it is missed,
        # nothing is dragged.)
        def coloured():
            window.drag((250, LAMP_ROW), (190, LAMP_ROW))
            return window.keep("ctrl+s", "view-*.exr").lamp()["tint"] != [1, 1, 1]
        until(coloured, "the temperature")

        # The mood that was there, under "Moods": its button "to scene".
        written = folder / f"{NAME}.dim.gltf"
        def clicked_to_scene():
            window.click(77, 275)
            return written.exists()
        until(clicked_to_scene, "the copy of the scene")
        facts = subprocess.run([photile, "info", written, "--json"], text=True, check=True,
                               capture_output=True).stdout
        power = json.loads(facts)["lights"][0]["lumens"]
        if abs(power - 7) > 1e-5:
            fail(f"the copy of the scene has a lamp of {power} lm, the mood one of 7")

        # The slider of the lamp, all the way to the left.
        def darkened():
            window.drag((140, LAMP_ROW), (2, LAMP_ROW))
            picture = window.keep("ctrl+s", "view-*.exr")
            return picture if picture.lamp()["power"] == 0 else None
        dark = until(darkened, "the slider")
        if dark.rgb.max() != 0:
            fail("a lamp of 0 lm gives light")

        window.hand("windowsize", window.id, 400 + PANEL, 300)
        window.picture_when(lambda each: each.has_size(400, 300), "a picture of the new size")

        window.close()
    print("walked, clicked, dragged, resized, closed")


if __name__ == "__main__":
    main()
