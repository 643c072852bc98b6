#!/usr/bin/env python3
"""Examples in docstrings are run, and everything public has a docstring."""
import doctest
import inspect
import os
import sys
import tempfile
from pathlib import Path

from environment import SCENE, TABLE

import numpy
import railtab


def objects():
    """Name and docstring of the package, its modules' functions and classes, and what the classes have."""
    yield "railtab", railtab.__doc__
    for name in railtab.__all__:
        item = getattr(railtab, name)
        yield name, item.__doc__
        if not inspect.isclass(item) or issubclass(item, Exception):
            continue
        for member, value in vars(item).items():
            if not member.startswith("_") and (callable(value) or isinstance(value, (property, staticmethod))):
                yield f"{name}.{member}", inspect.getdoc(getattr(item, member))


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        os.symlink(TABLE, "s1002_60e1.h5")
        Path("scene.toml").write_text(SCENE)
        railtab.run("scene.toml", "results.h5", changes={"integration.duration": 0.02})
        given = {"railtab": railtab, "np": numpy, "displacement": railtab.displacement, "scene_file": "scene.toml",
                 "table": railtab.GeometryTable.open(TABLE), "results_file": "results.h5"}
        runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
        bare = []
        for name, text in objects():
            if not text or not text.strip():
                bare.append(name)
                continue
            runner.run(doctest.DocTestParser().get_doctest(text, dict(given), name, None, 0))
        os.chdir("/")
    result = runner.summarize()
    print(f"{result.attempted} examples, {result.failed} failed; without a docstring: {bare}")
    return 0 if result.failed == 0 and result.attempted > 20 and not bare else 1


if __name__ == "__main__":
    sys.exit(main())
