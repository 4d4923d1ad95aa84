"""Sequences that are baked or planned in this process, in the current folder."""

import hashlib
import json
from pathlib import Path

from skybake.formats.reader import read_image
from tests.cli.runs import SMALL, invoke

QUICK = (*SMALL, "--method", "hillaire")
DAY = ("--sun", "20deg..60deg")
THREE = ("--frames", "1-3")
PARIS = ("--lat", "48.8566", "--lon", "2.3522", "--tz", "Europe/Paris")


def sequence(*arguments, status=0):
    """Bake quietly; returns what ``--json`` prints."""
    result = invoke("sequence", *QUICK, "--json", "--quiet", *arguments)
    assert result.exit_code == status, result.output
    return json.loads(result.stdout)


def plan(*arguments):
    """Frames of a dry run."""
    result = invoke("sequence", "--dry-run", "--json", *arguments)
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)["frames"]


def attributes(path):
    """Of a file of a map."""
    return read_image(Path(path))[1]


def digests(pattern):
    """SHA-256 of files of the current folder, by name."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in files(pattern)}


def files(pattern):
    """Files of the current folder; there must be some."""
    found = sorted(path for path in Path().glob(pattern) if path.is_file())
    assert found
    return found


def records(path):
    """Of a manifest in JSON."""
    return json.loads(Path(path).read_text("utf-8"))["records"]
