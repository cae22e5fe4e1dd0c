"""Measure a robot, learn which physical effect its model lacks, and control it.

>>> import handstand as hs
>>> model = hs.Model.load("arm.toml")
>>> diagnosis = hs.diagnose(model, ["a.csv", "b.csv"], hold_out="c.csv")
>>> better = hs.add(model, diagnosis.effects, ["a.csv", "b.csv"], hold_out="c.csv").model
>>> hs.gains(better).k

Angles are in rad, times in s, torques in N m. Everything is computed by the library behind the
command line; ``to_dict()`` has the keys of its ``--json``.
"""

from ._native import (
    Comparison,
    DataError,
    Diagnosis,
    Gains,
    HandstandError,
    Model,
    Motion,
    Refit,
    UsageError,
    add,
    compare,
    diagnose,
    fit,
    gains,
    read_log,
    simulate,
)

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
