"""Farms start what they should: checked with a real shell and OpenJD's own model."""

import json
import subprocess
import sys

import pytest
from openjd.model import (
    StepParameterSpaceIterator,
    SymbolTable,
    create_job,
    decode_job_template,
    preprocess_job_parameters,
)

from skybake.errors import InputError, OutputError
from skybake.sequence.farm import commands, write_openjd
from skybake.sequence.frames import chunks, parse_frames
from tests.cli.runs import listing, run
from tests.sequence.runs import QUICK

ARGUMENTS = [
    "skybake",
    "sequence",
    "--preset",
    "/maps/it's $HOME.toml",
    "--set",
    'aerosol.name="a b"',
    "-o",
    "/out/sky {face}.$F4.exr",
    "",
    "`date`;é*",
]

ECHO = "import json, sys; print(json.dumps(sys.argv[1:]))"


def _tasks(path):
    """Command and arguments of every task that OpenJD would run."""
    template = decode_job_template(template=json.loads(path.read_text("utf-8")))
    values = preprocess_job_parameters(
        job_template=template,
        job_parameter_values={},
        job_template_dir=path.parent,
        current_working_dir=path.parent,
    )
    (step,) = create_job(job_template=template, job_parameter_values=values).steps
    action = step.script.actions.onRun
    for parameters in StepParameterSpaceIterator(space=step.parameterSpace):
        table = SymbolTable()
        for name, value in parameters.items():
            table[f"Task.Param.{name}"] = value.value
        yield [part.resolve(symtab=table) for part in (action.command, *action.args)]


@pytest.mark.parametrize(
    ("frames", "size", "lines"),
    [
        ("1-10", 5, ["skybake sequence --only 1-5", "skybake sequence --only 6-10"]),
        ("-3-0", 3, ["skybake sequence --only -3--1", "skybake sequence --only 0"]),
        ("1-9x2,20", 10, ["skybake sequence --only 1-9x2,20"]),
    ],
)
def test_there_is_a_line_for_each_chunk(frames, size, lines):
    assert commands(["skybake", "sequence"], chunks(parse_frames(frames), size)) == lines


def test_a_shell_gives_the_program_what_was_meant(tmp_path):
    lines = commands([sys.executable, "-c", ECHO, *ARGUMENTS], [(1, 2, 3), (-5,)])
    ran = subprocess.run(
        ["sh"], input="\n".join(lines), capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert [json.loads(line) for line in ran.stdout.splitlines()] == [
        [*ARGUMENTS, "--only", "1-3"],
        [*ARGUMENTS, "--only", "-5"],
    ]


@pytest.mark.parametrize(
    ("frames", "size"), [("1-96", 10), ("1-100x5,150,200-210", 7), ("-10--1,5", 4), ("8", 1)]
)
def test_openjd_runs_the_chunks_and_no_more(tmp_path, frames, size):
    frames = parse_frames(frames)
    path = write_openjd(tmp_path / "job", ARGUMENTS, frames, size, "sky of earth")
    assert path == tmp_path / "job" / "template.json"
    tasks = list(_tasks(path))
    assert [task[:-2] for task in tasks] == [ARGUMENTS] * len(tasks)
    assert [task[-2] for task in tasks] == ["--only"] * len(tasks)
    assert [parse_frames(task[-1]) for task in tasks] == chunks(frames, size)


def test_openjd_takes_as_many_tasks_as_it_allows(tmp_path):
    path = write_openjd(tmp_path, ARGUMENTS, range(2048), 2, "n" * 128)
    assert len(list(_tasks(path))) == 1024
    with pytest.raises(InputError, match="chunk: must be at least 3 frames for the 1024 tasks"):
        write_openjd(tmp_path, ARGUMENTS, range(2049), 2, "sky")


def test_openjd_takes_as_long_a_list_of_frames_as_it_allows(tmp_path):
    scattered = [k * k for k in range(400)]
    write_openjd(tmp_path, ARGUMENTS, scattered, 100, "sky")
    assert len(list(_tasks(tmp_path / "template.json"))) == 4
    with pytest.raises(InputError, match="chunk: must be smaller"):
        write_openjd(tmp_path, ARGUMENTS, scattered, 400, "sky")


def test_a_template_is_replaced_whole_or_not_at_all(tmp_path):
    path = write_openjd(tmp_path, ARGUMENTS, (1, 2), 1, "one")
    write_openjd(tmp_path, ARGUMENTS, (1, 2), 1, "two")
    assert json.loads(path.read_text("utf-8"))["name"] == "two"
    before = path.read_bytes()
    for name in ("", "n" * 129, "a\nb", "{{Param.X}}"):
        with pytest.raises(InputError):
            write_openjd(tmp_path, ARGUMENTS, (1, 2), 1, name)
    assert path.read_bytes() == before
    assert [one.name for one in tmp_path.iterdir()] == ["template.json"]


@pytest.mark.parametrize("argument", ["a\nb", "a\tb", "\udcff", "\x85"])
def test_an_argument_that_breaks_a_line_is_refused(tmp_path, argument):
    with pytest.raises(InputError, match="farm: an argument must be UTF-8 without control"):
        commands([*ARGUMENTS, argument], [(1,)])
    with pytest.raises(InputError, match="farm: an argument must be UTF-8 without control"):
        write_openjd(tmp_path, [*ARGUMENTS, argument], (1,), 1, "sky")


def test_what_openjd_would_expand_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"cannot hold \{\{ or \}\} in 'a\{\{b\}\}'"):
        write_openjd(tmp_path, [*ARGUMENTS, "a{{b}}"], (1,), 1, "sky")


def test_a_folder_that_cannot_be_made_is_an_error_of_one_line(tmp_path):
    (tmp_path / "file").touch()
    for folder in (tmp_path / "file", tmp_path / "absent" / "job"):
        with pytest.raises(OutputError, match="cannot be created"):
            write_openjd(folder, ARGUMENTS, (1,), 1, "sky")


def test_the_tasks_of_openjd_bake_the_frames_and_tell_their_progress(tmp_path):
    for name in ("maps", "session"):
        (tmp_path / name).mkdir()
    arguments = ("-o", "a.#.exr", "--frames", "1-5", "--emit-openjd", "../job", "--chunk-size", "3")
    status, output, errors = run(*QUICK, *arguments, cwd=tmp_path / "maps")
    assert (status, output, errors) == (0, "../job/template.json\n", "")
    told = []
    for program, *words in _tasks(tmp_path / "job" / "template.json"):
        assert program == "skybake"
        status, output, errors = run(*words, cwd=tmp_path / "session")
        assert (status, errors) == (0, "")
        told += [line.split()[1] for line in output.splitlines() if "openjd_progress" in line]
    assert told == ["33.3", "66.7", "100.0", "50.0", "100.0"]
    assert listing(tmp_path / "session") == []
    assert listing(tmp_path / "maps") == [f"a.{i:04d}.exr" for i in range(1, 6)]
