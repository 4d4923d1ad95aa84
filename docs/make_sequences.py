"""Makes the contact sheets of sequences.md: ``python docs/make_sequences.py``, in a minute.

Runs the document's own commands, with small maps: tiles have a size of their own.
"""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

DOCUMENT = Path(__file__).parent / "sequences.md"


def main() -> None:
    """Run each command that writes a contact sheet, and keep the sheet."""
    commands = re.findall(r"^skybake (.* --contact-sheet .*)$", DOCUMENT.read_text("utf-8"), re.M)
    with tempfile.TemporaryDirectory() as folder:
        for command in commands:
            words = [*shlex.split(command), "--size", "64x32", "--quiet"]
            subprocess.run([sys.executable, "-m", "skybake", *words], cwd=folder, check=True)
        for sheet in Path(folder).glob("*.png"):
            shutil.copy(sheet, DOCUMENT.parent / "images" / sheet.name)
            print(sheet.name)


if __name__ == "__main__":
    main()
