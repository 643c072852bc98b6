"""Wheel-rail contact from tables, and train-bridge runs.

SI units; x forward, y right, z down. Arguments of look-ups are numbers or arrays, which NumPy broadcasts; docstrings
state the shapes. The user's guide is docs/guide/python.md.

>>> import railtab
>>> railtab.standard_profiles("rail")
['60E1', 'UIC60', 'CHN60', 'JIS60-stand-in']
"""
import numpy

from ._railtab import (
    ComputationError,
    ContactGeometry,
    ContactSearch,
    CreepLaw,
    CreepTable,
    GeometryTable,
    InputError,
    Profile,
    StepRecord,
    WheelContact,
    __version__,
    kalker_coefficients,
    scene_keys,
    standard_profiles,
)
from .results import Results, open_results
from .runs import run, sweep

try:
    from ._rolling import rolling_contact
except ImportError:  # built without tablegen
    pass

__all__ = [
    "ComputationError",
    "ContactGeometry",
    "ContactSearch",
    "CreepLaw",
    "CreepTable",
    "GeometryTable",
    "InputError",
    "Profile",
    "Results",
    "StepRecord",
    "WheelContact",
    "displacement",
    "kalker_coefficients",
    "open_results",
    "run",
    "scene_keys",
    "standard_profiles",
    "sweep",
]
if "rolling_contact" in globals():
    __all__.append("rolling_contact")


def __getattr__(name):
    if name == "rolling_contact":
        raise AttributeError("railtab.rolling_contact: this railtab was built without tablegen, which solves it; "
                             "the packages and builds with -D RAILTAB_TABLEGEN=ON have it")
    raise AttributeError(f"module 'railtab' has no attribute '{name}'")


def displacement(y=0.0, z=0.0, roll=0.0, yaw=0.0) -> numpy.ndarray:
    """Displacements of a wheelset for WheelContact, shape (..., 6): x, y, z [m], roll, pitch, yaw [rad], x = pitch = 0.

    y, z [m], roll and yaw [rad] are numbers or arrays that broadcast to a shape (...).

    >>> displacement(y=[0.0, 1e-3]).shape
    (2, 6)
    """
    y, z, roll, yaw = numpy.broadcast_arrays(y, z, roll, yaw)
    zero = numpy.zeros(y.shape)
    return numpy.stack([zero, y, z, roll, zero, yaw], axis=-1)
