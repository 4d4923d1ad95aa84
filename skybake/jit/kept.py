"""The last few results of something expensive, each computed once for all threads."""

from __future__ import annotations

import os
import threading
import weakref
from collections import OrderedDict
from collections.abc import Callable, Hashable
from concurrent.futures import Future
from typing import Any, Generic, TypeVar

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")


class Kept(Generic[Key, Value]):
    """Results by key; the least recently used are dropped first.

    Parameters
    ----------
    most : int
        How many stay.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._results: OrderedDict[Key, Future[Value]] = OrderedDict()
        self._lock = threading.Lock()
        _all_kept.add(self)

    def get(self, key: Key, make: Callable[[], Value]) -> Value:
        """Return the result of a key, made now if it is not there.

        Several threads that need one key wait for the first of them. If that one fails or
        is cancelled, the next makes the result itself.
        """
        while True:
            with self._lock:
                kept = self._results.pop(key, None)
                pending = self._results[key] = kept or Future()
                self._forget_oldest()
            if kept is None:
                return self._make(key, make, pending)
            try:
                return kept.result()
            except Exception:  # noqa: BLE001 - its maker raises it
                self._forget(key, kept)

    def put(self, key: Key, value: Value) -> None:
        """Keep a result that was made elsewhere, unless there is one."""
        done: Future[Value] = Future()
        done.set_result(value)
        with self._lock:
            self._results.setdefault(key, done)
            self._forget_oldest()

    def has(self, key: Key) -> bool:
        """Whether a result is there or being made."""
        return key in self._results

    def clear(self) -> None:
        """Forget all results."""
        with self._lock:
            self._results.clear()

    def _make(self, key: Key, make: Callable[[], Value], pending: Future[Value]) -> Value:
        try:
            value = make()
        except BaseException as error:
            self._forget(key, pending)
            pending.set_exception(error)
            raise
        pending.set_result(value)
        return value

    def _forget(self, key: Key, result: Future[Value]) -> None:
        with self._lock:
            if self._results.get(key) is result:
                del self._results[key]

    def _forget_oldest(self) -> None:
        while len(self._results) > self._most:
            self._results.popitem(last=False)

    def _leave_to_parent(self) -> None:
        self._lock = threading.Lock()
        for key in [key for key, result in self._results.items() if not result.done()]:
            del self._results[key]


_all_kept: weakref.WeakSet[Kept[Any, Any]] = weakref.WeakSet()


def _leave_to_parent() -> None:
    """Let a forked process make itself what threads of its parent had begun to make."""
    for kept in _all_kept:
        kept._leave_to_parent()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_leave_to_parent)
