"""``python -m tests.peers``: light a scene in other programs by our files, and measure it.

After that they are asked where they find the directions that maps encode.

A program that is not there is reported. The exit status is 1 if a measurement of one that is
there is beyond its limit, or if it fails.
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

import click

from tests.peers import blender, mitsuba, orientation, three
from tests.peers.files import bake_files
from tests.peers.measure import measure
from tests.peers.peer import AbsentError
from tests.peers.pictures import write_picture

PEERS = {"blender": blender, "three": three, "mitsuba": mitsuba}
TITLES = {"blender": "Blender", "three": "three.js", "mitsuba": "Mitsuba"}


def main():
    """Run the programs and return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tests.peers", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(PEERS)}")
    parser.add_argument(
        "--pictures", type=Path, metavar="FOLDER", help="write engine-NAME.png of each here"
    )
    options = parser.parse_args()
    unknown = sorted(set(options.names) - set(PEERS))
    if unknown:
        parser.error(f"unknown: {', '.join(unknown)}")
    with tempfile.TemporaryDirectory(prefix="skybake-peers-") as folder:
        outcomes = [_run(name, Path(folder), options.pictures) for name in options.names or PEERS]
    click.echo("Directions")
    outcomes.append(orientation.main(options.names or orientation.ASKED) == 0)
    return 0 if all(outcomes) else 1


def _run(name, folder, pictures):
    """Whether a program is absent, or all its measurements are within their limits."""
    own = folder / name
    own.mkdir()
    baked = bake_files(own, name)
    try:
        rendered = PEERS[name].render(baked, own)
    except AbsentError as reason:
        click.echo(f"{TITLES[name]}: absent: {reason}")
        return True
    except subprocess.SubprocessError as error:
        click.echo(f"{TITLES[name]}: FAILED: {error}\n{getattr(error, 'stderr', '')}")
        return False
    click.echo(f"{TITLES[name]} {rendered.version}")
    checks = measure(rendered.views, baked.sky)
    for check in checks:
        verdict = "" if check.is_met else "  FAILED"
        limit = f"(limit {check.limit:g} {check.unit})"
        click.echo(f"  {check.what:26} {check.value:8.3f} {check.unit:3} {limit}{verdict}")
    if pictures is not None:
        write_picture(pictures / f"engine-{name}.png", rendered.views.picture)
    return all(check.is_met for check in checks)


if __name__ == "__main__":
    raise SystemExit(main())
