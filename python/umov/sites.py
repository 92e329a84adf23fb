"""Places on the Earth."""
from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import _toml, _umov
from ._made import Made
from ._numbers import number, text, utf8
from .errors import UsageError

if TYPE_CHECKING:
    from astropy.coordinates import EarthLocation

__all__ = ["Site", "site_names"]


def site_names() -> list[str]:
    """Names that `Site` knows.

    >>> "maui" in umov.site_names() or "amos" in umov.site_names()
    True
    """
    return _umov.site_names()


class Site(Made):
    """A place on the WGS 84 ellipsoid: by name, by coordinates, or from an EarthLocation, a skyfield
    topos or the [observer] table of a scenario.

    Parameters
    ----------
    site
        A name of `umov.site_names()`, another Site, an EarthLocation, a skyfield topos or a table with lat_deg,
        lon_deg and alt_m.
    lat_deg
        Geodetic latitude, north positive [deg].
    lon_deg
        Longitude, east positive [deg].
    alt_m
        Height above the ellipsoid [m].
    name
        Over that of the site.

    Notes
    -----
    `UsageError` where none or two of them are given and for an unknown name, `InputError` for numbers out of range.

    Examples
    --------
    >>> umov.Site("paranal")
    Site('paranal', lat_deg=-24.6275, lon_deg=-70.4044, alt_m=2635.0)
    >>> umov.Site(lat_deg=20.7083, lon_deg=-156.2578, alt_m=3058, name="Maui").to_dict()["name"]
    'Maui'
    """

    def __init__(self, site: AnySite | None = None, *, lat_deg: float | None = None,
                 lon_deg: float | None = None, alt_m: float | None = None, name: str = "") -> None:
        numbers = (lat_deg, lon_deg, alt_m)
        if site is None:
            if lat_deg is None or lon_deg is None or alt_m is None:
                raise UsageError("where? Give a name of umov.site_names(), or lat_deg, lon_deg and alt_m")
            told = _umov.check_site(str(name), number(lat_deg, "lat_deg"), number(lon_deg, "lon_deg"), number(alt_m, "alt_m"))
        elif any(number is not None for number in numbers):
            raise UsageError(f"{site!r} and coordinates besides; one of them was expected")
        else:
            told = _told(site, name)
        self.name: str = told[0]
        self.lat_deg: float = told[1]
        self.lon_deg: float = told[2]
        self.alt_m: float = told[3]

    @classmethod
    def from_dict(cls, table: Mapping[str, Any]) -> Site:
        """From the [observer] table of a scenario.

        Parameters
        ----------
        table
            With lat_deg, lon_deg, alt_m and name, or a known name alone.
        """
        return cls(table)

    @classmethod
    def from_toml(cls, text: str) -> Site:
        """From a text with an [observer] table.

        Parameters
        ----------
        text
            TOML.
        """
        return cls(_toml.tables_of(text, "site").get("observer", {}))

    def __setattr__(self, name: str, value: Any) -> None:
        """Checked as when it was made."""
        if name in ("lat_deg", "lon_deg", "alt_m"):
            numbers = {"lat_deg": 0.0, "lon_deg": 0.0, "alt_m": 0.0, name: number(value, name)}
            told = _umov.check_site("", *numbers.values())
            value = told[1 + list(numbers).index(name)]
        elif name == "name":
            value = text(value, name)
        object.__setattr__(self, name, value)

    def to_dict(self) -> dict[str, Any]:
        """The [observer] table of a scenario."""
        return {"name": self.name, "lat_deg": self.lat_deg, "lon_deg": self.lon_deg, "alt_m": self.alt_m}

    def to_toml(self) -> str:
        """The same as text."""
        return _toml.text_of({"observer": self.to_dict()}).lstrip()

    def to_earth_location(self) -> EarthLocation:
        """The same as astropy has it."""
        from astropy import units
        from astropy.coordinates import EarthLocation
        return EarthLocation.from_geodetic(self.lon_deg * units.deg, self.lat_deg * units.deg,
                                           self.alt_m * units.m)

    def _tuple(self) -> tuple[str, float, float, float]:
        return self.name, self.lat_deg, self.lon_deg, self.alt_m

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Site) and self._tuple() == other._tuple()

    def __hash__(self) -> int:
        return hash(self._tuple())

    def __repr__(self) -> str:
        return (f"Site({self.name!r}, lat_deg={self.lat_deg:g}, lon_deg={self.lon_deg:g}, "
                f"alt_m={self.alt_m})")


AnySite = Union[str, Site, Mapping[str, Any], "EarthLocation", Any]


def _with_unit(cell: Any, columns: Any, name: str) -> Any:
    """A number of a row in the unit of its column, which a Table of astropy keeps apart; all else as it is."""
    unit = getattr(columns[name], "unit", None) if hasattr(columns, "colnames") else None
    is_bare = isinstance(cell, (int, float, np.number, np.ndarray)) and not (cell is np.ma.masked or hasattr(cell, "to_value"))
    return cell * unit if unit is not None and is_bare and not isinstance(cell, bool) else cell


def _told(site: AnySite, name: str) -> tuple[str, float, float, float]:
    if isinstance(site, Site):
        return (name or site.name), site.lat_deg, site.lon_deg, site.alt_m
    if isinstance(site, str):
        told = _umov.site(utf8(site, "site"))
        return (name or told[0]), told[1], told[2], told[3]
    if isinstance(site, Mapping) or (hasattr(site, "keys") and hasattr(site, "__getitem__")):  # a dictionary, a row of astropy's or pandas'
        columns = getattr(site, "table", None)
        site = {key: site[key] for key in site.keys()}
        if "lat_deg" not in site and "name" in site:
            return _told(str(site["name"]), name)
        if missing := [key for key in ("lat_deg", "lon_deg", "alt_m") if key not in site]:
            raise UsageError(f"a site has no {missing[0]}; lat_deg, lon_deg and alt_m were expected, there are "
                             f"{', '.join(map(str, site)) or 'none'}")
        numbers = [number(_with_unit(site[key], columns, key), key) for key in ("lat_deg", "lon_deg", "alt_m")]
        return _umov.check_site(name or str(site.get("name", "")), *numbers)
    if hasattr(site, "geodetic"):  # astropy
        if not site.isscalar:
            raise UsageError(f"an EarthLocation of shape {site.shape}; a single place was expected, such as location[0]")
        number(site.x.to_value("m"), "the EarthLocation's x")  # before ERFA makes a place of nothing
        place = site.geodetic
        return _umov.check_site(name, float(place.lat.deg), float(place.lon.wrap_at("180d").deg),
                                float(place.height.to_value("m")))
    if hasattr(site, "latitude") and hasattr(site, "elevation"):  # skyfield
        return _umov.check_site(name, float(site.latitude.degrees), float(site.longitude.degrees),
                                float(site.elevation.m))
    raise UsageError(f"{site!r} is a {type(site).__name__}; a site was expected: a name, a Site, an "
                     "EarthLocation, a skyfield topos or a table with lat_deg, lon_deg and alt_m")
