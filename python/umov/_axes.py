"""What figures over time share: axes, the stretches that a line joins, ticks with a date."""
from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .errors import UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .light_curves import LightCurve


def axes_or_new(axes: Axes | None, projection: str | None = None) -> Axes:
    """Those given, or those of a new figure."""
    if axes is not None:
        return axes
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise UsageError("a figure needs the package matplotlib: pip install matplotlib") from error
    made: Axes = plt.figure(figsize=(7, 4.5), layout="constrained").add_subplot(projection=projection)
    return made


def passes_of(curve: LightCurve) -> Iterator[NDArray[np.intp]]:
    """Epochs of each pass: no line joins two of them."""
    ids = curve.pass_id
    for one in dict.fromkeys(ids.tolist()):
        yield np.flatnonzero(ids == one)


def every(count: int) -> int:
    """Some two dozen markers on a line, however many points it has."""
    return max(1, count // 24)


def time_axis(axes: Axes) -> None:
    """Short ticks, and the date once beside them."""
    from matplotlib.dates import AutoDateLocator, ConciseDateFormatter
    locator = AutoDateLocator(minticks=3, maxticks=8)  # type: ignore[no-untyped-call]
    axes.xaxis.set_major_locator(locator)
    axes.xaxis.set_major_formatter(ConciseDateFormatter(locator))  # type: ignore[no-untyped-call]
    axes.set_xlabel("UTC")
