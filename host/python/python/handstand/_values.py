"""Values with names."""

from typing import NamedTuple


class FittedValue(NamedTuple):
    """A fitted value and its interval at 95 %, in the unit that its address ends in."""

    value: float
    low: float
    high: float
