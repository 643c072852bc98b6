#!/usr/bin/env python3
"""Wheels on stiff contact springs run over the bridge of an FMU of vsi fmu: every step is repeated until forces and
motions agree.

    wheels_on_springs.py TRACK.fmu
"""
import ctypes
import sys

from moving_loads import Slave, unpacked

SPEED = 200 / 3.6      # m/s
Q0 = 60e3              # N, weight that a wheel carries, its own included
MASS = 800.0           # kg, of a wheel
STIFFNESS = 1e9        # N/m, of a contact
TOLERANCE = 1.0        # N


class State:
    """A place for the FMU's state."""

    def __init__(self, track):
        self.track, self.state = track, ctypes.c_void_p()

    def keep(self):
        self.track.call("GetFMUstate", ctypes.byref(self.state))

    def set(self):
        self.track.call("SetFMUstate", self.state)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    track = Slave(unpacked(sys.argv[1]))
    wheels = [name.removesuffix(".Q") for name in track.start if name.endswith(".Q")]
    loads = [f"{wheel}.Q" for wheel in wheels]
    rails = [f"{wheel}.rail_z" for wheel in wheels]
    start = {name: x for name, x in track.start.items() if name.endswith(".x")}
    dt, state = track.time_step, State(track)
    track.begin(dict.fromkeys(loads, Q0))

    def step(time, forces):
        """Rails at t + dt under forces there."""
        track.set({name: x + SPEED * (time + dt) for name, x in start.items()})
        track.set(dict(zip(loads, forces)))
        track.step(time)
        return track.get(rails)

    # wheels begin at rest on their contacts
    position = [z + Q0 / STIFFNESS for z in track.get(rails)]
    velocity, acceleration = [0.0] * len(wheels), [0.0] * len(wheels)
    forces = [Q0] * len(wheels)

    # compliance of the rail within a step, which does not change much along the track
    state.keep()
    under_q0 = step(0.0, forces)
    state.set()
    compliance = (step(0.0, [2 * Q0, *forces[1:]])[0] - under_q0[0]) / Q0
    state.set()

    # Newmark's average acceleration; the slope of the residual in the force is the same for all wheels
    of_wheel = 0.25 * dt * dt / MASS
    slope = 1 + STIFFNESS * (of_wheel + compliance)
    steps, trials, smallest, largest = 0, 0, Q0, Q0
    while min(start.values()) + SPEED * steps * dt < 40.0:
        state.keep()
        predicted = [z + dt * v + 0.25 * dt * dt * a for z, v, a in zip(position, velocity, acceleration)]
        while True:
            under = step(steps * dt, forces)
            trials += 1
            reached = [z + of_wheel * (Q0 - force) for z, force in zip(predicted, forces)]
            exerted = [max(0.0, STIFFNESS * (z - rail)) for z, rail in zip(reached, under)]
            if max(abs(force - of) for force, of in zip(forces, exerted)) < TOLERANCE:
                break
            forces = [force + (of - force) / slope for force, of in zip(forces, exerted)]
            state.set()
        position = reached
        new = [(Q0 - force) / MASS for force in forces]
        velocity = [v + 0.5 * dt * (a + b) for v, a, b in zip(velocity, acceleration, new)]
        acceleration = new
        steps += 1
        smallest, largest = min(smallest, *forces), max(largest, *forces)
    print(f"{steps} steps of {trials / steps:.1f} trials: Q from {1e-3 * smallest:.1f} to {1e-3 * largest:.1f} kN")
    track.free()


if __name__ == "__main__":
    main()
