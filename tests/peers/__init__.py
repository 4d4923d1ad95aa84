"""Other programs that light a scene with our files, run by ``python -m tests.peers``."""
