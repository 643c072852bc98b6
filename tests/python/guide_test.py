#!/usr/bin/env python3
"""Every Python block of docs/guide/python.md runs as written, one after another, in a folder with the guide's files."""
import os
import re
import shutil
import sys
import tempfile
from pathlib import Path

from environment import SOURCE, TABLE


def main():
    page = (SOURCE / "docs/guide/python.md").read_text()
    blocks = re.findall(r"^```python\n(.*?)^```", page, flags=re.M | re.S)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        shutil.copytree(SOURCE / "docs/examples", "docs/examples")
        Path("out/demo").mkdir(parents=True)
        os.symlink(TABLE, "out/demo/S1002-60E1-40.h5")
        names = {}
        for number, block in enumerate(blocks):
            print(f"block {number + 1}")
            exec(compile(block, f"block {number + 1} of python.md", "exec"), names)
        os.chdir("/")
    return 0 if len(blocks) >= 5 else 1


if __name__ == "__main__":
    sys.exit(main())
