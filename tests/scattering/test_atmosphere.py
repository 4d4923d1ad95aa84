"""Tables on disk."""

import resource
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from skybake.jit import tables
from skybake.jit.digest import add_digest
from skybake.jit.private_folder import open_private_folder
from skybake.jit.tables import arrays_from_content, content_from_arrays
from skybake.scattering import atmosphere
from skybake.scattering.atmosphere import (
    KEPT,
    atmosphere_key,
    build_atmosphere,
    forget_atmospheres,
    is_stored,
)
from tests.media import plain_medium
from tests.skies import truth_atmosphere

MEDIUM = plain_medium(lambda h: np.exp(-h / 8.0), [0.01, 0.05])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    private = open_private_folder(tmp_path)
    monkeypatch.setattr(tables, "cache_folder", lambda: private)
    return tmp_path / "atmospheres"


def load(medium):
    """As a process does that has not loaded any before."""
    forget_atmospheres()
    return atmosphere.load_atmosphere(medium, "hillaire")


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
    assert not is_stored(MEDIUM, "hillaire")
    built = load(MEDIUM)
    assert is_stored(MEDIUM, "hillaire")
    assert_same(load(MEDIUM), built)
    assert len(list(folder.iterdir())) == 1


def test_stored_tables_of_all_orders_are_not_built_again_where_air_has_no_matrices(monkeypatch):
    assert len(truth_atmosphere("EARTH_A").medium.matrix) == 0
    forget_atmospheres()
    monkeypatch.setattr(atmosphere, "build_atmosphere", None)
    truth_atmosphere("EARTH_A")


def test_stored_tables_are_not_built_again(folder, monkeypatch):
    load(MEDIUM)
    monkeypatch.setattr(atmosphere, "build_atmosphere", None)
    load(MEDIUM)


def test_tables_in_memory_are_not_read_again(folder):
    kept = load(MEDIUM)
    (path,) = folder.iterdir()
    path.write_bytes(b"")
    assert atmosphere.load_atmosphere(MEDIUM, "hillaire") is kept


def test_of_many_atmospheres_the_last_stay_in_memory(folder):
    others = [MEDIUM._replace(ground_albedo=np.full(2, 0.1 * i)) for i in range(KEPT + 1)]
    kept = [load(others[0])]
    kept += [atmosphere.load_atmosphere(medium, "hillaire") for medium in others[1:]]
    again = [atmosphere.load_atmosphere(medium, "hillaire") for medium in reversed(others)]
    assert [a is b for a, b in zip(again, reversed(kept), strict=True)] == [True] * KEPT + [False]


def test_threads_that_need_the_same_tables_build_them_once(folder, monkeypatch):
    built = []

    def build(*arguments):
        built.append(arguments)
        time.sleep(0.2)
        return build_atmosphere(*arguments)

    monkeypatch.setattr(atmosphere, "build_atmosphere", build)
    forget_atmospheres()
    with ThreadPoolExecutor(4) as threads:
        found = list(
            threads.map(lambda _: atmosphere.load_atmosphere(MEDIUM, "hillaire"), range(4))
        )
    assert len(built) == 1
    assert all(one is found[0] for one in found)


def test_a_build_that_fails_is_tried_again(folder, monkeypatch):
    def fail(*_):
        raise MemoryError

    forget_atmospheres()
    with monkeypatch.context() as broken:
        broken.setattr(atmosphere, "build_atmosphere", fail)
        with pytest.raises(MemoryError):
            atmosphere.load_atmosphere(MEDIUM, "hillaire")
    assert atmosphere.load_atmosphere(MEDIUM, "hillaire").shells.size > 1


def half(whole):
    return whole[: len(whole) // 2]


def with_another_bit(whole):
    """In the middle, which is within an array."""
    middle = len(whole) // 2
    return whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :]


KEY = atmosphere_key(MEDIUM, "hillaire")


def with_another_array(whole, name, change, key=KEY):
    arrays = arrays_from_content(KEY, whole)
    return content_from_arrays(key, arrays | {name: change(arrays[name])})


def with_nan(whole):
    """The digest stays."""
    other = with_another_array(whole, "radiance", lambda array: np.full_like(array, np.nan))
    return whole[:32] + other[32:]


def with_its_own_digest(name, change):
    return lambda whole: with_another_array(whole, name, change)


def of_another_name(whole):
    return with_another_array(whole, "columns", np.copy, key="0" * 32)


def without_an_array(whole):
    arrays = arrays_from_content(KEY, whole)
    del arrays["ground"]
    return content_from_arrays(KEY, arrays)


def with_another_head(whole):
    return add_digest(b"\0" * 8 + b"not JSON", f"tables {KEY}")


DAMAGES = [
    lambda whole: b"",
    lambda whole: b"not tables",
    half,
    with_another_bit,
    with_nan,
    of_another_name,
    without_an_array,
    with_another_head,
    with_its_own_digest("columns", lambda array: array[:, :-1]),
    with_its_own_digest("columns", lambda array: array[..., :0]),
    with_its_own_digest("radiance", lambda array: array[:-1]),
    with_its_own_digest("radiance", lambda array: array.astype(np.float64)),
    with_its_own_digest("ground", lambda array: array[:2]),
    with_its_own_digest("sun_angle", lambda array: array[:, None]),
    with_its_own_digest("order", lambda array: array + 1),
    with_its_own_digest("delta_m_peaked", lambda _: np.array([7])),
    with_its_own_digest("basis_weights", lambda array: array[..., :-1]),
    with_its_own_digest("shells", lambda array: array[:1]),
]


@pytest.fixture(scope="module")
def built_once():
    return build_atmosphere(MEDIUM, "hillaire")


@pytest.fixture
def built(built_once, folder, monkeypatch):
    """What building the atmosphere returns, which is on disk."""
    monkeypatch.setattr(atmosphere, "build_atmosphere", lambda *_: built_once)
    load(MEDIUM)
    return built_once


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_file_that_is_not_what_was_written_is_made_anew(folder, built, damage):
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    path.write_bytes(damage(whole))
    assert load(MEDIUM) is built
    assert path.read_bytes() == whole


@pytest.mark.parametrize("damage", DAMAGES)
def test_tables_from_another_machine_that_do_not_fit_are_made_anew(folder, built, damage):
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    path.unlink()
    for content, is_anew in ((whole, False), (damage(whole), True)):
        forget_atmospheres()
        atmosphere.adopt_atmosphere(MEDIUM, "hillaire", content)
        found = atmosphere.load_atmosphere(MEDIUM, "hillaire")
        assert_same(found, built)
        assert (found is built) == is_anew
        assert len(list(folder.iterdir())) == is_anew


def test_a_file_in_place_of_the_folder_only_costs_the_reuse(folder):
    folder.write_text("not a folder")
    first, second = (load(MEDIUM) for _ in range(2))
    assert_same(first, second)
    assert not is_stored(MEDIUM, "hillaire")
    assert folder.read_text() == "not a folder"


def test_a_folder_in_place_of_a_file_only_costs_the_reuse(folder):
    built = load(MEDIUM)
    (path,) = folder.iterdir()
    path.unlink()
    path.mkdir()
    assert_same(load(MEDIUM), built)
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
    load(MEDIUM)
    assert not is_stored(other, "hillaire")
    assert not is_stored(MEDIUM, "full")


def test_a_full_disk_only_costs_the_reuse(folder):
    """Files beyond a limit cannot grow, as on a full disk."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (5000, limits[1]))
    try:
        built = load(MEDIUM)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert list(folder.iterdir()) == []
    assert_same(load(MEDIUM), built)


def test_the_tables_used_least_recently_go_first(folder, monkeypatch):
    others = [MEDIUM._replace(ground_albedo=np.full(2, 0.1 * i)) for i in range(3)]
    load(others[0])
    (path,) = folder.iterdir()
    monkeypatch.setattr(tables, "LARGEST_STORE", int(2.5 * path.stat().st_size))
    load(others[1])
    time.sleep(0.05)  # file systems count in clock ticks
    load(others[0])
    time.sleep(0.05)
    load(others[2])
    assert [is_stored(medium, "hillaire") for medium in others] == [True, False, True]
