import subprocess
import sys
import threading

import numba
import numpy as np
import pytest

from skybake.transport import kernel as kernels
from skybake.transport.kernel import run_rows, thread_count


@pytest.mark.parametrize("chunk", [1, 3, 7, 100])
@pytest.mark.parametrize("rows", [0, 1, 10, 64])
def test_every_row_is_worked_on_once(rows, chunk):
    visits = np.zeros(rows, int)

    def work(first, last):
        visits[first:last] += 1

    run_rows(rows, work, chunk=chunk)
    assert (visits == 1).all()


def test_work_that_fails_tells_its_caller():
    def work(first, last):
        if first == 3:
            raise ArithmeticError("row 3")

    with pytest.raises(ArithmeticError, match="row 3"):
        run_rows(8, work)


def test_rows_within_rows_do_not_wait_for_themselves():
    done = []

    def outer(first, last):
        run_rows(4, lambda a, b: done.append((first, a)))

    worker = threading.Thread(target=run_rows, args=(2 * thread_count() + 2, outer), daemon=True)
    worker.start()
    worker.join(timeout=20.0)
    assert not worker.is_alive()
    assert len(set(done)) == 4 * (2 * thread_count() + 2)


SCRIPT = """
import sys
from skybake.transport.kernel import cache_directory, is_warm
import numpy as np
from skybake.luts.harmonics import build_harmonics, fill_harmonics
before = is_warm()
fill_harmonics(build_harmonics(2), 0.5, np.empty(6))
print(cache_directory(), before, is_warm(), sum(fill_harmonics.stats.cache_hits.values()))
"""


def run(cache, **environment):
    return subprocess.run(
        [sys.executable, "-W", "always", "-c", SCRIPT],
        env={"SKYBAKE_CACHE_DIR": str(cache), "PYTHONPATH": ":".join(sys.path), **environment},
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )


def test_second_process_finds_what_the_first_compiled(tmp_path):
    first, second = (run(tmp_path).stdout.split() for _ in range(2))
    assert first[1:3] == ["False", "True"]
    assert second[1:] == ["True", "True", "1"]
    assert first[0] == second[0]
    assert first[0].startswith(str(tmp_path))


def test_without_a_writable_folder_kernels_run_with_one_warning(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    result = run(blocked / "cache")
    assert result.stdout.split() == ["None", "False", "False", "0"]
    assert result.stderr.count("RuntimeWarning") == 1
    assert "kernel cache must be writable" in result.stderr


def test_cache_of_other_users_of_numba_stays_where_it_was():
    before = numba.config.CACHE_DIR
    kernels.kernel(lambda x: x)
    assert before == numba.config.CACHE_DIR


def test_edit_to_any_kernel_source_changes_the_folder(tmp_path, monkeypatch):
    folder = tmp_path / "skybake" / "transport"
    folder.mkdir(parents=True)
    (folder / "kernel.py").write_text("a = 1\n")
    monkeypatch.setattr(kernels, "__file__", str(folder / "kernel.py"))
    first = kernels._source_hash.__wrapped__()
    (folder / "kernel.py").write_text("a = 2\n")
    assert kernels._source_hash.__wrapped__() != first
