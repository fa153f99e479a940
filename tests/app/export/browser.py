# SPDX-License-Identifier: Apache-2.0
"""Opens a page in a browser of the distribution, for tests of web pages: Chromium through its debugging pipe, Firefox
through Marionette.

A computer without a GPU draws WebGL slowly: tests wait for what happens, not for a time.
"""

import base64
import json
import os
import select
import shutil
import socket
import subprocess
import tempfile
import time

PATIENCE = 240  # [s], of each wait; a busy machine draws a frame in seconds


def chromium():
    """The program, or None."""
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


def firefox():
    """The program, or None. Without a display, even a virtual one, Firefox has no WebGL."""
    return shutil.which("Xvfb") and (shutil.which("firefox-esr") or shutil.which("firefox"))


class Chromium:
    """A browser with one page. Use it in `with`."""

    def __init__(self, program=None, size=(640, 400), touch=False, scale=1):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_read, self._to = os.pipe()
        self._from, to_write = os.pipe()
        command = [program or chromium(), "--headless=new", "--no-sandbox", "--remote-debugging-pipe", "--use-gl=angle",
                   "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run", "--disable-extensions",
                   "--disable-background-networking", "--disable-dev-shm-usage", "--hide-scrollbars",
                   f"--user-data-dir={self.folder.name}", f"--window-size={size[0]},{size[1]}"]

        def descriptors():  # the browser reads from 3 and writes to 4
            os.dup2(to_read, 13)
            os.dup2(to_write, 14)
            os.dup2(13, 3)
            os.dup2(14, 4)

        self.process = subprocess.Popen(command, preexec_fn=descriptors, pass_fds=(3, 4), stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self._buffer, self._next, self._answers = b"", 1, {}
        self.problems = []  # errors and warnings of the console, exceptions
        self.requests = []  # addresses that the page asked for, except its own
        self.session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")
        self.call("Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=scale,
                  mobile=touch)
        if touch:
            self.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is not None and self._to is None:
            return
        self.process.kill()
        self.process.wait()
        os.close(self._to)
        os.close(self._from)
        self._to = None
        self.folder.cleanup()

    def call(self, method, **parameters):
        number, self._next = self._next, self._next + 1
        message = {"id": number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + PATIENCE
        while number not in self._answers:
            self._receive(end, method)
        answer = self._answers.pop(number)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']}")
        return answer["result"]

    def _receive(self, end, what):
        ready, _, _ = select.select([self._from], [], [], max(0, end - time.monotonic()))
        if not ready:
            raise TimeoutError(f"{what}: no answer in {PATIENCE} s")
        data = os.read(self._from, 1 << 20)
        if not data:
            raise RuntimeError("the browser has ended")
        self._buffer += data
        *whole, self._buffer = self._buffer.split(b"\0")
        for text in whole:
            self._take(json.loads(text))

    def _take(self, message):
        if "id" in message:
            self._answers[message["id"]] = message
            return
        method, parameters = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.problems.append(details.get("exception", {}).get("description") or details["text"])
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            self.problems.append(" ".join(str(a.get("value", a.get("description"))) for a in parameters["args"]))
        elif method == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
            self.problems.append(parameters["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            address = parameters["request"]["url"]
            if not address.startswith(("data:", "blob:")):
                self.requests.append(address)

    def open(self, path):
        self.call("Page.navigate", url="file://" + str(path))
        self.wait_for("(document.documentElement?.dataset.state ?? 'loading') !== 'loading'")

    def value(self, expression):
        """What a JavaScript expression gives."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"]["exception"].get("description", expression))
        return answer["result"].get("value")

    def wait_for(self, expression):
        end = time.monotonic() + PATIENCE
        while not self.value(expression):
            if time.monotonic() > end:
                raise TimeoutError(f"{expression} stays false; {self.problems}")
            time.sleep(0.1)

    def screenshot(self, path=None):
        """The page as PNG."""
        png = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        if path:
            with open(path, "wb") as file:
                file.write(png)
        return png

    def press(self, key):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, **({"text": key} if len(key) == 1 else {}))

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def touch(self, kind, *points):
        self.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)])


class Firefox:
    """The same with Firefox on a virtual display. `problems` are read when they are asked for."""

    SMALLEST = 500  # width of a window

    def __init__(self, size=(640, 400), scale=1):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        # Port 0: Firefox takes a free one and writes it into a file.
        preferences = {"marionette.port": 0, "layout.css.devPixelsPerPx": str(scale),
                       "browser.shell.checkDefaultBrowser": False,
                       "datareporting.policy.dataSubmissionEnabled": False, "webgl.force-enabled": True,
                       "app.update.disabledForTesting": True, "browser.startup.page": 0}
        with open(os.path.join(self.folder.name, "user.js"), "w") as file:
            for name, value in preferences.items():
                file.write(f"user_pref({json.dumps(name)}, {json.dumps(value)});\n")
        read, write = os.pipe()
        self.display = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x2000x24"],
                                        pass_fds=(write,), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as line:  # whole: Xvfb writes it in parts
            number = line.readline().strip()
        environment = dict(os.environ, DISPLAY=":" + number, HOME=self.folder.name)
        command = [firefox(), "--marionette", "-remote-allow-system-access", "--no-remote", "--profile",
                   self.folder.name, "--width", str(max(size[0], self.SMALLEST)), "--height", str(size[1] + 100)]
        self._socket = None
        messages = open(os.path.join(self.folder.name, "messages"), "w+")
        self.process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=messages)
        end = time.monotonic() + PATIENCE
        while not self._socket:
            try:
                with open(os.path.join(self.folder.name, "MarionetteActivePort")) as port:
                    self._socket = socket.create_connection(("127.0.0.1", int(port.read())), timeout=PATIENCE)
            except (OSError, ValueError):
                if time.monotonic() > end or self.process.poll() is not None:
                    messages.seek(0)
                    problem = messages.read()[-500:]
                    self.close()
                    raise RuntimeError(f"Firefox does not start: {problem}") from None
                time.sleep(0.2)
        messages.close()
        self._answers, self._number = self._socket.makefile("rb"), 0
        self._read()
        self.call("WebDriver:NewSession", capabilities={})
        self.call("WebDriver:SetTimeouts", script=1000 * PATIENCE, pageLoad=1000 * PATIENCE)
        self._in_chrome("const { style } = gBrowser.selectedBrowser;"
                        f"style.maxWidth = '{size[0]}px'; style.maxHeight = '{size[1]}px'")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if self._socket:
            self._socket.close()
        for process in (self.process, self.display):
            process.kill()
            process.wait()
        self.folder.cleanup()

    def _read(self):
        length = b""
        while (letter := self._answers.read(1)) != b":":
            if not letter:
                raise RuntimeError("the browser has ended")
            length += letter
        return json.loads(self._answers.read(int(length)))

    def call(self, method, **parameters):
        self._number += 1
        message = json.dumps([0, self._number, method, parameters]).encode()
        self._socket.sendall(str(len(message)).encode() + b":" + message)
        _, _, error, result = self._read()
        if error:
            raise RuntimeError(f"{method}: {error}")
        return result

    def value(self, expression):
        return self.call("WebDriver:ExecuteScript", script=f"return ({expression})", args=[])["value"]

    def _in_chrome(self, script):
        self.call("Marionette:SetContext", value="chrome")
        value = self.call("WebDriver:ExecuteScript", script=script, args=[])["value"]
        self.call("Marionette:SetContext", value="content")
        return value

    @property
    def problems(self):
        """Errors and warnings that the page has caused."""
        found = self._in_chrome("return Services.console.getMessageArray().map(m => String(m.message))"
                                ".filter(m => /file:\\/\\/|WebGL/.test(m))")
        return [text for text in found if "chrome://" not in text]

    def open(self, path):
        self.call("WebDriver:Navigate", url="file://" + str(path))
        self.wait_for("document.documentElement.dataset.state !== 'loading'")

    wait_for = Chromium.wait_for

    def screenshot(self, path=None):
        png = base64.b64decode(self.call("WebDriver:TakeScreenshot", full=False)["value"])
        if path:
            with open(path, "wb") as file:
                file.write(png)
        return png
