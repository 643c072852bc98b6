#!/usr/bin/env python3
"""The shared library shows the functions of railtab/contact.h and nothing else, under the name of its interface."""
import re
import sys

from environment import LIBRARY, SOURCE, run


def main():
    header = (SOURCE / "c/railtab/contact.h").read_text()
    header = re.sub(r"/\*.*?\*/", "", header, flags=re.S)
    declared = set(re.findall(r"\b(railtab_\w+)\(", header))
    shown = {line.split()[-1] for line in run("nm", "-D", "--defined-only", LIBRARY).splitlines()}
    print(f"{len(declared)} functions declared; other symbols shown: {sorted(shown ^ declared)}")
    soname = re.search(r"SONAME.*\[(.*)\]", run("readelf", "-d", LIBRARY))[1]
    version = re.search(r"^project\(railtab VERSION (\d+\.\d+)\.", (SOURCE / "CMakeLists.txt").read_text(), re.M)[1]
    print(soname)
    return 0 if shown == declared and len(declared) > 5 and soname == f"librailtab-contact.so.{version}" else 1


if __name__ == "__main__":
    sys.exit(main())
