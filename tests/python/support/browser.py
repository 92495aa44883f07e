"""A headless Chromium, driven through chromedriver by the WebDriver protocol (W3C), which is plain
JSON over HTTP: no package is needed for the few calls of a test."""

from __future__ import annotations

import json
import shutil
import socket
import subprocess
import time
import urllib.error
import urllib.request

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
DRIVER = shutil.which("chromedriver")
MISSING = None if CHROMIUM and DRIVER else "no Chromium and chromedriver (apt-get install chromium-driver)"


def _move(x: float, y: float) -> dict:
    return {"type": "pointerMove", "x": round(x), "y": round(y), "duration": 0}


class Browser:
    """One session; close() ends it and the driver."""

    def __init__(self):
        with socket.socket() as probe:  # a port that is free now
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self._address = f"http://127.0.0.1:{port}"
        self._driver = subprocess.Popen([DRIVER, f"--port={port}"], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        options = {
            "binary": CHROMIUM,
            # No sandbox: it needs rights that containers rarely give; the page is our own.
            "args": ["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1300,1000",
                     "--disable-dev-shm-usage", "--disable-quic", "--no-first-run", "--disable-sync",
                     "--disable-background-networking", "--disable-component-update"],
        }
        wanted = {"browserName": "chrome", "goog:chromeOptions": options,
                  "goog:loggingPrefs": {"browser": "ALL"}}
        deadline = time.monotonic() + 20
        while True:
            try:
                made = self._post("/session", {"capabilities": {"alwaysMatch": wanted}})
                break
            except (ConnectionError, urllib.error.URLError) as error:
                if isinstance(error, urllib.error.HTTPError) or time.monotonic() > deadline:
                    self._driver.terminate()
                    raise
                time.sleep(0.1)
        self._session = f"/session/{made['sessionId']}"

    def _post(self, path: str, body: dict | None = None, method: str = "POST"):
        request = urllib.request.Request(self._address + path, method=method,
                                         data=None if body is None else json.dumps(body).encode(),
                                         headers={"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            error.msg += ": " + error.read().decode()[:500]
            raise

    def open(self, path, state: str = "") -> None:
        """Opens a file, with `state` (#a=b) behind its address."""
        self._post(f"{self._session}/url", {"url": "about:blank"})  # or a new state would not load the page
        self._post(f"{self._session}/url", {"url": path.resolve().as_uri() + state})

    def _act(self, *actions: dict) -> None:
        """Actions of the mouse, as a user's."""
        mouse = {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": list(actions)}
        self._post(f"{self._session}/actions", {"actions": [mouse]})

    def click(self, x: float, y: float) -> None:
        self._act(_move(x, y), {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0})

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        self._act(_move(*start), {"type": "pointerDown", "button": 0}, _move(*end),
                  {"type": "pointerUp", "button": 0})

    def wheel(self, x: float, y: float, delta: float) -> None:
        wheel = {"type": "wheel", "id": "wheel", "actions": [
            {"type": "scroll", "x": round(x), "y": round(y), "deltaX": 0, "deltaY": round(delta)}]}
        self._post(f"{self._session}/actions", {"actions": [wheel]})

    def run(self, script: str, *arguments):
        """Runs the body of a JavaScript function; returns what it returns."""
        return self._post(f"{self._session}/execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, condition: str, seconds: float = 10):
        """Until the expression is true; its value."""
        deadline = time.monotonic() + seconds
        while not (value := self.run(f"return {condition}")):
            assert time.monotonic() < deadline, f"never true: {condition}"
            time.sleep(0.05)
        return value

    def errors(self) -> list[str]:
        """What the console has said since the last call, at the level of errors."""
        log = self._post(f"{self._session}/se/log", {"type": "browser"})
        return [entry["message"] for entry in log if entry["level"] == "SEVERE"]

    def screenshot(self) -> bytes:
        import base64
        return base64.b64decode(self._post(f"{self._session}/screenshot", method="GET"))

    def close(self) -> None:
        try:
            self._post(self._session, method="DELETE")
        finally:
            self._driver.terminate()
            self._driver.wait(10)
