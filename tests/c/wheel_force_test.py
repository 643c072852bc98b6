#!/usr/bin/env python3
"""The example wheel_force against the C++ functions, to the last bit: wheel_force_test.py WHEEL_FORCE_CPP SOURCE..."""
import sys
import tempfile

from environment import TABLES, build, run

NUMBERS_OF_TWO_WHEELS = 2 * (6 + 3 + 81)


def numbers(text, read):
    """The numbers of all lines, in hexadecimal: those of two NaN or of 0 and -0 differ."""
    found = []
    for line in text.splitlines():
        for field in line.split():
            try:
                found.append(read(field).hex())
            except ValueError:
                pass  # a word
    return found


def main():
    cpp, *sources = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        example = build(folder, *sources)
        for table in ("s1002_60e1.h5", "loaded.h5"):
            # 17 significant digits name one double
            found = numbers(run(*example, TABLES / table), float)
            expected = numbers(run(cpp, TABLES / table), float.fromhex)
            if found != expected or len(found) < NUMBERS_OF_TWO_WHEELS + 2 * 7:
                print(f"{table}: {len(found)} numbers, {len(expected)} of C++")
                print(*(pair for pair in zip(found, expected) if pair[0] != pair[1]), sep="\n")
                return 1
            print(f"{table}: {len(found)} numbers are those of C++")
    return 0


if __name__ == "__main__":
    sys.exit(main())
