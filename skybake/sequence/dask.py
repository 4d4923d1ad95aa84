"""Frames on the workers of a Dask cluster. Needs the extra ``skybake[dask]``."""

from __future__ import annotations

import functools
import hashlib
import logging
import platform
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from importlib.metadata import version
from typing import Any

import llvmlite.binding

from skybake.errors import InputError
from skybake.jit.workers import Workers
from skybake.optics.medium import Medium
from skybake.pipeline import Pipeline
from skybake.preset import Planet
from skybake.scattering.atmosphere import adopt_atmosphere, atmosphere_content
from skybake.sequence.frame import FrameOutcome, PreviewSettings, finish_frame
from skybake.sequence.plan import Frame, Plan
from skybake.sequence.pool import Done, Run
from skybake.sky.sky import Sky
from skybake.version import __version__

CONNECT_WITHIN = 6
"""Time after which a scheduler is considered absent. [s]"""

WORKER_WITHIN = 30
"""The same of its first worker, which a cluster may only now be starting. [s]"""

_PACKAGES = ("numpy", "numba", "llvmlite", "OpenImageIO")

Tables = tuple[Medium, str, bytes] | None


@contextmanager
def dask_pool(
    plan: Plan, previews: PreviewSettings, address: str, *, skip_existing: bool = False
) -> Iterator[Run]:
    """Bake frames on a cluster.

    Parameters
    ----------
    plan : Plan
        The sequence. Its files must be in folders that the workers share.
    previews : PreviewSettings
        How its frames are shown.
    address : str
        Of the scheduler, as ``tcp://host:8786``.
    skip_existing : bool, optional
        Skip frames whose files are complete and of the same recipe.

    Raises
    ------
    InputError
        If the extra is not installed, no scheduler or worker answers, or workers run
        other versions, which could make other bytes.

    Notes
    -----
    The world and the tables of its atmosphere, 14 MB, are sent to each worker once; a
    frame is half a kilobyte each way besides its thumbnails. If a worker dies, its frame
    is given to another.
    """
    try:
        from dask.distributed import Client, as_completed
    except ImportError as error:
        raise InputError("dask: needs distributed; try pip install distributed") from error
    # Its messages would mix with ours; what is lost becomes a frame's failure.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    try:
        client = Client(address, timeout=CONNECT_WITHIN, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            f"dask: no scheduler has answered at {address} within {CONNECT_WITHIN} s "
            f"({_one_line(error)})"
        ) from error
    futures: dict[Any, Frame] = {}
    try:
        _check_workers(client, address)
        # Of many worlds each worker needs a few, and those come with their frames.
        planets = list(plan.planets)
        if len(planets) == 1:
            planets = client.scatter(planets, broadcast=True)
        tables = client.scatter(_tables(plan), broadcast=True)

        def run(frames: Sequence[Frame]) -> Iterator[Done]:
            futures.clear()
            for frame in frames:
                future = client.submit(
                    finish_on_worker,
                    replace(frame, output=frame.output.absolute(), preview=_absolute(frame)),
                    planets[frame.world],
                    tables,
                    previews,
                    skip_existing=skip_existing,
                    pure=False,
                )
                futures[future] = frame
            for future in as_completed(list(futures), loop=client.loop):
                yield futures.pop(future), _outcome(future)
                future.release()

        yield run
    finally:
        client.cancel(list(futures))
        client.close()


def finish_on_worker(
    frame: Frame, planet: Planet, tables: Tables, previews: PreviewSettings, *, skip_existing: bool
) -> FrameOutcome:
    """Bake a frame on a worker, with tables that were sent to it."""
    if tables is not None:
        adopt_atmosphere(*tables)
    return finish_frame(frame, planet, previews, _pipeline(), skip_existing=skip_existing)


@functools.cache
def _pipeline() -> Pipeline:
    """Pipeline of this process, whose threads are the cluster's."""
    return Pipeline(workers=Workers(1), keeps_light_of_clouds=False)


def versions() -> dict[str, str]:
    """Return what a worker's pixels depend on besides the frame."""
    major, minor, _ = platform.python_version_tuple()
    ours = {"skybake": __version__, "python": f"{major}.{minor}", "processor": processor()}
    return ours | {name: version(name) for name in _PACKAGES}


def processor() -> str:
    """Name of the processor and digest of its features, for which kernels are compiled."""
    name: str = llvmlite.binding.get_host_cpu_name()
    features: str = llvmlite.binding.get_host_cpu_features().flatten()
    return f"{name} {hashlib.sha256(features.encode()).hexdigest()[:8]}"


def _check_workers(client: Any, address: str) -> None:
    try:
        client.wait_for_workers(1, timeout=WORKER_WITHIN)
    except TimeoutError as error:
        raise InputError(f"dask: {address} has had no worker within {WORKER_WITHIN} s") from error
    ours = versions()
    for worker, theirs in client.run(versions, on_error="return").items():
        if isinstance(theirs, Exception):
            raise InputError(
                f"dask: worker {worker} must have skybake {ours['skybake']}, "
                f"got {_one_line(theirs)}"
            )
        for name, mine in ours.items():
            if theirs[name] != mine:
                raise InputError(
                    f"dask: worker {worker} must have {name} {mine} as here, got {theirs[name]}"
                )


def _tables(plan: Plan) -> Tables:
    """Tables that all frames share; where each has its own atmosphere, its worker builds them."""
    if len(plan.planets) > 1:
        return None
    lighting = plan.frames[0].settings.lighting
    sky = Sky(plan.planets[0], lighting.sun_elevation, method=lighting.method)
    return sky.medium, sky.table_method, atmosphere_content(sky.medium, sky.table_method)


def _absolute(frame: Frame) -> Any:
    return None if frame.preview is None else frame.preview.absolute()


def _outcome(future: Any) -> FrameOutcome | Exception:
    """Return the result of a future, or why there is none."""
    if future.status == "finished":
        outcome: FrameOutcome = future.result()
        return outcome
    if future.status == "error":
        error: Exception = future.exception()
        return error
    return InputError(f"dask: a frame was lost ({future.status})")


def _one_line(error: BaseException) -> str:
    return " ".join(str(error).split()) or type(error).__name__
