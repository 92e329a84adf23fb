"""Light over time: arrays (epoch, band), and the same as tables."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from . import _umov
from ._made import Made
from .errors import UsageError
from .scenarios import Scenario
from .tables import Table, same

if TYPE_CHECKING:
    import pandas
    import pyarrow
    from astropy.coordinates import SkyCoord
    from astropy.table import QTable
    from astropy.time import Time
    from astropy.timeseries import TimeSeries
    from astropy.units import Quantity
    from matplotlib.figure import Figure

__all__ = ["LightCurve"]

Floats = NDArray[np.float64]


class _Column:
    """A column of the light curve as (epoch, band), or as (epoch) where all bands share it."""

    def __init__(self, text: str, per_band: bool = False) -> None:
        self.__doc__ = text
        self._per_band = per_band

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, curve: None, owner: type) -> _Column: ...
    @overload
    def __get__(self, curve: LightCurve, owner: type) -> NDArray[Any]: ...
    def __get__(self, curve: LightCurve | None, owner: type) -> NDArray[Any] | _Column:
        if curve is None:
            return self
        rows = curve[self._name]
        return rows if self._per_band else rows[:, 0]


class LightCurve(Made):
    """A light curve: `curve.I`, `curve.q_scat` and so on are read-only arrays (epoch, band) over the
    library's memory; what all bands share (`curve.az`) is (epoch). `curve["name"]` gives any column.
    Objects of a scenario follow each other; `curve.object(name)` is one of them.

    >>> curve.I.shape == (len(curve.time), len(curve.bands))
    True
    >>> curve.bands
    ['nm:425', 'nm:550', 'nm:650']
    >>> curve.unit("I"), curve.quantity("range").unit.to_string()
    ('W / (m2 nm)', 'km')
    """

    I = _Column("irradiance at the observer above the atmosphere [W m-2 nm-1]", True)
    intensity = _Column("without distance and solar flux [m2/sr]", True)
    intensity_err = _Column("numerical 95 % half-width [m2/sr]", True)
    q = _Column("Q/I in the sky frame", True)
    u = _Column("U/I in the sky frame", True)
    v = _Column("V/I", True)
    q_err = _Column("numerical 95 % half-width of q", True)
    u_err = _Column("numerical 95 % half-width of u", True)
    v_err = _Column("numerical 95 % half-width of v", True)
    p = _Column("degree of linear polarization", True)
    p_err = _Column("numerical 95 % half-width of p", True)
    dop = _Column("degree of polarization", True)
    pa = _Column("position angle of polarization, [0, 180) [deg]", True)
    pa_err = _Column("numerical 95 % half-width of pa [deg]", True)
    q_scat = _Column("Q/I, + perpendicular to the scattering plane", True)
    u_scat = _Column("U/I in the scattering frame", True)
    mag = _Column("magnitude of `mag_system`", True)
    mag_err = _Column("numerical 95 % half-width of mag", True)
    mag_limit = _Column("the object is fainter than mag", True)
    mjd_utc = _Column("UTC as modified Julian date [d]")
    name = _Column("object")
    pass_id = _Column("catalogue number and culmination")
    sunlit = _Column("visible part of the Sun's disk")
    az = _Column("azimuth from north through east, geometric [deg]")
    alt = _Column("altitude, geometric [deg]")
    ra = _Column("right ascension, topocentric, GCRS axes [deg]")
    dec = _Column("declination, topocentric, GCRS axes [deg]")
    range = _Column("distance from the site [km]")
    range_rate = _Column("positive: receding [km/s]")
    phase_angle = _Column("Sun-object-observer, 0 = full [deg]")
    sun_alt = _Column("altitude of the Sun at the site, airless [deg]")
    airmass = _Column("Kasten & Young 1989")
    pa_scat = _Column("position angle of the normal of the scattering plane [deg]")
    glint = _Column("a flat mirror-like part gives most of the light")
    elset_age = _Column("time since the epoch of the elements [d]")

    def __init__(self, table: Table, passes: Table, jd: tuple[Floats, Floats], epochs: list[int],
                 bands: list[str], scenario: Scenario | None, is_partial: bool = False,
                 contributions: Mapping[str, Floats] | None = None) -> None:
        self.table = table  #: all rows, those of lightcurve.ecsv
        self.passes = passes  #: a row per pass, those of passes.ecsv
        self._bands = list(bands)
        self.scenario = scenario  #: what was asked
        self.is_partial = is_partial  #: it ended early
        #: direct light of each material of the object, name to (epoch, band) [m2/sr]; they add up to `intensity` where
        #: no light between surfaces was asked for
        self.contributions: dict[str, Floats] = dict(contributions or {})
        self._jd = jd
        self._epochs = epochs

    @classmethod
    def _from_run(cls, run: _umov.Run, scenario: Scenario) -> LightCurve:
        return cls(Table(run.light_curve), Table(run.passes), (run.jd1, run.jd2), list(run.epochs),
                   scenario.bands, scenario, run.stopped is not None, _by_material(run.contributions))

    @property
    def bands(self) -> list[str]:
        """Names of the bands, in the order of the second axis."""
        return list(self._bands)

    @property
    def objects(self) -> list[str]:
        """Names of the objects that have rows."""
        return list(dict.fromkeys(self.name.tolist()))

    def object(self, name: str) -> LightCurve:
        """The epochs of one object; no copy.

        Parameters
        ----------
        name
            Of the object; `UsageError` with the names for what is none.

        Examples
        --------
        >>> len(curve.object("HST").time) == len(curve.time)
        True
        """
        first = 0
        for count in self._epochs:
            if str(self.name[first]) == name:
                return _Part(self, slice(first, first + count))
            first += count
        raise UsageError(f"there is no object \"{name}\"; there are {', '.join(self.objects)}")

    @property
    def mag_system(self) -> str:
        """System of the magnitudes: AB, ST or Vega."""
        return str(self.table["mag_system"][0]) if len(self.table["mag_system"]) else "AB"

    @property
    def time(self) -> Time:
        """UTC of every epoch, exact to 1 us."""
        from astropy.time import Time
        return Time(self._jd[0], self._jd[1], format="jd", scale="utc")

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.table[name].reshape(-1, len(self._bands))

    def __len__(self) -> int:
        return len(self._jd[0])

    def unit(self, name: str) -> str:
        """Unit of a column as astropy spells it; "" for none.

        Parameters
        ----------
        name
            Of the column.
        """
        return self.table.unit(name)

    def quantity(self, name: str) -> Quantity:
        """A column with its unit.

        Parameters
        ----------
        name
            Of the column; a magnitude comes as astropy's Magnitude.
        """
        from astropy import units
        values = getattr(self, name) if isinstance(getattr(type(self), name, None), _Column) else self[name]
        unit = self.unit(name)
        if unit.startswith("mag("):
            return units.Magnitude(values, unit=units.Unit(unit), copy=False)
        if values.dtype.kind not in "fiub":
            raise UsageError(f"the column \"{name}\" holds no numbers and has no unit; a column of numbers was expected")
        return units.Quantity(values, unit=units.Unit(unit), copy=False)

    def band(self, band: str | int) -> int:
        """Number of a band along the second axis.

        Parameters
        ----------
        band
            Its name, or its number along the second axis.

        Notes
        -----
        `UsageError` with the names for what is none.
        """
        if isinstance(band, str) and band in self.bands:
            return self.bands.index(band)
        if isinstance(band, (int, np.integer)) and not isinstance(band, bool) and -len(self.bands) <= band < len(self.bands):
            return int(band)
        raise UsageError(f"there is no band {band!r}; there are {', '.join(self.bands)}")

    def to_qtable(self) -> QTable:
        """Rows and columns of lightcurve.ecsv, one row per epoch and band."""
        return self.table.to_qtable()

    def to_table(self) -> QTable:
        """The same as `to_qtable`."""
        return self.to_qtable()

    def to_pandas(self) -> pandas.DataFrame:
        """The same rows as a pandas DataFrame."""
        return self.table.to_pandas()

    def to_arrow(self) -> pyarrow.Table:
        """The same rows as a pyarrow Table."""
        return self.table.to_arrow()

    def to_timeseries(self, band: str | int | None = None) -> TimeSeries:
        """An astropy TimeSeries, one row per epoch: columns (epoch, band), or of one band.

        Parameters
        ----------
        band
            Its name or number; None: columns (epoch, band).

        Examples
        --------
        >>> curve.to_timeseries("nm:550")["mag"].shape == curve.time.shape
        True
        """
        from astropy.timeseries import TimeSeries
        which = None if band is None else self.band(band)
        columns = {}
        for name in self.table.names:
            if name in ("time_utc", "mjd_utc", "band", "lambda_eff"):
                continue
            shared = isinstance(getattr(type(self), name, None), _Column) and getattr(self, name).ndim == 1
            rows = self[name][:, 0] if shared else self[name] if which is None else self[name][:, which]
            unit = self.unit(name)
            columns[name] = _with_unit(rows, unit)
        out = TimeSeries(time=self.time, data=columns)
        out.meta.update(self.table.notes, bands=self.bands if which is None else [self.bands[which]])
        return out

    def to_skycoord(self) -> SkyCoord:
        """Where the object stood, topocentric along the axes of the GCRS and with its distance, one place per epoch.

        >>> curve.to_skycoord().distance.to("km").value.shape == curve.time.shape
        True
        """
        from astropy import units
        from astropy.coordinates import GCRS, CartesianRepresentation, SkyCoord
        from astropy.utils import iers

        from .sites import Site
        if self.scenario is None:
            raise UsageError("the curve has no scenario, so no site; one that umov.run made was expected")
        place = Site(self.scenario.to_dict()["observer"]).to_earth_location()
        # The tables that come with astropy: nothing is fetched for a place.
        with iers.conf.set_temp("auto_download", False), iers.conf.set_temp("iers_degraded_accuracy", "ignore"):
            origin, _ = place.get_gcrs_posvel(self.time)
        at_rest = CartesianRepresentation([0, 0, 0] * units.m / units.s)
        frame = GCRS(obstime=self.time, obsgeoloc=origin, obsgeovel=at_rest)
        return SkyCoord(self.ra * units.deg, self.dec * units.deg, distance=self.range * units.km, frame=frame)

    def to_lightkurve(self, band: str | int = 0) -> Any:
        """A lightkurve LightCurve of one band: flux is `I`, flux_err what the half-width means as one
        standard deviation.

        Parameters
        ----------
        band
            Its name, or its number along the second axis.
        """
        try:
            from lightkurve import LightCurve as Lightkurve  # type: ignore[import-not-found,unused-ignore]
        except ImportError as error:
            raise UsageError("a lightkurve LightCurve needs the package: pip install lightkurve") from error
        which = self.band(band)
        flux = self.quantity("I")[:, which]
        with np.errstate(divide="ignore", invalid="ignore"):
            error_share = self.intensity_err[:, which] / self.intensity[:, which] / 1.96
        return Lightkurve(time=self.time, flux=flux, flux_err=flux * error_share,
                          meta={"LABEL": ", ".join(self.objects), "BAND": self.bands[which]})

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes .csv, .ecsv, .fits or .json: the bytes of the command's lightcurve file.

        Parameters
        ----------
        path
            Its suffix says the format; `UsageError` for another one, `DeviceError` where it cannot be written.
        """
        self.table.write(path)

    def plot(self, figure: Figure | None = None) -> Figure:
        """Magnitude, q and u, p and position angle over time, and Q against phase.

        Parameters
        ----------
        figure
            A matplotlib Figure to draw into; None: a new one.
        """
        from . import plot
        return plot.overview(self, figure)

    def _own_rows(self) -> Table | QTable:
        return self.table

    def _summary(self) -> list[str]:
        lines = [f"{', '.join(self.objects)}: {len(self)} epochs x {len(self.bands)} bands "
                 f"({', '.join(self.bands)}){', PARTIAL: the run stopped early' if self.is_partial else ''}"]
        for number, one in enumerate(self.passes["pass_id"].tolist()):
            here = self.pass_id == one
            middle = len(self.bands) // 2  # a range over several bands would mix the object's colour into it
            mag, p = self.mag[here][:, middle], self.p[here][:, middle]
            phase = self.phase_angle[here]
            text = f"{one}  max alt {self.passes['culmination_alt'][number]:.0f} deg"
            if here.any():
                text += f"  phase {phase.min():.0f}-{phase.max():.0f} deg"
            if np.isfinite(mag).any():
                text += f"  {self.bands[middle].removeprefix('nm:')}{' nm' if self.bands[middle].startswith('nm:') else ''}: mag {np.nanmin(mag):.1f} to {np.nanmax(mag):.1f} {self.mag_system}"
            if np.isfinite(p).any():
                text += f"  p up to {100 * np.nanmax(p):.0f} %"
            lines.append(text)
        return lines

    def _all(self) -> tuple[Any, ...]:
        """All that it is but arrays that are compared value by value."""
        return self.table, self.passes, self._epochs, self._bands, self.scenario, self.is_partial, list(self.contributions)

    def __eq__(self, other: Any) -> bool:
        """The same rows of the same scenario, as a pickled curve has them; NaN is as NaN."""
        if not isinstance(other, LightCurve) or type(self) is not type(other):
            return NotImplemented
        return self is other or (self._all() == other._all() and all(same(one, two) for one, two in zip(self._jd, other._jd))
                                 and all(same(rows, other.contributions[name]) for name, rows in self.contributions.items()))

    def __hash__(self) -> int:
        return hash((self.table, tuple(self._epochs), tuple(self._bands)))

    def __repr__(self) -> str:
        return "<umov.LightCurve " + "\n  ".join(self._summary()) + ">"

    def _repr_html_(self) -> str:
        import html
        head, *passes = self._summary()
        items = "".join(f"<li>{html.escape(one)}</li>" for one in passes)
        return f"<p><b>{html.escape(head)}</b></p><ul>{items}</ul>{_picture(self)}"

    def __reduce__(self) -> tuple[Any, ...]:
        return LightCurve, (self.table, self.passes, (np.array(self._jd[0]), np.array(self._jd[1])),
                            self._epochs, self.bands, self.scenario, self.is_partial,
                            {name: np.array(rows) for name, rows in self.contributions.items()})


def _by_material(told: list[tuple[list[str], Floats]]) -> dict[str, Floats]:
    """Of objects that follow each other; views where there is one, 0 where an object lacks a material."""
    if len(told) == 1:
        return {name: told[0][1][:, k] for k, name in enumerate(told[0][0])}
    names = dict.fromkeys(name for one, _ in told for name in one)
    return {name: np.concatenate([rows[:, one.index(name)] if name in one else np.zeros_like(rows[:, 0])
                                  for one, rows in told]) for name in names}


def _with_unit(values: NDArray[Any], unit: str) -> Any:
    from astropy import units
    if unit.startswith("mag("):
        return units.Magnitude(values, unit=units.Unit(unit), copy=False)
    return units.Quantity(values, unit=units.Unit(unit), copy=False) if unit else values


def _picture(curve: LightCurve) -> str:
    """The overview as an image in place, where matplotlib is there."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        return ""
    import base64
    import io
    out = io.BytesIO()
    curve.plot(Figure(figsize=(9, 6))).savefig(out, format="png", dpi=80)
    return f'<img alt="light curve" src="data:image/png;base64,{base64.b64encode(out.getvalue()).decode()}">'


class _Part(LightCurve):
    """Epochs of one object of a light curve."""

    def __init__(self, whole: LightCurve, epochs: slice) -> None:
        super().__init__(whole.table, whole.passes, (whole._jd[0][epochs], whole._jd[1][epochs]),
                         [epochs.stop - epochs.start], whole.bands, whole.scenario, whole.is_partial,
                         {name: rows[epochs] for name, rows in whole.contributions.items()})
        self._whole, self._slice = whole, epochs

    def __getitem__(self, name: str) -> NDArray[Any]:
        return super().__getitem__(name)[self._slice]

    def to_qtable(self) -> QTable:
        return self._rows(super().to_qtable())

    def to_pandas(self) -> pandas.DataFrame:
        bands = len(self.bands)
        return super().to_pandas()[self._slice.start * bands:self._slice.stop * bands]

    def to_arrow(self) -> pyarrow.Table:
        bands = len(self.bands)
        return super().to_arrow().slice(self._slice.start * bands, (self._slice.stop - self._slice.start) * bands)

    def _rows(self, table: QTable) -> QTable:
        bands = len(self.bands)
        return table[self._slice.start * bands:self._slice.stop * bands]

    def _own_rows(self) -> Table | QTable:
        return self.to_qtable()  # `table` is that of the whole

    def write(self, path: str | os.PathLike[str]) -> None:
        raise UsageError("a part of a light curve has no file of the command's; write the whole, or "
                         "to_qtable().write(path)")

    def _all(self) -> tuple[Any, ...]:
        return (*super()._all(), self._slice.start, self._slice.stop)

    def __reduce__(self) -> tuple[Any, ...]:
        return _Part, (self._whole, self._slice)
