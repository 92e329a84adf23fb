"""Bands: names, curves, and the [bands] table of a scenario."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _toml, _umov
from ._made import Made
from ._numbers import _short, number, text
from .errors import UsageError
from .tables import Table

if TYPE_CHECKING:
    from astropy.units import Quantity

__all__ = ["Bands", "band", "bands"]


def _wave(value: Any) -> Any:
    """A wavelength with an astropy unit as a scenario names it; all else as it is."""
    return f"nm:{number(value, 'wavelength_nm'):.10g}" if hasattr(value, "to_value") else value


def names_of(given: Any) -> Any:
    """Names as a scenario has them: one, or a list of them."""
    if hasattr(given, "to_value"):  # one Quantity, or an array of them
        given = _wave(given) if given.isscalar else list(given)
    if not isinstance(given, str) and (isinstance(given, (bytes, Mapping)) or not hasattr(given, "__iter__")):
        raise UsageError(f"bands is {given!r}; names were expected, such as [\"nm:550\", \"Bessell.V\"]")
    if isinstance(given, str):
        return given
    listed = [_wave(one) for one in given]
    if strange := [one for one in listed if isinstance(one, (bytes, Mapping, list, tuple)) or one is None]:
        raise UsageError(f"bands has {_short(strange[0])}; names were expected, such as [\"nm:550\", \"Bessell.V\"]")
    return listed


class Bands(Made):
    """The [bands] table of a scenario, to be given wherever `bands=` is asked for.

    Parameters
    ----------
    set
        Wavelengths ("nm:550"), filters ("Bessell.V", "gaia" for all three of Gaia), files ("file:my.vot") or a set
        ("paper_rgb"): one name or a list of them. `umov.bands()` lists the curves. Wavelengths with an astropy unit too
        (`[425, 550] * u.nm`).
    mag_system
        Of the magnitudes: "AB" (default), "ST" or "Vega".

    Notes
    -----
    Names are looked up at once: `InputError` with the nearest one for what is none.

    Examples
    --------
    >>> umov.Bands(["Bessell.V", "nm:550"], mag_system="Vega")
    Bands(['Bessell.V', 'nm:550'], mag_system='Vega')
    >>> umov.Bands.from_toml(umov.Bands("paper_rgb").to_toml()) == umov.Bands("paper_rgb")
    True
    """

    def __init__(self, set: str | Sequence[Any] | Quantity, *, mag_system: str = "AB") -> None:
        if mag_system not in ("AB", "ST", "Vega"):
            raise UsageError(f"mag_system is {mag_system!r}; AB, ST or Vega was expected")
        if not hasattr(set, "to_value") and (not isinstance(set, (str, Sequence)) or isinstance(set, bytes)):
            raise UsageError(f"set is a {type(set).__name__}; a name or a list of names was expected")
        self._set = names_of(set)
        self.mag_system = mag_system  #: AB, ST or Vega
        for name in [self._set] if isinstance(self._set, str) else self._set:
            if isinstance(name, str) and not name.startswith("file:"):
                _umov.check_bands([name])

    @property
    def set(self) -> Any:
        """Names as a scenario has them: one, or a list of them."""
        return _toml.copied(self._set)

    @classmethod
    def from_dict(cls, table: Mapping[str, Any]) -> Bands:
        """From the [bands] table of a scenario.

        Parameters
        ----------
        table
            With the keys `set` and, if it is not AB, `mag_system`; `UsageError` for others.
        """
        if strange := [key for key in table if key not in ("set", "mag_system")]:
            raise UsageError(f"[bands] has the key {strange[0]!r}; set and mag_system were expected")
        return cls(table.get("set", "paper_rgb"), mag_system=table.get("mag_system", "AB"))

    @classmethod
    def from_toml(cls, text: str) -> Bands:
        """From a text with a [bands] table, such as a scenario.

        Parameters
        ----------
        text
            TOML.
        """
        return cls.from_dict(_toml.tables_of(text, "bands").get("bands", {}))

    def to_dict(self) -> dict[str, Any]:
        """The [bands] table of a scenario."""
        return {"set": self.set, "mag_system": self.mag_system}

    def to_toml(self) -> str:
        """The same as text."""
        return _toml.text_of({"bands": self.to_dict()}).lstrip()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Bands) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash(self.to_toml())

    def __repr__(self) -> str:
        return f"Bands({self.set!r}, mag_system={self.mag_system!r})"


def bands() -> Table:
    """Every curve that umov knows, with its zero points and the Sun in it: the rows of `umov bands list`.

    >>> "Bessell.V" in umov.bands()["band"], umov.bands().unit("pivot")
    (True, 'nm')
    """
    return Table(_umov.band_list())


def band(name: str, *, unit: str = "", detector: str = "") -> Table:
    """The curve of one band, `wavelength` [nm] and `response` to photons: the rows of `umov bands show`.

    Parameters
    ----------
    name
        As a scenario spells it: "Bessell.V", "nm:550", "file:x.vot". `UsageError` where it stands for several.
    unit
        Of the wavelengths of a file that does not say: nm, um or Angstrom.
    detector
        What the curve of a file multiplies, if it does not say: photon or energy.

    Examples
    --------
    >>> curve = umov.band("Bessell.V")
    >>> float(curve["wavelength"][curve["response"].argmax()])
    530.0
    """
    if unit not in ("", "nm", "um", "Angstrom"):
        raise UsageError(f"unit is {unit!r}; nm, um or Angstrom was expected")
    if detector not in ("", "photon", "energy"):
        raise UsageError(f"detector is {detector!r}; photon or energy was expected")
    return Table(_umov.band_table(text(name, "name"), unit, detector))
