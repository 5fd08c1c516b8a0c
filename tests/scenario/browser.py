"""A browser for tests: Debian's chromium, driven by its chromium-driver (WebDriver, JSON over HTTP)."""
import base64
import json
import re
import subprocess
import urllib.request


class Browser:
    def __init__(self, folder, width=800, height=640, webgl=True):
        self.driver = subprocess.Popen(["chromedriver", "--port=0", f"--log-path={folder}/driver.log"],
                                       stdout=subprocess.PIPE, text=True)
        port = None
        for line in self.driver.stdout:
            found = re.search(r"started successfully on port (\d+)", line)
            if found:
                port = found[1]
                break
        assert port, "chromedriver did not start"
        self.base = f"http://127.0.0.1:{port}"
        switches = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run", "--hide-scrollbars",
                    f"--user-data-dir={folder}/browser", f"--window-size={width},{height}"]
        switches += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if webgl else \
            ["--disable-gpu", "--disable-3d-apis"]
        # On a busy machine a picture takes long; a graphics process is not to be ended for that.
        switches.append("--disable-gpu-watchdog")
        # The processor draws each pixel, four times where edges are smoothed: most of what such a test takes.
        switches.append("--webgl-antialiasing-mode=none")
        wanted = {"browserName": "chrome", "timeouts": {"script": 95_000}, "goog:chromeOptions": {"args": switches, "binary": "/usr/bin/chromium"},
                  "goog:loggingPrefs": {"browser": "ALL"}}
        self.session = self.base + "/session/" + self.call(
            "/session", {"capabilities": {"alwaysMatch": wanted}}, self.base)["sessionId"]

    def call(self, path, body=None, base=None, method=None):
        request = urllib.request.Request((base or self.session) + path, method=method or ("POST" if body is not None else "GET"),
                                         data=None if body is None else json.dumps(body).encode(),
                                         headers={"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=100) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(f"{path}: {error.read().decode()[:500]}") from None

    def open(self, path):
        """A file, or what has another address."""
        self.call("/url", {"url": path if "://" in path else f"file://{path}"})

    def js(self, script, *args):
        return self.call("/execute/sync", {"script": script, "args": list(args)})

    def after_pictures(self, script="return null", *args):
        """What the script returns, two pictures later."""
        return self.call("/execute/async", {"script": f"""
            const done = arguments[arguments.length - 1], given = [...arguments].slice(0, -1);
            requestAnimationFrame(() => requestAnimationFrame(() => done((function() {{ {script} }})(...given))));""",
                                            "args": list(args)})

    def cdp(self, command, **parameters):
        return self.call("/goog/cdp/execute", {"cmd": command, "params": parameters})

    def resize(self, width, height, mobile=False):
        self.cdp("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)
        self.cdp("Emulation.setTouchEmulationEnabled", enabled=mobile)

    def media(self, media="", dark=False):
        self.cdp("Emulation.setEmulatedMedia", media=media,
                 features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def mouse(self, *steps):
        """Each step: ("move", x, y), ("down",) or ("up",); in pixels of the window."""
        actions = []
        for kind, *at in steps:
            if kind == "move":
                actions.append({"type": "pointerMove", "duration": 20, "x": round(at[0]), "y": round(at[1])})
            else:
                actions.append({"type": f"pointer{kind.capitalize()}", "button": 0})
        self.call("/actions", {"actions": [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
                                            "actions": actions}]})

    def click(self, x, y):
        self.mouse(("move", x, y), ("down",), ("up",))

    def keys(self, *values):
        actions = [{"type": kind, "value": value} for value in values for kind in ("keyDown", "keyUp")]
        self.call("/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def finger(self, *points):
        """One finger, down at the first point and up at the last."""
        self.cdp("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": points[0][0], "y": points[0][1]}])
        for x, y in points[1:]:
            self.cdp("Input.dispatchTouchEvent", type="touchMove", touchPoints=[{"x": x, "y": y}])
        self.cdp("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def rect(self, selector):
        """Where it is in the window, scrolled to."""
        return self.js("""const e = document.querySelector(arguments[0]); e.scrollIntoView({block: 'center'});
            const r = e.getBoundingClientRect(); return [r.left, r.top, r.width, r.height];""", selector)

    def screenshot(self, path, whole=False):
        if whole:
            picture = self.cdp("Page.captureScreenshot", captureBeyondViewport=True, format="png")["data"]
        else:
            picture = self.call("/screenshot")
        with open(path, "wb") as file:
            file.write(base64.b64decode(picture))

    def complaints(self):
        """What the page said that it should not have."""
        return [entry["message"] for entry in self.call("/se/log", {"type": "browser"})
                if entry["level"] in ("WARNING", "SEVERE") and "GPU stall" not in entry["message"]]

    def close(self):
        try:
            self.call("", method="DELETE")
        finally:
            self.driver.terminate()
            self.driver.wait(20)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
