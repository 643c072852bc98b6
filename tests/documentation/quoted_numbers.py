"""Numbers and tables that pages quote from measurements. The syntax is described in CONTRIBUTING.md.

Values: docs/validation/measured.csv (what tests measured) and docs/validation/quoted_runs.csv (what single commands
measured), by name; cells of every other CSV of docs/validation and of tests/benchmark/baseline.csv, by row and column.
"""

import csv
import operator
import re
from decimal import Decimal
from pathlib import Path

NAME = re.compile(r"(?<![0-9.])[A-Za-z][A-Za-z0-9_.]*")
CELL = re.compile(r"(max|min|count|)\[([^\]]+)\]")
GROUPED = r"[−+-]?\d{1,3}(?:\u00a0\d{3})*"
PLAIN = r"[−+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
MARK = re.compile(rf"(?P<shown>{GROUPED}(?=<!--[^>]*%')|{PLAIN}|)<!--(?P<value>[a-z0-9(\[][^<>]*?) %(?P<form>[^ <>]+)-->")
TABLE = re.compile(
    r"<!--table (?P<file>\S+)(?: where (?P<where>[^\n]+))?\n(?P<row>[^\n]+)\n-->\n"
    r"(?P<head>(?:[^\n]*\n)?(?:\|[ -]+)+\|\n)(?P<body>(?:\|[^\n]*\n)*)")
CODE = re.compile(r"^```.*?^```|^ {4,}\S[^\n]*", re.M | re.S)
CLAIM = re.compile(r"^<!--claim (.+)-->$", re.M)
COMPARISON = re.compile(r"(<=|>=|==|!=|<|>)")
HOLDS = {"<": operator.lt, ">": operator.gt, "<=": operator.le, ">=": operator.ge, "==": operator.eq, "!=": operator.ne}

NUMBER = r"[−+-]?\d[\d.,]*(?:·10[⁻⁰¹²³⁴-⁹]+)?"
MEASURED = re.compile(rf"{NUMBER}\s?(?:%|(?:ns|µs|ms|s|min|minutes|hours|kB|MB|GB|KiB|MiB|GiB)(?![\w/²]))")
INPUT = re.compile(  # steps of 1 ms, at 0.5 ms, a step of 1 ms and 2 ms
    rf"\b(?:steps?(?:\s(?:of|at|up\sto))?|at|from|to|in|and|or|,)\s{NUMBER}(?:(?:\s(?:to|and|or)|,)\s{NUMBER})*"
    r"\s[mµ]s\b(?:\ssteps)?")


class QuoteError(Exception):
    """A mark that no measurement answers."""


def read_rows(path):
    """Rows of a CSV as dictionaries; lines that begin with # are comments."""
    lines = [line for line in path.read_text().splitlines() if line and not line.startswith("#")]
    return list(csv.DictReader(lines))


def number(text):
    """The text as a number where it is one."""
    try:
        return float(text)
    except ValueError:
        return text


def shown(value, form):
    """A value as a page shows it. Forms are printf's, but for g, which never has an exponent, and ' (groups of three)."""
    if form.startswith("'"):
        text = f"{round(value):,d}".replace(",", "\u00a0")
    elif form.endswith("g"):
        sign, form = ("+", form[1:]) if form.startswith("+") else ("", form)
        text = f"{Decimal(f'{value:{form}}'):{sign}f}"
    else:
        text = re.sub(r"e([+-])0*(?=\d)", lambda m: "e" + m[1].strip("+"), f"%{form}" % value)
    return text.replace("-", "−", 1) if text.startswith("-") else text


class Measurements:
    """All that pages may quote."""

    def __init__(self, root):
        self.root = Path(root)
        self.files = sorted((self.root / "docs/validation").rglob("*.csv"))
        self.files.append(self.root / "tests/benchmark/baseline.csv")
        self.named = {}
        self.rows = {}
        for name in ("measured", "quoted_runs"):
            for row in self.table(name):
                self.named[row["name"]] = float(row["value"])

    def table(self, name):
        """Rows of a CSV, by its path in docs/validation or its bare name, without .csv."""
        name = name.removesuffix(".csv")
        if name not in self.rows:
            found = [f for f in self.files if f.with_suffix("").as_posix().endswith("/" + name)]
            if len(found) != 1:
                raise QuoteError(f"{len(found)} files {name}.csv")
            self.rows[name] = read_rows(found[0])
        return self.rows[name]

    @staticmethod
    def begins_with(row, key):
        """Whether the row's fields, themselves parted where they contain semicolons, begin with the key's."""
        fields = [part.strip() for field in row.values() for part in (field or "").split(";")]
        return len(fields) >= len(key) and all(k in ("*", field) for k, field in zip(key, fields))

    def cell(self, choice, reference):
        """[file; first field; second field; ...; column]: the one row that begins with these fields, * being any.

        With max or min before it, that of all rows that do; with count, how many of them have something there."""
        name, *key, column = [part.strip() for part in reference.split(";")]
        found = [row for row in self.table(name) if self.begins_with(row, key)]
        if not found or (len(found) > 1 and not choice) or column not in found[0]:
            raise QuoteError(f"{len(found)} rows [{reference}], or no such column")
        values = [row[column] for row in found if row[column]]
        return len(values) if choice == "count" else {"max": max, "min": min, "": max}[choice](map(float, values))

    def numbers_for(self, expression):
        """The expression with a number in place of each name and cell."""
        def name(match):
            if match[0] != "and" and match[0] not in self.named:
                raise QuoteError(f"no measured number {match[0]}")
            return repr(self.named[match[0]]) if match[0] in self.named else match[0]

        cells = []
        text = CELL.sub(lambda match: cells.append(self.cell(match[1], match[2])) or "\0", expression)
        text = NAME.sub(name, text)
        for cell in cells:
            text = text.replace("\0", repr(cell), 1)
        return text

    @staticmethod
    def arithmetic(text):
        """The value of digits and operators."""
        if not re.fullmatch(r"[0-9.e+\-*/() ]+", text):
            raise QuoteError(f"not arithmetic: {text}")
        return eval(text, {"__builtins__": {}})

    def value(self, expression):
        """Names and cells, joined by arithmetic."""
        return self.arithmetic(self.numbers_for(expression))

    def false_comparisons(self, expression):
        """Comparisons joined by `and`: those that do not hold, with the values of both sides."""
        false = []
        for comparison in self.numbers_for(expression).split(" and "):
            first, *rest = COMPARISON.split(comparison)
            if not rest:
                raise QuoteError(f"compares nothing: {comparison}")
            left = self.arithmetic(first.strip())
            for sign, text in zip(rest[::2], rest[1::2]):
                right = self.arithmetic(text.strip())
                if not HOLDS[sign](left, right):
                    false.append(f"{left:.6g} {sign} {right:.6g}")
                left = right
        return false

    def table_body(self, name, row_form, where):
        """A Markdown row for every row of the CSV that the condition chooses. Beside the row's own fields, form and condition
        may name cell(file, first field, ..., column), one number of another row."""
        outside = {"__builtins__": {}, "cell": lambda *reference: self.cell("", "; ".join(reference))}
        body = ""
        for row in self.table(name):
            fields = {key: number(text) for key, text in row.items()}

            def field(match):
                value = eval(match[1], outside, fields)
                return value if isinstance(value, str) else shown(value, match[2] or "g")

            if where is None or eval(where, outside, fields):
                body += re.sub(r"\{([^{}:]+)(?::([^{}]+))?\}", field, row_form) + "\n"
        if not body:
            raise QuoteError("no row is chosen")
        return body


def renewed(text, measurements):
    """The page as the measurements would have it. Returns it, what differs, what is wrong, and how much is marked."""
    differing, wrong, marks = [], [], 0

    def line(match):
        return text.count("\n", 0, match.start()) + 1

    def mark(match):
        nonlocal marks
        marks += 1
        try:
            if not match["shown"]:
                raise QuoteError("a mark without a number before it")
            new = shown(measurements.value(match["value"]), match["form"])
        except (QuoteError, ValueError, TypeError, SyntaxError, ZeroDivisionError) as error:
            wrong.append(f"{line(match)}: {match['value']}: {error}")
            return match[0]
        if new != match["shown"]:
            differing.append(f"{line(match)}: {match['value']} is {new}, not {match['shown']}")
        return f"{new}<!--{match['value']} %{match['form']}-->"

    def table(match):
        nonlocal marks
        marks += 1
        try:
            body = measurements.table_body(match["file"], match["row"], match["where"])
        except (QuoteError, NameError, ValueError, TypeError, SyntaxError) as error:
            wrong.append(f"{line(match)}: table {match['file']}: {error}")
            return match[0]
        if body != match["body"]:
            differing.append(f"{line(match)}: table {match['file']} has other numbers")
        return match[0][:len(match[0]) - len(match["body"])] + body

    for claim in CLAIM.finditer(text):
        marks += 1
        try:
            wrong += [f"{line(claim)}: claim {claim[1]}: {comparison} is false"
                      for comparison in measurements.false_comparisons(claim[1])]
        except (QuoteError, ValueError, TypeError, SyntaxError, ZeroDivisionError) as error:
            wrong.append(f"{line(claim)}: claim {claim[1]}: {error}")
    if text.count("<!--claim") != len(CLAIM.findall(text)):
        wrong.append("a <!--claim that does not stand alone on its line")
    new = MARK.sub(mark, text)
    if "<!--table" in text:
        starts = len(re.findall(r"^<!--table ", text, re.M))
        if starts != len(TABLE.findall(text)):
            wrong.append("a <!--table that is not followed by a row's form, --> and the head of a table")
        new = TABLE.sub(table, new)
    return new, differing, wrong, marks


def without(pattern, text):
    """The text without what matches, lines kept."""
    return pattern.sub(lambda match: "\n" * match[0].count("\n"), text)


def marks_in_prose(text):
    """Marks, with their lines, that stand in no row of a table."""
    lines = enumerate(without(CODE, text).splitlines(), 1)
    return [(number, match[0]) for number, line in lines if not line.lstrip().startswith("|")
            for match in MARK.finditer(line)]


def long_lines(text, limit=120):
    """Lines of prose, with their lengths, beyond the limit. Code, rows of tables and bare URLs may be longer; comments, which
    no reader sees, do not count.
    """
    lines = enumerate(without(re.compile(f"{CODE.pattern}|<!--.*?-->", re.M | re.S), text).splitlines(), 1)
    return [(number, len(line)) for number, line in lines
            if len(line) > limit and not re.match(r"\s*\||\s*[-*]?\s*<?https?://\S+$", line)]


def unmarked(text):
    """Numbers of time, memory and per cent, with their lines, that have no mark and stand neither in a generated table nor
    in code nor on a line that says <!--given-->. Time steps, inputs on nearly every line, are known by their words.
    """
    text = without(re.compile(rf"{CODE.pattern}|`[^`\n]*`", re.M | re.S), text)
    given = {number for number, line in enumerate(text.splitlines(), 1) if "<!--given-->" in line}
    text = re.sub(rf"{MARK.pattern}\s?(?:%|\w+)?", "", without(CLAIM, without(TABLE, text)))
    text = without(INPUT, text)
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        if number not in given:
            found += [(number, match[0]) for match in MEASURED.finditer(line)]
    return found
