"""Drivers without a class of your own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy.typing as npt

from ._core import OwnDriver, Pose, Wrench

#: Where a tool is to be: a Pose, or its position alone [m].
Place = Pose | Sequence[float] | npt.NDArray[Any]


class FunctionDriver(OwnDriver):
    """Moves a tool by a function with force feedback.

    `function(time, h, on_tool)` returns the pose, or the position [m], at the end of the step from `time` to `time` + h
    [s]; `on_tool.force` is the force of the tissue in the last step [N]. PathDriver is faster for a function of time.

    >>> import glisson
    >>> def until_half_a_newton(time, h, on_tool, tip=[0.0, 0.0, 0.0201]):
    ...     tip[2] -= 0.05 * h if on_tool.force[2] < 0.5 else 0.0
    ...     return tip
    >>> driver = glisson.FunctionDriver(glisson.Pose(position=[0, 0, 0.0201]), until_half_a_newton)
    >>> needle = glisson.Needle(glisson.NeedleOptions(), driver)
    """

    def __init__(
        self, start: Pose, function: Callable[[float, float, Wrench], Place], end: float | None = None
    ) -> None:
        super().__init__(start, end)
        self._function = function

    def advance(self, time: float, h: float, on_tool: Wrench) -> Place:
        """Calls the function."""
        return self._function(time, h, on_tool)
