"""Pages as a browser shows them: Chromium without a window, asked through the pipe of its DevTools protocol."""
import contextlib
import json
import os
import pathlib
import select
import subprocess
import time

SCRIPT = (pathlib.Path(__file__).parent / "figures.js").read_text()

PATIENCE_S = 120


class Browser:
    """One Chromium without network. `opened(path)` is a page in a fresh tab."""

    def __init__(self, profile):
        to_browser, self.write_end = os.pipe()
        self.read_end, from_browser = os.pipe()
        # The protocol wants descriptors 3 and 4, which the shell gives. 3-D figures want WebGL: drawn by the CPU.
        command = ["bash", "-c", f'exec chromium "$@" 3<&{to_browser} 4>&{from_browser}', "chromium", "--headless", "--no-sandbox",
                   "--remote-debugging-pipe", f"--user-data-dir={profile}", "--host-resolver-rules=MAP * ~NOTFOUND",
                   "--enable-unsafe-swiftshader", "--hide-scrollbars", "about:blank"]
        self.process = subprocess.Popen(command, pass_fds=(to_browser, from_browser), stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.count, self.events, self.rest = 0, [], b""

    def close(self):
        os.close(self.write_end)
        os.close(self.read_end)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def _receive(self, deadline):
        while b"\0" not in self.rest:
            if not select.select([self.read_end], [], [], max(0, deadline - time.monotonic()))[0]:
                raise TimeoutError("the browser does not answer")
            data = os.read(self.read_end, 1 << 20)
            if not data:
                raise EOFError("the browser has ended: is the package chromium installed?")
            self.rest += data
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def ask(self, method, session=None, **parameters):
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self.write_end, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + PATIENCE_S
        while True:
            answer = self._receive(deadline)
            if answer.get("id") == self.count:
                assert "error" not in answer, f"{method}: {answer['error']}"
                return answer["result"]
            self.events.append(answer)

    def wait_for(self, method, session):
        deadline = time.monotonic() + PATIENCE_S
        while not any(event.get("method") == method and event.get("sessionId") == session for event in self.events):
            self.events.append(self._receive(deadline))

    @contextlib.contextmanager
    def opened(self, path, width=1400, height=1000, dark=False):
        """A page of the disk in a fresh tab of that size."""
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        tab = Tab(self, self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"])
        self.events.clear()
        for domain in ("Page", "Runtime", "Log", "Network"):
            tab.ask(domain + ".enable")
        tab.resize(width, height)
        tab.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        tab.ask("Page.navigate", url=pathlib.Path(path).resolve().as_uri())
        self.wait_for("Page.loadEventFired", tab.session)
        yield tab
        self.ask("Target.closeTarget", targetId=target)


class Tab:
    def __init__(self, browser, session):
        self.browser, self.session = browser, session

    def ask(self, method, **parameters):
        return self.browser.ask(method, self.session, **parameters)

    def resize(self, width, height=1000):
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)

    def seen(self, width=None):
        """What figures.js finds once all is drawn, with `complaints` of the page and the `requests` it made."""
        if width:
            self.resize(width)
        found = self.ask("Runtime.evaluate", expression=SCRIPT, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in found, found
        out = found["result"]["value"]
        out["complaints"] = [text for text in map(complaint, self.browser.events) if text]
        out["requests"] = [event["params"]["request"]["url"] for event in self.browser.events
                           if event.get("method") == "Network.requestWillBeSent"]
        return out


def complaint(event):
    """What an event of the protocol says of an error; None of the others."""
    method, about = event.get("method"), event.get("params", {})
    if method == "Runtime.exceptionThrown":
        details = about["exceptionDetails"]
        return details.get("exception", {}).get("description") or details["text"]
    if method == "Runtime.consoleAPICalled" and about["type"] in ("error", "warning", "assert"):
        return " ".join(str(argument.get("value", argument.get("description"))) for argument in about["args"])
    if method == "Log.entryAdded" and about["entry"]["level"] == "error":
        return about["entry"]["text"]
    return None
