"""A TTB-2D case by NumPy and SciPy: banded Cholesky factor of track and bridge kept for the whole run, the wheels' forces
from a small system. Prints JSON: processor time per step [ms], that of its two substitutions alone, and the largest
difference of the midspan's displacement from the reference's, over the largest displacement.

    python3 ttb2d_banded.py FOLDER     a folder of the reference's files: case.json, dofmap.json, *.mtx, *.csv.gz

u is the motion of track and bridge, q that of the cars, up positive. Newmark's average acceleration with

    u'(t+dt) = a2 u - B,   u''(t+dt) = a1 u - A,   S u = M A + C B + N^T f,   S = K + a2 C + a1 M.

A wheel of mass m stays on the rail, at w = N u + h:   f = m (g - w'') - k (w - n q) - c (w' - n q'),   which is linear
in N u, N' u, N'' u and q; these are linear in f.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np
from scipy.io import mmread
from scipy.linalg import lapack
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import reverse_cuthill_mckee

folder = Path(sys.argv[1])
case = json.loads((folder / "case.json").read_text())
dof_map = json.loads((folder / "dofmap.json").read_text())
run = case["run"]
dt, speed, steps, g = run["dt_s"], run["v_mps"], run["num_t"] - 1, run["gravity"]
beta, gamma = run["newmark_beta"], run["newmark_gamma"]
a1, a2, a3 = 1 / (beta * dt**2), gamma / (beta * dt), 1 / (beta * dt)
a4, a5, a6 = 1 / (2 * beta) - 1, 1 - gamma / beta, (1 - gamma / (2 * beta)) * dt


def columns(name):
    file = folder / name
    return np.loadtxt(file, delimiter=",", skiprows=1)[:, 1:] if file.exists() else None


# The cars: body and two bogies, each bounce and pitch.
cars = case["Train"]["Veh"]
cars = cars if isinstance(cars, list) else [cars]
axles = np.concatenate([np.atleast_1d(a) for a in run["axle_offset_from_first_axle_m"]])
wheels, of_car = len(axles), 6
M_v, C_v, K_v = (np.zeros((of_car * len(cars),) * 2) for _ in range(3))
n = np.zeros((wheels, of_car * len(cars)))  # rise of the bogie above each wheel
load_v, k, c, m = np.zeros(of_car * len(cars)), np.zeros(wheels), np.zeros(wheels), np.zeros(wheels)
for number, car in enumerate(cars):
    at, bogies = of_car * number, car["Bogie"]
    M_v[range(at, at + 6), range(at, at + 6)] = [car["Body"]["m"], car["Body"]["I"], bogies["m"][0], bogies["I"][0],
                                                bogies["m"][1], bogies["I"][1]]
    load_v[[at, at + 2, at + 4]] = g * M_v[[at, at + 2, at + 4], [at, at + 2, at + 4]]
    first = axles[4 * number]
    half = 0.5 * (axles[4 * number + 2] - first)  # between the bogies
    for b in range(2):
        row = np.zeros(len(load_v))
        row[[at, at + 1, at + 2 + 2 * b]] = 1.0, (half if b == 0 else -half), -1.0
        K_v += car["Susp"]["Sec"]["k"][b] * np.outer(row, row)
        C_v += car["Susp"]["Sec"]["c"][b] * np.outer(row, row)
    for w in range(4):
        base = 0.5 * (axles[4 * number + 1] - first) * (1 if w % 2 == 0 else -1)
        wheel = 4 * number + w
        n[wheel, [at + 2 + 2 * (w // 2), at + 3 + 2 * (w // 2)]] = 1.0, base
        k[wheel], c[wheel] = car["Susp"]["Prim"]["k"][w], car["Susp"]["Prim"]["c"][w]
        m[wheel] = car["Wheels"]["m"][w]
        K_v += k[wheel] * np.outer(n[wheel], n[wheel])
        C_v += c[wheel] * np.outer(n[wheel], n[wheel])
inverse_v = np.linalg.inv(K_v + a2 * C_v + a1 * M_v)

# Track and bridge, in an order of small bandwidth.
M, C, K = (csr_matrix(mmread(folder / f"{name}.mtx")) for name in ("Mg", "Cg", "Kg"))
order = reverse_cuthill_mckee(csr_matrix(abs(K) + abs(C) + abs(M)), symmetric_mode=True)
position = np.empty_like(order)
position[order] = np.arange(len(order))
M, C, K = (csr_matrix(matrix[order][:, order]) for matrix in (M, C, K))


def banded_factor(matrix):
    entries = matrix.tocoo()
    width = int(np.max(entries.row - entries.col))
    band = np.zeros((width + 1, matrix.shape[0]))
    lower = entries.row >= entries.col
    band[entries.row[lower] - entries.col[lower], entries.col[lower]] = entries.data[lower]
    factor, info = lapack.dpbtrf(band, lower=1)
    assert info == 0
    return factor


def solve(factor, load):
    return lapack.dpbtrs(factor, load, lower=1)[0]


S = banded_factor(csr_matrix(K + a2 * C + a1 * M))
rail = position[np.array(dof_map["rail_vert"]) - 1]
slope = position[np.array(dof_map["rail_vert"])]
rail_x = np.array(dof_map["rail_x"])
length = rail_x[1] - rail_x[0]
midspan = position[dof_map["beam_vert"][len(dof_map["beam_vert"]) // 2] - 1]
# Compliance of the rail's nodes.
rail_dofs = np.column_stack((rail, slope)).ravel()
unit = np.zeros((M.shape[0], len(rail_dofs)))
unit[rail_dofs, np.arange(len(rail_dofs))] = 1.0
H = np.ascontiguousarray(solve(S, unit)[rail_dofs])
del unit


def at_wheels(x):
    """Places in rail_dofs, and N, N', N'', wheels x 4."""
    element = np.minimum((x / length).astype(int), len(rail_x) - 2)
    t = x / length - element
    N = np.array([1 - t * t * (3 - 2 * t), length * t * (1 - t) ** 2, t * t * (3 - 2 * t), -length * t * t * (1 - t)])
    N1 = np.array([-6 * t * (1 - t) / length, (1 - t) * (1 - 3 * t), 6 * t * (1 - t) / length, t * (3 * t - 2)])
    N2 = np.array([(12 * t - 6) / length**2, (6 * t - 4) / length, (6 - 12 * t) / length**2, (6 * t - 2) / length])
    return 2 * element[:, None] + np.arange(4), N.T, N1.T, N2.T


h, hd, hdd = (columns(f"wheel_irregularity_{name}.csv.gz") for name in ("h_m", "hd_mps", "hdd_mps2"))
if h is None:
    h = hd = hdd = np.zeros((steps + 1, wheels))
x0 = run["x_first_axle_t0_m"] - axles

# Static equilibrium: every axle bears its load.
places, N, N1, N2 = at_wheels(x0)
load = np.zeros(M.shape[0])
static = np.concatenate([np.atleast_1d(a) for a in run["static_axle_loads_N"]])
np.add.at(load, rail_dofs[places], static[:, None] * N)
u = solve(banded_factor(K), load)
w = np.sum(N * u[rail_dofs[places]], axis=1)
q = np.linalg.solve(K_v, load_v + n.T @ (k * w))
v, a, q_v, q_a = np.zeros_like(u), np.zeros_like(u), np.zeros_like(q), np.zeros_like(q)

alpha, beta_1, delta = m * a1 + k + c * a2, 2 * speed * m * a2 + c * speed, m * speed**2
k_dynamic = k + c * a2
of_train = n @ inverse_v  # the bogies' rise by loads on the cars
train = of_train @ n.T
middle = np.empty(steps + 1)
middle[0] = u[midspan]
started, of_substitutions = time.process_time(), 0.0
for i in range(1, steps + 1):
    A, B = a1 * u + a3 * v + a4 * a, a2 * u - a5 * v - a6 * a
    A_q, B_q = a1 * q + a3 * q_v + a4 * q_a, a2 * q - a5 * q_v - a6 * q_a
    rhs = M @ A + C @ B
    before = time.process_time()
    free = solve(S, rhs)
    of_substitutions += time.process_time() - before
    places, N, N1, N2 = at_wheels(x0 + speed * i * dt)
    dofs = rail_dofs[places]
    u_w, A_w, B_w = free[dofs], A[dofs], B[dofs]
    N_B = np.sum(N * B_w, axis=1)
    # of the free response: f = known - alpha N u - beta_1 N' u - delta N'' u + k_dynamic n q
    T = alpha[:, None] * N + beta_1[:, None] * N1 + delta[:, None] * N2
    by_rail = k_dynamic[:, None] * N + (c * speed)[:, None] * N1  # what a spring pushes up the bogie
    rough = k * h[i] + c * hd[i]
    load_q = load_v + M_v @ A_q + C_v @ B_q
    pushed = rough - c * N_B
    known = (m * (g - hdd[i] + np.sum(N * A_w, axis=1) + 2 * speed * np.sum(N1 * B_w, axis=1)) - pushed - c * (n @ B_q)
             - np.sum(T * u_w, axis=1)
             + k_dynamic * (of_train @ load_q + train @ (pushed + np.sum(by_rail * u_w, axis=1))))
    # their change by the forces
    pairs = H[places[:, :, None, None], places[None, None]]
    moved = np.einsum("iajb,jb->iaj", pairs, N)
    change = np.einsum("ia,iaj->ij", T, moved) - k_dynamic[:, None] * (train @ np.einsum("ia,iaj->ij", by_rail, moved))
    f = np.linalg.solve(np.eye(wheels) + change, known)
    load = np.zeros_like(rhs)
    np.add.at(load, dofs, f[:, None] * N)
    before = time.process_time()
    u = free + solve(S, load)
    of_substitutions += time.process_time() - before
    q = inverse_v @ (load_q + n.T @ (pushed + np.sum(by_rail * u[dofs], axis=1)))
    v, a = a2 * u - B, a1 * u - A
    q_v, q_a = a2 * q - B_q, a1 * q - A_q
    middle[i] = u[midspan]
took = time.process_time() - started

reference = columns("bridge.csv.gz")[:, 1]
print(json.dumps({"ms_per_step": 1e3 * took / steps, "substitutions_ms": 1e3 * of_substitutions / steps,
                  "difference": float(np.max(np.abs(middle - reference)) / np.max(np.abs(reference)))}))
