"""A local page with knobs, the sky that they make, and the command that bakes it.

The package has the name of a function of `skybake` and is that function: ``skybake.studio()`` shows
the page in a notebook, whichever of the two was imported first.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import Any


class _Studio(ModuleType):
    """The package, which can be called, see `skybake.commands.in_notebook.studio`."""

    def __call__(self, *arguments: Any, **keywords: Any) -> Any:
        # It reads knobs by the command line, which is above this room.
        return import_module("skybake.commands.in_notebook").studio(*arguments, **keywords)


studio = sys.modules[__name__]
studio.__class__ = _Studio
