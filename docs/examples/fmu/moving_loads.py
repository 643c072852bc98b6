#!/usr/bin/env python3
"""Constant wheel loads cross the bridge of an FMU of vsi fmu, which is loaded with nothing but Python's own modules.

    moving_loads.py TRACK.fmu [SPEED in m/s]
"""
import atexit
import ctypes
import sys
import tempfile
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

Q = 60e3  # N, of every wheel
LOGGER = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)


class Callbacks(ctypes.Structure):
    _fields_ = [("logger", LOGGER), ("allocate", ctypes.c_void_p), ("free", ctypes.c_void_p),
                ("step_finished", ctypes.c_void_p), ("environment", ctypes.c_void_p)]


class Slave:
    """An instance of the FMU unpacked in a folder."""

    def __init__(self, folder):
        root = ET.parse(folder / "modelDescription.xml").getroot()
        variables = root.find("ModelVariables")
        self.reference = {v.get("name"): int(v.get("valueReference")) for v in variables}
        self.start = {v.get("name"): float(v[0].get("start")) for v in variables if v.get("causality") == "input"}
        self.decks = [v.get("name") for v in variables if v.get("description").startswith("deck")]
        self.time_step = float(root.find("DefaultExperiment").get("stepSize"))
        name = root.find("CoSimulation").get("modelIdentifier")
        self.library = ctypes.CDLL(str(folder / "binaries/linux64" / f"{name}.so"))
        self.library.fmi2Instantiate.restype = ctypes.c_void_p
        self.callbacks = Callbacks(LOGGER(lambda _, of, status, category, message: print(message.decode())))
        self.component = ctypes.c_void_p(self.library.fmi2Instantiate(
            b"track", 1, root.get("guid").encode(), (folder / "resources").as_uri().encode(),
            ctypes.byref(self.callbacks), 0, 0))
        if not self.component:
            sys.exit("no instance")

    def call(self, function, *arguments):
        if getattr(self.library, f"fmi2{function}")(self.component, *arguments) != 0:
            sys.exit(f"{function} failed")

    def exchange(self, function, names, values):
        references = (ctypes.c_uint * len(names))(*(self.reference[name] for name in names))
        numbers = (ctypes.c_double * len(names))(*values)
        self.call(function, references, ctypes.c_size_t(len(names)), numbers)
        return list(numbers)

    def set(self, values):
        self.exchange("SetReal", values.keys(), values.values())

    def get(self, names):
        return self.exchange("GetReal", names, [0.0] * len(names))

    def begin(self, inputs):
        """At time 0 in the static equilibrium under the inputs."""
        zero, false = ctypes.c_double(0.0), ctypes.c_int(0)
        self.call("SetupExperiment", false, zero, zero, false, zero)
        self.call("EnterInitializationMode")
        self.set(inputs)
        self.call("ExitInitializationMode")

    def step(self, time):
        """From `time` on, with the inputs as values at the end of the step."""
        self.call("DoStep", ctypes.c_double(time), ctypes.c_double(self.time_step), ctypes.c_int(0))

    def free(self):
        self.library.fmi2FreeInstance(self.component)


def unpacked(fmu):
    """The folder with the content of an FMU, which stays until the program ends."""
    folder = tempfile.TemporaryDirectory()
    atexit.register(folder.cleanup)
    try:
        zipfile.ZipFile(fmu).extractall(folder.name)
    except (OSError, zipfile.BadZipFile) as error:
        sys.exit(f"{fmu}: found no FMU ({error}), expected one of vsi fmu SCENE.toml -o TRACK.fmu")
    if not (Path(folder.name) / "modelDescription.xml").exists():
        sys.exit(f"{fmu}: found a ZIP archive without modelDescription.xml, expected an FMU of vsi fmu")
    return Path(folder.name)


def arguments():
    """FMU and speed in m/s, of the command line."""
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__.strip())
    try:
        speed = float(sys.argv[2]) if len(sys.argv) == 3 else 200 / 3.6
    except ValueError:
        speed = 0.0
    if not 0 < speed < 200:
        sys.exit(f"SPEED: found {sys.argv[2]}, expected a number above 0 and below 200 m/s")
    return sys.argv[1], speed


def main():
    fmu, speed = arguments()
    track = Slave(unpacked(fmu))
    start = {name: x for name, x in track.start.items() if name.endswith(".x")}
    decks = [name for name in track.decks if name.endswith(".z")]
    rails = [name for name in track.reference if name.endswith(".rail_z")]
    dt = track.time_step
    track.begin({name: Q for name in track.start if name.endswith(".Q")})
    steps, largest_deck, largest_rail = 0, 0.0, 0.0
    while min(start.values()) + speed * steps * dt < 40.0:
        track.set({name: x + speed * (steps + 1) * dt for name, x in start.items()})
        track.step(steps * dt)
        steps += 1
        largest_deck = max(largest_deck, *track.get(decks))
        largest_rail = max(largest_rail, *track.get(rails))
    print(f"{steps} steps: deck {1e3 * largest_deck:.2f} mm, rail under a wheel {1e3 * largest_rail:.2f} mm")
    track.free()


if __name__ == "__main__":
    main()
