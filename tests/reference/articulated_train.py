"""Origin of articulated_train.csv: an own two-dimensional model of the train of docs/examples/articulated on a beam.

Bodies move in x, z and pitch, wheelsets stay on the beam or on rigid rails. The beam is simply supported and undamped,
by its sine modes. Trapezoidal rule. Nothing here is taken from railtab but the numbers of the train's files.

    python3 articulated_train.py ../../docs/examples/articulated > articulated_train.csv
"""
import math
import sys
import tomllib

import numpy as np

FOLDER = sys.argv[1]
LENGTH, EI, MASS, MODES = 20.0, 9.7e9, 15e3, 8
DT, G = 5e-4, 9.81
OMEGA1 = (math.pi / LENGTH) ** 2 * math.sqrt(EI / MASS)
SPEED = OMEGA1 / (2 * math.pi) * 18.7


def load(name):
    with open(f"{FOLDER}/{name}.toml", "rb") as file:
        return tomllib.load(file)


class Train:
    def __init__(self):
        self.bodies, self.units, self.wheelsets, self.cars = [], [], [], []

    def body(self, x, height, mass, J):
        self.bodies.append((x, height, mass, J))
        return len(self.bodies) - 1

    def unit(self, a, b, x, height, k, c, series=0.0):  # k, c: along x and z
        self.units.append((a, b, x, height, k, c, series))


def per(section, sides):
    return ((sides * section.get("kx", 0.0), sides * section.get("kz", 0.0)),
            (sides * section.get("cx", 0.0), sides * section.get("cz", 0.0)), sides * section.get("series_kx", 0.0))


def bogie(train, inertia, height, x, wheelset, half_wheelbase, primary, R):
    frame = train.body(x, height, inertia["mass"], inertia["Jy"])
    for way in (1, -1):
        axle = train.body(x + way * half_wheelbase, R, wheelset["mass"], wheelset["Jy"])
        train.wheelsets.append(axle)
        train.unit(axle, frame, x + way * half_wheelbase, R, *per(primary, 2))
    return frame


def connections(data, name):
    return next(c for c in data["connection"] if c["name"] == name)


train = Train()
power, end, coach, jacobs, coupler = (load(n) for n in ("power-car", "end-coach", "coach", "jacobs-bogie", "coupler"))
kinds = [(power, 1), (end, 1)] + 6 * [(coach, 1)] + [(end, -1), (power, -1)]
centre, x = [], 0.0
for i, (data, way) in enumerate(kinds):
    if i:
        x -= 0.5 * (kinds[i - 1][0]["length"] + data["length"])
    centre.append(x)
for (data, way), x in zip(kinds, centre):
    car = data["car_body"]
    body = train.body(x + way * car.get("x", 0.0), car["height"], car["mass"], car["Jy"])
    train.cars.append(body)
    R = data["nominal_radius"]
    if data is power:
        for side in (1, -1):
            at = x + side * data["layout"]["half_bogie_distance"]
            frame = bogie(train, data["bogie"], data["bogie"]["height"], at, data["wheelset"],
                          data["layout"]["half_wheelbase"], data["primary"], R)
            train.unit(frame, body, at, data["secondary"]["height"], *per(data["secondary"], 2))
            damper = connections(data, "yaw damper")
            train.unit(frame, body, at, damper["height"], *per(damper, 2))
    if data is end:
        frame_data = data["body"][0]
        at = x + way * frame_data["x"]
        frame = bogie(train, frame_data, frame_data["height"], at, data["wheelset"], 1.5,
                      connections(data, "primary suspension"), R)
        for name in ("secondary suspension", "yaw damper"):
            c = connections(data, name)
            train.unit(frame, body, at, c["height"], *per(c, 2))
for i in range(len(kinds) - 1):
    at = centre[i] - 0.5 * kinds[i][0]["length"]
    ahead, behind = train.cars[i], train.cars[i + 1]
    if power in (kinds[i][0], kinds[i + 1][0]):
        c = connections(coupler, "coupler")
        train.unit(ahead, behind, at, c["height"], *per(c, 1))
        continue
    frame_data = jacobs["body"][0]
    frame = bogie(train, frame_data, frame_data["height"], at, jacobs["wheelset"], 1.5,
                  connections(jacobs, "primary suspension"), jacobs["nominal_radius"])
    c = connections(jacobs, "secondary suspension")
    for car in (ahead, behind):
        train.unit(frame, car, at, c["height"], *per(c, 2))
    c = connections(jacobs, "inter-car damper")
    train.unit(ahead, behind, at, c["height"], *per(c, 2))

# matrices over x, z, pitch of each body (pitch about y, which points to the right, x forward, z down), and the springs
# in series with dampers
bodies, series = len(train.bodies), [u for u in train.units if u[6] > 0]
n = 3 * bodies + len(series)
M, K, C = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))
for b, (x, height, mass, J) in enumerate(train.bodies):
    M[3 * b, 3 * b] = M[3 * b + 1, 3 * b + 1] = mass
    M[3 * b + 2, 3 * b + 2] = J
inner = 3 * bodies
for a, b, x, height, k, c, s in train.units:
    rows = np.zeros((2, n))
    for body, sign in ((a, -1.0), (b, 1.0)):
        bx, bh = train.bodies[body][:2]
        rx, rz = x - bx, -(height - bh)  # z is down
        # u + θ × r with θ about y: (θ r_z, −θ r_x)
        rows[0, 3 * body] += sign
        rows[0, 3 * body + 2] += sign * rz
        rows[1, 3 * body + 1] += sign
        rows[1, 3 * body + 2] -= sign * rx
    for axis in range(2):
        e = rows[axis]
        K += k[axis] * np.outer(e, e)
        if s > 0 and axis == 0:
            d = e.copy()
            d[inner] = -1.0
            K[inner, inner] += s
            C += c[axis] * np.outer(d, d)
            inner += 1
        else:
            C += c[axis] * np.outer(e, e)

wheel_z = [3 * w + 1 for w in train.wheelsets]
held = {3 * train.cars[0]} | {3 * w + 2 for w in train.wheelsets}
free = [i for i in range(n) if i not in held and i not in wheel_z]
order = sorted(range(len(wheel_z)), key=lambda w: -train.bodies[train.wheelsets[w]][0])
wheel_z = [wheel_z[w] for w in order]
behind = np.array([train.bodies[train.wheelsets[order[0]]][0] - train.bodies[train.wheelsets[w]][0] for w in order])

# axle loads at rest: wheelsets held in z
weight = np.zeros(n)
for b, (x, height, mass, J) in enumerate(train.bodies):
    weight[3 * b + 1] = mass * G
sag = np.zeros(n)
sag[free] = np.linalg.lstsq(K[np.ix_(free, free)], weight[free], rcond=None)[0]
load = weight[wheel_z] - (K @ sag)[wheel_z]

omega = np.array([(k * math.pi / LENGTH) ** 2 * math.sqrt(EI / MASS) for k in range(1, MODES + 1)])
norm = math.sqrt(2 / (MASS * LENGTH))


def shapes(x, derivative):
    k = np.arange(1, MODES + 1) * math.pi / LENGTH
    on = ((x >= 0) & (x <= LENGTH))[:, None]
    s = np.sin(np.outer(x, k)), k * np.cos(np.outer(x, k)), -k * k * np.sin(np.outer(x, k))
    return norm * s[derivative] * on


Mff, Cff, Kff = (X[np.ix_(free, free)] for X in (M, C, K))
Cfw, Kfw = (X[np.ix_(free, wheel_z)] for X in (C, K))
Mww, Cww, Kww = (X[np.ix_(wheel_z, wheel_z)] for X in (M, C, K))


def crossing(interacts):
    """Midspan displacement and acceleration of car bodies over time."""
    u = len(free) if interacts else 0
    size = u + MODES
    y, v, a = np.zeros(size), np.zeros(size), np.zeros(size)
    steps = int((behind[-1] + 3 * LENGTH) / SPEED / DT)
    result = []
    cars = [free.index(3 * c + 1) for c in train.cars] if interacts else []
    for step in range(steps + 1):
        x = SPEED * step * DT - behind
        phi = shapes(x, 0)
        m, c, k = np.zeros((size, size)), np.zeros((size, size)), np.zeros((size, size))
        if interacts:
            # wheelsets w = Φ q: u_w' = Φ q' + V Φ' q, u_w'' = Φ q'' + 2 V Φ' q' + V² Φ'' q
            phi1, phi2 = SPEED * shapes(x, 1), SPEED**2 * shapes(x, 2)
            m[:u, :u], c[:u, :u], k[:u, :u] = Mff, Cff, Kff
            m[u:, u:] = phi.T @ Mww @ phi
            c[:u, u:], c[u:, :u] = Cfw @ phi, phi.T @ Cfw.T
            k[:u, u:], k[u:, :u] = Kfw @ phi + Cfw @ phi1, phi.T @ Kfw.T
            c[u:, u:] = phi.T @ (2 * Mww @ phi1 + Cww @ phi)
            k[u:, u:] = phi.T @ (Mww @ phi2 + Cww @ phi1 + Kww @ phi)
        for mode in range(MODES):
            m[u + mode, u + mode] += 1.0
            k[u + mode, u + mode] += omega[mode] ** 2
        f = np.zeros(size)
        f[u:] = load @ phi
        if step == 0:
            massive = np.diag(m) > 0
            a[massive] = np.linalg.solve(m[np.ix_(massive, massive)], (f - c @ v - k @ y)[massive])
        else:
            yp, vp = y + DT * v + DT * DT / 4 * a, v + DT / 2 * a
            a = np.linalg.solve(m + DT / 2 * c + DT * DT / 4 * k, f - c @ vp - k @ yp)
            y, v = yp + DT * DT / 4 * a, vp + DT / 2 * a
        mid = np.array([LENGTH / 2])
        result.append([step * DT, float((shapes(mid, 0) @ y[u:])[0])] + [a[i] for i in cars])
    return np.array(result)


with_train, forces = crossing(True), crossing(False)
print("# An articulated train of 10 vehicles (docs/examples/articulated) crosses a simply supported, undamped beam:")
print(f"# L = {LENGTH} m, EI = {EI:g} N m2, {MASS:g} kg/m, at {SPEED!r} m/s = 18.7 m times the first frequency.")
print("# Two-dimensional model of tests/reference/articulated_train.py; the same masses as constant forces beside it.")
print("# Axle loads at rest [N]: " + " ".join(f"{p:.4f}" for p in load))
print("t,u_mid,a_first,a_fifth,u_mid_forces")
for row, force in list(zip(with_train, forces))[::16]:
    print(f"{row[0]:.4f},{row[1]:.9e},{row[2]:.9e},{row[6]:.9e},{force[1]:.9e}")
print(f"peak {np.abs(with_train[:, 1]).max():.6e} forces {np.abs(forces[:, 1]).max():.6e}", file=sys.stderr)
