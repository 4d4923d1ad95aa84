"""The server answers its own page alone, and leads to no file but those of the page."""

import http.client
import socket
from contextlib import closing

import pytest

from skybake.studio.guard import LARGEST_BODY
from skybake.studio.server import PAGE

API = ("/", "/api/options", "/api/world", "/api/live", "/api/parse?option=sun&text=5deg")


@pytest.mark.parametrize("path", API)
def test_a_request_without_the_token_is_refused(server, path):
    status, _, body = server.request(path, token=False)
    assert (status, b"token" in body) == (403, True)


def test_a_request_with_another_token_is_refused(server):
    wrong = server.token[:-1] + "x"
    assert server.request(f"/api/options?token={wrong}", token=False)[0] == 403
    assert server.request(f"/api/options?token={server.token}", token=False)[0] == 200


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1:1", "0.0.0.0:{port}"]
)
@pytest.mark.parametrize("path", ["/api/options", "/page/index.html"])
def test_a_request_for_another_host_is_refused(server, host, path):
    """A name that another site lets point to this machine is not the page's."""
    status, _, _ = server.request(path, headers={"Host": host.format(port=server.port)})
    assert status == 403


@pytest.mark.parametrize(
    "origin", ["https://evil.example", "null", "http://127.0.0.1:1", "file://"]
)
def test_a_request_of_a_foreign_page_is_refused(server, origin):
    assert server.request("/api/options", headers={"Origin": origin})[0] == 403


def test_a_request_of_the_own_page_is_answered(server):
    for name in ("127.0.0.1", "localhost"):
        host = f"{name}:{server.port}"
        headers = {"Host": host, "Origin": f"http://{host}"}
        assert server.request("/api/options", headers=headers)[0] == 200


def test_parts_of_the_page_are_not_given_to_other_sites(server):
    headers = {"Sec-Fetch-Site": "cross-site"}
    assert server.request("/page/index.html", headers=headers)[0] == 403


@pytest.mark.parametrize(
    "path",
    [
        "/page/../server.py",
        "/page/..%2fserver.py",
        "/page/%2e%2e/%2e%2e/version.py",
        "/page/..%5c..%5cversion.py",
        "/page//etc/passwd",
        "/page/%2fetc%2fpasswd",
        "/page/index.html%00.js",
        "/etc/passwd",
        "/api/preset-picture/..%2f..%2fsecret",
        "/page/",
    ],
)
def test_no_path_leads_out_of_the_page(server, path):
    status, _, body = server.request(path)
    assert status == 404
    assert b"root:" not in body


def test_a_large_body_is_refused(server):
    body = b'{"state": "' + b"x" * 10_000_000 + b'"}'
    try:
        status, _, _ = server.request("/api/command", method="POST", body=body)
    except (BrokenPipeError, ConnectionResetError):
        status = 413  # it hung up before all of it had come
    assert status == 413


def test_a_large_body_of_unknown_length_is_refused(server):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
    blocks = (b"x" * 100_000 for _ in range(2 * LARGEST_BODY // 100_000))
    headers = {"X-Skybake-Token": server.token}
    with closing(connection):
        try:
            connection.request("POST", "/api/command", blocks, headers, encode_chunked=True)
            status = connection.getresponse().status
        except (BrokenPipeError, ConnectionResetError):
            status = 413  # it hung up before all of it had come
        assert status == 413


@pytest.mark.parametrize(
    "body", ["", "[]", "{", '{"state": 5}', '{"state": {"colour": 1}}', "[" * 9999]
)
def test_a_body_that_is_no_state_is_refused_in_one_line(server, body):
    status, _, answer = server.request("/api/command", method="POST", body=body)
    assert status == 400
    assert b"must be" in answer


def test_the_server_listens_on_this_machine_alone(server):
    addresses = {entry[4][0] for entry in socket.getaddrinfo(socket.gethostname(), server.port)}
    for address in addresses - {"127.0.0.1", "127.0.1.1", "::1"}:
        with pytest.raises(OSError, match=r"refused|unreachable|assign"):
            socket.create_connection((address, server.port), timeout=5)


def test_answers_let_a_browser_load_nothing_from_elsewhere(server):
    for path in ("/", "/api/options", "/no-such-path"):
        _, headers, _ = server.request(path)
        policy = headers["Content-Security-Policy"]
        assert "default-src 'self'" in policy
        assert "frame-ancestors 'none'" in policy
        assert "unsafe" not in policy
        assert headers["Cache-Control"] == "no-store"


def test_the_page_and_all_its_parts_are_served(server):
    """They are data of the package, which an installation has to hold."""
    status, headers, body = server.request("/")
    assert (status, headers["Content-Type"]) == (200, "text/html; charset=utf-8")
    assert body.lower().startswith(b"<!doctype html>")
    parts = [path for path in PAGE.iterdir() if path.is_file()]
    assert {path.suffix for path in parts} >= {".html", ".js", ".css"}
    for path in parts:
        status, headers, body = server.request(f"/page/{path.name}", token=False)
        assert (status, body) == (200, path.read_bytes()), path.name
