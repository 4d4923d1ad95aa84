"""``skybake check``: what is wrong with maps in files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.memory import check_memory

if TYPE_CHECKING:
    from skybake.inspect.check import Checked

WRONG = 1


@click.command()
@click.argument(
    "files", metavar="FILE...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@click.option("--json", "as_json", is_flag=True, help="Print the findings as one JSON object.")
@click.option("-q", "--quiet", is_flag=True, help="Print faults only.")
@click.pass_context
def check(context: click.Context, files: tuple[Path, ...], as_json: bool, quiet: bool) -> None:
    """Check EXR and Radiance maps, also of other programs.

    Prints a line for each finding: values that are not finite, negative or beyond what half floats
    or DWA hold; edges, poles and faces that do not go on; tags that contradict each other; light
    and a sun that are not as stated. The status is 1 if something is wrong, 0 if not.

    \b
    Examples:
      skybake check sky.exr
      skybake check faces_*.exr --json
    """
    check_memory()

    from skybake.inspect.check import check_files

    checked = check_files(files)
    is_wrong = any(one.is_wrong for one in checked)
    if as_json:
        click.echo(json.dumps({"is_wrong": is_wrong, "checked": [_record(one) for one in checked]}))
    else:
        _print(checked, quiet)
    if is_wrong:
        context.exit(WRONG)


def _print(checked: list[Checked], quiet: bool) -> None:
    for one in checked:
        where = one.files[0] if len(one.files) == 1 else f"{one.files[0]} and the other faces"
        shown = [finding for finding in one.findings if finding.is_wrong or not quiet]
        for finding in shown:
            kind = "wrong" if finding.is_wrong else "note"
            click.echo(f"{where}: {kind}: {finding.check}: {finding.text}")
        if not one.findings and not quiet:
            click.echo(f"{where}: fine")


def _record(one: Checked) -> dict[str, Any]:
    return {
        "files": [str(path) for path in one.files],
        "is_wrong": one.is_wrong,
        "findings": [finding._asdict() for finding in one.findings],
    }
