"""Signals that end a process wait while files take their names."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

_ENDING = tuple(
    getattr(signal, name)
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")
    if hasattr(signal, name)
)

_holding = threading.Lock()


@contextmanager
def signals_held() -> Iterator[None]:
    """Hold back signals that end the process until the block has ended.

    Python handles signals in its main thread only. On another thread the block holds
    back `wait_until_released` instead, which is called before an exit.
    """
    with _holding:
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        arrived: list[int] = []
        before: dict[int, Any] = {}

        def hold(number: int, _: FrameType | None) -> None:
            arrived.append(number)

        try:
            for number in _ENDING:
                handler = signal.getsignal(number)
                # Ignored signals stay ignored; handlers that are not Python's are unknown and stay.
                if handler not in {signal.SIG_IGN, None}:
                    before[number] = handler
                    signal.signal(number, hold)
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
    for number in arrived:
        signal.raise_signal(number)


def wait_until_released(timeout: float) -> None:
    """Wait until no thread holds back signals, and let none do so any more.

    Parameters
    ----------
    timeout : float
        After which it stops waiting. [s]
    """
    _holding.acquire(timeout=timeout)
