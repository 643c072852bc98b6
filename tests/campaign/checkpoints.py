"""Part 2: results with checkpoints of a killed run, each 64th byte damaged in turn, resumed."""

import random as random_module
import re
import sys
from collections import Counter

import h5py
from outcomes import Case, asked_to_end, save
from scenes import rigid, vertical, wagon

resume_budget = 5.0  # s
largest_file = 1_000_000  # bytes
scene = (wagon + vertical + rigid + '[irregularity]\nfile = "rough.csv"\n[integration]\nduration = DURATION\n'
         'time_step = 1e-3\n[output]\nevery = 10\nwheels = false\nbodies = ["*/car-body"]\n')
classes = ("same_bits", "rejected", "other_bits", "crash", "hang", "other_code", "silent", "file_not_named")


def histories(file, live=False):
    """What results hold, but for the run times and the parts that a resumed run lays out otherwise. Those of a killed
    run are open for HDF5 (`live`), which waits without end for damaged ones.
    """
    held = {}
    with h5py.File(file, **({"libver": "latest", "swmr": True} if live else {})) as results:
        records = int(results["records"][0])

        def take(group, place):  # by path, as readers do; h5py's visititems also asks for indices that none needs
            for name in group:
                item = group[name]
                if isinstance(item, h5py.Group):
                    take(item, f"{place}{name}/")
                elif name != "block_checksums" and place != "checkpoint/":
                    values = item[()]
                    held[place + name] = (values[:records] if "rows" in item.attrs else values).tobytes()

        take(results, "")
        held["complete"] = int(results["summary"].attrs["complete"])
    return held


def state_of(file):
    """'none', 'no checkpoint', 'checkpoint' or 'complete'."""
    if not file.exists():
        return "none"
    try:
        with h5py.File(file, libver="latest", swmr=True) as results:
            if int(results["summary"].attrs["complete"]):
                return "complete"
            slots = [results[f"checkpoint/{slot}"][()] for slot in "ab"]
            return "checkpoint" if any(slot.size for slot in slots) else "no checkpoint"
    except OSError:
        return "none"


def killed_halfway(base, launcher, order, file):
    """Bytes of the results of a run that was killed after its first checkpoint."""
    whole = launcher([base.vsi, "run", "long.toml", "-q", "-o", "whole.h5"], base.folder)
    if whole.code != 0:
        sys.exit(f"tests/campaign: {whole.err}")
    seconds = whole.seconds
    for attempt in range(400):
        file.unlink(missing_ok=True)
        outcome = launcher(order, base.folder, kill_after=seconds * (0.2 + 0.7 * (attempt % 20) / 20))
        if state_of(file) == "checkpoint":
            return file.read_bytes()
        if outcome.signal is None:  # ended before the kill: the machine was slower when `seconds` was measured
            seconds = min(seconds, outcome.seconds)
    sys.exit("tests/campaign: no run could be killed between its first checkpoint and its end")


def one(base, launcher, order, file, damaged, whole):
    file.write_bytes(damaged)
    outcome = launcher(order, base.folder, seconds=resume_budget)
    if outcome.out_of_time:
        return "hang", outcome
    if outcome.signal is not None:
        return "crash", outcome
    if outcome.code == 0:
        try:
            return ("same_bits" if histories(file) == whole else "other_bits"), outcome
        except (OSError, KeyError, ValueError, RuntimeError) as error:
            outcome.out += f"\nh5py: {error}"
            return "other_bits", outcome
    if outcome.code not in (1, 2):
        return "other_code", outcome
    if not outcome.err.strip():
        return "silent", outcome
    if "killed.h5" not in outcome.err or not re.search(r"killed\.h5.*\w", outcome.err):
        return "file_not_named", outcome
    return "rejected", outcome


def campaign(base, launcher, options, findings):
    """Counts by class, and the facts of the file."""
    random = random_module.Random(f"{options.seed}/checkpoints")
    (base.folder / "long.toml").write_text(scene.replace("DURATION", "5.0"))
    file = base.folder / "killed.h5"
    order = [base.vsi, "run", "long.toml", "--resume", "-q", "-o", "killed.h5"]
    content = killed_halfway(base, launcher, order, file)
    if len(content) > largest_file:
        sys.exit(f"tests/campaign: the results have {len(content)} bytes, more than {largest_file}")
    file.write_bytes(content)
    undamaged = launcher(order, base.folder)
    whole = histories(base.folder / "whole.h5")
    if undamaged.code != 0 or histories(file) != whole:
        sys.exit(f"tests/campaign: the undamaged run does not go on to the same bits: {undamaged.err}")
    counts, slowest = Counter(), 0.0
    places = range(0, len(content), options.every)
    for done, at in enumerate(places):
        damaged = bytearray(content)
        damaged[at] ^= random.randrange(1, 256)
        name, outcome = one(base, launcher, order, file, bytes(damaged), whole)
        counts[name] += 1
        slowest = max(slowest, outcome.seconds)
        if name not in ("same_bits", "rejected"):
            save(findings, at, name, Case("checkpoint", f"byte {at}", order, {"killed.h5": bytes(damaged)}), outcome)
        if asked_to_end():
            break
        if done % 500 == 0:
            print(f"checkpoints {done}/{len(places)} {dict(counts)}", file=sys.stderr, flush=True)
    rows = [("checkpoints", "damaged byte", "tried", sum(counts.values()))]
    rows += [("checkpoints", "damaged byte", name, counts[name]) for name in classes]
    return rows + [("checkpoints", "damaged byte", "slowest_s", f"{slowest:.2f}"),
                   ("checkpoints", "damaged byte", "file_bytes", len(content))]
