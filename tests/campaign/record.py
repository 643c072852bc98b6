"""The record of the campaign: docs/validation/campaign.csv, a row for each part, reader and class."""

import csv
import datetime
import os
import subprocess
from pathlib import Path

columns = ["part", "of", "class", "value", "seed", "date", "commit", "processor", "cores"]
head = ("# Made by tests/campaign/run. Classes that did not occur are listed under \"all\" only; file_only: rejected by a\n"
        "# message that names the file and no place in it.\n")


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return " ".join(line.partition(":")[2].replace(",", " ").split())
    return "unknown"


def commit_of(root):
    answer = subprocess.run(["git", "-C", root, "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    return answer.stdout.strip() or "unknown"


def write(file: Path, rows, seed, commit):
    """Rows (part, of, class, value) in place of those of their parts."""
    parts = {row[0] for row in rows}
    kept = []
    if file.exists():
        with file.open() as old:
            kept = [[row[name] for name in columns] for row in csv.DictReader(line for line in old if line[0] != "#")
                    if row["part"] not in parts]
    facts = [seed, datetime.date.today().isoformat(), commit, processor(), os.cpu_count()]
    order = ["inputs", "memory", "checkpoints", "kills"]
    merged = sorted([*kept, *([*row, *facts] for row in rows)], key=lambda row: order.index(row[0]))
    with file.open("w", newline="") as new:
        new.write(head)
        writer = csv.writer(new, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(merged)
