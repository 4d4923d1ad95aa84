"""Frames on the threads of this process, which share the tables of the atmosphere."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed, wait
from contextlib import contextmanager

from skybake.jit.workers import Workers, cpu_count
from skybake.pipeline import Pipeline
from skybake.sequence.frame import FrameOutcome, PreviewSettings, finish_frame
from skybake.sequence.plan import Frame, Plan

Done = tuple[Frame, FrameOutcome | Exception]
Run = Callable[[Sequence[Frame]], Iterator[Done]]
"""Bakes frames and yields each when it is done or has failed, in any order."""

_ANSWER_WITHIN = 0.4


@contextmanager
def local_pool(
    plan: Plan,
    previews: PreviewSettings,
    *,
    workers: int | None = None,
    skip_existing: bool = False,
) -> Iterator[Run]:
    """Bake several frames at once.

    Parameters
    ----------
    plan : Plan
        The sequence.
    previews : PreviewSettings
        How its frames are shown.
    workers : int, optional
        Frames at once; default one for each CPU. A single one uses all CPUs, which
        is slower but takes the memory of one frame.
    skip_existing : bool, optional
        Skip frames whose files are complete and of the same recipe.

    Notes
    -----
    Threads suffice: kernels, compression and file access release the interpreter's lock.
    """
    workers = min(workers or cpu_count(), max(len(plan.frames), 1))
    stop = threading.Event()
    threads = ThreadPoolExecutor(workers)
    # Where several frames are baked at once, each keeps to its own thread.
    threads_of_frame = Workers(None if workers == 1 else 1, stop)
    pipeline = Pipeline(workers=threads_of_frame, keep=workers, keeps_light_of_clouds=False)
    pending: dict[Future[FrameOutcome], Frame] = {}

    def run(frames: Sequence[Frame]) -> Iterator[Done]:
        pending.clear()
        for frame in frames:
            future = threads.submit(
                finish_frame,
                frame,
                plan.planet(frame),
                previews,
                pipeline,
                skip_existing=skip_existing,
            )
            pending[future] = frame
        for future in as_completed(pending):
            error = future.exception()
            if error is not None and not isinstance(error, Exception):
                raise error
            # Release it, since it holds the thumbnails of its frame.
            yield pending.pop(future), error or future.result()

    try:
        yield run
    finally:
        stop.set()
        threads.shutdown(wait=False, cancel_futures=True)
        # What is being written stops at its next band and takes its hidden folder along.
        begun = [future for future in pending if not future.cancelled()]
        wait(begun, timeout=_ANSWER_WITHIN)
