"""Part 1: mutated inputs over all readers, commands and keys of scenes, run and not only read."""

import math
import re
import random as random_module
import tomllib
from pathlib import Path

import scenes
from outcomes import Case
from text_mutation import mutate_text, mutate_toml, numbers, random_bytes, toml_values, truncate, flip_bytes

# Work of an accepted scene: its steps times its elements and coaches. What is above the first is planned, not run;
# what is above the second would be long even to plan, and is not made.
most_run, most_planned = 600.0, 3000.0


class Base:
    """The folder of unchanged files, and their contents."""

    def __init__(self, folder: Path, binaries: Path):
        self.folder, self.vsi, self.tablegen = folder, binaries / "vsi", binaries / "tablegen"
        self.bytes = {file.name: file.read_bytes() for file in folder.iterdir() if file.is_file()}
        self.keys = scenes.scene_keys()
        self.listed = set(re.findall(r"### `\[\[(\w+)\]\]`", (scenes.root / "docs/guide/scene.md").read_text()))
        self.unsealed = {}

    def names(self):
        return [name for name in self.bytes if not name.startswith("launcher")]


def number(section, key, default):
    value = section.get(key, default) if isinstance(section, dict) else default
    return float(value) if isinstance(value, (int, float)) and math.isfinite(value) else default


def work_of(text):
    """Steps x (elements + coaches) that a scene asks for, roughly; 0 where it is no TOML."""
    try:
        scene = tomllib.loads(text.decode())
    except (ValueError, RecursionError):
        return 0.0
    train, track, run = (scene.get(name, {}) for name in ("train", "track", "integration"))
    spans = scene.get("bridge", [])
    spans = [span for span in spans if isinstance(span, dict)] if isinstance(spans, list) else []
    length = number(track, "length_before", 120.0) + number(track, "length_after", 60.0)
    length += sum(number(span, "length", 32.0) * max(1.0, number(span, "count", 1)) for span in spans)
    elements = abs(length / max(1e-9, number(track, "sleeper_spacing", 0.6)) * max(1.0, number(track, "elements_per_bay", 1)))
    elements += sum(abs(number(span, "count", 1) * number(span, "elements", 32)) for span in spans)
    if isinstance(track, dict) and track.get("kind") in ("rigid", "imported"):
        elements = 10.0
    if isinstance(scene.get("structure"), dict) and "stiffness" in scene["structure"]:
        elements *= 60.0  # a bridge of another program is coupled widely
    coaches = number(train, "count", 1)
    if isinstance(train, dict) and isinstance(train.get("consist"), list):
        repeats = [str(name).rpartition("*")[2] for name in train["consist"]]
        coaches = sum(min(1e6, float(times)) if times.isdecimal() else 1.0 for times in repeats)
    duration = number(run, "duration", 0.0)
    if duration <= 0.0:
        duration = length / max(1e-3, number(train, "speed", 30.0))
    steps = duration / max(1e-12, number(run, "time_step", 5e-4))
    halved = 2.0 ** min(20.0, max(0.0, number(run, "max_halvings", 6) - 6))
    return max(1.0, steps / 20.0) * (0.2 * elements + 10.0 * coaches) * min(halved, 1e3)


def run_of(base, name, text, reader, what, files):
    """A run of a scene, or its plan where the run would take long; None where the plan would."""
    work = work_of(text)
    if work > most_planned:
        return None
    if work > most_run:
        return Case(reader, what + " (planned)", [base.vsi, "run", name, "--plan", "--json"], files, [], [name, *files])
    return Case(reader, what, [base.vsi, "run", name, "--json", "-o", "out.h5"], files, ["out.h5"], [name, *files])


def put(base, random, lines, key, value):
    """Sets a key of a scene, in a section of that name, made where there is none."""
    first, _, inner = key.partition(".")
    if not inner:
        lines.insert(0, f"{key} = {value}")
        return
    heads = [i for i, line in enumerate(lines) if line.startswith("[") and line.strip("[]") == first]
    if not heads:
        lines.append(f"[[{first}]]" if first in base.listed else f"[{first}]")
        heads = [len(lines) - 1]
    at = random.choice(heads)
    end = next((i for i in range(at + 1, len(lines)) if lines[i].startswith("[")), len(lines))
    lines[at + 1:end] = [line for line in lines[at + 1:end] if line.split(" = ")[0] != inner]
    lines.insert(at + 1, f"{inner} = {value}")


def home_of(random, key):
    """A scene that has the key's section, where there is one."""
    section = key.partition(".")[0]
    homes = [name for name, text in scenes.scenes.items() if f"[{section}]" in text]
    return random.choice(homes if homes and random.random() < 0.9 else list(scenes.scenes))


def scene_key(base, random, count):
    """Every key of scenes in turn, with every extreme or permitted value."""
    key, values = base.keys[count % len(base.keys)]
    value = scenes.permitted(random, values) if random.random() < 0.75 else None
    if value is None:
        value = random.choice(toml_values)
    home = home_of(random, key)
    lines = scenes.tiny(home, "p.prw", "p.prr").splitlines()
    put(base, random, lines, key, value)
    text = ("\n".join(lines) + "\n").encode("utf-8", "surrogatepass")
    return run_of(base, "scene.toml", text, "scene_key", f"{home}: {key} = {value[:60]}", {"scene.toml": text})


def scene_mix(base, random, count):
    """One to three numbers of a scene scaled, and a key or two added, all in their ranges or next to them."""
    home = list(scenes.scenes)[count % len(scenes.scenes)]
    lines = scenes.tiny(home, "p.prw", "p.prr").splitlines()
    sections = {line.strip("[]") for line in lines if line.startswith("[")}
    own = [(key, values) for key, values in base.keys if key.partition(".")[0] in sections and "…" in values]
    present = [(key, values) for key, values in own
               if any(line.startswith(key.partition(".")[2] + " = ") for line in lines)]
    done = []
    for _ in range(random.choice((1, 1, 2, 3))):
        key, values = random.choice(present if present and random.random() < 0.6 else own or base.keys)
        value = scenes.permitted(random, values, inside=True)
        if value is not None and key not in ("integration.duration", "integration.time_step"):
            put(base, random, lines, key, value)
            done.append(f"{key} = {value}")
    text = ("\n".join(lines) + "\n").encode()
    return run_of(base, "scene.toml", text, "scene_mix", f"{home}: {', '.join(done)}", {"scene.toml": text})


def scene_text(base, random, count):
    home = list(scenes.scenes)[count % len(scenes.scenes)]
    text = scenes.tiny(home, "p.prw", "p.prr").encode()
    text, what = (mutate_toml if random.random() < 0.75 else mutate_text)(random, text)
    if random.random() < 0.1:
        return Case("scene_check", f"{home}: {what}", [base.vsi, "check", "scene.toml", "-o", "out.svg", "--json"],
                    {"scene.toml": text}, ["out.svg"], ["scene.toml"]) if work_of(text) < most_run else None
    return run_of(base, "scene.toml", text, "scene", f"{home}: {what}", {"scene.toml": text})


def file_of(reader, choices, mutate=mutate_text):
    """A reader of one of several files, each with the scene or command that takes it."""

    def make(base, random, count):
        name, command = choices[count % len(choices)]
        content, what = mutate(random, base.bytes[name])
        if isinstance(command, str):
            return Case(reader, f"{name}: {what}", [base.vsi, "run", command, "--json", "-o", "out.h5"],
                        {name: content}, ["out.h5"], [name, command])
        program, *words = command
        return Case(reader, f"{name}: {what}", [getattr(base, program), *words], {name: content},
                    [word for word in words if word.startswith("out")], [name, *words])

    return make


def profile(base, random, count):
    wheel, rail, changed = [("p.prw", "p.prr", 0), ("p.prw", "p.prr", 1), ("p.whl", "p.ban", 0), ("p.whl", "p.ban", 1),
                            ("wheel.txt", "rail.txt", 0), ("wheel.txt", "rail.txt", 1)][count % 6]
    name = (wheel, rail)[changed]
    content, what = mutate_text(random, base.bytes[name])
    text = scenes.tiny("profiles", wheel, rail).encode()
    return Case("profile" + Path(name).suffix, what, [base.vsi, "run", "scene.toml", "--json", "-o", "out.h5"],
                {name: content, "scene.toml": text}, ["out.h5"], [name])


structure_files = [
    *[(name, "imported_bridge.toml") for name in ("bridge_mass.mtx", "bridge_stiffness.mtx", "bridge_dofs.csv",
                                                  "bridge_nodes.inp")],
    *[(name, "calculix.toml") for name in ("bridge.mas", "bridge.sti", "bridge.dof")],
    *[(name, "ansys.toml") for name in ("bridge_m.matrix", "bridge_k.matrix", "bridge_k.mapping", "bridge_nodes.txt")],
    *[(name, "abaqus.toml") for name in ("bridge_MASS1.mtx", "bridge_STIF1.mtx")],
    *[(name, "modes.toml") for name in ("bridge_modes.csv", "bridge_shapes.csv")],
    *[(name, "imported_rails.toml") for name in ("rails_mass.mtx", "rails_damping.mtx", "rails_stiffness.mtx",
                                                 "rails_dofs.csv")]]
structure_choices = structure_files + [(name, ("vsi", "structure", scene, "--modes", "3", "--json"))
                                       for name, scene in structure_files if "rails" not in name]
vehicle_matrices = [(name, "imported_vehicle.toml") for name in ("vehicle_mass.mtx", "vehicle_damping.mtx",
                                                                 "vehicle_stiffness.mtx", "vehicle_dofs.csv")]
vehicle_choices = [("wagon.toml", "vertical.toml"), ("wagon.toml", "online.toml"), ("stops.toml", "speed.toml"),
                   ("coupler.toml", "consist.toml"), ("stops.toml", "consist.toml"), ("coach.toml", "coaches.toml"),
                   *[(name, ("vsi", "vehicle", name, "--json")) for name in ("wagon.toml", "stops.toml", "coach.toml")]]
history_choices = [("rough.csv", "vertical.toml"), ("ground.csv", "bridge.toml"), ("ground.csv", "loads.toml"),
                   ("gust.csv", "loads.toml"), ("wind.csv", "wind.toml"),
                   ("coefficients.csv", "wind.toml"), ("speed.csv", "speed.toml"), ("friction.csv", "speed.toml"),
                   ("wheel.csv", "loads.toml"), ("ground.csv", "imported_bridge.toml")]
beam = ("--length", "12", "--mass", "1e4", "--bending-stiffness", "4e9", "--damping", "0.01")
query_choices = [("poses.csv", ("vsi", "contact", "pair.h5", "--query", "poses.csv", "-o", "out.csv")),
                 ("loads.csv", ("vsi", "contact", "pair.h5", "--query", "loads.csv", "-o", "out.csv", "--total")),
                 ("poses.csv", ("vsi", "contact", "pair.h5", "--query", "poses.csv", "-o", "out.csv", "--online")),
                 *[("creepages.csv", ("vsi", "creep", "--law", law, "--query", "creepages.csv", "-o", "out.csv"))
                   for law in ("table", "polach", "fastsim", "linear")],
                 ("axles.csv", ("vsi", "moving-load", *beam, "--train", "axles.csv", "--speed", "40:60:20", "-o",
                                "out.csv"))]
clause_choices = [("clauses.toml", ("vsi", "assess", "bridge.toml", "--stage", "check", "--clauses", "clauses.toml",
                                    "-o", "out_assess", "-q"))]
batch_choices = [("pairs.toml", ("tablegen", "batch", "pairs.toml", "--plan", "--json"))]
table_commands = {
    "pair.h5": [("vsi", "contact", "pair.h5", "--query", "poses.csv", "-o", "out.csv"),
                ("vsi", "run", "table.toml", "--json", "-o", "out.h5"), ("tablegen", "info", "pair.h5", "--json"),
                ("tablegen", "conicity", "pair.h5", "--json")],
    "loaded.h5": [("vsi", "contact", "loaded.h5", "--query", "loads.csv", "-o", "out.csv"),
                  ("vsi", "run", "loaded.toml", "--json", "-o", "out.h5"), ("tablegen", "info", "loaded.h5", "--json")],
    "creep.h5": [("vsi", "creep", "creep.h5", "--query", "creepages.csv", "-o", "out.csv"),
                 ("vsi", "run", "creep.toml", "--json", "-o", "out.h5"), ("tablegen", "info", "creep.h5", "--json")],
    "part1.h5": [("tablegen", "merge", "part1.h5", "part2.h5", "-o", "out.h5", "-q"),
                 ("tablegen", "info", "part1.h5", "--json")],
    "results.h5": [("vsi", "report", "results.h5", "-o", "out.html", "-q"),
                   ("vsi", "run", "online.toml", "--resume", "-q", "-o", "results.h5"),
                   ("vsi", "results.h5", "--json"), ("vsi", "export", "results.h5", "-q", "-o", "out.pvd"),
                   ("vsi", "report", "results.h5", "results2.h5", "-o", "out.html", "-q")]}


def hdf5(base, random, count):
    """A table or results with changed bytes, or changed by another program."""
    from hdf5_mutation import mutate_hdf5, without_seal
    name = list(table_commands)[count % len(table_commands)]
    commands = table_commands[name]
    program, *words = commands[count // len(table_commands) % len(commands)]
    reader = {"pair.h5": "geometry_table", "loaded.h5": "loaded_table", "creep.h5": "creep_table", "part1.h5": "table_shard",
              "results.h5": "results"}[name]
    if random.random() < 0.25:
        act = random.choice((flip_bytes, flip_bytes, random_bytes, truncate))
        content, what = act(random, base.bytes[name]), act.__name__
    else:
        if name not in base.unsealed:
            plain = name == "results.h5"
            base.unsealed[name] = base.bytes[name] if plain else without_seal(base.folder / name)
        content, what = mutate_hdf5(random, base.unsealed[name])
    files = {name: content}
    if "results2.h5" in words:
        files["results2.h5"] = base.bytes["results.h5"]
    return Case(reader, f"{name}: {what}", [getattr(base, program), *words], files,
                [word for word in words if word.startswith("out")], [name, *words])


def runs_of_study(text):
    """How many runs a study's plan asks for, roughly; 0 where it is no TOML."""
    try:
        plan = tomllib.loads(text.decode())
    except (ValueError, RecursionError):
        return 0.0
    runs = 1.0
    for vary in plan.get("vary", []) if isinstance(plan.get("vary"), list) else []:
        if not isinstance(vary, dict):
            continue
        if isinstance(vary.get("values"), list):
            runs *= len(vary["values"])
        try:
            low, high, step = map(float, str(vary.get("range", "")).split(":"))
            runs *= max(1.0, abs(high - low) / max(1e-300, abs(step)))
        except ValueError:
            pass
    for name in ("sampling", "probability", "importance"):
        section = plan.get(name)
        if isinstance(section, dict):
            subset = section.get("method") == "subset"
            runs *= max(1.0, number(section, "samples", 1000.0 if subset or name == "importance" else 1.0))
            runs *= max(1.0, number(section, "most_levels", 8.0)) if subset else 1.0
    return runs


def study(base, random, count):
    """A plan of few runs, carried out; of many, counted."""
    name = list(scenes.studies)[count % len(scenes.studies)]
    content, what = (mutate_toml if random.random() < 0.75 else mutate_text)(random, base.bytes[name])
    words = ["--threads", "1", "-q", "-o", "out_study"] if runs_of_study(content) <= 60 else ["--count"]
    return Case("study", f"{name}: {what}", [base.vsi, "study", name, *words], {name: content}, ["out_study"],
                [name, "vertical.toml"])


def assessment(base, random, count):
    """A scene whose bridge is assessed without a run, or its deck under moving loads."""
    command, *words = [("assess", "--stage", "check", "-q", "-o", "out_assess"),
                       ("moving-load", "--speed", "30:40:10", "--threads", "1", "-q", "-o", "out.csv")][count % 2]
    text, what = mutate_toml(random, scenes.tiny(("bridge", "spans")[count // 2 % 2], "p.prw", "p.prr").encode())
    if work_of(text) > most_run:
        return None
    return Case("assessment", f"{command}: {what}", [base.vsi, command, "scene.toml", *words], {"scene.toml": text},
                [words[-1]], ["scene.toml"])


def what_is(base, random, count):
    """vsi FILE over any file."""
    names = [name for name in base.names() if name != "fifo"]
    name = names[count % len(names)]
    act = random.choice((flip_bytes, random_bytes, truncate)) if name.endswith(".h5") else None
    content, what = (act(random, base.bytes[name]), act.__name__) if act else mutate_text(random, base.bytes[name])
    return Case("any_file", f"{name}: {what}", [base.vsi, name, "--json"], {name: content}, [], [name])


flags = [
    ("vsi", "moving-load", "--length", 12, "--mass", 1e4, "--bending-stiffness", 4e9, "--damping", 0.01, "--train",
     "axles.csv", "--speed", "40:60:20", "--modes", 3, "--sleeper-spacing", 0.6),
    ("tablegen", "contact", "--ratio", 2, "--creepage", "0.1,0.05,0.1", "--elements", 8),
    ("tablegen", "contact", "--wheel", "cone-1:20", "--rail", "60E1", "--pose", "0.001,0,0", "--load", 75000,
     "--friction", 0.3, "--elements", 6),
    ("tablegen", "conicity", "pair.h5", "--amplitude", 1e-4, "--diameter-difference", 0),
    ("vsi", "structure", "bridge.toml", "--modes", 3), ("vsi", "vehicle", "wagon.toml", "--modes", 3),
    ("vsi", "critical-speed", "online.toml", "--to-kmh", 100, "--amplitude", 1e-4),
    ("vsi", "creep", "--law", "polach", "--poisson", 0.28, "--query", "creepages.csv", "-o", "out.csv"),
    ("vsi", "new", "out.toml", "--train", "manchester-coach", "--coaches", 2, "--span", 20, "--spans", 2,
     "--speed", 100),
    ("vsi", "run", "vertical.toml", "--check-reduction", 0.01, "-o", "out.h5"),
    ("vsi", "sweep", "vertical.toml", "--speed", "10:20:10", "--seeds", 1, "--threads", 1, "-o", "out_sweep"),
    ("vsi", "assess", "bridge.toml", "--stage", "check", "-o", "out_assess"),
    ("vsi", "study", "grid.toml", "--shard", "1/1", "--threads", 1, "-o", "out_study"),
    ("vsi", "export", "results.h5", "-o", "out.pvd"),
    ("tablegen", "loaded", "loaded.h5", *scenes.loaded_options, "--modulus", 210e9, "--poisson", 0.28),
]
flag_values = [*numbers[:20], "", "a", "1:2", "2:1", "0:0:0", "1:2:0", "1:2:1e-9", "1:1e9", "nan:1", "1,2", "1,2,3,4",
               ",,", "-5", "1e6", "0.001", "1000", "a" * 3000, "\x1b[31m", "/dev/null", "fifo", "."]


def command_line(base, random, count):
    program, *words = flags[count % len(flags)]
    words = [str(word) for word in words]
    at = random.randrange(1, len(words))
    act = random.choice(("value", "value", "value", "delete", "repeat", "unknown"))
    if act == "value":
        places = [i for i in range(1, len(words)) if not words[i].startswith("-") and not words[i].startswith("out")]
        at = random.choice(places)
        words[at] = random.choice(flag_values)
    elif act == "delete":
        del words[at]
    elif act == "repeat":
        words.insert(at, words[at])
    else:
        words.insert(at, random.choice(("--unknown", "-x", "--threads=-1", "--speed=", "--", "x", "--json", "--quiet",
                                        "--threads=1000000", "-o")))
    words = [word.replace("\x00", "") for word in words]
    options = [word for word in words if len(word) > 1] + ["tablegen", "vsi"]
    return Case("command_line", " ".join([program, *words])[:200], [getattr(base, program), *words], {},
                ["out.csv", "out.h5", "out.toml", "out.pvd", "out_sweep", "out_assess", "out_study"], options)


# Readers with their share of the inputs, in twentieths.
readers = [(scene_key, 4), (scene_mix, 3), (scene_text, 2), (profile, 1), (file_of("structure", structure_choices), 2),
           (file_of("vehicle_matrices", vehicle_matrices), 1),
           (file_of("vehicle_file", vehicle_choices, lambda random, content: (
               mutate_toml if random.random() < 0.7 else mutate_text)(random, content)), 1),
           (file_of("history", history_choices), 1), (file_of("query", query_choices), 1), (hdf5, 2), (what_is, 1)]
last_slot = [(file_of("clauses", clause_choices, mutate_toml), 2),
             (file_of("batch_list", batch_choices, mutate_toml), 2), (study, 4), (assessment, 3), (command_line, 9)]


def case_of(base, seed, index):
    """The input of this number: depends on seed and number alone. None where no try makes one that ends in time."""
    slot, round_ = index % 20, index // 20
    for make, share in readers:
        if slot < share:
            return tried(base, seed, index, make, round_ * share + slot)
        slot -= share
    slot = round_ % 20
    for make, share in last_slot:
        if slot < share:
            return tried(base, seed, index, make, (round_ // 20) * share + slot)
        slot -= share
    raise AssertionError("shares do not add up to twenty")


def tried(base, seed, index, make, count):
    random = random_module.Random(f"{seed}/{index}")
    for _ in range(20):
        case = make(base, random, count)
        if case is not None:
            return case
    return None
