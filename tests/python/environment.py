"""What the tests of the Python module share. Ends with 77 (skipped) where h5py or NumPy is missing."""
import csv
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import h5py  # noqa: F401
    import numpy
except ImportError as missing:
    print(f"skipped: {missing} (Debian: python3-numpy, python3-h5py)")
    sys.exit(77)

TABLES = Path(os.environ["RAILTAB_TABLES"])
TABLE = TABLES / "s1002_60e1.h5"
LOADED_TABLE = TABLES / "loaded.h5"
SOURCE = Path(os.environ["RAILTAB_SOURCE_DIR"])

# A coach on a bridge, with the table beside it.
SCENE = """name = "a coach on a bridge, Brücke"
[train]
vehicle = "manchester-coach"
speed_kmh = 200
start = 2.0
[contact]
table = "s1002_60e1.h5"
[track]
length_before = 30
length_after = 10
[[bridge]]
length = 10
Iy = 1.0
[integration]
duration = 0.1
time_step = 1e-3
"""
# Two wheelsets that hunt on rigid rails: made in no time.
RIGID_SCENE = """[train]
vehicle = "manchester-coach"
speed_kmh = 200
initial_lateral_shift = 0.002
[contact]
mode = "table"
table = "s1002_60e1.h5"
[track]
kind = "rigid"
[integration]
duration = 0.2
time_step = 1e-3
"""


def vsi(*arguments, code=0):
    """Runs the command in the current folder."""
    done = subprocess.run([os.environ["VSI"], *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != code:
        raise AssertionError(f"vsi {arguments}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def columns(file):
    """A CSV as columns; numbers to the last bit, since the command writes them so."""
    with open(file, newline="") as text:
        rows = list(csv.reader(text))
    return {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])}


def numbers(column):
    return numpy.array([float(field) for field in column])


class FolderTest(unittest.TestCase):
    """In a folder of its own, with the scenes and a table."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder.name)
        os.symlink(TABLE, "s1002_60e1.h5")
        os.symlink(LOADED_TABLE, "loaded.h5")
        Path("scene.toml").write_text(SCENE)
        Path("rigid.toml").write_text(RIGID_SCENE)
