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
HEADER_AND_LIBRARY = [
    f"-I{SOURCE}/c", f"-L{LIBRARY.parent}", f"-Wl,-rpath,{LIBRARY.parent}", "-lrailtab-contact", "-lm"]
COMPILERS = {
    ".c": ["cc", "-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-pedantic"],
    ".f90": ["gfortran", "-std=f2018", "-O2", "-Wall", "-Wextra", "-Werror"],
    ".m": ["mkoctfile", "--mex", "-Wall", "-Wextra", "-Werror"],
}
PACKAGES = {
    "cc": "gcc",
    "gfortran": "gfortran (tools/install_dependencies --fortran)",
    "mkoctfile": "octave-dev (tools/install_dependencies --octave)",
}
SKIPPED = 77


def require(compiler):
    """Ends the test as skipped where the compiler is missing."""
    if shutil.which(compiler) is None:
        print(f"skipped: no {compiler}; Debian's package is {PACKAGES[compiler]}")
        sys.exit(SKIPPED)


def build(folder, *sources):
    """The command that runs an example: files of docs/examples/contact, the last its main program, compiled against the
    header and the shared library with warnings as errors."""
    main = EXAMPLES / sources[-1]
    compiler = COMPILERS[main.suffix]
    require(compiler[0])
    compiled = [EXAMPLES / source for source in sources if not source.endswith(".m")]
    if main.suffix == ".m":
        program, command = Path(folder) / "railtab_mex.mex", ["octave-cli", "--norc", "--path", folder, main]
    else:
        program = Path(folder) / main.stem
        command = [program]
    subprocess.run([*compiler, *compiled, *HEADER_AND_LIBRARY, "-o", program], check=True, cwd=folder)
    return command


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout
