from collections.abc import Sequence
from os import PathLike
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
_Path = str | PathLike[str]
_Array = NDArray[np.float64]

class InputError(ValueError): ...
class ComputationError(RuntimeError): ...

def standard_profiles(kind: Literal["wheel", "rail"]) -> list[str]: ...
def scene_keys() -> dict[str, dict[str, str]]: ...
def kalker_coefficients(ratio: ArrayLike, nu: float = 0.28) -> _Array: ...

class Profile:
    @staticmethod
    def wheel(name: str, smoothing: float = 0.0) -> Profile: ...
    @staticmethod
    def rail(name: str, inclination: float = 0.025, smoothing: float = 0.0) -> Profile: ...
    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> str: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def s(self) -> _Array: ...
    @property
    def y(self) -> _Array: ...
    @property
    def z(self) -> _Array: ...
    def points(self, s: ArrayLike) -> _Array: ...
    def curvature(self, s: ArrayLike) -> _Array: ...

class ContactGeometry:
    def contacts(
        self,
        y: ArrayLike,
        dz: ArrayLike | None = None,
        *,
        z: ArrayLike | None = None,
        load: ArrayLike | None = None,
        roll: ArrayLike = 0.0,
        yaw: ArrayLike = 0.0,
    ) -> NDArray[np.void]: ...
    def rail_force(
        self,
        y: ArrayLike,
        dz: ArrayLike | None = None,
        *,
        z: ArrayLike | None = None,
        load: ArrayLike | None = None,
        roll: ArrayLike = 0.0,
        yaw: ArrayLike = 0.0,
    ) -> _Array: ...
    def height(
        self,
        y: ArrayLike,
        *,
        dz: ArrayLike | None = None,
        load: ArrayLike | None = None,
        roll: ArrayLike = 0.0,
        yaw: ArrayLike = 0.0,
    ) -> _Array: ...
    @property
    def wheel(self) -> Profile: ...
    @property
    def rail(self) -> Profile: ...
    @property
    def dimensions(self) -> dict[str, float]: ...

class ContactSearch(ContactGeometry):
    def __init__(
        self,
        wheel: Profile,
        rail: Profile,
        *,
        gauge: float = 1.435,
        gauge_height: float = 0.014,
        flange_back: float = 1.36,
        wheel_radius: float = 0.46,
    ) -> None: ...

class GeometryTable(ContactGeometry):
    @staticmethod
    def open(file: _Path) -> GeometryTable: ...
    @property
    def info(self) -> dict[str, Any]: ...
    def online(self) -> ContactSearch: ...

class CreepTable:
    @staticmethod
    def open(file: _Path | None = None) -> CreepTable: ...
    def lookup(
        self, ratio: ArrayLike, ux: ArrayLike, uy: ArrayLike, phi: ArrayLike
    ) -> tuple[_Array, _Array, NDArray[np.bool_]]: ...
    @property
    def info(self) -> dict[str, Any]: ...

class CreepLaw:
    def __init__(
        self,
        name: Literal["table", "polach", "fastsim", "linear"] = "table",
        *,
        nu: float = 0.28,
        table: _Path | None = None,
    ) -> None: ...
    @property
    def name(self) -> str: ...
    def force(self, ratio: ArrayLike, ux: ArrayLike, uy: ArrayLike, phi: ArrayLike) -> _Array: ...
    def jet(self, ratio: ArrayLike, ux: ArrayLike, uy: ArrayLike, phi: ArrayLike) -> tuple[_Array, _Array]: ...
    def table_share(self, ratio: ArrayLike, ux: ArrayLike, uy: ArrayLike, phi: ArrayLike) -> _Array: ...

class WheelContact:
    def __init__(
        self,
        geometry: ContactGeometry,
        *,
        speed: float,
        law: str | CreepLaw = "table",
        friction: float = 0.3,
        damping: float = 0.0,
        young: float = 210e9,
        poisson: float = 0.28,
    ) -> None: ...
    def force(
        self,
        wheelset: ArrayLike,
        wheelset_velocity: ArrayLike | None = None,
        rail: ArrayLike | None = None,
        rail_velocity: ArrayLike | None = None,
        *,
        rail_yaw: ArrayLike = 0.0,
        rail_slope: ArrayLike = 0.0,
        rail_friction: ArrayLike = 1.0,
        side: Literal["right", "left"] = "right",
    ) -> _Array: ...
    def force_and_tangent(
        self,
        wheelset: ArrayLike,
        wheelset_velocity: ArrayLike | None = None,
        rail: ArrayLike | None = None,
        rail_velocity: ArrayLike | None = None,
        *,
        rail_yaw: ArrayLike = 0.0,
        rail_slope: ArrayLike = 0.0,
        rail_friction: ArrayLike = 1.0,
        side: Literal["right", "left"] = "right",
        velocity_rate: float = 0.0,
    ) -> tuple[_Array, _Array]: ...

class StepRecord:
    @property
    def time(self) -> float: ...
    @property
    def position(self) -> float: ...
    @property
    def newton_iterations(self) -> int: ...
    @property
    def wheels(self) -> NDArray[np.void]: ...
    @property
    def bodies(self) -> NDArray[np.void]: ...
    @property
    def nodes(self) -> NDArray[np.void]: ...
    @property
    def body_names(self) -> list[str]: ...
    @property
    def node_names(self) -> list[str]: ...

def run_scene(
    scene: _Path,
    changes: Sequence[tuple[str, str]],
    output: _Path | None,
    resume: bool,
    on_step: Any,
    on_progress: Any,
    on_warning: Any,
) -> str: ...
