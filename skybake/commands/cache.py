"""``skybake cache``: compiled kernels and tables that are kept between runs."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.printing.notices import notice
from skybake.errors import OutputError

if TYPE_CHECKING:
    from skybake.jit.cache import Usage

_MEGABYTE = 1e6


@click.group()
def cache() -> None:
    """Show, clear or fill the folder of kernels, solved atmospheres, tiles and light of clouds."""


@cache.command()
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def info(as_json: bool) -> None:
    """Print where the cache is and what each version keeps in it.

    SKYBAKE_CACHE_DIR names another place than the user's cache folder. Folders that have not been
    used for 30 days are removed when a new version creates its own, the oldest atmospheres and
    tiles of clouds when all of them exceed 1 GB, and the oldest light of clouds beyond 0.5 GB.
    """
    from skybake.jit.cache import cache_root, cache_usage, version_directory

    root, present = cache_root(), version_directory()
    usages = cache_usage()
    if as_json:
        versions = [_as_json(usage, is_present=usage.folder == present) for usage in usages]
        click.echo(json.dumps({"folder": _text(root), "versions": versions}))
        return
    click.echo(root or "nowhere: there is no home folder")
    for usage in usages:
        mark = " (this version)" if usage.folder == present else ""
        click.echo(
            f"{usage.folder.name}{mark}: {usage.kernels} kernels "
            f"{usage.kernel_bytes / _MEGABYTE:.1f} MB, {usage.atmospheres} atmospheres "
            f"{usage.atmosphere_bytes / _MEGABYTE:.1f} MB, {usage.cloud_tiles} tiles of clouds "
            f"{usage.cloud_tile_bytes / _MEGABYTE:.1f} MB, "
            f"light of {usage.cloud_lights} skies with clouds "
            f"{usage.cloud_light_bytes / _MEGABYTE:.1f} MB"
        )


@cache.command()
def clear() -> None:
    """Remove kernels, atmospheres, tiles and light of clouds of all versions.

    Other files in the folder are left alone.
    """
    from skybake.jit.cache import cache_usage, clear_cache

    before = cache_usage()
    clear_cache()
    left = cache_usage()
    if left:
        raise OutputError(f"{left[0].folder}: cannot be removed ({_size(left)} remain)")
    click.echo(f"{_size(before)} freed")


@cache.command()
@click.option(
    "--preset",
    "presets",
    metavar="NAME|PATH",
    multiple=True,
    default=("earth",),
    show_default=True,
    help="World whose atmosphere is solved in advance; may be repeated.",
)
@click.option(
    "--for-all-users",
    is_flag=True,
    help="Let every user read the cache, as in a container image.",
)
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
def warm(presets: tuple[str, ...], for_all_users: bool, quiet: bool) -> None:
    """Compile every kernel, so that no later run has to, for example in a container image.

    \b
    Examples:
      skybake cache warm
      SKYBAKE_CACHE_DIR=/opt/skybake skybake cache warm --for-all-users --preset earth --preset mars

    The cache is private to its owner. With --for-all-users other users can read it, and use it if
    root owns it.
    """
    check_memory()
    started = time.perf_counter()
    say = _silent if quiet else notice

    from skybake.jit.cache import check_cache, share_cache

    check_cache()

    from skybake.aerial.warm import compile_air
    from skybake.baking.warm import compile_all, solve
    from skybake.luts.warm import compile_kernels
    from skybake.preset import load_preset

    # An error in the last one is to be reported before the first is solved.
    for preset in presets:
        load_preset(preset)
    say("compiling kernels")
    solve(presets, say)
    compile_air()
    compile_all()
    compile_kernels()
    if for_all_users:
        share_cache()
    if not quiet:
        click.echo(f"warm; {time.perf_counter() - started:.1f} s")


def _size(usages: Sequence[Usage]) -> str:
    total = sum(usage.total_bytes for usage in usages)
    return f"{total / _MEGABYTE:.1f} MB"


def _as_json(usage: Usage, *, is_present: bool) -> dict[str, Any]:
    return {
        "folder": _text(usage.folder),
        "present": is_present,
        "kernels": usage.kernels,
        "kernel_bytes": usage.kernel_bytes,
        "atmospheres": usage.atmospheres,
        "atmosphere_bytes": usage.atmosphere_bytes,
        "cloud_tiles": usage.cloud_tiles,
        "cloud_tile_bytes": usage.cloud_tile_bytes,
        "cloud_lights": usage.cloud_lights,
        "cloud_light_bytes": usage.cloud_light_bytes,
    }


def _text(path: Path | None) -> str | None:
    return None if path is None else str(path)


def _silent(_: str) -> None:
    pass
