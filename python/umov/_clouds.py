"""Clouds of Q/I in three bands."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._axes import PHASE_MAP, THREE, axes_or_new as _axes, band_title, of_a_curve as _of_a_curve
from ._numbers import number_array, real_array
from .errors import UsageError
from .passbands import Bands, names_of

if TYPE_CHECKING:
    from .engines import Light
    from .light_curves import LightCurve


@_of_a_curve
def three_bands(curve: LightCurve) -> list[int]:
    """Numbers of the shortest, the middle and the longest band. `UsageError` if there are fewer than three.

    Parameters
    ----------
    curve
        A light curve.

    Examples
    --------
    >>> plot.three_bands(curve)
    [0, 1, 2]
    """
    if len(curve.bands) < 3:
        raise UsageError(f"the curve has {len(curve.bands)} bands; three or more were expected")
    order = np.argsort(curve["lambda_eff"][0], kind="stable")
    return [int(order[0]), int(order[len(order) // 2]), int(order[-1])]


def q_rgb(curve: LightCurve | Light | ArrayLike, axes: Any = None, *, bands: Sequence[str] | None = None,
          phase_deg: ArrayLike | None = None) -> Any:
    """Q/I of short, middle and long wavelength as a cloud in three dimensions, coloured by phase angle.

    Parameters
    ----------
    curve
        A light curve; or poses, as `Engine.evaluate` and `Engine.light` give them: Stokes parameters (..., band, 4).
    axes
        To draw into; None: a new figure.
    bands
        Of poses: names of the bands, as `engine.bands` has them, three or more from short to long: the first, the middle and
        the last are drawn.
    phase_deg
        Of poses: the phase angle of each [deg], or one for all; None: all in one colour.

    Notes
    -----
    Poses in which nothing is both lit and seen have no Q/I and are left out.

    Examples
    --------
    >>> plot.q_rgb(curve).get_zlabel()
    '650 nm [%]'
    >>> three = umov.Engine(hst, bands="paper_rgb", method="masks")
    >>> light = three.evaluate(*umov.random_poses(50, phase_deg=60))
    >>> plot.q_rgb(light, bands=three.bands, phase_deg=60).get_xlabel()
    '425 nm [%]'
    """
    from .light_curves import LightCurve as Curve
    if isinstance(curve, Curve):
        if bands is not None or phase_deg is not None:
            raise UsageError("bands and phase_deg are of poses; a light curve has its own")
        three = three_bands(curve)
        return _cloud(100 * curve.q_scat[:, three], [curve.bands[b] for b in three], curve.phase_angle, axes)
    return _cloud(*_poses_of(curve, bands, phase_deg), axes)


def _poses_of(light: Any, bands: Any, phase_deg: Any) -> tuple[NDArray[np.float64], list[str], NDArray[np.float64] | None]:
    """Q/I [%] (pose, 3), names of the bands, and phase angles of poses with light."""
    from .engines import Light as Poses
    stokes = real_array(light.stokes if isinstance(light, Poses) else light, "curve",
                        "a LightCurve, or Stokes parameters (..., band, 4) of poses,")
    named = [] if bands is None else names_of(bands.set if isinstance(bands, Bands) else bands)
    names = [named] if isinstance(named, str) else [str(one) for one in named]
    if stokes.ndim < 2 or stokes.shape[-1] != 4 or stokes.shape[-2] != len(names) or len(names) < 3:
        raise UsageError(f"curve has shape {stokes.shape} and bands are {', '.join(map(str, names)) or 'none'}; Stokes parameters (..., band, 4) "
                         "and as many names, three or more, were expected: plot.q_rgb(light, bands=engine.bands)")
    if not np.isfinite(stokes).all():
        raise UsageError("curve has values that are not finite; light of poses without NaN and infinity was expected. Leave them out.")
    which = [0, len(names) // 2, len(names) - 1]
    flat = stokes.reshape(-1, len(names), 4)[:, which]
    is_lit = (flat[..., 0] > 0).all(axis=1)
    if not is_lit.any():
        raise UsageError("no pose has light; poses with some were expected")
    phase = None
    if phase_deg is not None:
        try:
            phase = np.broadcast_to(number_array(phase_deg, "phase_deg"), stokes.shape[:-2]).reshape(-1)[is_lit]
        except ValueError as error:
            raise UsageError(f"phase_deg has shape {np.shape(phase_deg)}; that of the poses was expected, {stokes.shape[:-2]}, or one number") from error
    return 100 * flat[is_lit, :, 1] / flat[is_lit, :, 0], [names[b] for b in which], phase


def _cloud(rows: NDArray[np.float64], names: list[str], phase: NDArray[np.float64] | None, axes: Any) -> Any:
    axes = _axes(axes, "3d")
    cloud: Callable[..., Any] = axes.scatter
    colours = {"c": phase, "cmap": PHASE_MAP, "vmin": 0, "vmax": 180} if phase is not None else {"color": THREE[0]}
    drawn = cloud(*rows.T, s=8, **colours)
    for axis, name in zip("xyz", names):
        getattr(axes, f"set_{axis}label")(f"{band_title(name)} [%]")
    if axes.figure is not None and phase is not None:
        axes.figure.colorbar(drawn, ax=axes, label="phase angle [°]", shrink=0.7)
    return axes
