"""Origin of vehicle_modes.csv: the first eight natural motions of every vehicle of the library on standing wheelsets.

An own assembly after docs/file_formats/vehicle.md and the energies of docs/theory/vehicle.md. Nothing here is taken from
railtab but the vehicles' files. The undamped frequencies are those of masses on springs alone; the others are those
of the linear vehicle with dampers (in series with their stiffnesses) under its weight: |lambda|/2 pi and -Re lambda/|lambda|.

    python3 vehicle_modes.py ../../runtime/vehicle/library > vehicle_modes.csv
"""
import pathlib
import sys
import tomllib

import numpy as np

G, MODES = 9.81, 8
X, Y, Z, ROLL, PITCH, YAW = range(6)


def plain(node):
    """A table without provenance: { value = 1.0, ... } is 1.0."""
    if isinstance(node, dict):
        return plain(node["value"]) if "value" in node else {key: plain(value) for key, value in node.items()}
    return [plain(entry) for entry in node] if isinstance(node, list) else node


class Vehicle:
    """Bodies by name, and units that join two of them at a point. z counts down, from the rail-head tops."""

    def __init__(self, data):
        self.vertical = data.get("motion") == "vertical"
        self.radius = data["nominal_radius"]
        self.bodies, self.units = {}, []
        if "template" in data:
            self.two_bogie(data)
        else:
            self.body("car-body", data["car_body"].get("x", 0.0), data["car_body"])
            for section in data.get("body", []):
                self.further_body(section)
            for w, x in enumerate(data["wheelset"]["x"]):
                self.wheelset(w, x)
        for section in data.get("connection", []):
            self.connection(section)

    def z(self, height):
        return -(self.radius if self.vertical else height)

    def body(self, name, x, section, y=0.0):
        J = [section.get(key, 1.0) for key in ("Jx", "Jy", "Jz")]
        position = np.array([x, y, self.z(section.get("height", self.radius))])
        self.bodies[name] = (position, np.array([section["mass"]] * 3 + J))

    def wheelset(self, w, x):
        self.bodies[f"wheelset-{w + 1}"] = (np.array([x, 0.0, -self.radius]), None)  # stands

    def unit(self, a, b, point, section, turning=(0.0, 0.0, 0.0)):
        self.units.append((a, b, np.array(point), section, np.array(turning), section.get("couple_share", 0.5)))

    def two_bogie(self, data):
        layout, primary, secondary = data["layout"], data["primary"], data["secondary"]
        self.body("car-body", 0.0, data["car_body"])
        axles, wheelset = layout.get("axles_per_bogie", 2), 0
        bending = secondary.get("bending", 0.0)
        rolling = bending + 0.5 * data.get("roll_bar", {}).get("stiffness", 0.0)
        for number, sign in ((1, 1.0), (2, -1.0)):
            bogie, x = f"bogie-{number}", sign * layout["half_bogie_distance"]
            self.body(bogie, x, data["bogie"])
            for offset in ((1.0, -1.0) if axles == 2 else (1.0, 0.0, -1.0)):
                at = x + offset * layout["half_wheelbase"]
                self.wheelset(wheelset, at)
                wheelset += 1
                for side in (-1.0, 1.0):
                    self.unit(f"wheelset-{wheelset}", bogie,
                              (at, side * primary.get("half_distance", 1.0), -self.radius), primary)
            for side in (-1.0, 1.0):
                self.unit(bogie, "car-body", (x, side * secondary.get("half_distance", 1.0),
                                              self.z(secondary.get("height", 0.0))), secondary,
                          (rolling, bending, 0.0))

    def further_body(self, section):
        xs = section["x"] if isinstance(section["x"], list) else [section["x"]]
        for i, x in enumerate(xs):
            name = section["name"] + (f"-{i + 1}" if len(xs) > 1 else "")
            y = section.get("y", 0.0)
            if section.get("both_sides"):
                self.body(name + "-left", x, section, -y)
                self.body(name + "-right", x, section, y)
            else:
                self.body(name, x, section, y)

    def connection(self, section):
        both = section.get("both_sides", False)
        for first, second in section["joins"]:
            for side, word in ((-1.0, "left"), (1.0, "right")) if both else ((1.0, None),):
                a, b = (name.replace("*", word) if word else name for name in (first, second))
                x = self.bodies[a][0][0] + section.get("x", 0.0)
                self.unit(a, b, (x, side * section.get("y", 0.0), self.z(section.get("height", self.radius))), section,
                          [section.get(key, 0.0) for key in ("k_roll", "k_pitch", "k_yaw")])


def assemble(vehicle):
    """Numbers of the free motions by body, M, K, C, the rows of Maxwell elements, and K of the weight."""
    free = {}
    kept = (Z, PITCH) if vehicle.vertical else range(6)
    for name, (_, inertia) in vehicle.bodies.items():
        for motion in kept:
            if inertia is not None and not (name == "car-body" and motion == X):
                free[name, motion] = len(free)
    n = len(free)
    M, K, C, maxwell = np.zeros(n), np.zeros((n, n)), np.zeros((n, n)), []
    for (name, motion), row in free.items():
        M[row] = vehicle.bodies[name][1][motion]

    def displacement(name, point, motion):
        """u + theta x r of a body's point for a unit motion, and theta."""
        u, theta = np.zeros(3), np.zeros(3)
        (u if motion < 3 else theta)[motion % 3] = 1.0
        return u + np.cross(theta, point - vehicle.bodies[name][0]), theta

    kinematics = []
    for a, b, point, section, turning, _ in vehicle.units:
        e, turn = np.zeros((3, n)), np.zeros((3, n))
        for name, sign in ((a, -1.0), (b, 1.0)):
            for motion in range(6):
                if (name, motion) in free:
                    u, theta = displacement(name, point, motion)
                    e[:, free[name, motion]] += sign * u
                    turn[:, free[name, motion]] += sign * theta
        kinematics.append(e)
        for axis, letter in enumerate("xyz"):
            row = e[axis]
            K += section.get("k" + letter, 0.0) * np.outer(row, row)
            K += turning[axis] * np.outer(turn[axis], turn[axis])
            c = section.get("c" + letter, 0.0)
            if "damper_curve_" + letter in section and "c" + letter not in section:
                speed, force = section["damper_curve_" + letter][0]
                c = force / speed
            series = section.get("series_k" + letter, 0.0)
            if series > 0.0:
                maxwell.append((row, series, c))
            else:
                C += c * np.outer(row, row)

    weight = np.zeros(n)
    for (name, motion), row in free.items():
        if motion == Z:
            weight[row] = G * vehicle.bodies[name][1][Z]
    rest = np.linalg.solve(K, weight)
    return free, M, K, C, maxwell, weight_stiffness(vehicle, free, kinematics, rest)


def weight_stiffness(vehicle, free, kinematics, rest):
    """Second derivatives of (V1), whose axes turn with theta_m = (1 - lambda) theta_a + lambda theta_b."""
    n = len(free)
    K = np.zeros((n, n))
    for (a, b, point, section, _, share), e_row in zip(vehicle.units, kinematics):
        force = np.array([section.get("k" + letter, 0.0) for letter in "xyz"]) * (e_row @ rest)
        if not force.any():
            continue
        share = np.full(3, share)
        if vehicle.bodies[a][1] is None:
            share[1] = 1.0  # about a wheelset's axle the other body takes the whole couple
        arms = [point - vehicle.bodies[name][0] for name in (a, b)]
        rows = [free[name, motion] for name in (a, b) for motion in range(6) if (name, motion) in free]

        def V(q):
            theta = [np.array([q[free[name, m]] if (name, m) in free else 0.0 for m in (ROLL, PITCH, YAW)])
                     for name in (a, b)]
            second = [0.5 * np.cross(t, np.cross(t, r)) for t, r in zip(theta, arms)]
            mean = (1.0 - share) * theta[0] + share * theta[1]
            return force @ (second[1] - second[0] - np.cross(mean, e_row @ q))

        unit = np.eye(n)
        alone = {i: V(unit[i]) for i in rows}
        for i in rows:
            for j in rows:
                K[i, j] += V(unit[i] + unit[j]) - alone[i] - alone[j]
    return K


def natural_motions(vehicle):
    _, M, K, C, maxwell, Kg = assemble(vehicle)
    scale = 1.0 / np.sqrt(M)
    undamped = np.sqrt(np.linalg.eigvalsh(scale[:, None] * K * scale)) / (2.0 * np.pi)
    n, m = len(M), len(maxwell)
    A = np.zeros((2 * n + m, 2 * n + m))  # of u, du/dt and the forces q of the Maxwell elements
    A[:n, n:2 * n] = np.eye(n)
    A[n:2 * n, :n] = -(K + Kg) / M[:, None]
    A[n:2 * n, n:2 * n] = -C / M[:, None]
    for i, (row, series, c) in enumerate(maxwell):
        A[n:2 * n, 2 * n + i] = -row / M
        A[2 * n + i, n:2 * n] = series * row
        A[2 * n + i, 2 * n + i] = -series / c
    values = np.linalg.eigvals(A)
    values = sorted(values[values.imag >= 0.0], key=abs)
    count = min(MODES, n)
    return [(undamped[k], abs(values[k]) / (2.0 * np.pi), -values[k].real / abs(values[k])) for k in range(count)]


print("# First natural motions of the library's vehicles on standing wheelsets, by tests/reference/vehicle_modes.py.")
print("# undamped: masses on springs alone; the others with dampers and under the weight.")
print("vehicle,mode,undamped_hz,hz,damping_ratio")
for path in sorted(pathlib.Path(sys.argv[1]).glob("*.toml")):
    with open(path, "rb") as stream:
        vehicle = Vehicle(plain(tomllib.load(stream)))
    for mode, row in enumerate(natural_motions(vehicle)):
        print(f"{path.stem},{mode + 1}," + ",".join(f"{value:.9g}" for value in row))
