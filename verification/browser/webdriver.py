"""A browser by the W3C's WebDriver protocol: chromedriver speaks it over HTTP,
and needs no package here.

https://www.w3.org/TR/webdriver2/; `/se/log` and `/goog/cdp/execute` are chromedriver's own.
"""

import base64
import json
import os
import re
import shutil
import subprocess
import tempfile
import urllib.error
import urllib.request

BROWSERS = ["chromium", "google-chrome", "google-chrome-stable", "chromium-browser", "chrome"]
REMEDY = "install Chromium and its driver (Debian: apt install chromium chromium-driver)"
SWITCHES = [
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
]


def major(program):
    """The first number of a program's version; None where it does not say."""
    told = subprocess.run([program, "--version"], capture_output=True, text=True, timeout=60)
    found = re.search(r"(\d+)\.\d+\.\d+", told.stdout)
    return found and found[1]


def find():
    """The driver, and the browser of its version."""
    driver = shutil.which("chromedriver")
    folder = os.environ.get("CHROMEWEBDRIVER")
    if driver is None and folder:
        driver = shutil.which("chromedriver", path=folder)
    if driver is None:
        raise SystemExit(f"there is no chromedriver: {REMEDY}")
    wanted = major(driver)
    there = [path for path in map(shutil.which, BROWSERS) if path]
    for path in there:
        if major(path) == wanted:
            return driver, path
    raise SystemExit(f"chromedriver {wanted} has no browser of its version among {there}: {REMEDY}")


class Browser:
    """One window; a context manager."""

    def __init__(self, width, height):
        driver, browser = find()
        self.profile = tempfile.TemporaryDirectory(prefix="ancf-browser-")
        # With port 0 the driver takes a free one and says which.
        self.process = subprocess.Popen(
            [driver, "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
        )
        try:
            self.base = f"http://127.0.0.1:{self._port()}"
            switches = SWITCHES + [f"--user-data-dir={self.profile.name}"]
            options = {"binary": browser, "args": switches + [f"--window-size={width},{height}"]}
            wanted = {"goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
            made = self._ask("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
        except BaseException:
            self._end()
            raise
        self.base += f"/session/{made['sessionId']}"
        self.name = (
            f"{made['capabilities']['browserName']} {made['capabilities']['browserVersion']}"
        )

    def _port(self):
        for line in self.process.stdout:
            found = re.search(r"started successfully on port (\d+)", line)
            if found:
                return found[1]
        raise SystemExit("chromedriver ended before it had started")

    def _ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        head = {"Content-Type": "application/json"}
        request = urllib.request.Request(self.base + path, data, head, method=method)
        # A proxy has no business between this process and its child.
        direct = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            with direct.open(request, timeout=120) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            value = json.load(error).get("value", {})
            raise RuntimeError(f"{value.get('error')}: {value.get('message', '')[:500]}") from None

    def open(self, url):
        """Loads a page; returns when it is loaded."""
        self._ask("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        """What the body of a function of JavaScript returns."""
        return self._ask("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def click(self, selector):
        """A click with the mouse on the first element."""
        chosen = {"using": "css selector", "value": selector}
        element = self._ask("POST", "/element", chosen)
        self._ask("POST", f"/element/{next(iter(element.values()))}/click", {})

    def resize(self, width, height):
        """Sets the size of the page's view, which may be narrower than a window can be."""
        self._devtools(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False},
        )

    def messages(self):
        """What has come on the console since the last call."""
        return [
            f"{m['level']}: {m['message']}"
            for m in self._ask("POST", "/se/log", {"type": "browser"})
        ]

    def picture(self, path):
        """The whole page as PNG."""
        shot = {"format": "png", "captureBeyondViewport": True}
        with open(path, "wb") as out:
            out.write(base64.b64decode(self._devtools("Page.captureScreenshot", shot)["data"]))

    def _devtools(self, command, parameters):
        return self._ask("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def _end(self):
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
        try:
            self.profile.cleanup()
        except OSError:
            # The browser may still write into it.
            shutil.rmtree(self.profile.name, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._ask("DELETE", "")
        except (OSError, RuntimeError):
            pass
        self._end()
