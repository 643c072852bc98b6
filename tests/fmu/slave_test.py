#!/usr/bin/env python3
"""What an FMU promises beyond the motions of a run: instances, states, errors.

    slave_test.py VSI [CASE...]
"""
import ctypes
import shutil
import subprocess
import sys
import tempfile
import zipfile
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p
from pathlib import Path

from importer import ERROR, FUNCTIONS, Callbacks, Fmu, Rejected, Slave

SCENE = """name = "A <short> bridge & 100 % track"
[train]
vehicle = "manchester-coach"
start = -4.0
[contact]
mode = "online"
[track]
kind = "flexible"
length_before = 40
length_after = 20
[[bridge]]
length = 16
[integration]
time_step = 1e-3
"""
LOAD = 60e3


def passage(slave, speed=50.0, steps=40, begin=0):
    """Motions of a train of constant loads: outputs after every step."""
    fmu = slave.fmu
    motions = []
    for k in range(begin, begin + steps):
        values = dict.fromkeys(fmu.inputs, 0.0)
        for name in fmu.inputs:
            if name.endswith(".x"):
                values[name] = fmu.start[name] + speed * (k + 1) * fmu.step_size
            elif name.endswith(".Q"):
                values[name] = LOAD * (1.0 + 0.3 * (k % 7))
            elif name.endswith(".left.Y"):
                values[name] = 5e3
        slave.set(list(values), list(values.values()))
        slave.step()
        motions.append(slave.get(fmu.outputs))
    return motions


def started(fmu, **arguments):
    slave = Slave(fmu, **arguments)
    slave.initialize(["wheelset[1].left.Q", "wheelset[1].right.Q"], [LOAD, LOAD])
    return slave


def rejected(action, *texts, status=ERROR):
    """The call fails and the logger says why, with all of the texts."""
    try:
        action()
    except Rejected as rejection:
        assert rejection.status == status, rejection
        assert len(rejection.messages) == 1 and rejection.messages[0][0] == ERROR, rejection
        assert all(text in rejection.messages[0][1] for text in texts), rejection
        return
    raise AssertionError(f"no rejection with {texts}")


def instances(fmu):
    """Two instances in turns give the bits that each gives alone, as does an instance after a reset."""
    alone = [passage(started(fmu), speed) for speed in (50.0, 80.0)]
    assert alone[0] != alone[1] and any(value for value in alone[0][-1])
    both = [started(fmu, name=f"of {speed}") for speed in (50.0, 80.0)]
    in_turns = [[], []]
    for k in range(40):
        for i, speed in enumerate((50.0, 80.0)):
            in_turns[i] += passage(both[i], speed, 1, k)
    assert in_turns == alone
    both[1].call("Terminate")
    both[1].call("Reset")
    both[1].initialize(["wheelset[1].left.Q", "wheelset[1].right.Q"], [LOAD, LOAD])
    assert passage(both[1]) == alone[0]
    for slave in both:
        slave.free()


def states(fmu):
    """A state that is set again, also from bytes in another instance, goes on with the same bits."""
    slave, other = started(fmu), started(fmu)
    passage(slave, steps=10)
    kept, size = c_void_p(), c_size_t()
    slave.call("GetFMUstate", byref(kept))
    expected = passage(slave, steps=10, begin=10)
    slave.call("SerializedFMUstateSize", kept, byref(size))
    content = ctypes.create_string_buffer(size.value)
    slave.call("SerializeFMUstate", kept, content, size)
    slave.call("SetFMUstate", kept)
    slave.time -= 10 * fmu.step_size
    assert passage(slave, steps=10, begin=10) == expected
    read = c_void_p()
    other.call("DeSerializeFMUstate", content, size, byref(read))
    other.call("SetFMUstate", read)
    other.time = 10 * fmu.step_size
    assert passage(other, steps=10, begin=10) == expected
    rejected(lambda: other.call("DeSerializeFMUstate", content, size.value - 8, byref(read)), "numbers", "expected")
    slave.call("FreeFMUstate", byref(kept))
    other.call("FreeFMUstate", byref(read))
    assert not kept.value and not read.value


def rest(fmu):
    """Under loads that stay, the structure stays in its static equilibrium; deflections are reciprocal; steps of twice
    the length are two steps."""
    places = {"wheelset[1].x": 4.0, "wheelset[2].x": 9.3}
    motions = {}
    for loaded, other in ((1, 2), (2, 1)):
        slave = Slave(fmu)
        slave.initialize([*places, f"wheelset[{loaded}].left.Q"], [*places.values(), LOAD])
        begin = slave.get(fmu.outputs)
        motions[loaded] = slave.get([f"wheelset[{other}].left.rail_z"])[0]
        for _ in range(50):
            slave.step()
        ends = slave.get(fmu.outputs)
        for name, a, b in zip(fmu.outputs, begin, ends):
            limit = 1e-6 if "acceleration" in name else 1e-10
            assert abs(a - b) < limit, (name, a, b)
        halves, whole = Slave(fmu), Slave(fmu)
        for instance in (halves, whole):
            instance.initialize(list(places), list(places.values()))
        loads = [f"wheelset[{loaded}].left.Q"], [LOAD]
        halves.set([loads[0][0]], [0.5 * LOAD])
        halves.step()
        halves.set(*loads)
        halves.step()
        whole.set(*loads)
        whole.step(2 * fmu.step_size)
        assert halves.get(fmu.outputs) == whole.get(fmu.outputs) and halves.time == whole.time
    assert motions[1] > 0 and abs(motions[1] - motions[2]) < 1e-9 * motions[1]


def beyond_the_track(fmu):
    """Beyond the modelled track rails are rigid: no motion, and loads without effect."""
    slave = Slave(fmu)
    slave.initialize(["wheelset[1].x", "wheelset[1].left.Q"], [1e3, LOAD])
    slave.step()
    assert not any(slave.get(fmu.outputs))
    slave.set(["wheelset[1].x"], [4.0])
    slave.step()
    assert slave.get(["wheelset[1].left.rail_z"])[0] > 0


def errors(fmu):
    """Every error has its message, and the instance goes on."""
    slave = Slave(fmu)
    step = fmu.step_size
    rejected(lambda: slave.call("DoStep", 0.0, step, 0), "fmi2DoStep", "found instantiated, expected step complete")
    slave.initialize()
    for wrong in (0.5 * step, 1.5 * step, 0.0, -step, float("nan")):
        rejected(lambda: slave.call("DoStep", 0.0, wrong, 0), "found", "0.001 s" if wrong > 0 else "")
    rejected(lambda: slave.call("DoStep", 0.5, step, 0), "currentCommunicationPoint: found 0.5 s, expected 0 s")
    rejected(lambda: slave.set(["wheelset[1].left.Q"], [float("inf")]), "wheelset[1].left.Q: found inf")
    rejected(lambda: slave.set(["wheelset[1].left.Q"], [-1e12]), "Q: found -1e+12 N, expected -1e+08 to 1e+08 N")
    rejected(lambda: slave.set(["wheelset[1].right.Mx"], [2e8]), "Mx: found 2e+08 N.m, expected -1e+08 to 1e+08 N.m")
    rejected(lambda: slave.set(["wheelset[1].left.rail_z"], [0.0]), "value reference", "expected an input, 0 to 27")
    unknown = (c_uint * 1)(10 ** 6)
    rejected(lambda: slave.call("GetReal", unknown, 1, (c_double * 1)()), "found 1000000, expected 0 to")
    rejected(lambda: slave.call("GetInteger", unknown, 1, (c_int * 1)()), "real")
    slave.call("GetInteger", unknown, 0, (c_int * 1)())
    for name, flag in (("CancelStep", "canRunAsynchronuously"), ("SetRealInputDerivatives", "canInterpolateInputs"),
                       ("GetRealOutputDerivatives", "maxOutputDerivativeOrder"),
                       ("GetDirectionalDerivative", "providesDirectionalDerivative")):
        assert fmu.slave.get(flag) in ("false", "0")
        nothing = [None if issubclass(t, ctypes._Pointer) else 0 for t in FUNCTIONS[name]]
        rejected(lambda: slave.call(name, *nothing), "not supported", flag)
    rejected(lambda: slave.call("SetDebugLogging", 1, 1, (c_char_p * 1)(b"100 % #")), "found 100 % #, expected log")
    slave.call("SetDebugLogging", 1, 1, (c_char_p * 1)(b"logStatusError"))
    rejected(lambda: slave.call("GetBooleanStatus", 0, (c_int * 1)()), "expected fmi2Terminated")
    slave.step()
    last = (c_double * 1)()
    slave.call("GetRealStatus", 2, last)
    assert last[0] == step
    slave.call("Terminate")
    rejected(lambda: slave.step(), "found terminated")
    slave.free()

    stopped = Slave(fmu)
    stopped.call("SetupExperiment", 0, 0.0, 2.0, 1, 2.0 + step)
    stopped.call("EnterInitializationMode")
    stopped.call("ExitInitializationMode")
    stopped.time = 2.0
    stopped.step()
    rejected(stopped.step, "none beyond the stop time")
    assert fmu.library.fmi2DoStep(None, 0.0, step, 0) == ERROR


def instantiation(fmu):
    """Wrong arguments and changed files give no instance."""
    guid = fmu.root.get("guid")
    rejected(lambda: Slave(fmu, guid="other"), "fmuGUID: found other, expected " + guid, status=None)
    rejected(lambda: Slave(fmu, type=0), "found fmi2ModelExchange", status=None)
    rejected(lambda: Slave(fmu, resources="http://host/a"), "fmuResourceLocation: found http://host/a", status=None)
    rejected(lambda: Slave(fmu, resources="file:///a%zz"), "found file:///a%zz", status=None)
    rejected(lambda: Slave(fmu, resources="file:///absent"), "/absent/track: found no file", status=None)
    uri = (fmu.folder / "resources").as_uri()
    Slave(fmu, resources=uri.replace("file://", "file:")).free()
    Slave(fmu, resources=uri.replace("file://", "file://localhost")).free()
    assert not fmu.library.fmi2Instantiate(b"track", 1, guid.encode(), uri.encode(), POINTER(Callbacks)(), 0, 0)
    track = fmu.folder / "resources/track"
    whole = track.read_bytes()
    track.write_bytes(whole[:-3] + b"xyz")
    rejected(lambda: Slave(fmu), "fmuGUID: found " + guid, status=None)
    track.write_bytes(whole)


def symbols(fmu):
    """The library shows the functions of the standard and nothing else."""
    library = next((fmu.folder / "binaries/linux64").iterdir())
    listed = subprocess.run(["nm", "-D", "--defined-only", library], check=True, text=True, capture_output=True).stdout
    others = ("GetTypesPlatform", "GetVersion", "Instantiate", "FreeInstance")
    assert {line.split()[-1] for line in listed.splitlines()} == {f"fmi2{name}" for name in (*FUNCTIONS, *others)}


def archive(vsi, folder):
    """The same scene gives the same bytes, with its text and the licence; foreign files stay."""
    first = (folder / "track.fmu").read_bytes()
    assert run(vsi, folder, "fmu", "scene.toml", "-o", "track.fmu", "-q").returncode == 0, "an FMU replaces an FMU"
    assert (folder / "track.fmu").read_bytes() == first
    with zipfile.ZipFile(folder / "track.fmu") as content:
        assert content.read("documentation/scene.toml").decode() == SCENE
        assert b"Apache License" in content.read("documentation/licenses/LICENSE")
        assert all(entry.date_time == (1980, 1, 1, 0, 0, 0) for entry in content.infolist())
    assert "FMI 2.0" in run(vsi, folder, "track.fmu").stdout
    (folder / "window.toml").write_text(SCENE + "[structure]\nreduction = \"window\"\n")
    assert run(vsi, folder, "fmu", "window.toml", "-o", "window.fmu", "-q").returncode == 0
    with zipfile.ZipFile(folder / "track.fmu") as whole, zipfile.ZipFile(folder / "window.fmu") as window:
        assert whole.read("resources/track") == window.read("resources/track"), "the whole structure takes part"
    shutil.make_archive(folder / "foreign", "zip", folder, "scene.toml")
    (folder / "foreign.zip").rename(folder / "foreign.fmu")
    before = (folder / "foreign.fmu").read_bytes()
    for arguments, text in ((("scene.toml", "-o", "foreign.fmu"), "found a file that is no FMU of railtab"),
                            (("scene.toml", "-o", "scene.toml"), "found the ending .toml, expected .fmu"),
                            (("scene.toml",), "found no -o TRACK.fmu"),
                            (("rigid.toml", "-o", "none.fmu"), "rigid.toml:8: track.kind: found \"rigid\""),
                            (("ground.toml", "-o", "none.fmu"), "ground_motion: found ground that moves")):
        done = run(vsi, folder, "fmu", *arguments)
        assert done.returncode == 2 and text in done.stderr, done
    assert (folder / "foreign.fmu").read_bytes() == before and not (folder / "none.fmu").exists()
    limited = f"trap '' XFSZ; ulimit -f 100; '{vsi}' fmu scene.toml -o full.fmu"
    done = subprocess.run(["bash", "-c", limited], cwd=folder, text=True, capture_output=True)
    assert done.returncode == 1 and "full.fmu: could not be written" in done.stderr, done
    assert not list(folder.glob("full.fmu*"))


def example(vsi, folder):
    """The example of the guide ends with a message where its input is missing or wrong."""
    scripts = Path(__file__).parents[2] / "docs/examples/fmu"
    script = scripts / "moving_loads.py"
    shutil.make_archive(folder / "other", "zip", folder, "scene.toml")
    for arguments, text in (((), "moving_loads.py TRACK.fmu"),
                            (("none.fmu",), "none.fmu: found no FMU"),
                            (("scene.toml",), "scene.toml: found no FMU"),
                            (("other.zip",), "other.zip: found a ZIP archive without modelDescription.xml"),
                            (("track.fmu", "fast"), "SPEED: found fast")):
        done = run(sys.executable, folder, script, *arguments)
        assert done.returncode == 1 and text in done.stderr and "Traceback" not in done.stderr, done
    done = run(sys.executable, folder, scripts / "wheels_on_springs.py")
    assert done.returncode == 1 and "wheels_on_springs.py TRACK.fmu" in done.stderr, done


def run(vsi, folder, *arguments):
    return subprocess.run([vsi, *arguments], cwd=folder, text=True, capture_output=True)


def main():
    vsi, *names = sys.argv[1:]
    cases = {case.__name__: case for case in (instances, states, rest, beyond_the_track, errors, instantiation, symbols)}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.toml").write_text(SCENE)
        (folder / "rigid.toml").write_text(SCENE.split("[track]")[0] + "[track]\nkind = \"rigid\"\n[integration]\n"
                                                                       "duration = 1\n")
        (folder / "ground.csv").write_text("t,ay\n0,0\n1,0.1\n2,0\n")
        (folder / "ground.toml").write_text(SCENE + "[[ground_motion]]\nfile = \"ground.csv\"\n")
        done = run(vsi, folder, "fmu", "scene.toml", "-o", "track.fmu")
        assert done.returncode == 0 and "2 wheelsets" not in done.stderr, done
        of_files = {case.__name__: case for case in (archive, example)}
        for case in names or [*cases, *of_files]:
            print(case, flush=True)
            of_files[case](vsi, folder) if case in of_files else cases[case](Fmu(folder / "track.fmu"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
