"""An importer of FMUs for co-simulation (FMI 2.0), after the standard alone: it shares no code with what writes them.
Section numbers are the standard's."""
import ctypes
import re
import tempfile
import xml.etree.ElementTree as ET
import zipfile
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p
from pathlib import Path

OK, WARNING, DISCARD, ERROR, FATAL, PENDING = range(6)
CO_SIMULATION = 1
LOGGER = ctypes.CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p)


class Callbacks(ctypes.Structure):
    """2.1.5 fmi2CallbackFunctions"""
    _fields_ = [("logger", LOGGER), ("allocateMemory", c_void_p), ("freeMemory", c_void_p),
                ("stepFinished", c_void_p), ("componentEnvironment", c_void_p)]


# 2.1, 4.2: functions of every slave, with their arguments after the component
REFERENCES, REALS, INTEGERS = POINTER(c_uint), POINTER(c_double), POINTER(c_int)
STRINGS = POINTER(c_char_p)
FUNCTIONS = {
    "SetDebugLogging": [c_int, c_size_t, STRINGS],
    "SetupExperiment": [c_int, c_double, c_double, c_int, c_double],
    "EnterInitializationMode": [], "ExitInitializationMode": [], "Terminate": [], "Reset": [],
    "GetReal": [REFERENCES, c_size_t, REALS], "GetInteger": [REFERENCES, c_size_t, INTEGERS],
    "GetBoolean": [REFERENCES, c_size_t, INTEGERS], "GetString": [REFERENCES, c_size_t, STRINGS],
    "SetReal": [REFERENCES, c_size_t, REALS], "SetInteger": [REFERENCES, c_size_t, INTEGERS],
    "SetBoolean": [REFERENCES, c_size_t, INTEGERS], "SetString": [REFERENCES, c_size_t, STRINGS],
    "GetFMUstate": [POINTER(c_void_p)], "SetFMUstate": [c_void_p], "FreeFMUstate": [POINTER(c_void_p)],
    "SerializedFMUstateSize": [c_void_p, POINTER(c_size_t)],
    "SerializeFMUstate": [c_void_p, ctypes.c_char_p, c_size_t],
    "DeSerializeFMUstate": [ctypes.c_char_p, c_size_t, POINTER(c_void_p)],
    "GetDirectionalDerivative": [REFERENCES, c_size_t, REFERENCES, c_size_t, REALS, REALS],
    "SetRealInputDerivatives": [REFERENCES, c_size_t, INTEGERS, REALS],
    "GetRealOutputDerivatives": [REFERENCES, c_size_t, INTEGERS, REALS],
    "DoStep": [c_double, c_double, c_int], "CancelStep": [],
    "GetStatus": [c_int, INTEGERS], "GetRealStatus": [c_int, REALS], "GetIntegerStatus": [c_int, INTEGERS],
    "GetBooleanStatus": [c_int, INTEGERS], "GetStringStatus": [c_int, STRINGS],
}


class Fmu:
    """An unpacked FMU whose description keeps the rules that the importer relies on."""

    def __init__(self, file):
        self._folder = tempfile.TemporaryDirectory(prefix="f m%u ")  # names that a URI has to escape
        self.folder = Path(self._folder.name)
        with zipfile.ZipFile(file) as archive:
            assert archive.testzip() is None
            archive.extractall(self.folder)
        self.root = ET.parse(self.folder / "modelDescription.xml").getroot()
        self.slave = self.root.find("CoSimulation")
        self.variables = self.root.find("ModelVariables").findall("ScalarVariable")
        self.check_description()
        self.reference = {v.get("name"): int(v.get("valueReference")) for v in self.variables}
        self.start = {v.get("name"): float(v[0].get("start")) for v in self.variables if v[0].get("start")}
        self.inputs = [v.get("name") for v in self.variables if v.get("causality") == "input"]
        self.outputs = [v.get("name") for v in self.variables if v.get("causality") == "output"]
        self.step_size = float(self.root.find("DefaultExperiment").get("stepSize"))
        self.library = ctypes.CDLL(str(self.folder / "binaries/linux64" / f"{self.slave.get('modelIdentifier')}.so"))
        self.check_library()

    def check_description(self):
        root = self.root
        assert root.tag == "fmiModelDescription" and root.get("fmiVersion") == "2.0"
        assert root.get("guid") and root.get("modelName")
        # 2.2: the elements in the order of the schema
        order = ["ModelExchange", "CoSimulation", "UnitDefinitions", "TypeDefinitions", "LogCategories",
                 "DefaultExperiment", "VendorAnnotations", "ModelVariables", "ModelStructure"]
        places = [order.index(child.tag) for child in root]
        assert places == sorted(places)
        # 2.2.1: the identifier is that of C
        assert re.fullmatch(r"[A-Za-z_]\w*", self.slave.get("modelIdentifier"))
        units = {unit.get("name") for unit in root.find("UnitDefinitions")}
        names = [v.get("name") for v in self.variables]
        assert len(set(names)) == len(names), "2.2.7: names are unique"
        # 2.2.9: structured names
        assert all(re.fullmatch(r"[A-Za-z_]\w*(\[\d+\])?(\.[A-Za-z_]\w*(\[\d+\])?)*", name) for name in names)
        references = [v.get("valueReference") for v in self.variables]
        assert len(set(references)) == len(references), "no variable is an alias"
        for v in self.variables:
            assert v[0].tag == "Real" and v[0].get("unit") in units and v.get("description")
            assert v.get("causality") in ("input", "output") and v.get("variability") == "continuous"
            # 2.2.7: an input has a start value and no `initial`, a calculated output has no start value
            is_input = v.get("causality") == "input"
            assert is_input == (v[0].get("start") is not None) == (v.get("initial") is None)
            assert is_input or v.get("initial") == "calculated"
        # 2.2.8: outputs by their index from 1, in order, all of them; here all are computed in initialization mode
        outputs = [i for i, v in enumerate(self.variables, 1) if v.get("causality") == "output"]
        structure = root.find("ModelStructure")
        for kind in ("Outputs", "InitialUnknowns"):
            assert [int(unknown.get("index")) for unknown in structure.find(kind)] == outputs

    def check_library(self):
        self.library.fmi2GetTypesPlatform.restype = self.library.fmi2GetVersion.restype = c_char_p
        assert self.library.fmi2GetTypesPlatform() == b"default" and self.library.fmi2GetVersion() == b"2.0"
        for name, arguments in FUNCTIONS.items():
            function = getattr(self.library, f"fmi2{name}")
            function.argtypes, function.restype = [c_void_p, *arguments], c_int
        self.library.fmi2Instantiate.argtypes = [c_char_p, c_int, c_char_p, c_char_p, POINTER(Callbacks), c_int, c_int]
        self.library.fmi2Instantiate.restype = c_void_p
        self.library.fmi2FreeInstance.argtypes, self.library.fmi2FreeInstance.restype = [c_void_p], None

    def references(self, names):
        return (c_uint * len(names))(*(self.reference[name] for name in names))


class Rejected(Exception):
    """A call that did not return fmi2OK: its status, and the messages of the logger."""

    def __init__(self, status, messages):
        super().__init__(f"status {status}: {messages}")
        self.status, self.messages = status, messages


class Slave:
    """An instance, from instantiation on."""

    def __init__(self, fmu, name="track", guid=None, type=CO_SIMULATION, resources=None):
        self.fmu, self.messages = fmu, []
        self.time = 0.0

        def log(_, instance, status, category, message):
            assert instance.decode() == name and category == b"logStatusError"
            self.messages.append((status, message.decode().replace("%%", "%").replace("##", "#")))

        self._callbacks = Callbacks(LOGGER(log), None, None, None, None)
        guid = fmu.root.get("guid") if guid is None else guid
        resources = (fmu.folder / "resources").as_uri() if resources is None else resources
        self.component = fmu.library.fmi2Instantiate(name.encode(), type, guid.encode(), resources.encode(),
                                                     byref(self._callbacks), 0, 0)
        if not self.component:
            raise Rejected(None, self.messages)

    def call(self, function, *arguments):
        status = getattr(self.fmu.library, f"fmi2{function}")(self.component, *arguments)
        if status != OK:
            messages, self.messages = self.messages, []
            raise Rejected(status, messages)

    def set(self, names, values):
        self.call("SetReal", self.fmu.references(names), len(names), (c_double * len(names))(*values))

    def get(self, names):
        values = (c_double * len(names))()
        self.call("GetReal", self.fmu.references(names), len(names), values)
        return list(values)

    def initialize(self, names=(), values=(), start=0.0):
        self.time = start
        self.call("SetupExperiment", 0, 0.0, start, 0, 0.0)
        self.call("EnterInitializationMode")
        self.set(list(names), list(values))
        self.call("ExitInitializationMode")

    def step(self, size=None):
        size = size or self.fmu.step_size
        self.call("DoStep", self.time, size, 0)
        self.time += size

    def free(self):
        self.fmu.library.fmi2FreeInstance(self.component)
