#!/usr/bin/env python3
"""The example hunting against the kinematics of a free wheelset: hunting_test.py KINEMATIC_WAVELENGTH

The wheel is a cone of 1:20. At low speed the wheelset follows the wave of Klingel, whose length kinematic_wavelength
finds from the table without forces. The kinematic wave knows neither spin nor gravity nor the elastic approach: the wave
of the example is longer by 0.2 %. Without the roll of the wheelset the kinematic wave would be shorter by 1.5 %. At
higher speed inertia lets the wave grow: the logarithm of the ratio of successive amplitudes is in proportion to the
square of the speed, as in linear theory of a free wheelset at speeds at which inertia is small beside creep forces."""
import math
import re
import sys
import tempfile

from environment import TABLES, build, run

TABLE = TABLES / "cone_60e1.h5"


def waves(program, speed, distance=60):
    """Wavelengths and amplitudes [m] of half-waves in turn."""
    text = run(program, TABLE, str(speed), str(distance))
    found = [(float(length), 1e-3 * float(amplitude))
             for length, amplitude in re.findall(r"wavelength (\S+) m, amplitude (\S+) mm", text)]
    assert len(found) >= 5, text
    return found


def growth(program, speed):
    """Mean growth of the amplitude per half-wave, logarithmic."""
    found = waves(program, speed)
    return math.log(found[-1][1] / found[0][1]) / (len(found) - 1)


def main():
    with tempfile.TemporaryDirectory() as folder:
        (program,) = build(folder, "hunting.c")
        kinematic = float(run(sys.argv[1], TABLE, "2.5e-3"))
        slow = waves(program, 10)
        print(f"wavelength {slow[-1][0]} m, kinematic {kinematic:.4f} m")
        assert all(abs(length / kinematic - 1.0) < 3e-3 for length, _ in slow), slow
        at_rest, at_15, at_30 = (growth(program, speed) for speed in (2, 15, 30))
        print(f"growth per half-wave at 2, 15, 30 m/s: {at_rest:.5f}, {at_15:.5f}, {at_30:.5f}")
        assert abs(at_rest) < 1e-3
        assert at_30 > 0.05
        assert abs(at_30 / at_15 - 4.0) < 0.4
    return 0


if __name__ == "__main__":
    sys.exit(main())
