"""``skybake studio`` begins, ends and begins again."""

import signal
import socket
import sys

import pytest

from tests.cli.runs import invoke, run
from tests.studio.servers import TOKEN, serving

COLD = "skybake: compiling kernels, once for this version\n"
"""What is said where no test has run yet."""


def test_it_prints_the_address_and_ends_on_an_interrupt(tmp_path):
    with serving(tmp_path) as server:
        assert server.url == f"http://127.0.0.1:{server.port}/?token={TOKEN}"
        assert server.json("/api/options")["preset"] == "earth"
        status, output, errors = server.end()
    assert (status, output) == (0, "")
    assert errors in {"", COLD}


def test_tokens_differ_from_run_to_run(tmp_path, monkeypatch):
    from skybake.studio.serve import token_of_environment

    monkeypatch.delenv("SKYBAKE_STUDIO_TOKEN", raising=False)
    first, second = token_of_environment(), token_of_environment()
    assert first != second
    assert min(len(first), len(second)) >= 32


def test_a_killed_server_is_started_again_at_the_same_address(tmp_path):
    with serving(tmp_path) as server:
        assert server.end(signal.SIGKILL)[0] == -signal.SIGKILL
        with serving(tmp_path, port=server.port) as again:
            assert again.url == server.url
            assert server.json("/api/options")["groups"]


def test_it_is_terminated_like_any_command(tmp_path):
    with serving(tmp_path) as server:
        status, output, errors = server.end(signal.SIGTERM)
    assert (status, output) == (143, "")
    assert errors.removeprefix(COLD) == "skybake: terminated\n"


def test_a_taken_port_is_one_line():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        result = invoke("studio", "--no-browser", "--port", port)
    assert result.exit_code == 1
    assert result.stderr.startswith(f"skybake: --port: cannot be used ({port}: ")
    assert result.stderr.count("\n") == 1


def test_a_short_token_is_refused(monkeypatch):
    monkeypatch.setenv("SKYBAKE_STUDIO_TOKEN", "short")
    result = invoke("studio", "--no-browser")
    assert result.exit_code == 1
    assert "must be at least 16 letters" in result.stderr


def test_an_unknown_preset_is_refused_before_anything_is_served():
    result = invoke("studio", "--no-browser", "--preset", "vulcan")
    assert result.exit_code == 1
    assert "unknown preset 'vulcan'" in result.stderr


def test_without_its_extra_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    result = invoke("studio", "--no-browser")
    assert result.exit_code == 1
    assert result.stderr == "skybake: studio: needs aiohttp; try pip install 'skybake[studio]'\n"


@pytest.mark.parametrize("arguments", [("--port", "70000"), ("--port", "x"), ("--preset",)])
def test_wrong_usage_is_one_line(arguments):
    status, output, errors = run("studio", *arguments)
    assert (status, output, errors.count("\n")) == (2, "", 1)
