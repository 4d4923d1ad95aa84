"""Cubemaps to write, and readers of their files that are independent of the writers."""

import json
import os
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest

VK = {"half": 97, "float": 109, "rgb9e5": 123, "r11g11b10": 122}


def cube_levels(edge=16, count=3, seed=0, largest=4.0):
    """Levels of a cubemap, in which every texel is another."""
    noise = np.random.default_rng(seed)
    return [
        largest * noise.random((6, edge >> k, edge >> k, 3), dtype=np.float32) for k in range(count)
    ]


def read_ktx2(path):
    """Header, levels as bytes (6 faces each), descriptor and texts of a KTX 2 file."""
    import zstandard

    data = Path(path).read_bytes()
    assert data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n"
    names = "vk type_size width height depth layers faces levels scheme"
    header = dict(zip(names.split(), struct.unpack_from("<9I", data, 12), strict=True))
    dfd_at, dfd_size, kvd_at, kvd_size = struct.unpack_from("<4I", data, 48)
    assert struct.unpack_from("<2Q", data, 64) == (0, 0)
    levels, ends = [], {kvd_at + kvd_size}
    for k in range(header["levels"]):
        at, size, plain = struct.unpack_from("<3Q", data, 80 + 24 * k)
        stored = data[at : at + size]
        text = zstandard.ZstdDecompressor().decompress(stored) if header["scheme"] == 2 else stored
        assert len(text) == plain
        levels.append(text)
        ends.add(at + size)
        if header["scheme"] == 2:
            assert at in ends or k < header["levels"] - 1
        else:
            assert at % len(text[: plain // (6 * (header["width"] >> k) ** 2)]) == 0
    assert max(ends) == len(data)
    texts, at = {}, kvd_at
    while at < kvd_at + kvd_size:
        (size,) = struct.unpack_from("<I", data, at)
        key, value = data[at + 4 : at + 4 + size].split(b"\0", 1)
        texts[key.decode()] = value
        at += 4 + -(-size // 4) * 4
    assert at == kvd_at + kvd_size
    assert dfd_at == 80 + 24 * header["levels"]
    assert kvd_at == dfd_at + dfd_size
    return header, levels, data[dfd_at : dfd_at + dfd_size], texts


def decode(texels, pixel):
    """RGB of texels' bytes, by the definitions of the formats, as float64, shape (n, 3)."""
    if pixel in {"half", "float"}:
        rgba = np.frombuffer(texels, "<f2" if pixel == "half" else "<f4").reshape(-1, 4)
        assert (rgba[:, 3] == 1.0).all()
        return rgba[:, :3].astype(float)
    word = np.frombuffer(texels, "<u4").astype(np.int64)
    if pixel == "rgb9e5":
        scale = 2.0 ** ((word >> 27) - 15 - 9)
        return np.stack([(word >> (9 * i) & 511) * scale for i in range(3)], -1)
    return np.stack(
        [
            _small_float(word & 2047, 6),
            _small_float(word >> 11 & 2047, 6),
            _small_float(word >> 22, 5),
        ],
        -1,
    )


def _small_float(bits, mantissa):
    exponent, rest = bits >> mantissa, (bits & ((1 << mantissa) - 1)) / (1 << mantissa)
    assert (exponent < 31).all()
    return np.where(exponent == 0, 2.0**-14 * rest, 2.0 ** (exponent - 15.0) * (1.0 + rest))


def read_dds(path):
    """Faces of a DDS cubemap of half floats, each a list of levels, shape (n, n, 3).

    By Microsoft's pages dds-header, dds-pixelformat, dds-header-dxt10 and
    dds-file-layout-for-cubic-environment-maps.
    """
    data = Path(path).read_bytes()
    magic, size, flags, height, width, pitch, depth, count = struct.unpack_from("<4s7I", data)
    assert (magic, size, depth, height) == (b"DDS ", 124, 0, width)
    assert flags & 0x1007 == 0x1007
    assert pitch == 8 * width
    assert bool(flags & 0x20000) == (count > 1)
    kind = struct.unpack_from("<2I4s5I", data, 76)
    assert kind[:3] == (32, 4, b"DX10")
    caps, caps2 = struct.unpack_from("<2I", data, 108)
    assert caps & 0x1008 == 0x1008
    assert bool(caps & 0x400000) == (count > 1)
    assert caps2 == 0xFE00
    assert struct.unpack_from("<5I", data, 128) == (10, 3, 4, 1, 0)
    at, faces = 148, []
    for _ in range(6):
        levels = []
        for k in range(count):
            edge = max(1, width >> k)
            rgba = np.frombuffer(data, "<f2", 4 * edge * edge, at).reshape(edge, edge, 4)
            assert (rgba[..., 3] == 1.0).all()
            levels.append(rgba[..., :3].astype(np.float32))
            at += rgba.nbytes
        faces.append(levels)
    assert at == len(data)
    return faces


_KTX_PARSE = """
import { readFileSync } from 'node:fs';
const { read } = await import(process.argv[1]);
const file = read(new Uint8Array(readFileSync(process.argv[2])));
file.levels = file.levels.map((level) => ({
  bytes: Buffer.from(level.levelData).toString('base64'),
  uncompressedByteLength: level.uncompressedByteLength,
}));
console.log(JSON.stringify(file));
"""


_THREE = """
import { readFileSync } from 'node:fs';
const { KTX2Loader } = await import(process.argv[1]);
const loader = new KTX2Loader();
loader.workerConfig = {};
const { buffer } = new Uint8Array(readFileSync(process.argv[2]));
const texture = await new Promise((done, fail) => loader.parse(buffer, done, fail));
console.log(JSON.stringify({
  colorSpace: texture.colorSpace,
  width: texture.image.width,
  levels: texture.mipmaps.map(({ data }) => Buffer.from(
    data.buffer, data.byteOffset, data.byteLength).toString('base64')),
}));
"""


def ktx_parse(path):
    """A KTX 2 file as the package ktx-parse of npm reads it; skips where it is not installed."""
    return _node(_KTX_PARSE, "ktx-parse/dist/index.mjs", path)


def three_texture(path):
    """The texture that three.js makes of a KTX 2 file; skips where it is not installed."""
    return _node(_THREE, "three/examples/jsm/loaders/KTX2Loader.js", path)


def _node(code, module, path):
    node = shutil.which("node")
    folders = [Path(one) for one in os.environ.get("NODE_PATH", "").split(os.pathsep) if one]
    found = next((one / module for one in folders if (one / module).is_file()), None)
    if node is None or found is None:
        name = module.partition("/")[0]
        pytest.skip(f"node with {name} in a folder of NODE_PATH is not installed")
    command = [node, "--input-type=module", "-e", code, str(found), str(path)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
