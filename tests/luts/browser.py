"""Pages and programs that judge the code: Chromium, and the Khronos compiler of shaders."""

import base64
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

_FLAGS = (
    *("--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--allow-file-access-from-files", "--virtual-time-budget=60000"),
)

_WEBGPU = """
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
const [modules, program, page, file] = process.argv.slice(1);
const { chromium } = createRequire(modules + '/test.js')('playwright-core');
const browser = await chromium.launch({ executablePath: program, args: [
  '--no-sandbox', '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader',
  '--enable-unsafe-swiftshader'] });
try {
  const opened = await browser.newPage();
  await opened.goto(page);
  console.log(JSON.stringify(await opened.evaluate(async (code) => {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter) return null;
    const device = await adapter.requestDevice();
    const { messages } = await device.createShaderModule({ code }).getCompilationInfo();
    return messages.map(({ type, lineNum, message }) => `${type} ${lineNum}: ${message}`);
  }, readFileSync(file, 'utf8'))));
} finally {
  await browser.close();
}
"""


def program(name):
    """Path of a program; skips where it is not installed."""
    found = shutil.which(name)
    if found is None:
        pytest.skip(f"{name} is not installed")
    return found


def drawn(page, size, query=""):
    """Radiances that a page of docs draws in WebGL, shape (height, width, 3)."""
    width, height = size
    address = f"{page.as_uri()}?values&size={width}x{height}{query}"
    profile = f"--user-data-dir={page.parent / 'profile'}"
    made = subprocess.run(
        [program("chromium"), *_FLAGS, profile, "--dump-dom", address],
        check=True,
        capture_output=True,
        text=True,
        timeout=120,
    )
    fault = re.search('<pre id="error">([^<]*)<', made.stdout)
    assert fault is None, fault[1]
    text = re.search('<pre id="values">([^<]*)<', made.stdout)
    assert text is not None, made.stderr[-2000:]
    values = np.frombuffer(base64.b64decode(text[1]), "<f4").reshape(height, width, 4)
    return values[::-1, :, :3].astype(float)


def webgpu_messages(file):
    """What Chromium's compiler says of a file in WGSL; skips where there is none."""
    node, chromium = program("node"), program("chromium")
    folders = [one for one in os.environ.get("NODE_PATH", "").split(os.pathsep) if one]
    modules = next((one for one in folders if (Path(one) / "playwright-core").is_dir()), None)
    if modules is None:
        pytest.skip("node with playwright-core in a folder of NODE_PATH is not installed")
    page = file.parent / "empty.html"
    page.write_text("<!doctype html>")
    made = subprocess.run(
        [
            *(node, "--input-type=module", "-e", _WEBGPU),
            *(modules, chromium, page.as_uri(), str(file)),
        ],
        check=True,
        capture_output=True,
        text=True,
        timeout=120,
    )
    messages = json.loads(made.stdout)
    if messages is None:
        pytest.skip("this Chromium has no WebGPU")
    return messages


def compiled(path, *arguments):
    """What the Khronos compiler says of a shader: its status, and its lines."""
    made = subprocess.run(
        [program("glslangValidator"), *arguments, str(path)],
        cwd=path.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    return made.returncode, made.stdout
