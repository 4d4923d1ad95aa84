import ast
import threading
from pathlib import Path

import numba
import numpy as np
import pytest

import skybake
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


def test_cache_of_other_users_of_numba_stays_where_it_was():
    before = numba.config.CACHE_DIR
    kernels.kernel(lambda x: x)
    assert before == numba.config.CACHE_DIR


def decorated_functions():
    """Functions of the package that are kernels: their nodes by the kind of kernel."""
    found = {"kernel": {}, "inner_kernel": {}, "shared_kernel": {}}
    for path in Path(skybake.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.FunctionDef):
                for decorator in node.decorator_list:
                    if isinstance(decorator, ast.Name) and decorator.id in found:
                        found[decorator.id][node.name] = node
    return found


def test_kernels_that_python_calls_are_called_by_no_kernel():
    """What is kept of them on disk cannot be linked to."""
    found = decorated_functions()
    assert min(map(len, found.values())) > 5
    alone = found["kernel"].keys() - found["shared_kernel"].keys()
    for name, node in (found["kernel"] | found["inner_kernel"]).items():
        calls = {
            one.func.id
            for one in ast.walk(node)
            if isinstance(one, ast.Call) and isinstance(one.func, ast.Name)
        }
        assert not calls & alone, name
