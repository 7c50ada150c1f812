# SPDX-License-Identifier: Apache-2.0
"""The viewer's page in Chromium without a window, by Selenium of Debian."""

import base64
import os
import shutil
import time

from viewer_process import Viewer

SECONDS = 90
# Moves the pointer over an element for some seconds, with each picture of the screen. Gives how
# many frames were shown a second, the milliseconds until an exact one at rest, and how many pixels
# the traced ones were apart.
DRAG = """
const [selector, seconds, done] = arguments;
const target = document.querySelector(selector);
const box = target.getBoundingClientRect();
const x = box.left + box.width / 2, y = box.top + box.height / 2;
const event = (type, i) => target.dispatchEvent(new PointerEvent(type, {bubbles: true,
  pointerId: 1, button: type === 'pointermove' ? -1 : 0, buttons: type === 'pointerup' ? 0 : 1,
  clientX: x + 60 * Math.sin(i / 12), clientY: y + 20 * Math.cos(i / 17), cancelable: true}));
target.setPointerCapture = () => {};
document.querySelectorAll('.plot svg').forEach((svg) => { svg.setPointerCapture = () => {}; });
let i = 0, shown = 0, strides = 0, last = document.body.dataset.frame;
const start = performance.now();
// The points are drawn anew while they move; their plot stays.
const mover = target.closest('.plot svg') ?? target;
event('pointerdown', 0);
const step = () => {
  if (document.body.dataset.frame !== last) {
    ++shown;
    last = document.body.dataset.frame;
    strides += Number(document.body.dataset.stride);
  }
  const now = performance.now();
  if (now - start < seconds * 1000) {
    mover.dispatchEvent(new PointerEvent('pointermove', {bubbles: true, pointerId: 1, button: -1,
      buttons: 1, clientX: x + 60 * Math.sin(++i / 12), clientY: y + 20 * Math.cos(i / 17)}));
    requestAnimationFrame(step);
    return;
  }
  mover.dispatchEvent(new PointerEvent('pointerup', {bubbles: true, pointerId: 1, button: 0}));
  const rest = performance.now();
  const wait = () => {
    if (document.body.dataset.state === 'exact') {
      done([shown / seconds, performance.now() - rest, strides / Math.max(shown, 1)]);
    } else {
      setTimeout(wait, 2);
    }
  };
  // The state is still that of a frame before the last move where it is exact at once.
  setTimeout(wait, 60);
};
requestAnimationFrame(step);
"""


def why_not():
    """What is missing for a browser test; None if nothing is."""
    try:
        import selenium  # noqa: F401
    except ImportError:
        return "python3-selenium is not installed"
    for program in ("chromium", "chromedriver"):
        if shutil.which(program) is None:
            return f"{program} is not installed"
    return None


def make_browser(folder, arguments=()):
    """Chromium without a window, with a profile of its own in the folder."""
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    options = Options()
    options.binary_location = shutil.which("chromium")
    for argument in ("--headless=new", "--disable-gpu", "--hide-scrollbars",
                     "--disable-background-networking", "--no-first-run",
                     f"--user-data-dir={os.path.join(folder, 'profile')}", *arguments):
        options.add_argument(argument)
    if os.geteuid() == 0:
        options.add_argument("--no-sandbox")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


class Page:
    """A browser with the page of a viewer, until the end of a with statement."""

    def __init__(self, viewer: Viewer, folder, window=(1280, 800), dark=False, scale=1,
                 waits=True, arguments=()):
        self.browser = make_browser(folder, arguments)
        self.browser.set_script_timeout(SECONDS)
        self.folder = folder
        command = self.browser.execute_cdp_cmd
        command("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": folder})
        command("Emulation.setEmulatedMedia", {"features": [
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]})
        self.scale = scale
        self.resize(*window)
        self.browser.get(viewer.address)
        if waits:
            self.wait_exact(-1)

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.browser.quit()

    def resize(self, width, height):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": self.scale, "mobile": False})

    def run(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    def frame(self):
        return int(self.run("return document.body.dataset.frame ?? -1"))

    def state(self):
        return self.run("return document.body.dataset.state ?? ''")

    def wait_for(self, condition, what):
        deadline = time.monotonic() + SECONDS
        while time.monotonic() < deadline:
            result = condition()
            if result:
                return result
            time.sleep(0.03)
        raise AssertionError(f"waited in vain for {what}; the page says: "
                             f"{self.text('#state')} {self.text('#message')}")

    def wait_exact(self, after):
        """Waits for an exact frame that is newer than frame `after`, and that stays."""
        def settled():
            frame = self.frame()
            if frame <= after or self.state() not in ("exact", "over"):
                return False
            time.sleep(0.4)
            return self.frame() == frame and self.state() in ("exact", "over")
        self.wait_for(settled, "an exact frame")

    def text(self, selector):
        return self.run("return document.querySelector(arguments[0])?.textContent ?? ''", selector)

    def box(self, selector):
        return self.run("const box = document.querySelector(arguments[0]).getBoundingClientRect();"
                        "return [box.left, box.top, box.width, box.height]", selector)

    def center(self, selector):
        left, top, width, height = self.box(selector)
        return left + width / 2, top + height / 2

    def mouse(self, kind, x, y, button="left", count=1):
        buttons = {"none": 0, "left": 1, "right": 2, "middle": 4}[button]
        self.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {
            "type": kind, "x": x, "y": y, "button": button, "clickCount": count,
            "buttons": buttons if kind != "mouseReleased" else 0})

    def drag(self, start, end, steps=12, button="left"):
        """Drags the mouse as a hand does, and gives the frame before it."""
        before = self.frame()
        self.mouse("mouseMoved", *start, button="none", count=0)
        self.mouse("mousePressed", *start, button)
        for i in range(1, steps + 1):
            share = i / steps
            self.mouse("mouseMoved", start[0] + share * (end[0] - start[0]),
                       start[1] + share * (end[1] - start[1]), button)
            time.sleep(0.02)
        self.mouse("mouseReleased", *end, button)
        return before

    def click(self, x, y, button="left", count=1):
        before = self.frame()
        for i in range(1, count + 1):
            self.mouse("mousePressed", x, y, button, i)
            self.mouse("mouseReleased", x, y, button, i)
        return before

    def press(self, selector):
        """Clicks an element by its own click(), after it was scrolled into view."""
        before = self.frame()
        self.run("const element = document.querySelector(arguments[0]);"
                 "element.scrollIntoView({block: 'center'}); element.click()", selector)
        return before

    def press_button(self, text):
        before = self.frame()
        found = self.run(
            "const button = [...document.querySelectorAll('button')]"
            ".find((one) => one.textContent === arguments[0]);"
            "button?.scrollIntoView({block: 'center'}); button?.click(); return Boolean(button)",
            text)
        if not found:
            raise AssertionError(f"there is no button {text}")
        return before

    def show(self, selector):
        self.run("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)

    def open_panel(self, name):
        self.run("const panel = document.getElementById(arguments[0]); panel.open = true;"
                 "panel.scrollIntoView({block: 'start'})", name)

    def picture(self):
        """Width, height, channels and rows of the canvas, without alpha."""
        width, height, data = self.run("""
            const canvas = document.getElementById('picture');
            const {width, height} = canvas;
            const {data} = canvas.getContext('2d').getImageData(0, 0, width, height);
            let text = '';
            for (let i = 0; i < data.length; i += 32768) {
              text += String.fromCharCode(...data.subarray(i, i + 32768));
            }
            return [width, height, btoa(text)];""")
        pixels = base64.b64decode(data)
        colors = bytearray(3 * width * height)
        for channel in range(3):
            colors[channel::3] = pixels[channel::4]
        return width, height, 3, [bytes(colors[3 * width * y:3 * width * (y + 1)])
                                  for y in range(height)]

    def saved(self, button, name):
        """Clicks a button of the panel Save and gives the bytes of the file."""
        path = os.path.join(self.folder, name)
        if os.path.exists(path):
            os.remove(path)
        self.open_panel("save-panel")
        self.press_button(button)
        self.wait_for(lambda: os.path.exists(path) and os.path.getsize(path) > 0, name)
        time.sleep(0.2)
        with open(path, "rb") as file:
            return file.read()

    def complaints(self):
        """The errors on the browser's console."""
        return [entry["message"] for entry in self.browser.get_log("browser")
                if entry["level"] == "SEVERE"]
