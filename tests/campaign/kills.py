"""Part 3: commands that write, killed at random times: what is left is whole, absent or can be resumed, and the command
repeated gives what it gives unkilled, without left-overs."""

import hashlib
import json
import os
import random as random_module
import re
import shutil
import sys
import time
from collections import Counter
from pathlib import Path

import h5py
from checkpoints import histories
from outcomes import Case, asked_to_end, save
from scenes import loaded_options

pair = ["--wheel", "cone-1:20", "--rail", "60E1", "--yaw", "0:0", "--tolerance", "1e-6", "--threads", "1", "-q"]
rigid_run = ('[train]\nvehicle = "wagon.toml"\nspeed = 30.0\n[contact]\nnormal = "rigid"\n[track]\nkind = "rigid"\n'
             '[irregularity]\nfile = "rough.csv"\n[integration]\nduration = DURATION\ntime_step = 1e-3\n[output]\n'
             'every = 5\n')

# Command, what it writes, and how long an unkilled one is to take at least (by its input).
commands = {
    "vsi run": (["vsi", "run", "long.toml", "--resume", "-q", "-o", "out.h5"], ["out.h5"]),
    "vsi run (contact)": (["vsi", "run", "contact.toml", "--resume", "-q", "-o", "out.h5"], ["out.h5"]),
    "vsi sweep": (["vsi", "sweep", "swept.toml", "--speed", "20:40:10", "--threads", "1", "-q", "-o", "out"], ["out"]),
    "vsi study": (["vsi", "study", "study.toml", "--threads", "1", "-q", "-o", "out"], ["out"]),
    "vsi export": (["vsi", "export", "long.h5", "-q", "-o", "out.pvd"], ["out.pvd"]),
    "vsi report": (["vsi", "report", "long.h5", "-q", "-o", "out.html"], ["out.html"]),
    "vsi assess": (["vsi", "assess", "assessed.toml", "--stage", "check", "--stage", "moving-load", "--speed-kmh",
                    "100", "--threads", "1", "-q", "-o", "out"], ["out"]),
    "vsi moving-load": (["vsi", "moving-load", "assessed.toml", "--speed", "20:60:1", "--threads", "1", "-q", "-o",
                         "out.csv"], ["out.csv"]),
    "vsi contact": (["vsi", "contact", "pair.h5", "--online", "--query", "many_poses.csv", "-q", "-o", "out.csv"],
                    ["out.csv"]),
    "vsi creep": (["vsi", "creep", "--law", "fastsim", "--query", "many_creepages.csv", "-q", "-o", "out.csv"],
                  ["out.csv"]),
    "vsi check": (["vsi", "check", "bridge.toml", "-q", "-o", "out.svg"], ["out.svg"]),
    "vsi new": (["vsi", "new", "out.toml"], ["out.toml"]),
    "tablegen geometry": (["tablegen", "geometry", *pair, "--lateral", "-0.002:0.002", "-o", "out.h5"], ["out.h5"]),
    "tablegen batch": (["tablegen", "batch", "killed_pairs.toml", "--threads", "1", "-q"], ["out1.h5", "out2.h5"]),
    "tablegen creep": (["tablegen", "creep", "--nodes", "5,6,6,6", "--elements", "10", "--threads", "1", "-q", "-o",
                        "out.h5"], ["out.h5"]),
    "tablegen merge": (["tablegen", "merge", "part1.h5", "part2.h5", "-q", "-o", "out.h5"], ["out.h5"]),
    "tablegen loaded": (["tablegen", "loaded", "out.h5", *loaded_options, "--threads", "1", "-q"], ["out.h5"]),
    "tablegen info": (["tablegen", "info", "pair.h5", "--html", "out.html", "-q"], ["out.html"]),
    "tablegen contact": (["tablegen", "contact", "--wheel", "cone-1:20", "--rail", "60E1", "--pose", "0.001,0,0",
                          "--load", "75000", "--elements", "30", "-q", "-o", "out.csv"], ["out.csv"]),
}
classes = ("whole", "absent", "resumable", "ended_before", "damaged", "other_bits", "leftover", "not_repeated")


def write_inputs(base):
    folder = base.folder
    (folder / "long.toml").write_text(rigid_run.replace("DURATION", "40.0"))
    (folder / "swept.toml").write_text(rigid_run.replace("DURATION", "15.0"))
    (folder / "study.toml").write_text('scene = "swept.toml"\n[[vary]]\nkey = "train.speed"\nvalues = [20, 30, 40]\n')
    (folder / "contact.toml").write_text(
        rigid_run.replace("DURATION", "4.0").replace('normal = "rigid"', 'mode = "online"\ncreep_law = "linear"'))
    (folder / "assessed.toml").write_text(
        '[train]\nvehicle = "manchester-coach"\nspeed_kmh = 100\n[contact]\nmode = "online"\n[[bridge]]\n'
        "length = 25.0\nmass = 15e3\nE = 30e9\nIy = 1.0\ndamping_ratio = 0.01\n")
    (folder / "killed_pairs.toml").write_text(
        '[defaults]\nrail = "60E1"\nwheel = "cone-1:20"\nyaw = [0, 0]\ntolerance = 1e-6\n[[pair]]\n'
        'lateral = [-0.001, 0.001]\noutput = "out1.h5"\n[[pair]]\nlateral = [-0.002, 0.0]\noutput = "out2.h5"\n')
    random = random_module.Random(1)
    (folder / "many_poses.csv").write_text("y,yaw,roll,dz\n" + "".join(
        f"{random.uniform(-4e-4, 4e-4)!r},0,0,{random.uniform(1e-5, 2e-4)!r}\n" for _ in range(3000)))
    (folder / "many_creepages.csv").write_text("ratio,ux,uy,phi\n" + "".join(
        f"{random.uniform(0.3, 3)!r},{random.uniform(-1, 1)!r},0.1,0.2\n" for _ in range(20000)))


def without_times(value):
    """JSON without what differs from run to run: seconds, dates, folders."""
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items()
                if not re.search("second|date|created|time_ns|version", key)}
    if isinstance(value, list):
        return [without_times(item) for item in value]
    return value


def content(file: Path):
    """What a file says, without dates and run times."""
    if file.suffix == ".h5":
        with open(file, "rb") as stream:
            growing = stream.read(4) == b"\x89HDF"
        if growing:
            try:
                return histories(file)
            except (OSError, RuntimeError):
                return histories(file, live=True)
        with h5py.File(file) as table:
            if "checksum" in table.attrs:
                return bytes(table.attrs["checksum"])
            numbers = []
            table.visititems(lambda name, item: numbers.append((name, item[()].tobytes()))
                             if isinstance(item, h5py.Dataset) else None)
            return sorted(numbers)
    if file.suffix == ".json":
        return json.dumps(without_times(json.loads(file.read_text())), sort_keys=True)
    text = file.read_text(errors="replace")
    if file.suffix == ".row" or file.name == "summary.csv":  # their column of run times
        return [row[:-4] for row in map(lambda line: line.split(","), text.splitlines())]
    text = re.sub(r"\d+(\.\d+)?(e-\d+)? ?(s|ms|µs|min)\b", "", text)
    return hashlib.sha256(re.sub(r"\d{4}-\d\d-\d\d[T ]?[\d:]*Z?", "", text).encode()).hexdigest()


def listing(folder, before):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*")
                  if path.is_file() and path.name not in before)


def contents(folder, before):
    return {name: content(folder / name) for name in listing(folder, before)}


class Killed:
    """One command of the list, in its folder."""

    def __init__(self, base, launcher, name, before):
        self.base, self.launcher, self.name, self.before = base, launcher, name, before
        program, *words = commands[name][0]
        self.order = [getattr(base, program), *words]
        self.clean()
        first = launcher(self.order, base.folder)
        if first.code != 0:
            sys.exit(f"tests/campaign: {name}: {first.err}")
        self.expected = contents(base.folder, before)
        self.seconds = first.seconds

    def clean(self):
        for entry in list(os.scandir(self.base.folder)):
            if entry.name not in self.before:
                shutil.rmtree(entry.path) if entry.is_dir() else os.unlink(entry.path)
        if self.name == "tablegen loaded":
            shutil.copy(self.base.folder / "pair.h5", self.base.folder / "out.h5")

    def state(self):
        """What a kill has left, before the command is repeated."""
        left = listing(self.base.folder, self.before)
        finished = 0
        for name in left:
            if name not in self.expected:
                continue
            try:
                found = content(self.base.folder / name)
            except (OSError, KeyError, ValueError, RuntimeError) as error:
                return "damaged", f"{name}: {error}"
            if found == self.expected[name]:
                finished += 1
            elif self.name == "tablegen loaded":
                if found != content(self.base.folder / "pair.h5"):
                    return "damaged", name
            elif not (isinstance(found, dict) and is_prefix(found, self.expected[name])):
                return "damaged", name
        if finished == len(self.expected):
            return "whole", ""
        return ("resumable" if left else "absent"), ""

    def after_repetition(self, state):
        again = self.launcher(self.order, self.base.folder)
        if self.name == "vsi new" and state == "whole" and again.code == 2:  # replaces no scene
            return "", ""
        if again.code != 0:
            return "not_repeated", again.err
        found = contents(self.base.folder, self.before)
        if sorted(found) != sorted(self.expected):
            return "leftover", str(sorted(set(found) ^ set(self.expected)))
        differing = [name for name in found if found[name] != self.expected[name]]
        return ("other_bits", str(differing)) if differing else ("", "")


def is_prefix(part, whole):
    """Whether the histories of a killed run are the first records of the whole ones."""
    return set(part) == set(whole) and not part["complete"] and all(
        whole[name].startswith(values) for name, values in part.items() if isinstance(values, bytes)
        and not name.startswith("records"))


def campaign(base, launcher, options, findings):
    write_inputs(base)
    launcher([base.vsi, "run", "long.toml", "-q", "-o", "long.h5"], base.folder)
    before = {entry.name for entry in os.scandir(base.folder)}
    random = random_module.Random(f"{options.seed}/kills")
    rows, total = [], Counter()
    names = list(commands)
    shares = [options.kills // len(names) + (i < options.kills % len(names)) for i in range(len(names))]
    for name, share in zip(names, shares):
        if share == 0 or asked_to_end():
            continue
        killed = Killed(base, launcher, name, before)
        counts = Counter(tried=0)
        for _ in range(4 * share):
            if asked_to_end() or counts["tried"] - counts["ended_before"] >= share:
                break
            killed.clean()
            after = random.uniform(0.0, 1.02) * killed.seconds
            outcome = launcher(killed.order, base.folder, kill_after=after)
            counts["tried"] += 1
            if outcome.signal is None:
                counts["ended_before"] += 1
                continue
            time.sleep(0.02)  # processes of a sweep end with it
            state, note = killed.state()
            counts[state] += 1
            fault, said = killed.after_repetition(state)
            counts.update([fault] if fault else [])
            for bad, text in ((state if state == "damaged" else "", note), (fault, said)):
                if bad:
                    save(findings, counts["tried"], bad, Case("kill", f"{name} after {after:.4f} s", killed.order),
                         outcome, text)
        killed.clean()
        counts["kills"] = counts["tried"] - counts["ended_before"]
        print(f"kills {name}: {killed.seconds:.2f} s {dict(counts)}", file=sys.stderr, flush=True)
        total += counts
        rows += [("kills", name, key, counts[key]) for key in ("kills", *classes) if counts[key]]
    return rows + [("kills", "all", key, total[key]) for key in ("kills", *classes)]
