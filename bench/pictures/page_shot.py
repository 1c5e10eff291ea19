#!/usr/bin/python3
"""A picture of the live page of `photile view` at rest.

    bench/pictures/page_shot.py FILE.png [--size WxH] [--first SCRIPT] [--then SCRIPT] -- SCENE [OPTIONS]

SCRIPT is JavaScript: the first runs as soon as the page is there, the other at rest. Needs the built command and what
tools/live_page.py does.
"""

import argparse
import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from PIL import Image
from tools import live_page


def rest(driver):
    """Waits until the exact picture is there."""
    end = time.monotonic() + live_page.PATIENCE
    while not live_page.state(driver)[2]:
        if time.monotonic() > end:
            raise OSError("the page comes to no rest")
        time.sleep(0.2)
    time.sleep(1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--photile", default=ROOT / "build/release/photile")
    parser.add_argument("--size", default="1280x800")
    parser.add_argument("--first", default="")
    parser.add_argument("--then", default="")
    parser.add_argument("scene", nargs="+")
    asked = parser.parse_args()
    driver = live_page.open_browser(*map(int, asked.size.split("x")))
    try:
        with live_page.Served(asked.photile, *asked.scene) as served:
            driver.get(served.url)
            while not live_page.state(driver)[0]:
                time.sleep(0.1)
            driver.execute_script(asked.first)
            rest(driver)
            driver.execute_script(asked.then)
            time.sleep(2)
            Image.fromarray(live_page.screenshot(driver)).save(asked.file, optimize=True)
    finally:
        driver.quit()


main()
