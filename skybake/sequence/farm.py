"""A sequence as jobs of a render farm: a command for each chunk of frames."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from skybake.errors import InputError, OutputError
from skybake.formats.text import is_plain_line
from skybake.formats.whole_files import replace_when_whole
from skybake.sequence.frames import chunks, format_frames

ONLY = "--only"
"""Option that takes a chunk of the sequence's frames."""

# Limits of jobtemplate-2023-09.
_MOST_TASKS = 1024
_LONGEST_VALUE = 1024
_LONGEST_NAME = 128


def commands(arguments: Sequence[str], parts: Iterable[Sequence[int]]) -> list[str]:
    """Return a line for a POSIX shell for each chunk.

    Parameters
    ----------
    arguments : sequence of str
        The program, its command and all options but `ONLY`. Tasks start in folders of
        their own, so paths should be absolute.
    parts : iterable of sequence of int
        The frames of each chunk.

    Raises
    ------
    InputError
        If an argument does not fit on one line.
    """
    _check_arguments(arguments)
    return [shlex.join([*arguments, ONLY, format_frames(part)]) for part in parts]


def write_openjd(
    folder: Path, arguments: Sequence[str], frames: Sequence[int], chunk: int, name: str
) -> Path:
    """Write an Open Job Description, ``template.json``, with a task for each chunk.

    Parameters
    ----------
    folder : Path
        The job's own, as Deadline Cloud's job bundles have it; made if it is absent.
    arguments : sequence of str
        As of `commands`. No shell takes part, so nothing is quoted.
    frames : sequence of int
        All frames.
    chunk : int
        Frames of a task.
    name : str
        Of the job.

    Returns
    -------
    Path
        The template.

    Raises
    ------
    InputError
        If the specification jobtemplate-2023-09 cannot hold it.
    OutputError
        If the file cannot be written.
    """
    _check_arguments([*arguments, name])
    for text in (*arguments, name):
        if "{{" in text or "}}" in text:
            raise InputError(
                f"{folder}: an Open Job Description cannot hold {{{{ or }}}} in {text!r}"
            )
    if not 1 <= len(name) <= _LONGEST_NAME:
        raise InputError(
            f"{folder}: a job's name must have 1 to {_LONGEST_NAME} characters, got {name!r}"
        )
    values = [format_frames(part) for part in chunks(frames, chunk)]
    if len(values) > _MOST_TASKS:
        raise InputError(
            f"chunk: must be at least {math.ceil(len(frames) / _MOST_TASKS)} frames for the "
            f"{_MOST_TASKS} tasks of an Open Job Description, got {chunk}"
        )
    longest = max(values, key=len)
    if len(longest) > _LONGEST_VALUE:
        raise InputError(
            f"chunk: must be smaller, since the list of its frames may have {_LONGEST_VALUE} "
            f"characters in an Open Job Description, got {longest[:32]}..."
        )
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be created ({error.strerror})") from error
    path = folder / "template.json"
    with replace_when_whole(path) as temporary:
        document = _template(arguments, values, name)
        temporary.write_text(json.dumps(document, indent=2, ensure_ascii=False) + "\n", "utf-8")
    return path


def _template(arguments: Sequence[str], values: list[str], name: str) -> dict[str, Any]:
    return {
        "specificationVersion": "jobtemplate-2023-09",
        "name": name,
        "steps": [
            {
                "name": "Bake",
                "parameterSpace": {
                    "taskParameterDefinitions": [
                        {"name": "Frames", "type": "STRING", "range": values}
                    ]
                },
                "script": {
                    "actions": {
                        "onRun": {
                            "command": arguments[0],
                            "args": [*arguments[1:], ONLY, "{{Task.Param.Frames}}"],
                            # A signal first, so that no partial file is left.
                            "cancelation": {"mode": "NOTIFY_THEN_TERMINATE"},
                        }
                    }
                },
            }
        ],
    }


def _check_arguments(arguments: Sequence[str]) -> None:
    for argument in arguments:
        if not is_plain_line(argument):
            raise InputError(
                f"farm: an argument must be UTF-8 without control characters, got {argument!r}"
            )
