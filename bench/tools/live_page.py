"""`photile view` and its page in Chromium, which draws by its own rasteriser (SwiftShader) on the processor. Needs Debian's
chromium, chromium-driver and python3-selenium, and PIL."""

import base64
import io
import os
import pathlib
import signal
import subprocess

import numpy as np
from PIL import Image
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

PATIENCE = 300  # seconds


def open_browser(width, height):
    """A page of this many CSS pixels, which are pixels of its screenshots."""
    options = Options()
    for argument in ("--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"):
        options.add_argument(argument)
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    set_size(driver, width, height)
    driver.set_page_load_timeout(PATIENCE)
    driver.set_script_timeout(PATIENCE)
    return driver


def set_size(driver, width, height):
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})


def screenshot(driver):
    """RGB bytes."""
    return np.asarray(Image.open(io.BytesIO(driver.get_screenshot_as_png())).convert("RGB"))


def canvas(driver):
    """RGB bytes of the room alone, drawn anew, with all pixels."""
    url = driver.execute_script("""
const {renderer} = page, {share} = renderer;
renderer.share = 1;
renderer.draw(page.walker);
renderer.share = share;
return page.canvas.toDataURL('image/png');""")
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(url.split(",")[1]))).convert("RGB"))


class Served:
    """A process that ends with the block that it is opened for."""

    def __init__(self, photile, scene, *options):
        self.process = subprocess.Popen([photile, "view", scene, "--no-browser", "--quiet", *options],
                                        stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        if not self.url:
            raise OSError(f"{scene}: photile view ended with {self.process.wait()}")

    def processor_seconds(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait()


# Whether the room is seen and lit, and whether the picture at rest has come and is whole.
STATE = """
if (document.getElementById('loading') || typeof page === 'undefined' || !page.live) return [false, false, false];
const {renderer} = page, {rest} = renderer;
return [true, renderer.isLit, renderer.isLit && document.getElementById('work').hidden && rest?.shown === 1 &&
        rest.number === page.live.picture];"""


def state(driver):
    """(seen, lit, at rest)."""
    return driver.execute_script(STATE)
