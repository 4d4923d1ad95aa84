"""What other users may read of the cache, and what they may write."""

import os
import re
import tempfile
from pathlib import Path

import pytest

import skybake
from tests.jit.cached_runs import LARGER, SCRIPT, check_that_nothing_is_kept, run

READ_AS_ANOTHER_USER = """
import os
from skybake.jit import cache
from skybake.jit.private_folder import open_private_folder
path = cache.cache_folder().path
cache.cache_folder().write("a.kernel", b"content")
before = path.parent.stat().st_mode & 0o777
cache.share_cache()
child = os.fork()
if child == 0:
    os.setgroups([])
    os.setgid(65534)
    os.setuid(65534)
    folder = open_private_folder(path)
    readable = folder.read("a.kernel") == b"content"
    try:
        folder.write("b.kernel", b"content")
    except OSError:
        os._exit(7 if readable else 1)
print(oct(before), os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


@pytest.mark.skipif(os.getuid() != 0, reason="only root can become another user")
def test_what_root_shares_is_read_but_not_written_by_others():
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o755)
        result = run(Path(folder) / "cache", script=READ_AS_ANOTHER_USER)
    assert (result.stdout, result.stderr) == ("0o700 7\n", "")


def test_nothing_that_a_process_leaves_can_be_read_by_others(tmp_path):
    run(tmp_path / "cache", script="import os; os.umask(0)" + LARGER + SCRIPT)
    for path in [tmp_path / "cache", *(tmp_path / "cache").rglob("*")]:
        assert path.stat().st_mode & 0o777 == (0o700 if path.is_dir() else 0o600), path


def test_no_module_of_ours_unpickles():
    package = Path(skybake.__file__).parent
    banned = re.compile(r"^\s*(import|from) (pickle|marshal|shelve|dill|cloudpickle)\b", re.M)
    found = [path for path in package.rglob("*.py") if banned.search(path.read_text())]
    assert found == []


def test_a_folder_that_others_may_write_to_is_not_used(tmp_path, filled):
    """Who can write there could have us run what they like."""
    filled.chmod(0o777)
    result = run(tmp_path)
    check_that_nothing_is_kept(result, "writable for its owner only")


def test_a_folder_is_private_whatever_the_umask(tmp_path):
    result = run(tmp_path, script="import os; os.umask(0)" + SCRIPT)
    assert Path(result.stdout.split()[0]).stat().st_mode & 0o022 == 0
