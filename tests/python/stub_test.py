#!/usr/bin/env python3
"""The stub of the compiled part says what is there: names, arguments in their order, defaults."""
import ast
import re
import sys
from pathlib import Path

import environment  # noqa: F401

import railtab
from railtab import _railtab


def arguments_of_stub(node):
    plain, defaults = node.args.args, node.args.defaults
    values = [None] * (len(plain) - len(defaults)) + list(defaults)
    pairs = list(zip(plain, values)) + list(zip(node.args.kwonlyargs, node.args.kw_defaults))
    return [(arg.arg, None if value is None else ast.literal_eval(value)) for arg, value in pairs if arg.arg != "self"]


def arguments_of_docstring(text):
    """Names and defaults of pybind11's first line: "f(self: X, y: array, roll: array = array(0.)) -> array"."""
    inside = text.split("\n")[0].split("(", 1)[1].rsplit(") ->", 1)[0]
    depth, parts = 0, [""]
    for letter in inside:
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    found = []
    for part in parts:
        name = part.strip().split(":")[0].strip()
        if name in ("", "*", "self") or name.startswith("self"):
            continue
        default = part.rsplit("= ", 1)[1].strip() if "= " in part else None
        found.append((name, default))
    return found


def same_default(stub, written):
    if stub is None:
        return written in (None, "None")
    if isinstance(stub, bool) or written is None:
        return str(stub) == written
    number = re.search(r"-?[\d.]+(e[+-]?\d+)?", written)
    if isinstance(stub, (int, float)):
        return abs(float(number[0]) - stub) <= 1e-12 * abs(stub)
    return repr(stub) == written


def public(names):
    return {name for name in names if not name.startswith("_")}


def main():
    stub = ast.parse((Path(railtab.__file__).parent / "_railtab.pyi").read_text())
    assert (Path(railtab.__file__).parent / "py.typed").exists()
    wrong, checked = [], 0

    def compare(name, node, item):
        nonlocal checked
        checked += 1
        expected, found = arguments_of_stub(node), arguments_of_docstring(item.__doc__)
        if [a for a, _ in expected] != [a for a, _ in found]:
            wrong.append(f"{name}: {expected} in the stub, {found} in the module")
        wrong.extend(f"{name}: {a} = {d} in the stub, {w} in the module"
                     for (a, d), (_, w) in zip(expected, found) if not same_default(d, w))

    named = {node.name: node for node in stub.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    if public(named) != public(vars(_railtab)):
        wrong.append(f"names: {public(named) ^ public(vars(_railtab))} in one alone")
    for name, node in named.items():
        item = getattr(_railtab, name, None)
        if item is None:
            continue
        if isinstance(node, ast.FunctionDef):
            compare(name, node, item)
            continue
        members = {part.name: part for part in node.body if isinstance(part, ast.FunctionDef)}
        if not issubclass(item, Exception) and public(members) != public(vars(item)):
            wrong.append(f"{name}: {public(members) ^ public(vars(item))} in one alone")
        for member, part in members.items():
            if not any(getattr(d, "id", "") == "property" for d in part.decorator_list):
                compare(f"{name}.{member}", part, getattr(item, member))
    print(f"{checked} signatures", *wrong, sep="\n")
    return 1 if wrong or checked < 15 else 0


if __name__ == "__main__":
    sys.exit(main())
