"""What became of a command: how it ended, what it said, and whether that is one of the answers that it may give."""

import json
import re
import shutil
import signal
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

time_budget = 60.0  # s
address_space = 4 * 2**30  # bytes; what a scene asks for beyond is rejected by a message
longest_text = 1 << 20

# An answer is one of the first three; all others are findings.
answers = ("done", "failed", "rejected")
findings = ("crash", "hang", "other_code", "silent", "file_not_named", "not_finite", "raw_bytes", "above_plan",
            "leftover")


_asked_to_end = []


def end_on_signals():
    """Ctrl-C and SIGTERM end a part after what it does at the time; what was done is recorded."""
    for name in (signal.SIGINT, signal.SIGTERM):
        signal.signal(name, lambda number, frame: _asked_to_end.append(number))


def asked_to_end():
    return bool(_asked_to_end)


@dataclass
class Outcome:
    code: int | None
    signal: int | None
    seconds: float
    peak_bytes: int
    out_of_time: bool
    out: str = ""
    err: str = ""


class Launcher:
    """Runs commands one after the other, in a slim process."""

    def __init__(self, folder: Path):
        self._texts = [folder / "launcher.out", folder / "launcher.err"]
        self._process = subprocess.Popen(
            [sys.executable, "-S", "-E", str(Path(__file__).with_name("launcher.py")), *map(str, self._texts),
             str(address_space)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
            start_new_session=True)

    def __call__(self, command, folder, seconds=time_budget, kill_after=None) -> Outcome:
        order = {"command": [str(word) for word in command], "folder": str(folder), "seconds": seconds,
                 "kill_after": kill_after}
        self._process.stdin.write(json.dumps(order) + "\n")
        self._process.stdin.flush()
        answer = self._process.stdout.readline()
        if not answer:
            sys.exit("tests/campaign: the launcher has ended")
        outcome = Outcome(**json.loads(answer))
        outcome.out, outcome.err = (text_of(file) for file in self._texts)
        return outcome

    def close(self):
        self._process.stdin.close()
        self._process.wait()


def text_of(file):
    with open(file, "rb") as stream:
        return stream.read(longest_text).decode("utf-8", "backslashreplace")


@dataclass
class Case:
    """One input: the changed files by name, the command over them, and what the command writes."""

    reader: str
    what: str  # the mutation, in words
    command: list
    files: dict = field(default_factory=dict)
    outputs: list = field(default_factory=list)
    named: list = field(default_factory=list)  # a rejection names one of these


file_name = re.compile(r"[\w-]\.(toml|csv|h5|mtx|inp|txt|pr[wr]|whl|ban|mas|sti|dof|matrix|mapping)\b")
place = re.compile(r":\d+|\b(line|row|column|entry|entries|point|points|byte|bytes|record|records|node|characters)\b"
                   r"|[a-z_]+[./][a-z_]+|\[\[?\w+|'|\"|: [\w -]+: |--\w+")


def names_place(message, names):
    """Whether a message says more than the file: a line, key, dataset or option."""
    for name in names:
        message = message.replace(name, "")
    return bool(place.search(message))


def verdict(outcome: Outcome, case: Case):
    """The class of an outcome without a look at what was written."""
    if outcome.out_of_time:
        return "hang"
    if outcome.signal is not None:
        return "crash"
    if outcome.code not in (0, 1, 2):
        return "other_code"
    if re.search(r"[\x00-\x08\x0b-\x1f\x7f]", outcome.err.replace("\r", "")):
        return "raw_bytes"
    if outcome.code == 0:
        said = re.sub(r'"(\\.|[^"\\])*"', '""', outcome.out)  # quoted texts are those of the input
        return "not_finite" if re.search(r"(?<![\w-])-?(nan|inf)(?![\w-])", said) else "done"
    if not outcome.err.strip():
        return "silent"
    if outcome.code == 1:
        return "failed"
    named = file_name.search(outcome.err) or any(name in outcome.err for name in case.named)
    return "rejected" if named else "file_not_named"


def not_finite(file: Path):
    """The first dataset of results, or cell of a CSV, that is not a finite number, or None."""
    if file.suffix == ".csv":
        for number, line in enumerate(file.read_text(errors="replace").splitlines()):
            if number and re.search(r"(?<![\w-])-?(nan|inf)(?![\w-])", line):
                return f"{file.name}:{number + 1}"
        return None
    if file.suffix != ".h5":
        return None
    import h5py
    import numpy
    found = []

    def visit(name, node):
        if isinstance(node, h5py.Dataset) and node.dtype.kind == "f" and not name.startswith("checkpoint"):
            if not numpy.isfinite(node[()]).all():
                found.append(name)

    with h5py.File(file) as results:
        results.visititems(visit)
    return found[0] if found else None


def save(folder: Path, number, name, case: Case, outcome: Outcome, note=""):
    """Input, command and answer of a finding, to be looked at and repeated."""
    folder = folder / f"{name}-{case.reader}-{number}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for file, content in case.files.items():
        (folder / file).write_bytes(content)
    (folder / "finding.json").write_text(json.dumps(
        {"number": number, "class": name, "reader": case.reader, "mutation": case.what, "note": note,
         "command": [str(word) for word in case.command], "code": outcome.code, "signal": outcome.signal,
         "seconds": outcome.seconds, "peak_bytes": outcome.peak_bytes, "stderr": outcome.err[-4000:],
         "stdout": outcome.out[-2000:]}, indent=1) + "\n")
