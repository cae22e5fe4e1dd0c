from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Comparison",
    "DataError",
    "Diagnosis",
    "Gains",
    "HandstandError",
    "Model",
    "Motion",
    "Refit",
    "UsageError",
    "add",
    "compare",
    "diagnose",
    "fit",
    "gains",
    "read_log",
    "simulate",
]

_Row: TypeAlias = NDArray[np.float64]
_File: TypeAlias = str | PathLike[str]
_Logs: TypeAlias = _File | Motion | Sequence[_File | Motion]
_Horizon: TypeAlias = float | Literal["whole"]
_Progress: TypeAlias = Callable[[str, int, int], object]
_PerJoint: TypeAlias = ArrayLike | Sequence[ArrayLike | None]

class HandstandError(Exception): ...
class UsageError(ValueError): ...
class DataError(ValueError): ...

@final
class Model:
    @staticmethod
    def load(path: _File) -> Model: ...
    @staticmethod
    def parse(toml: str, name: str = "model.toml") -> Model: ...
    def save(self, path: _File, overwrite: bool = False) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def path(self) -> PathLike[str]: ...
    @property
    def toml(self) -> str: ...
    @property
    def links(self) -> int: ...
    @property
    def drives(self) -> list[str]: ...
    @property
    def effects(self) -> list[str]: ...

@final
class Motion:
    def __new__(
        cls,
        time_s: ArrayLike,
        position_rad: ArrayLike,
        *,
        input: _PerJoint | None = None,
        velocity_rad_s: _PerJoint | None = None,
        rate_rad_s: _PerJoint | None = None,
        supply_v: ArrayLike | None = None,
        torque_on: Sequence[bool] | None = None,
        payload_kg: float = 0.0,
        turned: bool = False,
        name: str = "motion",
    ) -> Motion: ...
    @property
    def name(self) -> str: ...
    @property
    def time_s(self) -> _Row: ...
    @property
    def position_rad(self) -> _Row: ...
    @property
    def velocity_rad_s(self) -> list[_Row | None]: ...
    @property
    def rate_rad_s(self) -> list[_Row | None]: ...
    @property
    def input(self) -> list[_Row | None]: ...
    @property
    def supply_v(self) -> _Row | None: ...
    @property
    def payload_kg(self) -> float: ...
    def __len__(self) -> int: ...

@final
class Comparison:
    @property
    def rms(self) -> list[float]: ...
    @property
    def floor(self) -> list[float]: ...
    def to_dict(self) -> dict[str, Any]: ...
    def html(self) -> str: ...
    def _repr_html_(self) -> str: ...

@final
class Diagnosis:
    @property
    def verdict(self) -> str: ...
    @property
    def effects(self) -> list[str]: ...
    @property
    def summary(self) -> list[str]: ...
    @property
    def warnings(self) -> list[str]: ...
    def to_dict(self) -> dict[str, Any]: ...
    def html(self) -> str: ...
    def _repr_html_(self) -> str: ...

@final
class Refit:
    @property
    def model(self) -> Model: ...
    @property
    def values(self) -> dict[str, tuple[float, float, float]]: ...
    @property
    def error_before_rad(self) -> float: ...
    @property
    def error_after_rad(self) -> float: ...
    def to_dict(self) -> dict[str, Any]: ...
    def _repr_html_(self) -> str: ...

@final
class Gains:
    @property
    def k(self) -> _Row: ...
    @property
    def states(self) -> list[str]: ...
    @property
    def x0(self) -> list[float]: ...
    @property
    def u0(self) -> list[float]: ...
    @property
    def plant(self) -> tuple[_Row, _Row]: ...
    @property
    def stabilised(self) -> bool: ...
    @property
    def region_rad(self) -> float: ...
    @property
    def region_open(self) -> bool: ...
    @property
    def stays_uncontrolled(self) -> bool: ...
    def c_header(self) -> str: ...
    def rust_file(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def _repr_html_(self) -> str: ...

def read_log(path: _File, model: Model) -> list[Motion]: ...
def compare(model: Model, logs: _Logs, *, horizon_s: _Horizon | None = None) -> Comparison: ...
def diagnose(
    model: Model,
    logs: _Logs,
    *,
    hold_out: _Logs | None = None,
    without: Sequence[str] = ...,
    known: Sequence[str] = ...,
    seed: int | None = None,
    tolerance_rad: float | None = None,
    horizon_s: _Horizon | None = None,
    trust_log: bool = False,
    within_s: float | None = None,
    progress: _Progress | None = None,
) -> Diagnosis: ...
def add(
    model: Model,
    effects: str | Sequence[str],
    logs: _Logs,
    *,
    hold_out: _Logs | None = None,
    horizon_s: _Horizon | None = None,
    progress: _Progress | None = None,
) -> Refit: ...
def fit(
    model: Model,
    logs: _Logs,
    *,
    free: str | Sequence[str] | None = None,
    hold_out: _Logs | None = None,
    horizon_s: _Horizon | None = None,
    progress: _Progress | None = None,
) -> Refit: ...
def simulate(
    model: Model,
    time_s: ArrayLike,
    *,
    input: _PerJoint | None = None,
    angle_rad: ArrayLike | None = None,
    speed_rad_s: ArrayLike | None = None,
    supply_v: ArrayLike | None = None,
    payload_kg: float = 0.0,
) -> Motion: ...
def gains(
    model: Model,
    *,
    q: ArrayLike | None = None,
    r: ArrayLike | None = None,
    ts_s: float | None = 0.01,
    delay_s: float | None = None,
    pose_rad: ArrayLike | None = None,
    balance: bool = False,
    progress: _Progress | None = None,
) -> Gains: ...
