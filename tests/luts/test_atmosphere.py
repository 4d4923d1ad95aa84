"""Tables on disk."""

import io
import resource
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


def half(whole):
    return whole[: len(whole) // 2]


def with_another_bit(whole):
    """In the middle, which is within an array."""
    middle = len(whole) // 2
    return whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :]


def with_another_array(whole, name, change):
    """The digest stays."""
    source, target = io.BytesIO(whole), io.BytesIO()
    target.write(source.read(32))
    names = np.load(source)
    np.save(target, names)
    for key in names:
        array = np.load(source)
        np.save(target, change(array) if key == name else array)
    return target.getvalue()


def with_nan(whole):
    return with_another_array(whole, "radiance", lambda array: np.full_like(array, np.nan))


def with_another_shape(whole):
    return with_another_array(whole, "columns", lambda array: array[:, :-1])


DAMAGES = [
    lambda whole: b"",
    lambda whole: b"not tables",
    half,
    with_another_bit,
    with_nan,
    with_another_shape,
]


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_file_that_is_not_what_was_written_is_made_anew(folder, damage):
    built = store.load_atmosphere(MEDIUM, "hillaire")
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    path.write_bytes(damage(whole))
    assert_same(store.load_atmosphere(MEDIUM, "hillaire"), built)
    assert path.read_bytes() == whole


def test_a_file_in_place_of_the_folder_only_costs_the_reuse(folder):
    folder.write_text("not a folder")
    first, second = (store.load_atmosphere(MEDIUM, "hillaire") for _ in range(2))
    assert_same(first, second)
    assert not store.is_stored(MEDIUM, "hillaire")
    assert folder.read_text() == "not a folder"


def test_a_folder_in_place_of_a_file_only_costs_the_reuse(folder):
    built = store.load_atmosphere(MEDIUM, "hillaire")
    (path,) = folder.iterdir()
    path.unlink()
    path.mkdir()
    assert_same(store.load_atmosphere(MEDIUM, "hillaire"), built)
    assert list(folder.iterdir()) == [path]


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


def test_a_full_disk_only_costs_the_reuse(folder):
    """Files beyond a limit cannot grow, as on a full disk."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (5000, limits[1]))
    try:
        built = store.load_atmosphere(MEDIUM, "hillaire")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert list(folder.iterdir()) == []
    assert_same(store.load_atmosphere(MEDIUM, "hillaire"), built)


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
