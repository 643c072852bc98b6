#!/usr/bin/env python3
"""Drives an FMU with what a run recorded at every step and compares the motions of the rails.

    compare_run.py TRACK.fmu RECORD

RECORD has the FMU's variables by name in its first line, separated by blanks, then a row of doubles for each step.
Prints, for each kind of output, the largest difference relative to the run's largest amount.
"""
import sys
from array import array
from collections import defaultdict

from importer import Fmu, Slave


def read(file):
    with open(file, "rb") as stream:
        names = stream.readline().decode().split()
        numbers = array("d", stream.read())
    assert len(numbers) % len(names) == 0
    return names, [numbers[i:i + len(names)] for i in range(0, len(numbers), len(names))]


def main():
    fmu = Fmu(sys.argv[1])
    names, rows = read(sys.argv[2])
    assert sorted(names) == sorted(fmu.inputs + fmu.outputs)
    inputs = [names.index(name) for name in fmu.inputs]
    outputs = [names.index(name) for name in fmu.outputs]
    slave = Slave(fmu)
    difference, amount = defaultdict(float), defaultdict(float)
    for number, row in enumerate(rows):
        values = [row[i] for i in inputs]
        if number == 0:
            slave.initialize(fmu.inputs, values)
        else:
            slave.set(fmu.inputs, values)
            slave.step()
        for name, value, place in zip(fmu.outputs, slave.get(fmu.outputs), outputs):
            kind = name.split(".")[-1]
            difference[kind] = max(difference[kind], abs(value - row[place]))
            amount[kind] = max(amount[kind], abs(row[place]))
    for kind in difference:
        print(kind, difference[kind] / amount[kind], amount[kind])
    return 0


if __name__ == "__main__":
    sys.exit(main())
