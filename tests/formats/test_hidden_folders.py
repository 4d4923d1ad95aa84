"""Hidden folders of several processes that write one file."""

import fcntl
import os

from skybake.formats.hidden_folders import lock_hidden_folder, name_hidden_folder
from skybake.formats.whole_files import remove_leftovers


def test_a_folder_that_came_back_while_it_was_taken_for_a_leftover_is_kept(tmp_path, monkeypatch):
    """One process removes it, its owner makes it anew, and a third then locks the old one."""
    target = tmp_path / "a.exr"
    folder = name_hidden_folder(target)
    folder.mkdir()
    lock = fcntl.flock

    def late(descriptor, operation):
        monkeypatch.setattr("fcntl.flock", lock)
        folder.rmdir()
        held.append(lock_hidden_folder(folder))
        lock(descriptor, operation)

    held = []
    monkeypatch.setattr("fcntl.flock", late)
    remove_leftovers(target)
    assert len(held) == 1
    assert folder.is_dir()
    os.close(held.pop())
    remove_leftovers(target)
    assert not folder.exists()
