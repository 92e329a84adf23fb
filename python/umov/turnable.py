"""Figures that turn under the mouse, with plotly (`pip install plotly`): the colours and markers of `umov.plot`.

>>> from umov import turnable
>>> figure = turnable.q_rgb(curve)
>>> figure.layout.scene.zaxis.title.text
'650 nm [%]'
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._axes import MANY, band_title
from ._clouds import three_bands
from .errors import UsageError
from .pictures import mesh as triangles_of
from .scenarios import AnyScenario

if TYPE_CHECKING:
    from .light_curves import LightCurve

__all__ = ["mesh", "q_rgb"]


def _plotly() -> Any:
    try:
        import plotly.graph_objects as plotly
    except ImportError as error:
        raise UsageError("a figure that turns needs the package plotly: pip install plotly") from error
    return plotly


def q_rgb(curve: LightCurve, figure: Any = None) -> Any:
    """Q/I of short, middle and long wavelength [%] as a cloud in three dimensions, coloured by phase angle. Adds to
    a plotly Figure, or makes one. `UsageError` for fewer than three bands.

    Parameters
    ----------
    curve
        A light curve.
    figure
        A plotly Figure to add to; None: a new one.

    Examples
    --------
    >>> len(turnable.q_rgb(curve).data[0].x) == len(curve)
    True
    """
    plotly = _plotly()
    three = three_bands(curve)
    figure = figure if figure is not None else plotly.Figure()
    x, y, z = (100 * curve.q_scat[:, b] for b in three)
    figure.add_scatter3d(
        x=x, y=y, z=z, mode="markers", name=", ".join(curve.objects), text=curve.time.isot.tolist(),
        marker={"size": 3, "color": curve.phase_angle, "colorscale": "cividis", "cmin": 0, "cmax": 180,
                "colorbar": {"title": "phase angle [°]"}})
    names = {f"{axis}axis": {"title": {"text": f"{band_title(curve.bands[b])} [%]"}} for axis, b in zip("xyz", three)}
    figure.update_layout(scene=names, margin={"l": 0, "r": 0, "t": 30, "b": 0})
    return figure


def mesh(scene: AnyScenario, figure: Any = None, *, object: int = 0) -> Any:
    """The triangles of an object [m, body frame], a colour for each mesh material.

    Parameters
    ----------
    scene
        A path, dictionary, Scenario or Satellite.
    figure
        A plotly Figure to add to; None: a new one.
    object
        Number of the object, from 0.

    Examples
    --------
    >>> figure = turnable.mesh(hst)
    >>> "light_shield" in [trace.name for trace in figure.data]
    True
    """
    plotly = _plotly()
    made = triangles_of(scene, object=object)
    figure = figure if figure is not None else plotly.Figure()
    for number, name in enumerate(made.group_names):
        faces = made.faces[made.groups == number].astype(np.int64)
        if not len(faces):
            continue
        figure.add_mesh3d(x=made.vertices[:, 0], y=made.vertices[:, 1], z=made.vertices[:, 2], i=faces[:, 0],
                          j=faces[:, 1], k=faces[:, 2], color=MANY[number % len(MANY)], name=name, showlegend=True,
                          flatshading=True, hoverinfo="name")
    axes = {f"{axis}axis": {"title": {"text": f"{axis} [m]"}} for axis in "xyz"}
    figure.update_layout(scene={"aspectmode": "data", **axes}, margin={"l": 0, "r": 0, "t": 30, "b": 0})
    return figure
