#!/usr/bin/python3
"""Moves the sun and places lamps in the window of `photile view`, and compares what it keeps with what
other commands give.

    xvfb-run window_edits_test.py PHOTILE
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np

from window_test import PANEL, SOURCE, Picture, Window, display_answers, fail, until

GALLERY = SOURCE / "scenes/gallery"
SETTINGS = ["--quality", "draft", "--photons", "20k", "--samples", "1", "--quiet"]
LARGE = ["--size", "420x240"]
SMALL = ["--size", "160x120"]  # of 145 patches, whose pictures are large
SITE = ["--site", "52.5,13.4,1"]
HOURS = [f"2026-06-21T{hour:02}:00" for hour in (4, 5, 6, 7)]  # the sun rises before four
WALL = (PANEL + 370, 60)  # in the window


class SmallWindow(Window):
    settings, finished = SETTINGS, "1 of 1 samples, 0.02M paths"


def moves_the_sun(photile, scene, folder):
    """At each hour, the window shows what `relight` makes of a picture of patches."""
    patches = folder / "patches.exr"
    subprocess.run([photile, "render", scene, "--sky", "patches=145", "-o", patches, *SETTINGS, *SMALL],
                   check=True)
    expected = {}
    for hour in HOURS:
        relit = folder / "relit.exr"
        subprocess.run([photile, "relight", patches, *SITE, "--time", hour, "-o", relit], check=True)
        expected[hour] = Picture(relit).rgb

    def hour_of(picture):
        for hour, rgb in expected.items():
            if np.allclose(picture.rgb, rgb, rtol=1e-3, atol=1e-4 * rgb.max()):
                return hour
        return None

    window = SmallWindow(photile, scene, folder, *SMALL, *SITE, "--time", HOURS[1])
    # Pressed once: the window shows a quick frame first, which cannot be kept.
    window.press("ctrl+s", 1)
    until(lambda: window.running() and list(folder.glob("view-*.exr")), "the picture asked for once")
    first = window.picture_when(hour_of, "the picture of an hour")
    if hour_of(first) != HOURS[1]:
        fail(f"asked for {HOURS[1]}, the window shows {hour_of(first)}")
    layers = [name for name in first.spec.channelnames if name.endswith(".R")]
    if layers != ["Combined_sky.R"]:
        fail(f"the sky is not one layer: {layers}")
    window.press("shift+Right")
    window.picture_when(lambda each: hour_of(each) in HOURS[2:], "a later hour")
    window.press("ctrl+z")
    window.picture_when(lambda each: hour_of(each) == HOURS[1], "the hour before")

    def is_night():
        window.press("shift+Left")
        window.finish()
        return window.keep("ctrl+s", "view-*.exr").rgb.max() == 0
    until(is_night, "the night")
    window.stop()


def places_lamps(photile, scene, folder):
    """Into a dark room, by a new file."""
    lamps = folder / "lamps.json"
    window = SmallWindow(photile, scene, folder, *LARGE, "--luminaires", lamps)

    def entries():
        return json.loads(lamps.read_text()) if lamps.exists() else []

    def save():
        window.press("ctrl+s")
        time.sleep(1)
        return entries()

    def placed():
        window.press("p")
        window.click(*WALL)
        return save()
    lamp = until(placed, "a placed lamp")[-1]
    if lamp["file"] != "downlight.ies" or sorted(map(abs, lamp["aim"])) != [0, 0, 1]:
        fail(f"not placed on a wall: {lamp}")
    axis = [abs(value) for value in lamp["aim"]].index(1)
    if abs(abs(lamp["position"][axis]) - 1.995) > 1e-6:  # walls at 2 m
        fail(f"not placed on a wall: {lamp}")
    lit = window.picture_when(
        lambda each: "Combined_downlight.R" in each.spec.channelnames, "the lamp's light")
    if "Combined_work_light.R" in lit.spec.channelnames or lit.rgb.max() == 0:
        fail("the placed lamp is not what lights the room")

    def dragged():
        window.drag(WALL, (WALL[0] - 40, WALL[1] + 30))
        return save()[0]["position"] != lamp["position"]
    until(dragged, "the dragged lamp")
    moved = entries()[0]["position"]
    if moved[axis] != lamp["position"][axis]:
        fail(f"dragged off its wall: from {lamp['position']} to {moved}")

    def duplicated():
        window.press("ctrl+d")
        return len(save()) > 1
    until(duplicated, "the duplicate")
    count = len(entries())

    def undone():
        window.press("ctrl+z")
        return len(save()) < count
    until(undone, "the duplicate taken back")

    window.press("ctrl+y")
    window.press("ctrl+q")  # asks, since something is not saved
    time.sleep(2)
    window.running()
    if len(entries()) >= count:
        fail("saved without being asked to")
    save()
    window.stop()
    subprocess.run([photile, "info", scene, "--luminaires", lamps], check=True,
                   stdout=subprocess.DEVNULL)


def main():
    photile = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name in ("sun-and-sky.gltf", "sun-and-sky.bin", "downlight.ies"):
            shutil.copy(GALLERY / name, folder)
        scene = folder / "sun-and-sky.gltf"
        until(display_answers, "the display")
        moves_the_sun(photile, scene, folder)
        places_lamps(photile, scene, folder)
    print("moved the sun, placed lamps")


main()
