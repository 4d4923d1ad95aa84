"""Who may ask: the page itself, on this machine, with the token of its address."""

from __future__ import annotations

import secrets
from dataclasses import dataclass

from aiohttp import web

HEADER = "X-Skybake-Token"
LARGEST_BODY = 1_000_000
"""Of a request. [byte]"""

_FOREIGN = {"cross-site", "same-site"}


@dataclass(frozen=True)
class Guard:
    """Refuses requests of other pages and other programs.

    Attributes
    ----------
    token : str
        Part of the page's address.
    port : int
        Of the server.
    """

    token: str
    port: int

    @property
    def hosts(self) -> frozenset[str]:
        """Hosts under which the page is served."""
        return frozenset(f"{name}:{self.port}" for name in ("127.0.0.1", "localhost"))

    def check(self, request: web.Request) -> None:
        """Refuse a request that is not the page's own.

        Raises
        ------
        aiohttp.web.HTTPForbidden
            If Host or Origin are others than the server's, so that no page that is open elsewhere
            can ask, not even by a name that it lets point here; or if the token is missing.
        aiohttp.web.HTTPRequestEntityTooLarge
            If the body is larger than `LARGEST_BODY`.
        """
        if request.headers.get("Host", "") not in self.hosts:
            raise web.HTTPForbidden(text="Host must be the server's own\n")
        origin = request.headers.get("Origin")
        if origin is not None and origin.removeprefix("http://") not in self.hosts:
            raise web.HTTPForbidden(text="Origin must be the server's own\n")
        if is_static(request.path):
            # Modules import each other without the token, and hold nothing secret.
            if request.headers.get("Sec-Fetch-Site") in _FOREIGN:
                raise web.HTTPForbidden(text="another site asks\n")
        elif not self._has_token(request):
            raise web.HTTPForbidden(text="the token of the printed address is missing\n")
        if (request.content_length or 0) > LARGEST_BODY:
            raise web.HTTPRequestEntityTooLarge(LARGEST_BODY, request.content_length or 0)

    def headers(self, *, in_frame: bool = False) -> dict[str, str]:
        """Return headers by which a browser loads nothing from anywhere else.

        Parameters
        ----------
        in_frame : bool, optional
            Whether another page, as that of a notebook, may show this one in a frame.
        """
        sockets = " ".join(f"ws://{host}" for host in sorted(self.hosts))
        rules = [
            "default-src 'self'",
            "img-src 'self' data: blob:",
            f"connect-src 'self' {sockets}",
            "object-src 'none'",
            "base-uri 'none'",
            "form-action 'none'",
            *([] if in_frame else ["frame-ancestors 'none'"]),
        ]
        return {
            "Content-Security-Policy": "; ".join(rules),
            "Cache-Control": "no-store",
            "Referrer-Policy": "no-referrer",
            "X-Content-Type-Options": "nosniff",
            "Cross-Origin-Resource-Policy": "same-origin",
        }

    def _has_token(self, request: web.Request) -> bool:
        given = request.query.get("token") or request.headers.get(HEADER) or ""
        return secrets.compare_digest(given.encode(), self.token.encode())


def is_static(path: str) -> bool:
    """Whether a path is that of a part of the page."""
    return path.startswith("/page/")
