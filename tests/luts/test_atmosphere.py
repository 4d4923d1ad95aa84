"""Tables on disk."""

import errno
import time

import numpy as np
import pytest

from skybake.luts import atmosphere as store
from tests.media import plain_medium

MEDIUM = plain_medium(lambda h: np.exp(-h / 8.0), [0.01, 0.05])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "cache_directory", lambda: tmp_path)
    return tmp_path / "atmospheres"


def leaves(value):
    """All arrays of nested tuples."""
    if isinstance(value, tuple):
        return [leaf for part in value for leaf in leaves(part)]
    return [np.asarray(value)]


def assert_same(first, second):
    for a, b in zip(leaves(first), leaves(second), strict=True):
        np.testing.assert_array_equal(a, b)
        assert a.dtype == b.dtype


def test_stored_tables_are_the_built_ones_bit_by_bit(folder):
    assert not store.is_stored(MEDIUM, "hillaire")
    built = store.load_atmosphere(MEDIUM, "hillaire")
    assert store.is_stored(MEDIUM, "hillaire")
    assert_same(store.load_atmosphere(MEDIUM, "hillaire"), built)
    assert len(list(folder.iterdir())) == 1


def test_stored_tables_are_not_built_again(folder, monkeypatch):
    store.load_atmosphere(MEDIUM, "hillaire")
    monkeypatch.setattr(store, "build_atmosphere", None)
    store.load_atmosphere(MEDIUM, "hillaire")


# numpy does not close a file that it cannot read.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.filterwarnings("ignore::ResourceWarning")
@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 not a zip", None])
def test_a_damaged_file_is_made_anew(folder, damage):
    built = store.load_atmosphere(MEDIUM, "hillaire")
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2] if damage is None else damage)
    assert_same(store.load_atmosphere(MEDIUM, "hillaire"), built)
    assert path.stat().st_size == len(whole)


@pytest.mark.parametrize(
    "other",
    [
        MEDIUM._replace(ground_albedo=MEDIUM.ground_albedo + 0.1),
        MEDIUM._replace(density=MEDIUM.density * 1.01),
        MEDIUM._replace(r_bottom=MEDIUM.r_bottom - 1.0),
        MEDIUM._replace(scattering=MEDIUM.scattering * 0.9),
    ],
)
def test_another_medium_has_tables_of_its_own(folder, other):
    store.load_atmosphere(MEDIUM, "hillaire")
    assert not store.is_stored(other, "hillaire")
    assert not store.is_stored(MEDIUM, "full")


def test_a_full_disk_only_costs_the_reuse(folder, monkeypatch):
    def savez(path, **arrays):
        path.write_bytes(b"half")
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(np, "savez", savez)
    assert store.load_atmosphere(MEDIUM, "hillaire").columns.shape[2] == 1
    assert list(folder.iterdir()) == []


def test_the_tables_used_least_recently_go_first(folder, monkeypatch):
    others = [MEDIUM._replace(ground_albedo=np.full(2, 0.1 * i)) for i in range(3)]
    store.load_atmosphere(others[0], "hillaire")
    (path,) = folder.iterdir()
    monkeypatch.setattr(store, "LARGEST_STORE", int(2.5 * path.stat().st_size))
    store.load_atmosphere(others[1], "hillaire")
    time.sleep(0.05)  # file systems count in clock ticks
    store.load_atmosphere(others[0], "hillaire")
    time.sleep(0.05)
    store.load_atmosphere(others[2], "hillaire")
    assert [store.is_stored(medium, "hillaire") for medium in others] == [True, False, True]
