#!/usr/bin/env python3
"""Every block of docs/guide/c.md runs as written, in a folder with the guide's table and the examples: the first in C is
a program, the others in C stand before its railtab_contact_close. Blocks of a compiler that is missing are skipped, and
with them the test, after the others have run."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from environment import EXAMPLES, LIBRARY, PACKAGES, SKIPPED, SOURCE, TABLES


def prefix(folder):
    """A folder like that of an installation."""
    (folder / "include").mkdir(parents=True)
    (folder / "include/railtab").symlink_to(SOURCE / "c/railtab")
    (folder / "lib").symlink_to(LIBRARY.parent)
    return folder


def main():
    page = (SOURCE / "docs/guide/c.md").read_text()
    first, *others = re.findall(r"^```c\n(.*?)^```", page, flags=re.M | re.S)
    commands = re.findall(r"^```sh\n(.*?)^```", page, flags=re.M | re.S)
    end = first.index("  railtab_contact_close")
    missing = set()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "first.c").write_text(first[:end] + "".join(others) + first[end:])
        for example in EXAMPLES.iterdir():
            shutil.copy(example, folder)
        (folder / "out/demo").mkdir(parents=True)
        (folder / "out/demo/S1002-60E1-40.h5").symlink_to(TABLES / "s1002_60e1.h5")
        environment = {**os.environ, "PREFIX": str(prefix(folder / "prefix"))}
        for block in commands:
            compiler = block.split()[0]
            if shutil.which(compiler) is None:
                missing.add(compiler)
                continue
            done = subprocess.run(["sh", "-e", "-c", block], cwd=folder, env=environment, capture_output=True, text=True)
            print(block, done.stdout[:1000], done.stderr, sep="\n")
            # every program of the page prints numbers
            if done.returncode or not re.search(r"\d", done.stdout):
                return 1
    for compiler in missing:
        print(f"skipped: blocks of {compiler}; Debian's package is {PACKAGES[compiler]}")
    if missing:
        return SKIPPED
    return 0 if len(others) >= 2 and len(commands) >= 3 else 1


if __name__ == "__main__":
    sys.exit(main())
