"""What three.js shows of a map, in a Chromium without a window.

Needs ``chromium`` and, in a folder ``node_modules`` that `SKYBAKE_PEER_NODE_MODULES` names,
``npm install three``.
"""

import json
import os
import queue
import shutil
import subprocess
import tempfile
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

PAGE = Path(__file__).with_name("three_directions.html")
KINDS = {".html": "text/html", ".js": "text/javascript"}
SECONDS = 180.0


def node_modules():
    """Folder of npm's packages."""
    default = Path(__file__).parent / "node_modules"
    return Path(os.environ.get("SKYBAKE_PEER_NODE_MODULES", default))


def is_there():
    """Whether this machine has what it takes."""
    return shutil.which("chromium") is not None and (node_modules() / "three").is_dir()


def shown(files, directions):
    """What three.js shows toward directions in its axes.

    Parameters
    ----------
    files : sequence of Path
        An equirect map, or six faces in the order that its cube loaders want.
    directions : list of list of float
        Unit vectors.

    Returns
    -------
    dict
        `version`; and lists of RGB: `background`, and `environment` as a ball of metal mirrors it.
    """
    names = {f"/map/{i}{file.suffix}": file for i, file in enumerate(files)}
    results = queue.Queue()

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):
            if self.path == "/task":
                task = {"files": list(names), "directions": directions}
                self.answer(json.dumps(task).encode(), "application/json")
            elif self.path == "/":
                self.answer(PAGE.read_bytes(), KINDS[".html"])
            elif self.path.startswith("/three/"):
                file = node_modules() / self.path[1:]
                self.answer(file.read_bytes(), KINDS.get(file.suffix, "application/octet-stream"))
            elif self.path in names:
                self.answer(names[self.path].read_bytes(), "application/octet-stream")
            else:
                self.send_error(404)

        def do_POST(self):
            result = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            self.answer(b"", "text/plain")
            results.put(result)

        def answer(self, body, kind):
            self.send_response(200)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_):
            pass

    with (
        ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server,
        tempfile.TemporaryDirectory() as home,
    ):
        threading.Thread(target=server.serve_forever, daemon=True).start()
        command = [
            *("chromium", "--headless=new", "--no-sandbox", "--use-angle=swiftshader"),
            *("--enable-unsafe-swiftshader", f"--user-data-dir={home}"),
            f"http://127.0.0.1:{server.server_port}/",
        ]
        browser = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            result = results.get(timeout=SECONDS)
        finally:
            browser.terminate()
            browser.wait()
            server.shutdown()
    if "error" in result:
        raise RuntimeError(result["error"])
    return result
