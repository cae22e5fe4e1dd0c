"""Measure a robot, learn which physical effect its model lacks, and control it.

>>> import handstand as hs
>>> model = hs.Model.load("arm.toml")
>>> diagnosis = hs.diagnose(model, ["a.csv", "b.csv"], holdout="c.csv")
>>> better = hs.add(model, diagnosis.effects, ["a.csv", "b.csv"], holdout="c.csv").model
>>> hs.gains(better).k

Angles are in rad, times in s, torques in N m. Everything is computed by the library behind the
command line; ``to_dict()`` has the keys of its ``--json``.
"""

from ._errors import (
    AddressError,
    DataError,
    FileError,
    HandstandError,
    UsageError,
)
from ._native import (
    Comparison,
    Diagnosis,
    Discovery,
    Draft,
    Gains,
    LogCheck,
    Model,
    Motion,
    Proposal,
    Refit,
    __version__,
    add,
    compare,
    diagnose,
    discover,
    drift,
    effects,
    fit,
    gains,
    init,
    log_check,
    next,  # noqa: A004, as the command is called
    read_log,
    simulate,
)
from ._values import FittedValue

__all__ = [
    "AddressError",
    "Comparison",
    "DataError",
    "Diagnosis",
    "Discovery",
    "Draft",
    "FileError",
    "FittedValue",
    "Gains",
    "HandstandError",
    "LogCheck",
    "Model",
    "Motion",
    "Proposal",
    "Refit",
    "UsageError",
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
