"""What a program gives back."""

from typing import NamedTuple

from tests.peers.scenes import Views


class AbsentError(Exception):
    """A program that cannot be found; the text says where it was looked for."""


class Rendered(NamedTuple):
    """Views of a program.

    Attributes
    ----------
    version : str
        Of the program.
    views : Views
        As it rendered them.
    """

    version: str
    views: Views
