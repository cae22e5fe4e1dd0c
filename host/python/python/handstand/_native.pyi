from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, ClassVar, Literal, Protocol, TypeAlias, final, type_check_only

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._values import FittedValue

__all__ = [
    "Comparison",
    "Diagnosis",
    "Discovery",
    "Draft",
    "Gains",
    "LogCheck",
    "Model",
    "Motion",
    "Proposal",
    "Refit",
    "__version__",
    "add",
    "compare",
    "diagnose",
    "discover",
    "drift",
    "effects",
    "fit",
    "gains",
    "init",
    "log_check",
    "next",
    "read_log",
    "simulate",
]

__version__: str

@type_check_only
class _Frame(Protocol):
    """A table as pandas has it."""

    @property
    def columns(self) -> Any: ...
    @property
    def index(self) -> Any: ...
    def to_csv(self, path_or_buf: Any = ..., /, *, index: bool = ...) -> Any: ...

_Row: TypeAlias = NDArray[np.float64]
_File: TypeAlias = str | PathLike[str]
_Log: TypeAlias = _File | Motion | _Frame
_Logs: TypeAlias = _Log | Sequence[_Log]
_Horizon: TypeAlias = float | Literal["whole"]
_Progress: TypeAlias = Callable[[str, int, int], object]
_PerJoint: TypeAlias = ArrayLike | Sequence[ArrayLike | None]

@final
class Model:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def __new__(cls, toml: str, name: str = "model.toml") -> Model: ...
    @property
    def values(self) -> dict[str, float]: ...
    def __getitem__(self, address: str, /) -> float: ...
    def __setitem__(self, address: str, value: float, /) -> None: ...
    def __contains__(self, address: str, /) -> bool: ...
    def __iter__(self) -> Iterator[str]: ...
    def __eq__(self, other: object, /) -> bool: ...
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
    __hash__: ClassVar[None]  # type: ignore[assignment]
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
    @property
    def torque_on(self) -> list[bool] | None: ...
    @property
    def turned(self) -> bool: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __len__(self) -> int: ...

@final
class Comparison:
    @property
    def rms(self) -> list[float]: ...
    @property
    def floor(self) -> list[float]: ...
    @property
    def motions(self) -> list[Motion]: ...
    @property
    def predictions(self) -> list[_Row]: ...
    @property
    def residuals(self) -> list[_Row]: ...
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
class Discovery:
    @property
    def verdict(self) -> str: ...
    @property
    def terms(self) -> list[str]: ...
    @property
    def model(self) -> Model | None: ...
    def to_dict(self) -> dict[str, Any]: ...
    def html(self) -> str: ...
    def _repr_html_(self) -> str: ...

@final
class Refit:
    @property
    def model(self) -> Model: ...
    @property
    def values(self) -> dict[str, FittedValue]: ...
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
    @property
    def margins(self) -> dict[str, Any] | None: ...
    def c_header(self, name: str = "gains") -> str: ...
    def rust_file(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...
    def _repr_html_(self) -> str: ...

@final
class Draft:
    @property
    def model(self) -> Model: ...
    @property
    def guesses(self) -> list[dict[str, str]]: ...
    @property
    def values(self) -> list[dict[str, Any]]: ...
    def to_dict(self) -> dict[str, Any]: ...

@final
class LogCheck:
    @property
    def verdict(self) -> str: ...
    @property
    def findings(self) -> list[dict[str, Any]]: ...
    def to_dict(self) -> dict[str, Any]: ...

@final
class Proposal:
    @property
    def helps(self) -> bool: ...
    @property
    def instructions(self) -> list[str]: ...
    @property
    def motion(self) -> Motion | None: ...
    @property
    def summary(self) -> list[str]: ...
    def to_dict(self) -> dict[str, Any]: ...

def init(
    log: _File | _Frame,
    *,
    name: str | None = None,
    drive: str | None = None,
    angle_zero: str | None = None,
    angles: str | None = None,
    length_m: Sequence[float] | None = None,
    mass_kg: Sequence[float] | None = None,
    robot: _File | None = None,
    lock: dict[str, float] | None = None,
    names: dict[str, str] | None = None,
    calibration: _File | None = None,
    unit: str | None = None,
) -> Draft: ...
def log_check(model: Model, logs: _Logs) -> LogCheck: ...
def drift(
    model: Model,
    logs: Sequence[_Logs],
    *,
    free: str | Sequence[str] | None = None,
    horizon_s: _Horizon | None = None,
) -> dict[str, Any]: ...
def effects(name: str | None = None) -> Any: ...
def next(
    model: Model,
    logs: _Logs,
    *,
    holdout: _Logs | None = None,
    value: str | Sequence[str] | None = None,
    criterion: str = "d",
    angles_rad: tuple[float, float] | Sequence[tuple[float, float]] | None = None,
    speed_rad_s: float | None = None,
    torque_nm: float | None = None,
    seconds: float = 20.0,
    mass_kg: float | None = None,
    without: Sequence[str] = ...,
    known: Sequence[str] = ...,
    trust_log: bool = False,
    seed: int = 1,
    horizon_s: _Horizon | None = None,
    progress: _Progress | None = None,
) -> Proposal: ...
def read_log(path: _File | _Frame, model: Model) -> list[Motion]: ...
def compare(model: Model, logs: _Logs, *, horizon_s: _Horizon | None = None) -> Comparison: ...
def diagnose(
    model: Model,
    logs: _Logs,
    *,
    holdout: _Logs | None = None,
    without: Sequence[str] = ...,
    known: Sequence[str] = ...,
    seed: int | None = None,
    tolerance_rad: float | None = None,
    horizon_s: _Horizon | None = None,
    trust_log: bool = False,
    within_s: float | None = None,
    progress: _Progress | None = None,
) -> Diagnosis: ...
def discover(
    model: Model,
    logs: _Logs,
    *,
    holdout: _Logs | None = None,
    terms: int = 2,
    known: Sequence[str] = ...,
    seed: int | None = None,
    horizon_s: _Horizon | None = None,
    within_s: float | None = None,
    progress: _Progress | None = None,
) -> Discovery: ...
def add(
    model: Model,
    effects: str | Sequence[str],
    logs: _Logs,
    *,
    holdout: _Logs | None = None,
    horizon_s: _Horizon | None = None,
    progress: _Progress | None = None,
) -> Refit: ...
def fit(
    model: Model,
    logs: _Logs,
    *,
    free: str | Sequence[str] | None = None,
    holdout: _Logs | None = None,
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
    pose_rad: ArrayLike | Mapping[str, float] | None = None,
    balance: bool = False,
    position_step_rad: float | None = None,
    speeds: Literal["true", "difference"] = "true",
    progress: _Progress | None = None,
) -> Gains: ...
