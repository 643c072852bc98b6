#!/usr/bin/env python3
"""Runs from Python against the command's results, bit for bit; callbacks, resuming, sweeps, results."""
import gc
import os
import signal
import threading
import unittest
import warnings
from pathlib import Path

from environment import FolderTest, vsi

import h5py
import numpy
import railtab


def contents(file):
    """Every dataset and attribute of a results file but the seconds that the run took."""
    items = {}
    with h5py.File(file, "r") as data:

        def add(name, item):
            if isinstance(item, h5py.Dataset):
                items[name] = item[()].tobytes()
            for key, value in item.attrs.items():
                if not key.startswith("seconds"):
                    items[f"{name}@{key}"] = numpy.asarray(value).tobytes()

        data.visititems(add)
        for key, value in data.attrs.items():
            items[f"@{key}"] = numpy.asarray(value).tobytes()
    return items


class Runs(FolderTest):
    def same(self, one, other, but=()):
        first, second = contents(one), contents(other)
        self.assertEqual(set(first), set(second))
        different = [name for name in first if first[name] != second[name] and not name.startswith(tuple(but) or "-")]
        self.assertEqual(different, [])

    def test_results_are_those_of_the_command(self):
        for scene in ("scene.toml", "rigid.toml"):
            vsi("run", scene, "-o", "command.h5", "-q")
            summary = railtab.run(scene, "python.h5")
            self.assertTrue(summary["complete"])
            self.assertEqual(summary["results"], "python.h5")
            self.same("command.h5", "python.h5")
            self.assertGreater(len(contents("python.h5")), 50)

    def test_the_summary_is_the_command_s(self):
        import json

        command = json.loads(vsi("run", "scene.toml", "-o", "command.h5", "--json").splitlines()[0])
        summary = railtab.run("scene.toml")
        for only in ("results", "seconds", "real_time_factor", "warnings"):
            command.pop(only, None)
            summary.pop(only, None)
        self.assertFalse(summary.pop("interrupted"))
        self.assertEqual(summary, command)
        self.assertEqual(sorted(os.listdir()), ["command.h5", "loaded.h5", "rigid.toml", "s1002_60e1.h5", "scene.toml"])

    def test_records_are_those_of_the_results(self):
        records, shares = [], []
        railtab.run("scene.toml", "r.h5", on_step=records.append, on_progress=shares.append)
        gc.collect()  # records are kept, not views of what the run goes on with
        with railtab.open_results("r.h5") as results:
            numpy.testing.assert_array_equal([r.time for r in records], results["time"])
            numpy.testing.assert_array_equal([r.position for r in records], results["position"])
            for name in ("Q", "Y", "X", "angle", "patches", "second_y_rail"):
                numpy.testing.assert_array_equal([r.wheels[name] for r in records], results["wheels/" + name])
            for part in ("bodies", "nodes"):
                for name in ("displacement", "velocity", "acceleration"):
                    found = [getattr(r, part)[name] for r in records]
                    numpy.testing.assert_array_equal(found, results[f"{part}/{name}"])
            self.assertEqual(records[0].body_names, list(results["bodies/names"]))
            self.assertEqual(records[0].node_names, list(results["nodes/names"]))
        wheels = records[3].wheels
        expected = wheels["Q"].copy()
        del records
        gc.collect()
        numpy.testing.assert_array_equal(wheels["Q"], expected)
        self.assertTrue(all(0.0 <= share <= 1.0 for share in shares))

    def test_a_callback_ends_the_run_which_goes_on_later(self):
        railtab.run("rigid.toml", "whole.h5")

        def stop(record):
            if record.time > 0.05:
                raise StopIteration

        def fail(record):
            if record.time > 0.05:
                raise KeyError("mine")

        summary = railtab.run("rigid.toml", "stopped.h5", on_step=stop)
        self.assertTrue(summary["interrupted"])
        self.assertFalse(summary["complete"])
        with self.assertRaisesRegex(KeyError, "mine"):
            railtab.run("rigid.toml", "failed.h5", on_step=fail)
        for file in ("stopped.h5", "failed.h5"):
            with railtab.open_results(file) as results:
                self.assertAlmostEqual(results["time"][-1], 0.051, places=6)
            summary = railtab.run("rigid.toml", file, resume=True)
            self.assertTrue(summary["complete"])
            with railtab.open_results(file) as results, railtab.open_results("whole.h5") as whole:
                numpy.testing.assert_array_equal(results["time"], whole["time"])
                # the step after an end begins its iteration anew: equal within Newton's tolerance
                numpy.testing.assert_allclose(results["wheels/Q"], whole["wheels/Q"], rtol=1e-3)
            before = contents(file)
            self.assertTrue(railtab.run("rigid.toml", file, resume=True)["complete"])
            self.assertEqual(contents(file), before, "complete results are left alone")

    def test_ctrl_c_ends_the_run(self):
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        begun = []
        with self.assertRaises(KeyboardInterrupt):
            railtab.run(
                "rigid.toml", "r.h5", changes={"integration.duration": 1000.0},
                on_step=lambda record: begun or (begun.append(True), timer.start()),
            )
        timer.join()
        self.assertTrue(railtab.run("rigid.toml", "r.h5", changes={"integration.duration": 1000.0}, resume=True,
                                    on_step=self.stop_at_once)["interrupted"])

    @staticmethod
    def stop_at_once(record):
        raise StopIteration

    def test_changes_are_keys_of_the_scene(self):
        text = Path("scene.toml").read_text()
        Path("other.toml").write_text(
            text.replace("speed_kmh = 200", "speed = 50.0").replace("length = 10", "length = 12.5")
            .replace('table = "s1002_60e1.h5"', 'table = "s1002_60e1.h5"\ncreep_law = "polach"\nfriction = 0.2')
            + "[output]\nnodes = [\"deck*\"]\nenergy = true\n"
        )
        changes = {"train.speed_kmh": None, "train.speed": 50.0, "bridge.length": numpy.float64(12.5),
                   "contact.creep_law": "polach", "contact.friction": 0.2, "output.nodes": ["deck*"],
                   "output.energy": True}
        railtab.run("other.toml", "file.h5")
        railtab.run("scene.toml", "changed.h5", changes=changes)
        self.same("file.h5", "changed.h5", but=["header/scene_text"])
        with railtab.open_results("changed.h5") as results:
            self.assertTrue(results.scene_text.startswith(text))
            self.assertIn("# changed: without train.speed_kmh, train.speed = 50.0, bridge", results.scene_text)

    def test_one_of_several_bridges(self):
        one = "[[bridge]]\nlength = 10\n"
        Path("two.toml").write_text(Path("scene.toml").read_text().replace(one, one + "[[bridge]]\nlength = 6\n"))
        short = {"integration.duration": 0.02}
        railtab.run("two.toml", "r.h5", changes={"bridge.2.length": 8.0, **short})
        with railtab.open_results("r.h5") as results:
            numpy.testing.assert_allclose(results["header/span_to"], [10.0, 18.0])
        with self.assertRaisesRegex(railtab.InputError, r"found 2 \[\[bridge\]\] in the scene, expected bridge.1.KEY"):
            railtab.run("two.toml", changes={"bridge.length": 8.0})

    def test_wrong_input(self):
        wrong = self.assertRaisesRegex
        message = r"scene.toml:4: train.speed_kmh: found -1, expected .*changed: train.speed_kmh = -1"
        with wrong(railtab.InputError, message):
            railtab.run("scene.toml", changes={"train.speed_kmh": -1})
        with wrong(railtab.InputError, "unknown key 'train.sped'; did you mean 'train.speed'"):
            railtab.run("scene.toml", changes={"train.sped": 5.0})
        with wrong(railtab.InputError, "output.every: found dict, expected a number"):
            railtab.run("scene.toml", changes={"output.every": {}})
        with wrong(railtab.InputError, "absent.toml"):
            railtab.run("absent.toml")
        scene = Path("scene.toml").read_bytes()
        for output in ("scene.toml", "s1002_60e1.h5"):
            with wrong(railtab.InputError, output):
                railtab.run("scene.toml", output)
        self.assertEqual(Path("scene.toml").read_bytes(), scene)
        Path("notes.h5").write_text("mine")
        with wrong(railtab.InputError, "notes.h5"):
            railtab.run("scene.toml", "notes.h5")
        self.assertEqual(Path("notes.h5").read_text(), "mine")

    def test_a_run_without_equilibrium(self):
        with self.assertRaisesRegex(railtab.ComputationError, "without the lateral acceleration"):
            railtab.run("scene.toml", "r.h5", changes={"train.lateral_acceleration": 5.0})

    def test_warnings_are_python_s(self):
        Path("zero.csv").write_text("x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n-40,0,0,0,0\n40,0,0,0,0\n")
        changes = {"irregularity.file": Path("zero.csv"), "integration.duration": 0.01, "train.start": -1}
        with self.assertWarnsRegex(UserWarning, "irregularity.file zero.csv"):
            railtab.run("scene.toml", changes=changes)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaisesRegex(UserWarning, "irregularity.file zero.csv"):
                railtab.run("scene.toml", changes=changes)


class Sweeps(FolderTest):
    def test_rows_are_runs(self):
        values = {"train.speed_kmh": [150, 200], "contact.friction": [0.1, 0.3]}
        changes = {"integration.duration": 0.05}
        rows = railtab.sweep("scene.toml", values, "sweep", changes=changes)
        self.assertEqual([(r["train.speed_kmh"], r["contact.friction"]) for r in rows],
                         [(150, 0.1), (150, 0.3), (200, 0.1), (200, 0.3)])
        alone = railtab.run("scene.toml", changes={**changes, "train.speed_kmh": 200, "contact.friction": 0.1})
        self.assertEqual(rows[2]["max_Q"], alone["max_Q"]["value"])
        self.assertEqual(len({row["max_Q"] for row in rows}), 4)
        self.assertEqual(sorted(os.listdir("sweep")), [f"run-000{k}.h5" for k in (1, 2, 3, 4)])
        at_once = railtab.sweep("scene.toml", values, "threads", changes=changes, threads=2)
        for one, other in zip(rows, at_once):
            for row in (one, other):
                row.pop("results")
                row.pop("real_time_factor")
            self.assertEqual(one, other)
        for name in os.listdir("sweep"):
            self.assertEqual(contents(f"sweep/{name}"), contents(f"threads/{name}"))

    def test_a_run_that_cannot_go_on_is_a_row(self):
        rows = railtab.sweep("scene.toml", {"train.lateral_acceleration": [0.0, 5.0]},
                             changes={"integration.duration": 0.02})
        self.assertEqual([row["complete"] for row in rows], [True, False])
        self.assertIn("without the lateral acceleration", rows[1]["message"])

    def test_pandas(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("no pandas (Debian: python3-pandas)")
        rows = railtab.sweep("scene.toml", {"train.speed_kmh": [150, 200]}, changes={"integration.duration": 0.02})
        frame = pandas.DataFrame(rows).set_index("train.speed_kmh")
        self.assertEqual(frame["max_Q"].dtype, float)
        self.assertEqual(list(frame.index), [150, 200])


class ResultFiles(FolderTest):
    def test_arrays_with_units(self):
        railtab.run("scene.toml", "r.h5")
        with railtab.open_results("r.h5") as results, h5py.File("r.h5") as file:
            self.assertEqual(len(results), len(list(results)))
            self.assertIn("wheels/Q", results)
            self.assertNotIn("wheels", results)
            n = len(results["time"])
            self.assertEqual(n, int(file["records"][0]))
            numpy.testing.assert_array_equal(results["wheels/Q"], file["wheels/Q"][:n])
            self.assertEqual(results["bodies/acceleration"].shape, (n, 7, 6))
            self.assertEqual(results["header/wheel_x"].shape, (8,))
            self.assertEqual([results.unit(name) for name in ("time", "wheels/Q", "bodies/velocity", "records")],
                             ["s", "N", "m/s, rad/s", "1"])
            self.assertTrue(all(results.unit(name) for name in results))
            self.assertEqual(results.summary["complete"], 1)
            self.assertEqual(results.summary["contact_mode"], "table")
            with self.assertRaises(KeyError):
                results["wheels/P"]
        for file in ("scene.toml", "s1002_60e1.h5", "absent.h5"):
            with self.assertRaisesRegex(railtab.InputError, file):
                railtab.open_results(file)

    def test_pandas(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("no pandas (Debian: python3-pandas)")
        railtab.run("scene.toml", "r.h5")
        with railtab.open_results("r.h5") as results:
            Q = results.to_pandas("wheels/Q")
            self.assertEqual((Q.index.name, Q.columns[1]), ("time", "wheelset 1 right"))
            numpy.testing.assert_array_equal(Q["wheelset 4 right"], results["wheels/Q"][:, 7])
            acceleration = results.to_pandas("bodies/acceleration")
            body = results["bodies/names"][0]
            numpy.testing.assert_array_equal(acceleration[body, "z"], results["bodies/acceleration"][:, 0, 2])
            self.assertIsInstance(results.to_pandas("position"), pandas.DataFrame)
            with self.assertRaisesRegex(railtab.InputError, "header/wheel_x: found no history"):
                results.to_pandas("header/wheel_x")


if __name__ == "__main__":
    unittest.main()
