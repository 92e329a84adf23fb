"""Figures of the report with matplotlib: axes in, axes out, the same colours and markers.

>>> from umov import plot
>>> axes = plot.q_phase(curve)
>>> axes.get_xlabel()
'phase angle [°]'
"""
from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._axes import MANY, MARKERS, PHASE_MAP, THREE, axes_or_new as _axes, band_title, every as _every, interfaces_of as _interfaces, \
    of_a_curve as _of_a_curve, passes_of as _passes, time_axis as _time_axis
from ._clouds import q_rgb, three_bands
from ._turns import folded, periodogram
from .errors import UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .light_curves import LightCurve
    from .pictures import Picture

__all__ = ["band_styles", "band_title", "colour_index", "contributions", "degree", "folded", "intensity", "magnitude", "overview",
           "periodogram", "picture", "position_angle", "pure_materials", "q_phase", "q_rgb",
           "qu_plane", "qu_time", "sky_track", "three_bands"]

CYCLIC_MAP = "twilight"
_NORTH = {"equatorial": "celestial north", "altaz": "the local zenith",
          "scattering": "the normal of the scattering plane"}


@_of_a_curve
def band_styles(curve: LightCurve) -> list[dict[str, Any]]:
    """Colour and marker of each band, by wavelength.

    Parameters
    ----------
    curve
        A light curve.

    Examples
    --------
    >>> [style["color"] for style in plot.band_styles(curve)]
    ['#0072b2', '#009e73', '#d55e00']
    """
    waves = curve["lambda_eff"][0]
    rank = np.argsort(np.argsort(waves, kind="stable"), kind="stable")
    palette = THREE if len(waves) <= 3 else MANY
    return [{"color": palette[k % len(palette)], "marker": MARKERS[k % len(MARKERS)], "markersize": 4,
             "linewidth": 1.5} for k in rank]


def _over_time(curve: LightCurve, axes: Axes | None, rows: NDArray[np.float64], label: str, *,
               cyclic: bool = False, bands: list[str] | None = None,
               styles: list[dict[str, Any]] | None = None) -> Axes:
    axes = _axes(axes)
    times = curve.time.datetime64
    for b, (style, name) in enumerate(zip(styles or band_styles(curve), bands or map(band_title, curve.bands))):
        for k, part in enumerate(_passes(curve)):
            values = rows[part, b].astype(np.float64)
            if cyclic:  # no line joins 180 to 0
                values[1:][np.abs(np.diff(values)) > 90] = np.nan
            axes.plot(times[part], values, label=name if k == 0 else None, markevery=_every(len(part)), **style)
    axes.set_ylabel(label)
    _time_axis(axes)
    axes.grid(alpha=0.3)
    _name_bands(axes, bands or [band_title(one) for one in curve.bands])
    return axes


def _name_bands(axes: Axes, names: list[str]) -> None:
    """A legend of several; one stands over the figure."""
    if len(names) > 1:
        axes.legend(fontsize="small")
    elif names:
        axes.set_title(names[0], loc="right", fontsize="small")


@_of_a_curve
def magnitude(curve: LightCurve, axes: Axes | None = None) -> Axes:
    """Magnitude over time, bright at the top.

    Parameters
    ----------
    curve
        A light curve.
    axes
        To draw into; None: a new figure.

    Examples
    --------
    >>> bool(plot.magnitude(curve).yaxis_inverted())
    True
    """
    axes = _over_time(curve, axes, curve.mag, f"{curve.mag_system} magnitude")
    if not axes.yaxis_inverted():
        axes.invert_yaxis()
    return axes


@_of_a_curve
def intensity(curve: LightCurve, axes: Axes | None = None) -> Axes:
    """Intensity without distance and solar flux over time.

    Parameters
    ----------
    curve
        A light curve.
    axes
        To draw into; None: a new figure.

    Examples
    --------
    >>> plot.intensity(curve).get_yscale()
    'log'
    """
    axes = _over_time(curve, axes, np.where(curve.intensity > 0, curve.intensity, np.nan), "intensity [m² sr⁻¹]")
    axes.set_yscale("log")
    return axes


@_of_a_curve
def qu_time(curve: LightCurve, axes: tuple[Axes, Axes] | None = None) -> tuple[Axes, Axes]:
    """q and u over time, in percent of I, in the sky frame.

    Parameters
    ----------
    curve
        A light curve.
    axes
        Two, to draw into; None: a new figure.

    Examples
    --------
    >>> upper, lower = plot.qu_time(curve)
    >>> lower.get_ylabel()
    'u [%]'
    """
    if axes is None:
        import matplotlib.pyplot as plt
        upper, lower = plt.figure(figsize=(7, 5), layout="constrained").subplots(2, 1, sharex=True)
        axes = (upper, lower)
    north = _NORTH.get(curve.table.notes.get("pol_frame", ""), "north")
    _over_time(curve, axes[0], 100 * curve.q, "q [%]").set_title(f"+q towards {north}", fontsize="small")
    return axes[0], _over_time(curve, axes[1], 100 * curve.u, "u [%]")


@_of_a_curve
def degree(curve: LightCurve, axes: Axes | None = None) -> Axes:
    """Degree of linear polarization over time, in percent.

    Parameters
    ----------
    curve
        A light curve.
    axes
        To draw into; None: a new figure.

    Examples
    --------
    >>> plot.degree(curve).get_ylabel()
    'p [%]'
    """
    return _over_time(curve, axes, 100 * curve.p, "p [%]")


@_of_a_curve
def position_angle(curve: LightCurve, axes: Axes | None = None) -> Axes:
    """Position angle over time; it is cyclic, and no line joins 180 to 0 deg.

    Parameters
    ----------
    curve
        A light curve.
    axes
        To draw into; None: a new figure.

    Examples
    --------
    >>> [float(end) for end in plot.position_angle(curve).get_ylim()]
    [0.0, 180.0]
    """
    axes = _over_time(curve, axes, curve.pa, "position angle [°]", cyclic=True)
    axes.set(ylim=(0, 180), yticks=range(0, 181, 45))
    return axes


@_of_a_curve
def q_phase(curve: LightCurve, axes: Axes | None = None) -> Axes:
    """Q/I in the scattering frame against phase angle.

    Parameters
    ----------
    curve
        A light curve.
    axes
        To draw into; None: a new figure.

    Examples
    --------
    >>> plot.q_phase(curve).get_ylabel()
    'q_scat [%]'
    """
    axes = _axes(axes)
    for b, (style, name) in enumerate(zip(band_styles(curve), map(band_title, curve.bands))):
        for k, part in enumerate(_passes(curve)):
            axes.plot(curve.phase_angle[part], 100 * curve.q_scat[part, b], label=name if k == 0 else None,
                      markevery=_every(len(part)), **style)
    axes.axhline(0, color="0.5", linewidth=0.8)
    axes.set(xlabel="phase angle [°]", ylabel="q_scat [%]")
    axes.grid(alpha=0.3)
    _name_bands(axes, [band_title(one) for one in curve.bands])
    return axes


@_of_a_curve
def pure_materials(curve: LightCurve, axes: Axes | None = None) -> Axes:
    """Q/I against phase angle of a surface of one material of the object alone, one reflection at its interface:
    thin lines to draw behind `q_phase`. A measured material has no interface and no line.

    Parameters
    ----------
    curve
        A light curve.
    axes
        To draw into; None: a new figure.

    Examples
    --------
    >>> axes = plot.pure_materials(curve, plot.q_phase(curve))
    >>> "film_silvered" in [text.get_text() for text in axes.get_legend().get_texts()]
    True
    """
    from .materials import Material
    axes = _axes(axes)
    phase = np.arange(0.0, 179.5, 1.0)
    for k, (name, table) in enumerate(_interfaces(curve)):
        interface = Material.from_dict(name, table)
        for b, style in enumerate(band_styles(curve)):
            f = interface.brdf(float(curve["lambda_eff"][0, b]), phase / 2, phase / 2, 180)
            axes.plot(phase, 100 * f[:, 1, 0] / f[:, 0, 0], color=style["color"], linewidth=0.8, alpha=0.6, zorder=1,
                      linestyle=("-", "--", ":", "-.")[k % 4], label=name if b == 0 else None)
    axes.set(xlabel="phase angle [°]", ylabel="q_scat [%]")
    axes.legend(fontsize="small")
    return axes


@_of_a_curve
def contributions(curve: LightCurve, axes: Axes | None = None, *, band: str | int = 0) -> Axes:
    """Direct light of each material over time, as parts of all direct light, on top of each other.

    Parameters
    ----------
    curve
        A light curve.
    axes
        To draw into; None: a new figure.
    band
        Its name, or its number along the second axis.

    Examples
    --------
    >>> axes = plot.contributions(curve)
    >>> axes.get_ylabel(), len(axes.collections) == len(curve.contributions)
    ('share of the direct light', True)
    """
    if not curve.contributions:
        raise UsageError("the curve does not know what each material gives; one that umov.run made was expected")
    axes = _axes(axes)
    which = curve.band(band)
    rows = np.stack([light[:, which] for light in curve.contributions.values()])
    with np.errstate(invalid="ignore"):
        share = rows / rows.sum(axis=0)
    times = curve.time.datetime64
    for part in _passes(curve):
        axes.stackplot(times[part], share[:, part], labels=list(curve.contributions) if part[0] == 0 else [],
                       colors=[MANY[k % len(MANY)] for k in range(len(rows))])
    axes.set(ylabel="share of the direct light", ylim=(0, 1))
    _time_axis(axes)
    axes.legend(fontsize="small", loc="upper left")
    return axes


def picture(image: Picture, axes: Axes | None = None) -> Axes:
    """A picture of `umov.render`, up as it was asked for.

    Parameters
    ----------
    image
        Of `umov.render`.
    axes
        To draw into; None: a new figure.

    Examples
    --------
    >>> plot.picture(umov.render(hst, sun=[1, 1, 1], observer=[0, 1, 1], side=64, samples=1)).get_title()
    'material'
    """
    import io

    from .pictures import Picture as Wanted
    if not isinstance(image, Wanted):
        raise UsageError(f"image is a {type(image).__name__}; a Picture was expected, as umov.render gives")
    axes = _axes(axes)
    from matplotlib.image import imread
    axes.imshow(imread(io.BytesIO(image.png)))
    axes.set(title=image.shade, xticks=[], yticks=[])
    return axes


@_of_a_curve
def qu_plane(curve: LightCurve, axes: Axes | None = None) -> Axes:
    """u against q, coloured by phase angle; bands differ by marker.

    Parameters
    ----------
    curve
        A light curve.
    axes
        To draw into; None: a new figure.

    Examples
    --------
    >>> plot.qu_plane(curve).get_xlabel()
    'q [%]'
    """
    axes = _axes(axes)
    drawn = None
    for b, style in enumerate(band_styles(curve)):
        drawn = axes.scatter(100 * curve.q[:, b], 100 * curve.u[:, b], c=curve.phase_angle, cmap=PHASE_MAP, s=14,
                             marker=style["marker"], label=band_title(curve.bands[b]), vmin=0, vmax=180)
    axes.axhline(0, color="0.5", linewidth=0.8)
    axes.axvline(0, color="0.5", linewidth=0.8)
    axes.set(xlabel="q [%]", ylabel="u [%]", aspect="equal")
    if drawn is not None and axes.figure is not None:
        axes.figure.colorbar(drawn, ax=axes, label="phase angle [°]")
    axes.legend(fontsize="small")
    return axes


@_of_a_curve
def colour_index(curve: LightCurve, axes: Axes | None = None) -> Axes:
    """Shorter minus longer wavelength over time, in magnitudes: larger is redder.

    Parameters
    ----------
    curve
        A light curve.
    axes
        To draw into; None: a new figure.

    Examples
    --------
    >>> [text.get_text() for text in plot.colour_index(curve).get_legend().get_texts()]
    ['425 nm − 550 nm', '550 nm − 650 nm']
    """
    if len(curve.bands) < 2:
        raise UsageError("the curve has one band; two or more were expected")
    order = np.argsort(curve["lambda_eff"][0], kind="stable").tolist()
    pairs = list(itertools.pairwise(order))
    rows = np.stack([curve.mag[:, a] - curve.mag[:, b] for a, b in pairs], axis=1)
    styles = [{"color": MANY[(2 * k) % 7], "marker": MARKERS[k % 7], "markersize": 4} for k in range(len(pairs))]
    names = [f"{band_title(curve.bands[a])} − {band_title(curve.bands[b])}" for a, b in pairs]
    axes = _over_time(curve, axes, rows, "colour [mag]", bands=names, styles=styles)
    axes.legend(fontsize="small")
    return axes


@_of_a_curve
def sky_track(curve: LightCurve, axes: Any = None) -> Any:
    """Where the object stood, north up and east to the left as one looks up, coloured by phase angle.

    Parameters
    ----------
    curve
        A light curve.
    axes
        To draw into; None: a new figure.

    Examples
    --------
    >>> plot.sky_track(curve).name
    'polar'
    """
    axes = _axes(axes, "polar")
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(1)
    for part in _passes(curve):
        theta, radius = np.radians(curve.az[part]), 90 - curve.alt[part]
        axes.plot(theta, radius, color="0.7", linewidth=1)
        drawn = axes.scatter(theta, radius, c=curve.phase_angle[part], cmap=PHASE_MAP, s=10, vmin=0, vmax=180)
    axes.set_rlim(0, 90)
    axes.set_rgrids([0, 30, 60, 90], ["90°", "60°", "30°", ""])
    axes.set_thetagrids(range(0, 360, 45), ["N", "NE", "E", "SE", "S", "SW", "W", "NW"])
    if axes.figure is not None and len(curve):
        axes.figure.colorbar(drawn, ax=axes, label="phase angle [°]", shrink=0.8)
    return axes


@_of_a_curve
def overview(curve: LightCurve, figure: Figure | None = None) -> Figure:
    """Magnitude, q, u, p and position angle over time, and Q against phase, in one figure.

    Parameters
    ----------
    curve
        A light curve.
    figure
        To draw into; None: a new one.

    Examples
    --------
    >>> len(plot.overview(curve).axes)
    6
    """
    if figure is None:
        try:
            import matplotlib.pyplot as plt
        except ImportError as error:
            raise UsageError("a figure needs the package matplotlib: pip install matplotlib") from error
        figure = plt.figure(figsize=(10, 7))
    if not hasattr(figure, "set_layout_engine"):
        raise UsageError(f"figure is a {type(figure).__name__}; a Figure of matplotlib was expected, or None for a new one")
    figure.set_layout_engine("constrained")
    axes = figure.subplots(3, 2)
    magnitude(curve, axes[0, 0])
    q_phase(curve, axes[0, 1])
    qu_time(curve, (axes[1, 0], axes[1, 1]))
    degree(curve, axes[2, 0])
    position_angle(curve, axes[2, 1])
    for one in axes.ravel()[1:]:
        if (legend := one.get_legend()) is not None:
            legend.remove()
    for one in (axes[0, 0], axes[1, 0], axes[1, 1]):
        one.tick_params("x", labelbottom=False)
        one.set_xlabel("")
        one.xaxis.offsetText.set_visible(False)
    if title := _heading(curve):
        figure.suptitle(title)
    return figure


def _heading(curve: LightCurve) -> str:
    """What the scenario is called, and the site where that does not say it."""
    if curve.scenario is None:
        return ""
    title = curve.scenario.title or ", ".join(curve.objects)
    site = str(curve.scenario.to_dict().get("observer", {}).get("name", ""))
    return title if not site or site.lower() in title.lower() else f"{title} from {site}"
