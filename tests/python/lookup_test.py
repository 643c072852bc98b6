#!/usr/bin/env python3
"""Look-ups from Python against the commands, derivatives against differences, wrong input, threads."""
import threading
import unittest

from environment import LOADED_TABLE, TABLE, FolderTest, columns, numbers, vsi

import numpy
import railtab

RANDOM = numpy.random.default_rng(1)


def poses(count, lateral, yaw, roll):
    return {
        "y": RANDOM.uniform(*lateral, count),
        "yaw": RANDOM.uniform(-yaw, yaw, count),
        "roll": RANDOM.uniform(-roll, roll, count),
    }


def write_queries(file, **query):
    names = list(query)
    with open(file, "w") as text:
        text.write(",".join(names) + "\n")
        for row in zip(*query.values()):
            text.write(",".join(repr(float(value)) for value in row) + "\n")


class Contacts(FolderTest):
    """The same numbers as vsi contact, to the last bit."""

    def check_patches(self, table, file, query, **by):
        write_queries("q.csv", **query, **by)
        vsi("contact", file, "--query", "q.csv", "-o", "r.csv", "-q")
        expected = columns("r.csv")
        found = table.contacts(query["y"], roll=query["roll"], yaw=query["yaw"], **by)
        self.assertGreater(len(found), 0)
        same = [name for name in found.dtype.names if name in expected]
        self.assertGreaterEqual(len(same), 13)
        for name in same:
            numpy.testing.assert_array_equal(found[name], numbers(expected[name]), name)
        self.assertEqual(["table" if t else "online" for t in found["from_table"]], expected["source"])

    def check_totals(self, table, file, query, **by):
        write_queries("q.csv", **query, **by)
        vsi("contact", file, "--query", "q.csv", "-o", "t.csv", "--total", "-q")
        expected = columns("t.csv")
        found = table.rail_force(query["y"], roll=query["roll"], yaw=query["yaw"], **by)
        for i, name in enumerate(("fy", "fz", "mx")):
            numpy.testing.assert_array_equal(found[:, i], numbers(expected[name]), name)

    def test_patches_and_forces_of_a_table(self):
        table = railtab.GeometryTable.open(TABLE)
        self.assertFalse(table.info["loaded"])
        query = poses(200, (-0.006, 0.006), 0.003, 0.001)  # beyond its range, too
        query["roll"][:150] = 0.0
        dz = RANDOM.uniform(0.0, 2e-4, 200)
        self.check_patches(table, TABLE, query, dz=dz)
        self.check_totals(table, TABLE, query, dz=dz)
        self.check_totals(table, TABLE, query, load=RANDOM.uniform(1e3, 1.5e5, 200))

    def test_patches_and_forces_of_a_loaded_table(self):
        table = railtab.GeometryTable.open(LOADED_TABLE)
        self.assertTrue(table.info["loaded"])
        query = poses(100, (-0.0035, -0.0015), 0.0, 0.0)  # beyond its range, too
        dz = RANDOM.uniform(0.0, 1e-4, 100)
        self.check_patches(table, LOADED_TABLE, query, dz=dz)
        self.check_totals(table, LOADED_TABLE, query, dz=dz)

    def test_online_search(self):
        table = railtab.GeometryTable.open(TABLE)
        search = railtab.ContactSearch(railtab.Profile.wheel("S1002"), railtab.Profile.rail("60E1"))
        query = poses(100, (-0.006, 0.006), 0.004, 0.001)
        for online in (search, table.online()):
            found = online.contacts(query["y"], 1e-4, roll=query["roll"], yaw=query["yaw"])
            self.assertFalse(found["from_table"].any())
            of_table = table.contacts(query["y"], 1e-4, roll=query["roll"], yaw=query["yaw"])
            numpy.testing.assert_allclose(found["penetration"], of_table["penetration"], atol=1e-8)

    def test_hertz_where_there_is_no_loaded_part(self):
        """Normal forces of patches carry the load, and the pressure is Hertz's of force and semi-axes."""
        table = railtab.GeometryTable.open(TABLE)
        rows = table.contacts([0.0, -0.002, 0.002], load=8e4)
        for query in range(3):
            of = rows[rows["query"] == query]
            # it acts along the normal at the centre of the overlap, whose angle is nearly that of the deepest pair
            self.assertAlmostEqual((of["normal_force"] * numpy.cos(of["angle"])).sum(), 8e4, delta=8e4 * 1e-3)
        numpy.testing.assert_allclose(
            rows["pressure"], 1.5 * rows["normal_force"] / (numpy.pi * rows["a"] * rows["b"]), rtol=1e-12
        )

    def test_heights(self):
        table = railtab.GeometryTable.open(TABLE)
        y = numpy.linspace(-0.005, 0.005, 11)
        touch = table.height(y)
        numpy.testing.assert_array_equal(table.height(y, dz=1e-4), touch + 1e-4)
        loaded = table.height(y, load=6e4)
        self.assertTrue((loaded > touch).all())
        numpy.testing.assert_allclose(table.rail_force(y, z=loaded)[:, 1], 6e4, rtol=1e-9)


class Broadcasting(unittest.TestCase):
    def test_shapes(self):
        table = railtab.GeometryTable.open(TABLE)
        y, dz = numpy.linspace(-3e-3, 3e-3, 4), numpy.array([[5e-5], [1e-4], [2e-4]])
        force = table.rail_force(y, dz, yaw=1e-3)
        self.assertEqual(force.shape, (3, 4, 3))
        for i in range(3):
            for k in range(4):
                numpy.testing.assert_array_equal(force[i, k], table.rail_force(y[k], dz[i, 0], yaw=1e-3))
        self.assertEqual(table.rail_force(0.0, 1e-4).shape, (3,))
        self.assertEqual(table.contacts([], []).shape, (0,))
        numpy.testing.assert_array_equal(table.rail_force(y[::-1], 1e-4), table.rail_force(y, 1e-4)[::-1])
        numpy.testing.assert_array_equal(
            table.rail_force(numpy.float32(1e-3), 1e-4), table.rail_force(float(numpy.float32(1e-3)), 1e-4)
        )

    def test_wrong_input(self):
        table = railtab.GeometryTable.open(TABLE)
        wrong = self.assertRaisesRegex
        with wrong(railtab.InputError, "contacts: found y = nan .number 1 in memory., expected finite"):
            table.contacts([0.0, numpy.nan], 1e-4)
        with wrong(railtab.InputError, "query 1: found dz = -1e-05, expected 0 to 0.01 m below first"):
            table.rail_force(0.0, [0.0, -1e-5])
        with wrong(railtab.InputError, "contacts: found 2 of dz, z and load, expected one"):
            table.contacts(0.0, 1e-4, load=1e4)
        with wrong(railtab.InputError, "where wheel and rail never meet"):
            table.contacts(0.3, 1e-4)
        with wrong(railtab.InputError, "query 0: found load = 0, expected above 0"):
            table.contacts(0.0, load=0)
        with wrong(ValueError, "shape mismatch|could not be broadcast"):
            table.contacts([0.0, 1.0], [0.0, 1e-4, 2e-4])
        with wrong(railtab.InputError, "absent.h5"):
            railtab.GeometryTable.open("absent.h5")
        self.assertTrue(issubclass(railtab.InputError, ValueError))
        self.assertTrue(issubclass(railtab.ComputationError, RuntimeError))

    def test_other_threads_run_meanwhile(self):
        table = railtab.GeometryTable.open(TABLE)
        count, stop = 0, threading.Event()

        def work():
            nonlocal count
            while not stop.is_set():
                count += 1

        other = threading.Thread(target=work)
        other.start()
        y = numpy.linspace(-5e-3, 5e-3, 100_000)
        before = count
        table.rail_force(y, 1e-4)
        during = count - before
        stop.set()
        other.join()
        self.assertGreater(during, 1000)

    def test_threads_share_a_table(self):
        table = railtab.GeometryTable.open(TABLE)
        y = numpy.linspace(-5e-3, 5e-3, 20_000)
        expected, found = table.rail_force(y, 1e-4), [None, None]

        def work(i):
            found[i] = table.rail_force(y, 1e-4)

        threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for of in found:
            numpy.testing.assert_array_equal(of, expected)


class Wheels(unittest.TestCase):
    def contact(self, file):
        self.table = railtab.GeometryTable.open(file)
        return railtab.WheelContact(self.table, speed=55.0, friction=0.3)

    def test_without_friction_the_force_is_that_of_the_look_up(self):
        for file in (TABLE, LOADED_TABLE):
            table = railtab.GeometryTable.open(file)
            contact = railtab.WheelContact(table, speed=1.0, friction=0.0)
            y = numpy.linspace(-2.8e-3, -2.2e-3, 9)
            z = table.height(y, load=7e4)
            force = contact.force(railtab.displacement(y, z))
            numpy.testing.assert_allclose(force[:, 6:], table.rail_force(y, z=z), rtol=1e-10)
            numpy.testing.assert_allclose(force[:, 1:3], -force[:, 6:8], rtol=1e-9, atol=1e-6)

    def test_the_left_wheel_is_the_mirror_image(self):
        contact = self.contact(TABLE)
        y, yaw = numpy.linspace(-4e-3, 4e-3, 9), 1e-3
        z = self.table.height(y, load=6e4, yaw=yaw)
        mirror = numpy.array([1, -1, 1, -1, 1, -1, -1, 1, -1])
        right = contact.force(railtab.displacement(y, z, yaw=yaw))
        left = contact.force(railtab.displacement(-y, z, yaw=-yaw), side="left")
        numpy.testing.assert_allclose(left, right * mirror, rtol=1e-9, atol=1e-6)

    def test_tangents_are_derivatives(self):
        """Of wheelset and rail, with velocities that follow, against central differences of the force."""
        for file in (TABLE, LOADED_TABLE):
            contact = self.contact(file)
            q = railtab.displacement(-2.5e-3, self.table.height(-2.5e-3, load=7e4))
            v, rail, rail_v = numpy.zeros(6), numpy.zeros(3), numpy.zeros(3)
            rate = 500.0
            force, tangent = contact.force_and_tangent(q, v, rail, rail_v, velocity_rate=rate)
            alone = contact.force(q, v, rail, rail_v)
            numpy.testing.assert_allclose(force, alone, rtol=1e-12, atol=1e-12 * numpy.abs(alone).max())
            step = 1e-8
            for k in range(9):
                if k == 5 and file == LOADED_TABLE:
                    continue  # made for yaw 0 alone: a difference leaves it
                e = step * numpy.eye(9)[k]
                more, less = (
                    contact.force(q + s * e[:6], v + s * rate * e[:6], rail + s * e[6:], rail_v + s * rate * e[6:])
                    for s in (1, -1)
                )
                difference = (more - less) / (2 * step)
                # the tangent leaves the loads as they are while the rail rolls
                largest = numpy.abs(difference).max()
                numpy.testing.assert_allclose(
                    tangent[:, k], difference, rtol=0, atol=4e-3 * largest, err_msg=f"{file.name} {k}"
                )

    def test_wrong_input(self):
        table = railtab.GeometryTable.open(LOADED_TABLE)
        wrong = self.assertRaisesRegex
        with wrong(railtab.InputError, "WheelContact: found speed = 0, expected above 0"):
            railtab.WheelContact(table, speed=0.0)
        with wrong(railtab.InputError, "that of the table's loaded part"):
            railtab.WheelContact(table, speed=1.0, young=100e9)
        with wrong(railtab.InputError, "creep law"):
            railtab.WheelContact(table, speed=1.0, law="unknown")
        contact = railtab.WheelContact(table, speed=1.0)
        with wrong(railtab.InputError, "wheelset of another shape, expected 6 numbers along its last axis"):
            contact.force([0.0, 0.0, 0.0])
        with wrong(railtab.InputError, "the side \"middle\", expected right or left"):
            contact.force(numpy.zeros(6), side="middle")


class Creep(FolderTest):
    def test_laws_are_those_of_the_command(self):
        n = 100
        query = {
            "ratio": numpy.exp(RANDOM.uniform(-3, 3, n)),
            "ux": RANDOM.normal(size=n),
            "uy": RANDOM.normal(size=n),
            "phi": RANDOM.normal(size=n),
        }
        write_queries("q.csv", **query)
        for name in ("table", "polach", "fastsim", "linear"):
            vsi("creep", "--law", name, "--query", "q.csv", "-o", "r.csv", "-q")
            expected = columns("r.csv")
            law = railtab.CreepLaw(name)
            self.assertEqual(law.name, name)
            force = law.force(**query)
            for i, column in enumerate(("fx", "fy", "mz")):
                numpy.testing.assert_array_equal(force[:, i], numbers(expected[column]))
            of_jet, derivative = law.jet(**query)
            numpy.testing.assert_array_equal(of_jet, force)
            self.assertEqual(derivative.shape, (n, 3, 4))

    def test_the_table_is_its_law_inside(self):
        creep, law = railtab.CreepTable.open(), railtab.CreepLaw("table")
        self.assertEqual(creep.info["poisson"], 0.28)
        query = (numpy.array([0.5, 1.0, 2.0]), 0.7, -0.2, 0.3)
        force, derivative, inside = creep.lookup(*query)
        self.assertTrue(inside.all())
        numpy.testing.assert_array_equal(law.table_share(*query), 1.0)
        numpy.testing.assert_array_equal(force, law.force(*query))
        step = 1e-6
        for k in range(4):
            change = numpy.eye(4)[k] * step
            more, less = (creep.lookup(*(q + s * c for q, c in zip(query, change)))[0] for s in (1, -1))
            numpy.testing.assert_allclose(derivative[:, :, k], (more - less) / (2 * step), atol=1e-7)
        self.assertFalse(creep.lookup(1e5, 0, 0, 0)[2])

    def test_linear_theory(self):
        """The slope of every law at zero creepage is Kalker's c11, c22, c23 (times a/b = 1 of the unit ellipse)."""
        c11, c22, c23, _ = railtab.kalker_coefficients(1.0)
        _, slope = railtab.CreepLaw("linear").jet(1.0, 0.0, 0.0, 0.0)
        numpy.testing.assert_allclose([slope[0, 1], slope[1, 2], slope[1, 3]], [-c11, -c22, -c23], rtol=1e-6)

    def test_wrong_input(self):
        with self.assertRaisesRegex(railtab.InputError, "query 0: found ratio = 0, expected a/b > 0"):
            railtab.CreepLaw().force(0.0, 0, 0, 0)
        with self.assertRaisesRegex(railtab.InputError, "for Poisson's ratio 0.28"):
            railtab.CreepLaw("table", nu=0.4)


class Profiles(FolderTest):
    def test_standard_profiles(self):
        self.assertIn("S1002", railtab.standard_profiles("wheel"))
        rail = railtab.Profile.rail("60E1", inclination=1 / 40)
        top = rail.s[numpy.argmin(rail.z)]
        self.assertAlmostEqual(rail.curvature(top), 1 / 0.3, delta=1e-3)  # the head's arc of 300 mm
        numpy.testing.assert_allclose(rail.points(rail.s), numpy.stack([rail.y, rail.z], axis=1), atol=1e-15)
        with self.assertRaisesRegex(railtab.InputError, "points: found s = 1 m"):
            rail.points(1.0)

    def test_a_file(self):
        cone = railtab.Profile.wheel("cone-1:20")
        with open("cone.txt", "w") as file:
            file.write("# units: m\n")
            for y, z in cone.points(numpy.linspace(cone.s[0], cone.s[-1], 400)):
                file.write(f"{float(y)!r} {float(z)!r}\n")
        read = railtab.Profile.wheel("cone.txt")
        self.assertEqual((read.name, read.kind), ("cone.txt", "wheel"))
        middle = 0.5 * (read.s[0] + read.s[-1])
        self.assertAlmostEqual(read.s[-1] - read.s[0], cone.s[-1] - cone.s[0], delta=1e-4)
        self.assertEqual(read.points(middle).shape, (2,))
        with self.assertRaisesRegex(railtab.InputError, "absent.txt"):
            railtab.Profile.wheel("absent.txt")


if __name__ == "__main__":
    unittest.main()
