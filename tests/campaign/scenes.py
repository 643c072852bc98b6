"""Scenes of some twenty steps, and the files that they name: what the campaign changes.

The train is a wagon of two axles and the track short, so that a run takes some ten milliseconds.
"""

import os
import re
import shutil
from pathlib import Path

root = Path(__file__).resolve().parent.parent.parent
steps = "[integration]\nduration = 0.02\ntime_step = 1e-3\n"
wagon = '[train]\nvehicle = "wagon.toml"\nspeed = 30.0\nstart = 0.0\n'
online = '[contact]\nmode = "online"\ncreep_law = "polach"\n'
vertical = '[contact]\nnormal = "rigid"\n'
rigid = '[track]\nkind = "rigid"\n'
flexible = "[track]\nlength_before = 12.0\nlength_after = 12.0\nsleeper_spacing = 1.0\nelements_per_bay = 1\n"
span = "[[bridge]]\nlength = 4.0\nelements = 2\n"

wagon_file = """name = "wagon"
description = "two axles"
nominal_radius = 0.46
length = 8.0
top_speed_kmh = 200
[car_body]
mass = 20000.0
Jx = 2e4
Jy = 1e5
Jz = 1e5
height = 1.5
[wheelset]
x = [2.0, -2.0]
mass = 1500.0
Jx = 900.0
Jy = 100.0
Jz = 900.0
[[connection]]
name = "springs"
joins = [["wheelset-1", "car-body"], ["wheelset-2", "car-body"]]
y = 1.0
both_sides = true
height = 0.46
kx = 5e6
ky = 3e6
kz = 1e6
cx = 1e4
cy = 1e4
cz = 2e4
"""

stops_file = wagon_file.replace('"wagon"', '"stops"') + """stop_z = [[0.02, 0.0], [0.03, 1e5]]
friction_y = 2e3
friction_travel_y = 1e-3
[[connection]]
name = "dampers"
joins = [["wheelset-1", "car-body"], ["wheelset-2", "car-body"]]
y = 1.1
both_sides = true
height = { value = 0.46, standing = "assumed", note = "by judgement" }
damper_curve_z = [[0.1, 2e3], [0.5, 3e3]]
cz = 1e4
cx = 2e4
series_kx = 4e6
[check]
mass = 23000.0
axle_load = 11500.0
"""

joint_file = """name = "coupler"
description = "coupler with buffers"
nominal_radius = 0.46
[[connection]]
name = "coupler"
joins = [["ahead/car-body", "behind/car-body"]]
height = 1.0
kx = 5e6
cx = 50e3
"""

coach_file = """name = "coach"
description = "two bogies"
template = "two-bogie"
nominal_radius = 0.46
length = 14.0
standing = "assumed"
[car_body]
mass = 32000.0
Jx = 56800.0
Jy = 1.97e6
Jz = 1.97e6
height = 1.8
[bogie]
mass = 2615.0
Jx = 1722.0
Jy = 1476.0
Jz = 3067.0
height = 0.6
[wheelset]
mass = 1813.0
Jx = 1120.0
Jy = 112.0
Jz = 1120.0
[layout]
half_wheelbase = 1.28
half_bogie_distance = 4.0
[primary]
kx = 31.391e6
ky = 3.884e6
kz = 1.220e6
cz = 4e3
half_distance = 1.0
[secondary]
kx = 0.160e6
ky = 0.160e6
kz = 0.430e6
cy = 32e3
cz = 20e3
half_distance = 1.0
height = 0.8275
[roll_bar]
stiffness = 1e6
[check]
mass = 44482.0
"""

imported_bridge = """[train]
vehicle = "wagon.toml"
speed = 30.0
[contact]
normal = "rigid"
[track]
sleeper_spacing = 2
elements_per_bay = 1
length_before = 12
length_after = 6
[structure]
%sdamping_ratio = 0.01
%s[[support]]
%sholds = ["x", "y", "z", "roll"]
"""
deck_set, ends_set = 'deck.set = "DECK"\n', 'set = "ENDS"\n'
deck_box = "deck.from = [-1, -1, -3]\ndeck.to = [21, 1, 0]\n"
ends_box = "from = [-1, -1, -3]\nto = [1, 1, 0]\n"
market = 'mass = "bridge_mass.mtx"\nstiffness = "bridge_stiffness.mtx"\ndofs = "bridge_dofs.csv"\n' \
         'nodes = "bridge_nodes.inp"\naxes = "x -y -z"\n'
calculix = 'format = "calculix"\nmass = "bridge.mas"\nstiffness = "bridge.sti"\ndofs = "bridge.dof"\n' \
           'nodes = "bridge_nodes.inp"\naxes = "x -y -z"\n'
abaqus = 'format = "abaqus"\nmass = "bridge_MASS1.mtx"\nstiffness = "bridge_STIF1.mtx"\n' \
         'nodes = "bridge_nodes.inp"\naxes = "x -y -z"\n'
modes = 'format = "modes"\nmode_table = "bridge_modes.csv"\nmode_shapes = "bridge_shapes.csv"\n' \
        'nodes = "bridge_nodes.inp"\naxes = "x -y -z"\n'
ansys = 'format = "ansys"\nmass = "bridge_m.matrix"\nstiffness = "bridge_k.matrix"\ndofs = "bridge_k.mapping"\n' \
        'nodes = "bridge_nodes.txt"\naxes = "x -y -z"\n'

scenes = {
    "vertical": wagon + vertical + rigid + '[irregularity]\nfile = "rough.csv"\n',
    "online": wagon + online + "friction = 0.3\n" + rigid,
    "profiles": wagon + '[contact]\nmode = "online"\ncreep_law = "linear"\nwheel = "WHEEL"\nrail = "RAIL"\n' + rigid,
    "table": wagon + '[contact]\nmode = "table"\ntable = "pair.h5"\ncreep_law = "table"\n' + rigid,
    "loaded": wagon + '[contact]\nmode = "table"\ntable = "loaded.h5"\nelastic = "half-space"\n' + rigid,
    "creep": wagon + '[contact]\nmode = "online"\ncreep_law = "table"\ncreep_table = "creep.h5"\n' + rigid,
    "bridge": wagon + vertical + flexible + span + '[[ground_motion]]\nfile = "ground.csv"\n[output]\nnodes = ["*"]\n',
    "spans": wagon + vertical + flexible + span.replace("4.0", "4.0\ncount = 2\nmass = 9e3\nIy = 0.2\nIz = 0.9")
             + '[span_deviation]\nshape = "bending"\nspan = 10\namplitude = 2e-3\n'
               '[irregularity]\nspectrum = "german-low"\nseed = 3\n',
    "window": wagon + vertical + flexible.replace("12.0", "24.0") + span
              + '[structure]\nreduction = "window"\nwindow_ahead = 6.0\nwindow_behind = 6.0\n'
                '[output]\nenergy = false\n',
    "loads": wagon + online + rigid + '[[load]]\nbody = "car-body"\nfile = "gust.csv"\nstart = 0.001\n[[load]]\n'
             'body = "wheelset-1"\ncoach = 1\nFy = 1e3\ngust_duration = 2.0\n[[ground_motion]]\nfile = "ground.csv"\n'
             'factor = 0.5\nwave_speed = 300.0\n[[wheel]]\ncoach = 1\nwheelset = 1\nside = "right"\n'
             'file = "wheel.csv"\n'
             '[[wheel]]\nflat_length = 0.03\npolygon_amplitude = 1e-5\nrun_out = 1e-4\n',
    "wind": wagon + online + rigid + '[[load]]\nbody = "car-body"\naerodynamics = "coefficients.csv"\n'
            'file = "wind.csv"\nwind_direction = 80.0\n[[load]]\nbody = "car-body"\ncoach = 1\n'
            'aerodynamics = "coefficients.csv"\nwind_speed = 12.0\ngust_duration = 2.0\narea = 12.0\nlength = 2.5\n'
            'air_density = 1.2\nwind_direction = -90.0\n',
    "speed": '[train]\nvehicle = "stops.toml"\nspeed_file = "speed.csv"\nstart = 0.0\n'
             + online.replace("polach", "fastsim") + 'friction_file = "friction.csv"\n' + rigid,
    "consist": '[train]\nconsist = ["wagon.toml", "-stops.toml"]\njoint = "coupler.toml"\nspeed = 20.0\n'
               + online + '[[profiles]]\ncoach = 2\nvehicle = "stops.toml"\nwheel = "cone-1:40"\n' + rigid,
    "coaches": '[train]\nvehicle = "coach.toml"\ncount = 2\nspeed_kmh = 200\n' + vertical + rigid,
    "imported_vehicle": '[vehicle]\nmass = "vehicle_mass.mtx"\ndamping = "vehicle_damping.mtx"\n'
                        'stiffness = "vehicle_stiffness.mtx"\ndofs = "vehicle_dofs.csv"\naxes = "x y z"\n'
                        'wheelsets = ["ws1", "ws2"]\ncar_body = "body"\nlength = 20.0\n[train]\nspeed = 40.0\n'
                        + online + rigid,
    "imported_bridge": imported_bridge % (market, deck_set, ends_set) + '[[ground_motion]]\nfile = "ground.csv"\n',
    "calculix": imported_bridge % (calculix, deck_set, ends_set),
    "ansys": imported_bridge % (ansys, deck_box, ends_box)
             + '[[support]]\nfrom = [19, -1, -3]\nto = [21, 1, 0]\nholds = ["y", "z", "roll"]\n',
    "abaqus": imported_bridge % (abaqus, deck_set, ends_set),
    "modes": imported_bridge.partition("[[support]]")[0].replace("damping_ratio = 0.01\n", "") % (modes, deck_set),
    "imported_rails": '[train]\nvehicle = "wagon.toml"\nspeed = 5.0\n[contact]\nnormal = "rigid"\n[track]\n'
                      'kind = "imported"\n[structure]\nmass = "rails_mass.mtx"\ndamping = "rails_damping.mtx"\n'
                      'stiffness = "rails_stiffness.mtx"\ndofs = "rails_dofs.csv"\n',
}

texts = {
    "wagon.toml": wagon_file, "stops.toml": stops_file, "coupler.toml": joint_file, "coach.toml": coach_file,
    "rough.csv": "# a hollow\nx[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n-10,0,0,0,0\n-4,0.1,-0.2,0.1,-0.1\n"
                 "0,0,1,0,0.5\n6,0,0,0,0\n",
    "ground.csv": "t[s],y[m/s2],z[m/s2]\n0,0,0\n0.1,0.5,-0.2\n0.3,-0.4,0.1\n0.5,0,0\n",
    "gust.csv": "t[s],Fy[kN],Mx[kN m]\n0,0,0\n0.5,20,-10\n1,0,0\n",
    "wind.csv": "t[s],U[km/h]\n0,36\n0.01,54\n2,0\n",
    "coefficients.csv": "yaw[deg],C_Fy[1],C_Fz[1],C_Mx[1],C_My[1],C_Mz[1]\n0,0,0,0,0,0\n30,2,-1,1.3,0,0.2\n"
                        "90,4,-2,2.6,0.1,0.1\n",
    "speed.csv": "t[s],V[km/h]\n0,0\n0.01,1\n4,100\n",
    "friction.csv": "# wet\nx[m],left[1],right[1]\n-50,0.3,0.3\n0,0.3,0.1\n0.5,0.05,0.3\n",
    "wheel.csv": "angle[deg],rise[mm]\n0,0\n90,0.05\n180,0\n270,-0.05\n",
    "axles.csv": "x[m],P[kN]\n0,170\n3,170\n14,170\n17,170\n",
    "poses.csv": "y,yaw,roll,dz\n0,0,0,1e-4\n1e-3,0.001,0,5e-5\n-0.0015,-0.002,0.0005,2e-4\n",
    "loads.csv": "y,yaw,roll,load\n0,0,0,5e4\n1e-3,0.001,0,1e5\n",
    "creepages.csv": "# units of Kalker\nratio,ux,uy,phi\n1,0.1,0,0\n0.5, -1e-3, 2e3 ,0.4\n1000,0,0,1\n",
    "pairs.toml": '[defaults]\nrail = "60E1"\nrail-inclination = "1:40"\ntolerance = 1e-8\nlateral = [-0.01, 0.01]\n'
                  '[[pair]]\nwheel = "S1002"\noutput = "a.h5"\n[[pair]]\nwheel = "cone-1:20"\nrail = "CHN60"\n'
                  'roll = [-0.005, 0.005]\noutput = "b.h5"\n',
}

study_head = 'scene = "vertical.toml"\n'
speeds = '[[vary]]\nkey = "train.speed"\nrange = "20:30:5"\n'
random_speed = '[[vary]]\nkey = "train.speed"\ndistribution = "normal"\nmean = 30.0\nstd = 3.0\nat_least = 10.0\n'
studies = {
    "grid.toml": study_head + speeds + '[[vary]]\nname = "rough"\nvalues = [1, 2]\n  [[vary.set]]\n'
                 '  key = "train.start"\n  factor = 0.5\n  power = 2\n',
    "samples.toml": study_head + random_speed + '[sampling]\nmethod = "latin-hypercube"\nsamples = 4\nseed = 2\n'
                    '[probability]\nmethod = "monte-carlo"\nmeasure = "wheel_unloading"\nlimit = 0.01\n',
    "fragility.toml": study_head + speeds + random_speed.replace("train.speed", "train.start")
                      .replace("30.0", "0.0").replace("10.0", "-1.0")
                      + '[sampling]\nsamples = 3\n[probability]\nmethod = "fragility"\nintensity = "train.speed"\n'
                        'measure = "wheel_unloading"\nlimit = 0.01\n',
    "subset.toml": study_head + random_speed + '[probability]\nmethod = "subset"\nmeasure = "wheel_unloading"\n'
                   "limit = 0.01\nsamples = 20\nmost_levels = 2\n",
    "threshold.toml": study_head + speeds + '[[vary]]\nkey = "train.start"\nvalues = [0, 1]\n[threshold]\n'
                      'measure = "wheel_unloading"\nlimit = 0.001\nvariable = "train.speed"\n',
    "peak.toml": study_head + speeds + '[peak]\nmeasure = "wheel_unloading"\ncoarse_step = 2\n',
}


def tiny(name, wheel="S1002", rail="60E1"):
    """A scene that runs twenty steps."""
    return scenes[name].replace("WHEEL", wheel).replace("RAIL", rail) + steps


def entries_of(matrix):
    """Lower triangle (row, column) -> value and size of a symmetric Matrix Market file."""
    lines = [line.split() for line in matrix.read_text().splitlines() if line and not line.startswith("%")]
    entries = {}
    for row, column, value in lines[1:]:
        low, high = sorted((int(row), int(column)))
        entries[high, low] = float(value)
    return entries, int(lines[0][0])


def harwell_boeing(entries, size):
    columns = [sorted(row for row, column in entries if column == j) for j in range(1, size + 1)]
    starts = [1 + sum(map(len, columns[:j])) for j in range(size + 1)]
    rows = [row for column in columns for row in column]
    values = [entries[row, j + 1] for j, column in enumerate(columns) for row in column]

    def cards(items, form, per_line):
        return ["".join(form % item for item in items[i:i + per_line]) for i in range(0, len(items), per_line)]

    parts = [cards(starts, "%8d", 10), cards(rows, "%8d", 10), cards(values, "%20.12E", 4)]
    sizes = [len(part) for part in parts]
    head = ["%-72s%-8s" % ("a bridge", "KEY"), "%14d%14d%14d%14d%14d" % (sum(sizes), *sizes, 0),
            "%-3s%11s%14d%14d%14d%14d" % ("RSA", "", size, size, len(values), 0),
            "%-16s%-16s%-20s" % ("(10I8)", "(10I8)", "(1P,4E20.12)")]
    return "\n".join(head + [line for part in parts for line in part]) + "\n"


def write_bridge(folder):
    """The bridge of the companions in the formats of CalculiX, ANSYS and Abaqus."""
    rows = [line.split(",") for line in (folder / "bridge_dofs.csv").read_text().split()[1:]]
    motions = ["x", "y", "z", "rotx", "roty", "rotz"]
    labels = dict(zip(motions, ["UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"]))
    for name, matrix in (("mass", ".mas"), ("stiffness", ".sti")):
        entries, size = entries_of(folder / f"bridge_{name}.mtx")
        (folder / f"bridge{matrix}").write_text(
            "".join(f"{c} {r} {value!r}\n" for (r, c), value in sorted(entries.items())))
        (folder / f"bridge_{name[0] if name == 'mass' else 'k'}.matrix").write_text(harwell_boeing(entries, size))
        names = [f"{node},{motions.index(motion) + 1}" for _, node, motion in rows]
        (folder / f"bridge_{'MASS' if name == 'mass' else 'STIF'}1.mtx").write_text(
            "".join(f"{names[r - 1]}, {names[c - 1]}, {value:.15e}\n" for (r, c), value in sorted(entries.items())))
    (folder / "bridge.dof").write_text("".join(f"{node}.{motions.index(motion) + 1}\n" for _, node, motion in rows))
    (folder / "bridge_k.mapping").write_text(
        "  Matrix Eqn     Node      DOF\n\n"
        + "".join(f"{row:>11}{node:>9}{labels[motion]:>11}\n" for row, node, motion in rows))
    deck = (folder / "bridge_nodes.inp").read_text().splitlines()
    (folder / "bridge_nodes.txt").write_text("".join(f"{line}\n" for line in deck if line[:1].isdigit() and
                                                     line.count(",") == 3))


def write_profiles(folder, wheel, rail):
    """Outlines (y, z) [m] of wheel and rail in every format of profile files."""
    for kind, extension, outline in ((1, "prw", wheel), (0, "prr", rail)):
        points = "".join(f"    {1e3 * y:.5f} {1e3 * z:.5f} 1.0\n" for y, z in outline)
        (folder / f"p.{extension}").write_text(
            f"header.begin\n  version = 1\n  type = {kind} ! kind\nheader.end\nspline.begin\n  units.len.f = 1000\n"
            f"  point.dist.min = 0.01\n  shift.y = 0\n  mirror.y = 0\n  rotate = 0\n  point.begin\n{points}"
            "  point.end\nspline.end\n")
    for name, sign, outline in (("p.whl", 1, wheel), ("p.ban", -1, rail)):
        points = "".join(f"{sign * 1e3 * y:.5f} {-1e3 * z:.5f} 0.0 0.0\n" for y, z in outline)
        (folder / name).write_text(f"Filename={name}\nXYPoints={len(outline)}\nXOffset=0.0\nYOffset=0.0\n"
                                   f"ColumnDef=X,Y,A,C\n\n{points}")
    for name, outline in (("wheel.txt", wheel), ("rail.txt", rail)):
        (folder / name).write_text("# units: mm\n" + "".join(f"{1e3 * y:.5f}  {1e3 * z:.5f}\n" for y, z in outline))


def thinned(y, z, most=90):
    every = max(1, len(y) // most)
    return list(zip(y, z))[::every]


# The least that tablegen loaded makes.
loaded_options = ["--lateral", "-0.0002:0.0002", "--yaw", "0.001", "--roll", "-0.0005:0.0005", "--climb", "0.2", "--levels", "5", "--elements",
                  "8", "--force-error", "0.1", "--light-error", "0.1"]


def write_base(folder: Path, vsi, tablegen, run):
    """All files that scenes name. `run` runs a command in the folder and ends the campaign where it fails."""
    folder.mkdir(parents=True)
    for file in (root / "tests/fuzz/companions").iterdir():
        shutil.copy(file, folder / file.name)
    shutil.copy(root / "tests/fuzz/seeds/clauses/client.toml", folder / "clauses.toml")
    for name, text in texts.items():
        (folder / name).write_text(text)
    for name, text in studies.items():
        (folder / name).write_text(text)
    for name in scenes:
        (folder / f"{name}.toml").write_text(tiny(name))
    os.mkfifo(folder / "fifo")
    write_bridge(folder)
    pair = ["--wheel", "cone-1:20", "--rail", "60E1", "--yaw", "0:0", "--tolerance", "1e-5", "-q"]
    run([tablegen, "geometry", *pair, "--lateral", "-0.0005:0.0005", "-o", "pair.h5"])
    for part in (1, 2):
        run([tablegen, "geometry", *pair, "--lateral", "-0.0002:0.0002", "--shard", f"{part}/2", "-o",
             f"part{part}.h5"])
    shutil.copy(folder / "pair.h5", folder / "loaded.h5")
    run([tablegen, "loaded", "loaded.h5", *loaded_options, "-q"])
    run([tablegen, "creep", "--nodes", "5,5,5,5", "--elements", "8", "-q", "-o", "creep.h5"])
    run([vsi, "run", "online.toml", "-q", "-o", "results.h5"])
    import h5py
    with h5py.File(folder / "results.h5") as results:
        header = results["header"]
        write_profiles(folder, thinned(header["wheel_y"][:], header["wheel_z"][:]),
                       thinned(header["rail_y"][:], header["rail_z"][:]))


# Keys of scenes, with their values, as the guide lists them.
row = re.compile(r"^\| (`[^|]+`) \| ([^|]*) \| ([^|]*) \|")


def scene_keys():
    keys = []
    for line in (root / "docs/guide/scene.md").read_text().splitlines():
        found = row.match(line)
        if found:
            names = re.findall(r"`([\w.]+)`", found.group(1))  # `track.rail.Iy`, `.Iz`
            start = names[0].rpartition(".")[0] if names else ""
            keys += [(start + name if name.startswith(".") else name, found.group(2).strip()) for name in names]
    return keys


def permitted(random, values, inside=False):
    """A value of this key, at or near the ends of its range, or within; None where the guide names no range."""
    number = r"[-\d.e+]+"
    found = re.search(rf"({number})…({number})", values)
    span = re.search(rf"±({number})", values)
    if found or span:
        low, high = (float(found.group(1)), float(found.group(2))) if found else (-float(span.group(1)),
                                                                                  float(span.group(1)))
        if values.startswith("integer"):
            low, high = int(low), int(high)
            near = [low, high, min(high, low + 1), random.randint(low, min(high, low + 10))]
            return str(random.choice(near if inside else [*near, low - 1, high + 1]))
        within = low + (high - low) * random.random() ** random.choice((1, 3, 9))
        if low > 0 or (low == 0 and random.random() < 0.5):
            within = max(low, 1e-12) * (high / max(low, 1e-12)) ** random.random()
        near = [low, high, within, within, within, within]
        new = random.choice(near if inside else [*near, low - 1e-9 * abs(low), 1.000001 * high, -within])
        return f"[{new!r}, {new!r}, 0.5]" if values.startswith("point") else repr(new)
    names = [word for word in re.split(r"[, ]+", values) if re.fullmatch(r"[a-zA-Z][\w-]*", word)]
    if values in ("file", "text", "list of texts") or not names:
        return None
    name = random.choice(names)
    return name if name in ("true", "false") else f'"{name}"'
