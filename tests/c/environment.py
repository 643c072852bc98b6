"""What the tests of the examples share: the library, the tables and the compilers."""
import os
import shutil
import subprocess
import sys
from pathlib import Path

SOURCE = Path(os.environ["RAILTAB_SOURCE_DIR"])
LIBRARY = Path(os.environ["RAILTAB_C_LIBRARY"])
TABLES = Path(os.environ["RAILTAB_TABLES"])
EXAMPLES = SOURCE / "docs/examples/contact"
WARNINGS = ["-O2", "-Wall", "-Wextra", "-Werror", "-pedantic"]
COMPILERS = {".c": ["cc", "-std=c99"], ".f90": ["gfortran", "-std=f2018"]}
PACKAGES = {"cc": "gcc", "gfortran": "gfortran (tools/install_dependencies --fortran)"}
SKIPPED = 77


def require(compiler):
    """Ends the test as skipped where the compiler is missing."""
    if shutil.which(compiler) is None:
        print(f"skipped: no {compiler}; Debian's package is {PACKAGES[compiler]}")
        sys.exit(SKIPPED)


def build(program, *sources):
    """Compiles files of docs/examples/contact against the header and the shared library, with warnings as errors."""
    compiler = COMPILERS[Path(sources[0]).suffix]
    require(compiler[0])
    subprocess.run(
        [*compiler, *WARNINGS, *(EXAMPLES / source for source in sources), "-I", SOURCE / "c", "-L", LIBRARY.parent,
         f"-Wl,-rpath,{LIBRARY.parent}", "-lrailtab-contact", "-lm", "-o", program],
        check=True, cwd=Path(program).parent)


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout
