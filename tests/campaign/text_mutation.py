"""Changes of text files: bytes, lines, numbers, and the keys of TOML files."""

import re

numbers = ["0", "-1", "nan", "inf", "-inf", "1e300", "-1e300", "1e-300", "5e-324", "1e9", "1e-9", "-0.0", "1e400",
           "9223372036854775807", "-9223372036854775808", "99999999999999999999999", "2147483648", "4294967296", "0x10",
           "1,5", "1.5.2", "--1", "+1", "1e", ".", "1_000"]
words = ["", "x", '""', "a" * 3000, "\x00", "\x1b[31m", "é", "\ud7ff", "#", "=", "[", "]", "{", "*", "/", "-", ",", ";"]
toml_values = [*numbers[:19], '""', '"x"', "[]", "{}", "[1, 2, 3]", "[[1]]", "true", "1979-05-27", "07:32:00",
               '"' + "a" * 3000 + '"', "[" + "0, " * 1000 + "0]", '[' + '"x", ' * 1000 + '"x"]', "[nan]",
               '"/dev/null"', '"/dev/zero"', '"fifo"', '"."', '"scene.toml"', '"\\u0000"', '"\\u001b[31m"', "'''",
               "{ value = 1 }", '"1:40"', '"1:0"', "[" * 60 + "]" * 60, "{ a = 1, a = 2 }", "'*'"]
scales = [-1.0, 1e-12, 1e-6, 1e-3, 0.1, 10.0, 1e3, 1e6, 1e12, *[0.3, 0.5, 0.7, 0.9, 1.001, 1.1, 1.4, 2.0, 3.0] * 2]
number_pattern = re.compile(rb"(?<![\w.])[-+]?\d[\d_]*\.?\d*(?:[eE][-+]?\d+)?")


def flip_bytes(random, content):
    data = bytearray(content)
    for _ in range(random.choice((1, 1, 2, 8))):
        if data:
            data[random.randrange(len(data))] ^= 1 << random.randrange(8)
    return bytes(data)


def random_bytes(random, content):
    at = random.randrange(len(content) + 1)
    return content[:at] + random.randbytes(random.choice((1, 4, 64))) + content[at + random.choice((0, 4, 64)):]


def truncate(random, content):
    return content[:random.randrange(len(content) + 1)]


def insert_word(random, content):
    at = random.randrange(len(content) + 1)
    word = random.choice(words + numbers)
    return content[:at] + word.encode("utf-8", "surrogatepass") + content[at:]


def change_number(random, content):
    """One to three numbers replaced by an extreme, or scaled."""
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        places = list(number_pattern.finditer(content))
        if not places:
            return insert_word(random, content)
        place = random.choice(places)
        if random.random() < 0.5:
            new = random.choice(numbers)
        else:
            try:
                new = repr(float(place.group()) * random.choice(scales))
            except ValueError:
                new = "0"
        content = content[:place.start()] + new.encode() + content[place.end():]
    return content


def change_lines(random, content):
    lines = content.splitlines(keepends=True)
    if not lines:
        return b"\n"
    i, j = random.randrange(len(lines)), random.randrange(len(lines))
    act = random.choice(("swap", "delete", "repeat", "many", "join", "empty"))
    if act == "swap":
        lines[i], lines[j] = lines[j], lines[i]
    elif act == "delete":
        del lines[i]
    elif act == "repeat":
        lines.insert(j, lines[i])
    elif act == "many":
        lines[i:i] = [lines[i]] * random.choice((3, 100, 1000))
    elif act == "join":
        lines[i] = lines[i].rstrip(b"\r\n")
    else:
        lines[i] = random.choice((b"\n", b"\r\n", b"\r", b" \t\n", b"\xef\xbb\xbf\n"))
    return b"".join(lines)


def change_cell(random, content):
    """A cell of a table, or a word, emptied, replaced or doubled."""
    cells = list(re.finditer(rb"[^\s,;=]+", content))
    if not cells:
        return insert_word(random, content)
    cell = random.choice(cells)
    new = random.choice((b"", cell.group() * 2, cell.group() + b"," + cell.group(),
                         random.choice(words).encode("utf-8", "surrogatepass"), random.choice(cells).group()))
    return content[:cell.start()] + new + content[cell.end():]


entry = re.compile(rb"^(\s*(\d+)\s+\2\s+)(\S+)$", re.M)


def change_diagonal(random, content):
    """One to three entries on the diagonal of a matrix scaled: it stays symmetric."""
    for _ in range(random.choice((1, 1, 2, 3))):
        entries = list(entry.finditer(content))
        if not entries:
            return change_number(random, content)
        place = random.choice(entries)
        try:
            new = repr(float(place.group(3)) * random.choice(scales))
        except ValueError:
            new = "0"
        content = content[:place.start(3)] + new.encode() + content[place.end(3):]
    return content


plain = [flip_bytes, random_bytes, truncate, insert_word, change_number, change_number, change_number, change_lines,
         change_lines, change_cell, change_cell]


def mutate_text(random, content):
    """Content with one or two changes, and their names."""
    matrix = content.startswith(b"%%MatrixMarket") or content.startswith(b"1 1 ")
    acts = [change_diagonal if matrix and random.random() < 0.4 else random.choice(plain) for _ in range(random.choice((1, 1, 1, 2)))]
    for act in acts:
        content = act(random, content)
    return content, "+".join(act.__name__ for act in acts)


assignment = re.compile(r"^(\s*)([\w.\"-]+)(\s*=\s*)(.*?)(\s*)$")


def change_value(random, lines, at):
    head = assignment.match(lines[at])
    old = head.group(4)
    new = random.choice(toml_values)
    found = number_pattern.search(old.encode())
    if found and random.random() < 0.7:
        if random.random() < 0.2:
            scaled = random.choice(numbers[:16])
        else:
            scaled = repr(float(found.group()) * random.choice(scales))
        new = old.replace(found.group().decode(), scaled, 1)
    elif random.random() < 0.15:
        new = random.choice((f"[{old}]", f"[{old}, {old}]", f"{{ value = {old} }}", f'"{old}"', f"{old} {old}"))
    lines[at] = head.group(1) + head.group(2) + head.group(3) + new


def mutate_toml(random, content):
    """TOML with one to three changes that mostly leave it TOML, and their names."""
    lines = content.decode("utf-8", "replace").split("\n")
    done = []
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        keys = [i for i, line in enumerate(lines) if assignment.match(line)]
        if not keys:
            break
        at, act = random.choice(keys), random.choice(("value",) * 12 + ("delete", "repeat", "unknown", "move", "section"))
        if act == "value":
            change_value(random, lines, at)
        elif act == "delete":
            del lines[at]
        elif act == "repeat":
            lines.insert(at, lines[at])
        elif act == "unknown":
            lines.insert(at, random.choice(('xyz = 1', '"" = 1', 'a.b.c = 1', "mass = 1", "x = [", "1 = 2", "é = 1",
                                            ".".join("a" * 30) + " = 1")))
        elif act == "move":
            lines.insert(random.randrange(len(lines)), lines.pop(at))
        else:
            change_sections(random, lines)
        done.append(act)
    return "\n".join(lines).encode("utf-8", "surrogatepass"), "+".join(done)


def change_sections(random, lines):
    """A section repeated, deleted, renamed, or made a list or not one."""
    heads = [i for i, line in enumerate(lines) if line.startswith("[")]
    if not heads:
        return
    at = random.choice(heads)
    end = next((i for i in heads if i > at), len(lines))
    act = random.choice(("repeat", "delete", "rename", "list", "many"))
    if act == "repeat":
        lines[at:at] = lines[at:end]
    elif act == "many":
        lines[at:at] = lines[at:end] * 40
    elif act == "delete":
        del lines[at:end]
    elif act == "rename":
        lines[at] = random.choice(("[x]", "[[x]]", "[]", "[a.b]", "[train.x]", "[" + "a." * 40 + "a]"))
    else:
        name = lines[at].strip("[]")
        lines[at] = f"[{name}]" if lines[at].startswith("[[") else f"[[{name}]]"
