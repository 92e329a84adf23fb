"""An object: shape, orbit, attitude and materials."""
from __future__ import annotations

import os
import pathlib
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

from . import _toml, adapters
from ._jobs import Progress
from ._made import Made
from ._numbers import number, path_text, truth
from .errors import UsageError
from .passbands import Bands, names_of
from .sites import AnySite, Site
from .times import AnyTime, columns_of, seconds, utc, utc_list

if TYPE_CHECKING:
    from astropy.units import Quantity, UnitBase

    from .light_curves import LightCurve
    from .materials import Material

__all__ = ["Satellite"]

AnyBands = Union[str, Sequence[Any], Bands, "Quantity"]


def band_table(bands: AnyBands) -> dict[str, Any]:
    """The [bands] table of a scenario."""
    if isinstance(bands, Bands):
        return bands.to_dict()
    return {"set": names_of(bands)}


def band_changes(bands: AnyBands | None) -> dict[str, Any]:
    """The same as changes of a scenario's keys."""
    return {} if bands is None else {f"bands.{key}": value for key, value in band_table(bands).items()}


def _without_none(value: Any) -> Any:
    return {k: v for k, v in value.items() if v is not None} if isinstance(value, Mapping) else value


#: A parsec in km: what is nearer stands elsewhere for a satellite than for the barycentre, to more than a second of arc.
_FAR_KM = 3.0856775814913673e13


def _direction(value: Any) -> Any:
    """A SkyCoord, or a frame of astropy with data, as the table of a scenario; all else as it is."""
    if not hasattr(value, "transform_to") or not (hasattr(value, "frame") or hasattr(value, "has_data")):
        return value
    if not getattr(value, "has_data", True):
        raise UsageError(f"{value!r} is no direction; one with coordinates was expected")
    if not value.isscalar:
        raise UsageError(f"a SkyCoord of shape {value.shape} is no direction; a single one was expected")
    try:
        from astropy.coordinates import SkyCoord
        found = SkyCoord(value).transform_to("icrs")
        far = found.distance.to_value("km") if found.distance.unit.is_equivalent("km") else _FAR_KM
    except Exception as error:
        raise UsageError(f"{value!r} does not go into ICRS ({error}); a direction among the stars was expected. AltAz needs "
                         "obstime and location.") from error
    if far < _FAR_KM:
        raise UsageError(f"{value!r} is a place {far:.3g} km from the barycentre of the solar system, no direction; one without a "
                         "distance was expected")
    return {"ra_deg": number(found.ra.deg, "ra_deg"), "dec_deg": number(found.dec.deg, "dec_deg")}


def _table(value: Any, name: str, such_as: str) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise UsageError(f"{name} is {value!r}; a table was expected, such as {such_as}")
    return {str(key): one for key, one in value.items()}


def _absolute(path: Any) -> Any:
    return str(pathlib.Path(path_text(path, "a file")).absolute()) if isinstance(path, (str, os.PathLike)) else path


class Satellite(Made):
    """An [[object]] of a scenario: shape, orbit, attitude and materials.

    Parameters
    ----------
    mesh
        A file (OBJ, glTF, PLY, STL), a trimesh mesh or scene, (vertices (N, 3), faces (M, 3) counted from 0) or these with
        (M) names of groups; or several of these by the names of their groups: {"bus": box, "wing": plate}. A trimesh scene
        and a mesh with named materials have a group for each; colours of faces are none.
    unit
        Of the mesh: m, mm, cm, in or ft, as text or of astropy; None: that of the format or of a trimesh mesh, asked
        for where a file has none, m for arrays.
    up
        Axis of the file that becomes +Z of the body, such as "+Y"; asked for where the format has none. glTF (.glb) is +Y up by
        its specification, and read so unless it is said here: trimesh writes its axes as they are, so take "+Z" for what
        stood upright along z there.
    orbit
        A file, TLE lines, an sgp4 Satrec, a skyfield EarthSatellite or a table; None where no orbit is needed.
    norad
        Catalogue number, where the file holds several.
    attitude
        The table of a scenario: {"point": "+Z", "at": "nadir", "then": "+X", "toward": "velocity"}, {"mode":
        "spin", ...}; a SkyCoord may stand for a direction of the sky. None: as the scenario's default.
    materials
        By mesh material or "default": a name, a TOML file, a `Material`, or {"front": ..., "back": ...}; one alone
        is for all.
    name
        Of the object, in tables and reports.
    normals
        "flat" or "smooth"; None: as the file has them.
    parts
        Tables [[object.part]]: groups that turn about an axis.

    Notes
    -----
    Files are read when they are needed; an `InputError` then names file, line and what was expected.

    Examples
    --------
    >>> hst = umov.Satellite(mesh=DATA / "mesh/hst.obj", unit="m", up="+Z", orbit=DATA / "tle/hst.tle",
    ...                      attitude={"mode": "nadir"}, materials={"default": "film_silvered"}, name="HST")
    >>> hst
    <umov.Satellite 'HST': mesh hst.obj, orbit hst.tle, materials film_silvered>
    >>> umov.Satellite.from_toml(hst.to_toml()) == hst
    True
    """

    def __init__(self, mesh: Any, *, unit: str | UnitBase | None = None, up: str | None = None, orbit: Any = None,
                 norad: int | None = None, attitude: Mapping[str, Any] | None = None,
                 materials: str | Material | Mapping[str, Any], name: str = "", normals: str | None = None,
                 parts: Sequence[Mapping[str, Any]] = ()) -> None:
        if not isinstance(name, str):
            raise UsageError(f"name is {name!r}; a text was expected")
        self.name = name
        self._texts: adapters.Texts = {}
        self._own: dict[str, dict[str, Any]] = {}
        self._table: dict[str, Any] = {
            "name": name, "orbit": self._orbit(orbit, norad), "mesh": self._mesh(mesh, unit, up, normals),
            "attitude": None if attitude is None else {key: _direction(value) for key, value in _table(
                attitude, "attitude", '{"mode": "nadir"}').items()},
            "materials": self._materials(materials),
            "part": [_table(part, "a part", '{"groups": ["wing"], "axis": "+Y"}') for part in parts] or None}
        self._table = {key: _toml.copied(_without_none(value)) for key, value in self._table.items() if value is not None}
        self._files = adapters.Files(self._texts) if self._texts else None
        self._set_files()

    def _orbit(self, orbit: Any, norad: int | None) -> dict[str, Any] | None:
        if orbit is None:
            return None
        orbit = adapters.out_of_array(orbit)
        made = adapters.orbit_texts(orbit)
        if made is not None:
            self._texts.update(made)
            return {"file": next(iter(made)), "norad": norad}
        table = dict(orbit) if isinstance(orbit, Mapping) else {"file": orbit, "norad": norad}
        return {**table, "file": _absolute(table["file"])} if "file" in table else table

    def _mesh(self, mesh: Any, unit: str | UnitBase | None, up: str | None, normals: str | None) -> dict[str, Any]:
        unit = unit if unit is None or isinstance(unit, str) else str(unit)  # of astropy
        unit = adapters.mesh_unit(mesh) if unit is None else unit
        text = adapters.mesh_text(mesh, unit or "m")
        more = {"unit": unit, "up": up, "normals": normals}
        if text is not None:
            self._texts["mesh.obj"] = text
            return {"file": "mesh.obj", **more, "unit": unit or "m", "up": up or "+Z"}
        table = dict(mesh) if isinstance(mesh, Mapping) else {"file": mesh}
        return {**more, **table, "file": _absolute(table.get("file"))}

    def _materials(self, materials: Any) -> dict[str, Any]:
        table = materials if isinstance(materials, Mapping) else {"default": materials}
        each = [of for one in table.values() for of in (one.values() if isinstance(one, Mapping) else (one,))]
        known = {str(getattr(of, "name", of)) for of in each if isinstance(of, str) or getattr(of, "is_named", False)}
        out: dict[str, Any] = {}
        for group, one in table.items():
            if isinstance(one, Mapping):
                out[group] = {side: self._material_name(of, known) for side, of in one.items()}
            else:
                out[group] = self._material_name(one, known)
        return out

    def _material_name(self, material: Any, known: set[str]) -> str:
        if isinstance(material, str):
            return _absolute(material) if material.endswith(".toml") else material
        if hasattr(material, "to_toml") and hasattr(material, "is_named"):
            return str(material.name) if material.is_named else self._own_name(material, known)
        raise UsageError(f"a material is a {type(material).__name__}; a name or a Material was expected")

    def _own_name(self, material: Material, known: set[str]) -> str:
        """The name of a material of one's own: with a number where another of that name, or one of the library, is meant
        besides. [material.NAME] of a scenario is one thing, and hides what the library has of that name."""
        table, name, count = material.to_dict(), material.name, 1
        while name in known or self._own.get(name, table) != table:
            count += 1
            name = f"{material.name}_{count}"
        self._own[name] = table
        return name

    def _set_files(self) -> None:
        """Files that adapters made stand in a folder that is another one in every process."""
        if self._files is not None:
            for key, name in (("orbit", "orbit.tle"), ("orbit", "orbit.json"), ("mesh", "mesh.obj")):
                if name in self._files.texts:
                    self._table[key] = {**self._table[key], "file": str(self._files.folder / name)}

    @classmethod
    def from_dict(cls, table: Mapping[str, Any]) -> Satellite:
        """From an [[object]] table of a scenario, with the tables `material` of its own besides.

        Parameters
        ----------
        table
            Keys as in a scenario (docs/keys.md).
        """
        from .materials import Material
        _table(table, "an object", '{"mesh": {...}, "materials": {...}}')
        if missing := [key for key in ("mesh", "materials") if key not in table]:
            raise UsageError(f"an object has no {missing[0]}; mesh and materials were expected")
        materials = _table(table["materials"], "materials", '{"default": "gold"}')
        own = {name: Material.from_dict(name, one) for name, one in table.get("material", {}).items()}

        def find(name: Any) -> Any:
            if isinstance(name, Mapping):
                return {side: find(of) for side, of in name.items()}
            return own.get(name, name)

        return cls(table["mesh"], orbit=table.get("orbit"), attitude=table.get("attitude"),
                   materials={group: find(name) for group, name in materials.items()},
                   name=table.get("name", ""), parts=table.get("part", ()))

    @classmethod
    def from_toml(cls, text: str) -> Satellite:
        """From a text with one [[object]] and its [material.NAME] tables, such as a scenario.

        Parameters
        ----------
        text
            TOML.
        """
        document = _toml.tables_of(text, "satellite")
        if len(document.get("object", ())) != 1:
            raise UsageError(f"the text has {len(document.get('object', ()))} objects; one [[object]] was expected")
        return cls.from_dict({**document["object"][0], "material": document.get("material", {})})

    def to_dict(self) -> dict[str, Any]:
        """The [[object]] table of a scenario, with `material` tables of its own besides. Files that were made of arrays or
        lines are there as long as this object is."""
        own = {"material": _toml.copied(self._own)} if self._own else {}
        return {**_toml.copied(self._table), **own}

    def to_toml(self, folder: str | os.PathLike[str] | None = None) -> str:
        """The same as text.

        Parameters
        ----------
        folder
            Where a mesh of arrays and an orbit of lines are put, as mesh.obj and orbit.tle or orbit.json: no file holds them. `UsageError` if
            there are some and no folder is given.
        """
        return adapters.put_down(self._text(), self._files, folder)

    def _text(self) -> str:
        table = self.to_dict()
        own = table.pop("material", {})
        return _toml.text_of({"object": [table], **({"material": own} if own else {})}).lstrip()

    def to_scenario_dict(self, bands: AnyBands = "paper_rgb", **sections: Any) -> dict[str, Any]:
        """A whole scenario of this object; `sections` are its other tables, such as time or render.

        Parameters
        ----------
        bands
            A set ("paper_rgb"), a list of names ("nm:550", "Bessell.V") or `umov.Bands`.
        **sections
            Other tables by name: `time={...}`.
        """
        table = self.to_dict()
        own = table.pop("material", None)
        return {"umov": 1, "object": [table], "bands": band_table(bands), "material": own, **sections}

    def light_curve(self, site: AnySite, start: Any, stop: AnyTime | None = None, *,
                    step: Quantity | Any = None, step_s: float | None = None, bands: AnyBands = "paper_rgb",
                    alt_min_deg: float = 0.0, sun_alt_max_deg: float = 90.0, sunlit: bool = True,
                    seed: int = 0, pol_frame: str = "equatorial", render: Mapping[str, Any] | None = None,
                    **options: Any) -> LightCurve:
        """The light of this object over time as seen from a site, between two times, during a pass
        (a row of `umov.passes`) or at times of your own. `options` are those of `umov.run`.

        Parameters
        ----------
        site
            A name of `umov.site_names()`, a Site, an astropy EarthLocation, a skyfield topos or a table with
            lat_deg, lon_deg and alt_m.
        start
            ISO 8601 with an offset or Z, an aware datetime, an astropy Time; or a row of `umov.passes`, without
            `stop`; or, without `stop` and a step, the epochs themselves in order: an array of Times, a list, a column of times
            of pandas.
        stop
            The same; it is included.
        step
            Between epochs, an astropy Quantity of time or a timedelta.
        step_s
            The same as a plain number [s]; 1 if neither is given.
        bands
            A set ("paper_rgb"), a list of names ("nm:550", "Bessell.V") or `umov.Bands`.
        alt_min_deg
            Epochs below are left out [deg].
        sun_alt_max_deg
            Epochs with the Sun above are left out [deg].
        sunlit
            Epochs in the Earth's shadow are left out.
        seed
            Of the rays.
        pol_frame
            Of q, u and pa: "equatorial" (IAU), "altaz" or "scattering".
        render
            The table [render] of a scenario.
        **options
            Those of `umov.run`: threads, cache, progress and so on.

        Notes
        -----
        Arrays (epoch, band), see `LightCurve`. Epochs without light from the Sun or below the horizon have no row, unless
        `sunlit=False` and `alt_min_deg` keep them. `NoResult` if the object is never up, `NumericsError` where the orbit
        ends.

        Examples
        --------
        >>> curve = hst.light_curve("maui", "2018-01-21T05:10:00Z", "2018-01-21T05:10:20Z", step_s=10,
        ...                         bands=["nm:550"])
        >>> curve.I.shape
        (3, 1)
        >>> mine = ["2018-01-21T05:10:00.25Z", "2018-01-21T05:10:03Z"]
        >>> hst.light_curve("maui", mine, bands=["nm:550"]).time.isot.tolist()
        ['2018-01-21T05:10:00.250', '2018-01-21T05:10:03.000']
        """
        from .runs import run
        from .scenarios import Scenario
        if "orbit" not in self._table:
            raise UsageError("the satellite has no orbit; light over time needs one: umov.Satellite(..., orbit=...). "
                             "Without one umov.Engine lights it from any direction.")
        if step is not None and step_s is not None:
            raise UsageError("step and step_s; one of them was expected")
        span: dict[str, Any]
        if _are_epochs(start):
            if stop is not None or step is not None or step_s is not None:
                raise UsageError("start holds several times; they alone, without stop and step, or one start were expected")
            span = {"epochs": utc_list(start)[0]}
        else:
            if stop is None:
                start, stop = _span_of_pass(start)
            length = seconds(step) if step is not None else number(1.0 if step_s is None else step_s, "step_s")
            span = {"start": utc(start), "stop": utc(stop), "step_s": length}
        only = {"alt_min_deg": number(alt_min_deg, "alt_min_deg"),
                "sun_alt_max_deg": number(sun_alt_max_deg, "sun_alt_max_deg"), "sunlit": truth(sunlit, "sunlit")}
        scenario = Scenario(self.to_scenario_dict(
            bands, title=self.name, seed=seed, observer=Site(site).to_dict(),
            time={**span, "only": only},
            render=_table(render, "render", '{"bounces": 2}') if render is not None else None, output={"pol_frame": pol_frame}))
        scenario._keep = self
        return run(scenario, **options)

    @property
    def orbit_file(self) -> str | None:
        """The file of its orbit, or None."""
        file = self._table.get("orbit", {}).get("file")
        return None if file is None else str(file)

    @property
    def norad(self) -> int | None:
        """The catalogue number that was given, or None."""
        number = self._table.get("orbit", {}).get("norad")
        return None if not number else int(number)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Satellite) and self._told() == other._told()

    def __hash__(self) -> int:
        return hash(self._told())

    def _told(self) -> str:
        """All of it: what adapters made by what it holds."""
        return adapters.by_content(self._text(), self._files)

    def __repr__(self) -> str:
        mesh = pathlib.Path(str(self._table["mesh"]["file"])).name
        orbit = pathlib.Path(self.orbit_file).name if self.orbit_file else "none"
        materials = sorted({name for one in self._table["materials"].values()
                            for name in (one.values() if isinstance(one, Mapping) else [one])})
        return f"<umov.Satellite {self.name!r}: mesh {mesh}, orbit {orbit}, materials {', '.join(materials)}>"

    def _repr_html_(self) -> str:
        import html
        return (f"<p><b>{html.escape(repr(self))}</b></p>{self._picture()}"
                f"<details><summary>TOML</summary><pre>{html.escape(self._text())}</pre></details>")

    def _picture(self) -> str:
        """The mesh by material as an image in place; what is wrong with a satellite is for others to say."""
        import base64

        from .errors import Error
        from .pictures import render
        try:
            png = render(self, sun=(1, 0.4, 0.9), observer=(1, 1.3, 0.7), side=240, samples=2).png
        except Error:
            return ""
        return f'<img alt="the mesh" width="240" src="data:image/png;base64,{base64.b64encode(png).decode()}">'

    def __getstate__(self) -> dict[str, Any]:
        state = dict(self.__dict__)
        state["_files"], state["_table"] = None, dict(self._table)  # a copy has files, and names of them, of its own
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._files = adapters.Files(self._texts) if self._texts else None
        self._set_files()


def _are_epochs(start: Any) -> bool:
    """Several times: an array of Times or a sequence; a row of passes has names, and a text is one time."""
    if hasattr(start, "utc_iso") or hasattr(start, "sidereal_time"):  # skyfield's Time is no sequence, astropy's always
        return bool(getattr(start, "shape", ()))
    if columns_of(start) is not None:
        return "rise_utc" not in (columns_of(start) or ())  # whoever reads times tells of a table
    is_row = isinstance(start, (str, bytes, Mapping)) or hasattr(start, "colnames") or (hasattr(start, "index") and "rise_utc" in start.index
                                                                                        if hasattr(start, "iloc") else False)
    return not is_row and isinstance(start, Iterable) and getattr(start, "shape", (1,)) != ()


def _span_of_pass(row: Any) -> tuple[str, str]:
    """Rise and set of a row of `umov.passes`."""
    if columns_of(row) is not None:
        raise UsageError(f"a table of {len(row)} passes; one row was expected, such as table[0], or a start and a stop")
    try:
        rise, end = str(row["rise_utc"]), str(row["set_utc"])
    except (TypeError, KeyError, IndexError, ValueError) as error:
        raise UsageError("no stop; a start and a stop were expected, or a row of umov.passes") from error
    if not rise or not end:
        raise UsageError("the pass is cut by the span that was searched; rise and set were expected. "
                         "Search a longer span.")
    return rise, end
