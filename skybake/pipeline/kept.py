"""The last few results of a stage, each made once however many threads ask for it."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable
from concurrent.futures import Future
from typing import Generic, TypeVar

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")


class Kept(Generic[Key, Value]):
    """Results by key; those that were not asked for longest go first.

    Parameters
    ----------
    most : int
        How many stay.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._results: OrderedDict[Key, Future[Value]] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, key: Key, make: Callable[[], Value]) -> Value:
        """Return the result of a key, made now if it is not there.

        Several threads that ask for one key wait for the first of them. If that one fails or
        is cancelled, the next makes the result itself.
        """
        while True:
            with self._lock:
                kept = self._results.pop(key, None)
                pending = self._results[key] = kept or Future()
                while len(self._results) > self._most:
                    self._results.popitem(last=False)
            if kept is None:
                return self._make(key, make, pending)
            try:
                return kept.result()
            except Exception:  # noqa: BLE001 - its maker raises it
                # Whoever made it was stopped, or will report the fault to its own caller.
                with self._lock:
                    if self._results.get(key) is kept:
                        del self._results[key]

    def clear(self) -> None:
        """Forget all results."""
        with self._lock:
            self._results.clear()

    def _make(self, key: Key, make: Callable[[], Value], pending: Future[Value]) -> Value:
        try:
            value = make()
        except BaseException as error:
            with self._lock:
                if self._results.get(key) is pending:
                    del self._results[key]
            pending.set_exception(error)
            raise
        pending.set_result(value)
        return value
