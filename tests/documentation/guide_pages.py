"""Commands of the pages of docs/guide: blocks without a language, of sh or of Python, by page and section."""
import re
from pathlib import Path

# Pages whose commands others run, timed as a whole: tests/python and tests/c; of the packages, tests/packages/run.
OWN_TESTS = ("python", "c")
OWN_RECORD = ("install",)

# What a page shows and no run repeats, by the beginning of a line, and why.
LEFT_OUT = {
    "tools/install_dependencies": "Debian's packages",
    "sudo ": "Debian's packages",
    "cp -r /usr/share/doc": "Debian's packages",
    "/usr/libexec": "Debian's packages",
    "cmake ": "the build",
    "export ": "the build",
    "find_package": "the build",
    "target_link_libraries": "the build",
    "tools/package": "Debian's packages, recorded by tests/packages/run",
    "tests/packages/run": "Debian's packages, recorded by itself",
    "SBATCH_OPTIONS": "a cluster",
    "tools/slurm": "a cluster",
    "tablegen batch": "as tablegen geometry, for each pair",
    "tablegen creep": "an hour",
    "tablegen merge": "needs tables of an hour",
    "tablegen verify creep.h5": "needs a table of an hour",
    "tablegen loaded": "a quarter of an hour",
    "vsi sweep": "250 runs",
    "vsi critical-speed scene.toml --limit-cycles": "long without a table",
}
# Commands that may end with another exit code than 0, which their page explains.
EXIT_CODES = {"vsi assess": 3, "vsi study docs": 1}
# What the tests leave to the record of times (tools/quoted_runs guide).
SLOW = ("tablegen geometry", "tablegen verify", "tablegen conicity --wheel wheel.txt", "SLICES=",
        "vsi structure out/bridge", "vsi assess docs/examples/hslm_beam.toml\n", "vsi study speeds.toml -o",
        "vsi study docs", "vsi critical-speed", "vsi vehicle manchester-coach --table",
        "vsi run docs/examples/wind.toml", "vsi run docs/examples/earthquake.toml")


def slug(heading):
    """The heading as part of a recorded name."""
    return re.sub(r"[^a-z0-9]+", "_", heading.lower()).strip("_")


def commands(block):
    """The lines of a block, continued ones joined; what no run repeats is left out."""
    lines = re.sub(r"\\\n\s*", "", block).splitlines()
    return [line for line in lines if line.strip() and not line.startswith(tuple(LEFT_OUT))]


def blocks(page: Path):
    """Section (of the first heading: ""), language and text of each block, in order."""
    section, first = "", True
    for found in re.finditer(r"^#+ ([^\n]*)$|^```(\w*)\n(.*?)^```", page.read_text(), re.M | re.S):
        if found[1] is None:
            yield section, found[2], found[3]
        else:
            section, first = "" if first else slug(found[1]), False


def sections_with_commands(page: Path):
    """Sections whose time is recorded."""
    return sorted({section for section, language, text in blocks(page)
                   if language == "python" or language in ("", "sh") and commands(text)})
