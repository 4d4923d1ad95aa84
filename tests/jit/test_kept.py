import threading

import pytest

from skybake.jit.kept import Kept


def test_a_result_is_made_once_for_all_threads_that_ask():
    kept, made, got = Kept(4), [], []
    gate = threading.Barrier(5)

    def make():
        made.append(threading.get_ident())
        return object()

    def ask():
        gate.wait()
        got.append(kept.get("key", make))

    threads = [threading.Thread(target=ask) for _ in range(5)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(made) == 1
    assert len(set(map(id, got))) == 1


def test_what_was_not_asked_for_longest_is_forgotten():
    kept, made = Kept(2), []

    def ask(key):
        return kept.get(key, lambda: made.append(key))

    for key in "ab", "a", "ab", "c", "ab", "a":
        ask(key)
    assert made == ["ab", "a", "c", "a"]


def test_a_failure_is_its_makers_and_the_next_makes_the_result_itself():
    kept = Kept(2)
    begun, go_on = threading.Event(), threading.Event()
    failures, results = [], []

    def fail():
        begun.set()
        go_on.wait()
        raise ArithmeticError

    def first():
        with pytest.raises(ArithmeticError):
            kept.get("key", fail)
        failures.append(True)

    def second():
        begun.wait()
        go_on.set()
        results.append(kept.get("key", lambda: 7))

    threads = [threading.Thread(target=each) for each in (first, second)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (failures, results) == ([True], [7])


def test_what_was_put_is_there_and_does_not_replace_a_result():
    kept = Kept(2)
    kept.put("key", 1)
    kept.put("key", 2)
    assert kept.has("key")
    assert kept.get("key", lambda: 3) == 1
    kept.clear()
    assert not kept.has("key")
