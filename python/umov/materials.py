"""Materials and their Mueller BRDFs."""
from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _toml, _umov
from ._made import Made
from ._numbers import number_array, path_text, text as utf8_text
from .errors import UsageError
from .tables import Table

__all__ = ["Material", "brdf", "materials"]

MOST_ROWS = 2**28  #: of `brdf`, some 350 bytes each while it works


def materials() -> Table:
    """Every material of the library: the rows of `umov material list`.

    >>> "film_silvered" in umov.materials()["material"]
    True
    """
    return Table(_umov.material_list())


class Material(Made):
    """A material: a name of the library or a TOML file, or with `from_dict` and `from_toml` one's own.

    Parameters
    ----------
    name
        Of the library (`umov.materials()`), or a TOML file with one [material.NAME] table; `InputError` with the
        nearest name for what is neither.

    Examples
    --------
    >>> gold = umov.Material("paper_au")
    >>> gold.brdf(wavelength_nm=550, theta_i_deg=60, theta_o_deg=60, phi_deg=180).shape
    (4, 4)
    >>> rough = umov.Material.from_dict("rough", {"index": {"n": 1.5, "k": 0},
    ...                                 "distribution": {"model": "ggx", "alpha": 0.3}})
    >>> rough
    Material('rough', reflection polarizes)
    """

    def __init__(self, name: str) -> None:
        if str(name).lower().endswith((".csv", ".ecsv", ".txt", ".dat")):
            raise UsageError(f"name is {name!r}, a table; the name of a material or a TOML file was expected. A measured BRDF becomes a material "
                             f"by umov.Material.from_dict(\"mine\", {{\"table\": {str(name)!r}}}), n and k by {{\"index\": {str(name)!r}, ...}}")
        self._material = _umov.Material.read(path_text(name, "name", "the name of a material or of its file"))
        #: the library or a file has it: scenarios may name it
        self.is_named = not str(name).endswith(".toml")

    @classmethod
    def from_toml(cls, text: str, path: str = "material.toml") -> Material:
        """From a text with one [material.NAME] table that stands for the file `path`.

        Parameters
        ----------
        text
            TOML.
        path
            The file that it stands for: relative paths start there, messages name it.
        """
        out = cls.__new__(cls)
        out._material, out.is_named = _umov.Material.parse(utf8_text(text, "text"), utf8_text(path, "path")), False
        return out

    @classmethod
    def from_dict(cls, name: str, table: Mapping[str, Any]) -> Material:
        """From the table [material.NAME] of a scenario.

        Parameters
        ----------
        name
            Its name.
        table
            Keys as in a scenario: `index`, `distribution`, `body` and so on (docs/keys.md).
        """
        return cls.from_toml(_toml.text_of({"material": {name: table}}))

    @property
    def name(self) -> str:
        """Its name."""
        return self._material.name

    @property
    def description(self) -> str:
        """What it is."""
        return self._material.description

    @property
    def source(self) -> str:
        """Where its numbers come from."""
        return self._material.source

    @property
    def assumed(self) -> str:
        """What is not known of it."""
        return self._material.assumed

    @property
    def range_nm(self) -> tuple[float, float]:
        """Wavelengths for which it is known."""
        first, last = self._material.range_nm
        return float(first), float(last)

    def to_toml(self) -> str:
        """As a [material.NAME] table."""
        return self._material.toml

    def to_dict(self) -> dict[str, Any]:
        """The same as a dictionary, without the name."""
        import tomllib
        table: dict[str, Any] = tomllib.loads(self.to_toml())["material"][self.name]
        return table

    def brdf(self, wavelength_nm: ArrayLike = 550.0, theta_i_deg: ArrayLike = 0.0,
             theta_o_deg: ArrayLike = 0.0, phi_deg: ArrayLike = 0.0,
             azimuth_deg: ArrayLike = 0.0) -> NDArray[np.float64]:
        """Mueller BRDF [1/sr] (..., 4, 4): see `umov.brdf`.

        Parameters
        ----------
        wavelength_nm
            Wavelength in vacuum [nm].
        theta_i_deg
            Angle of incidence from the normal, 0 to 90 [deg].
        theta_o_deg
            Angle of reflection from the normal, 0 to 90 [deg].
        phi_deg
            Azimuth of the observer minus that of the source, counter-clockwise about the outward normal [deg]: 0 is
            the same side, 180 the mirror's.
        azimuth_deg
            Azimuth of the source from the surface's own x axis [deg]; matters where it has a grain.
        """
        return brdf(self, wavelength_nm, theta_i_deg, theta_o_deg, phi_deg, azimuth_deg)

    def refractive_index(self, wavelength_nm: ArrayLike) -> NDArray[np.complex128]:
        """n + ik at wavelengths [nm], of the same shape.

        Parameters
        ----------
        wavelength_nm
            Of any shape [nm]; `InputError` outside the table's range.

        Examples
        --------
        >>> round(complex(umov.Material("paper_bk7").refractive_index(550)).real, 2)
        1.52
        """
        asked = number_array(wavelength_nm, "wavelength_nm")
        table = Table(self._material.index_table(np.atleast_1d(asked).ravel().tolist()))
        return (table["n"] + 1j * table["k"]).reshape(asked.shape)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Material) and self.to_toml() == other.to_toml()

    def __hash__(self) -> int:
        return hash(self.to_toml())

    def __repr__(self) -> str:
        return f"Material({self.name!r}, {self._material.polarization})"

    def __reduce__(self) -> tuple[Any, ...]:
        return (Material, (self.name,)) if self.is_named else (Material.from_toml, (self.to_toml(),))


def brdf(material: Union[str, Material], wavelength_nm: ArrayLike = 550.0, theta_i_deg: ArrayLike = 0.0,
         theta_o_deg: ArrayLike = 0.0, phi_deg: ArrayLike = 0.0,
         azimuth_deg: ArrayLike = 0.0) -> NDArray[np.float64]:
    """Mueller BRDF [1/sr] in the scattering plane: angles from the normal [deg], `phi_deg` the azimuth of
    the observer minus that of the source, broadcast against each other to (..., 4, 4).

    Parameters
    ----------
    material
        A name, a TOML file or a Material.
    wavelength_nm
        Wavelength in vacuum [nm].
    theta_i_deg
        Angle of incidence from the normal, 0 to 90 [deg].
    theta_o_deg
        Angle of reflection from the normal, 0 to 90 [deg].
    phi_deg
        Azimuth of the observer minus that of the source, counter-clockwise about the outward normal [deg]: 0 is the
        same side, 180 the mirror's.
    azimuth_deg
        Azimuth of the source from the surface's own x axis [deg]; matters where it has a grain.

    Notes
    -----
    Frames: each Stokes vector is referred to its own plane of the surface, +Q perpendicular to the scattering plane
    (docs/conventions.md). `UsageError` for angles out of range and shapes that do not broadcast, `InputError` outside
    the wavelengths of the material's tables.

    Examples
    --------
    >>> f = umov.brdf("paper_al", theta_i_deg=[10, 30, 50], theta_o_deg=30, phi_deg=180)
    >>> f.shape
    (3, 4, 4)
    """
    of = material if isinstance(material, Material) else Material(material)
    names = ("wavelength_nm", "theta_i_deg", "theta_o_deg", "phi_deg", "azimuth_deg")
    given = [number_array(value, name) for value, name in
             zip((wavelength_nm, theta_i_deg, theta_o_deg, phi_deg, azimuth_deg), names)]
    try:
        shape = np.broadcast_shapes(*(value.shape for value in given))
    except ValueError as error:
        shapes = ", ".join(f"{name} {value.shape}" for name, value in zip(names, given))
        raise UsageError(f"{shapes} do not fit together; shapes that broadcast were expected") from error
    if math.prod(shape) > MOST_ROWS:
        raise UsageError(f"the angles broadcast to {math.prod(shape)} geometries; at most {MOST_ROWS} at once were expected")
    nm, theta_i, theta_o, phi, azimuth = (np.ascontiguousarray(np.broadcast_to(value, shape)).ravel() for value in given)
    return _umov.brdf(of._material, nm, theta_i, theta_o, phi, azimuth, None).reshape(*shape, 4, 4)
