"""A Quantity is brought to the unit of its argument, which one table has for all of them: none is guessed from a name."""
import inspect
import re

import numpy as np
import pytest
from astropy import units as u

import umov
import umov.plot
import umov.scale
import umov.turnable
from conftest import DATA, EXAMPLES
from umov._numbers import number, plain_key
from umov._units import ARGUMENTS, KEYS

MODULES = (umov, umov.plot, umov.scale, umov.turnable)
#: What only umov fills: its numbers are results.
RESULTS = {"umov.scale.Plan", "umov.Column"}
#: Directions, of which only the way counts, light of poses, and what takes names of bands or the unit itself besides.
WITHOUT_UNIT = {"sun", "observer", "up", "set", "vertices", "curve"}


def _public():
    """Names and signatures of all that is public: functions, methods, and fields of what users make."""
    for module in MODULES:
        for name in module.__all__:
            one, at = getattr(module, name), f"{module.__name__}.{name}"
            if inspect.isfunction(one):
                yield at, inspect.signature(one)
            elif inspect.isclass(one) and at not in RESULTS:
                for method, function in inspect.getmembers(one, lambda f: inspect.isfunction(f) or inspect.ismethod(f)):
                    if not method.startswith("_") or method in ("__init__", "__new__"):
                        yield f"{at}.{method}", inspect.signature(function)


def _floats():
    """Arguments that are floats, or that take numbers or quantities."""
    for at, signature in _public():
        for name, one in signature.parameters.items():
            if isinstance(one.default, float) or re.search(r"\bfloat\b|ArrayLike|Quantity", str(one.annotation)):
                yield at, name


def test_every_float_of_every_public_signature_has_its_unit():
    found = list(_floats())
    assert len(found) > 70
    assert {name for _, name in found} - WITHOUT_UNIT - set(ARGUMENTS) == set(), [one for one in found if one[1] not in ARGUMENTS]
    assert set(ARGUMENTS) - {name for _, name in found} == set()  # and no unit of what is gone


def _numbers_of(node):
    """Keys of a schema that are numbers or lists of numbers, with what is said of them."""
    for key, value in node.get("properties", {}).items():
        if value.get("type") == "number" or (value.get("type") == "array" and value.get("items", {}).get("type") in ("number", "integer")):
            yield key, value.get("description", "")
        yield from _numbers_of(value)
    for inner in ("items", "additionalProperties"):
        if isinstance(node.get(inner), dict):
            yield from _numbers_of(node[inner])


def test_every_number_of_a_scenario_has_the_unit_that_its_schema_tells():
    told = {"electron / s": "electron / s", "mag / arcsec2": "mag / arcsec2", "electrons for one number": "electron / adu"}
    checked = 0
    for key, text in _numbers_of(umov.schema()):
        if key in tuple("UBVRI") or key in ("m", "ozone_du"):  # a filter's name; an exponent; astropy has no Dobson units
            continue
        assert key in KEYS, f"{key}: {text}"
        bracket = re.search(r"\[([^\[\],]+)\]", text)
        if bracket and not text.startswith("body_from"):
            assert u.Unit(KEYS[key]) == u.Unit(told.get(bracket[1], bracket[1])), key
            checked += 1
    assert checked > 25


@pytest.mark.parametrize("name", sorted(ARGUMENTS))
def test_a_quantity_comes_in_the_unit_of_its_argument_and_another_is_refused(name):
    unit = u.Unit(ARGUMENTS[name])
    assert number(3.0 * unit, name) == 3.0
    if not ARGUMENTS[name]:
        assert number(3.0 * u.percent, name) == pytest.approx(0.03)
    for wrong in (u.kg, u.kg / u.s, u.percent if ARGUMENTS[name] else u.s):
        with pytest.raises(umov.UsageError, match=f"^{name} is .* was expected"):
            number(3.0 * wrong, name)


@pytest.mark.filterwarnings("ignore:change_per_s")
def test_units_that_were_taken_for_what_they_were_not():
    """What `change_per_s` counted in seconds was taken for a rate, and a part in per cent for a hundred times itself."""
    def exposure(**more):
        return umov.exposure("c11_imx250", **{"mag": 6.0, **more})["value"].tolist()

    with pytest.raises(umov.UsageError, match=r"change_per_s is .*5.* s.*go into 1 / s; that was expected"):
        exposure(change_per_s=5 * u.s)
    assert exposure(change_per_s=2 * u.percent / u.s) == exposure(change_per_s=0.02)
    assert exposure(sd_p=1 * u.percent) == exposure(sd_p=0.01)
    assert exposure(aperture_fwhm=1.5 * u.one) == exposure(aperture_fwhm=1.5)
    for sky in (20 * u.mag / u.arcsec**2, 20 * u.mag(u.AB / u.arcsec**2), 20 * u.mag):
        assert exposure(sky_mag=sky) == exposure(sky_mag=20.0)
    assert umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 1 * u.min}).mag.shape == (6, 3)
    with pytest.raises(umov.UsageError, match="phase_deg"):
        umov.random_poses(5, phase_deg=1 * u.m)


def test_a_magnitude_knows_its_system():
    def exposure(mag, **more):
        return umov.exposure("c11_imx250", mag=mag, **more)["value"].tolist()

    own = umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 60}).quantity("mag")[0, 0]
    assert own.unit == u.ABmag and exposure(own) == exposure(float(own.value)) == exposure(own.value * u.mag)
    assert exposure(8 * u.STmag, mag_system="ST") == exposure(8.0, mag_system="ST")
    for mag, system in ((8 * u.STmag, "AB"), (8 * u.ABmag, "ST"), (8 * u.ABmag, "Vega")):
        with pytest.raises(umov.UsageError, match=f"mag is .*8.*; a magnitude of {system} was expected"):
            exposure(mag, mag_system=system, **({"band": "Bessell.V"} if system == "Vega" else {}))
    with pytest.raises(umov.UsageError, match="mag is .*a magnitude"):
        exposure(8 * u.dex(u.AB))


@pytest.mark.filterwarnings("ignore::umov.UmovWarning")
def test_limits_of_passes_and_peaks_take_units():
    hst = umov.Satellite(mesh=DATA / "mesh/hst.obj", unit="m", up="+Z", orbit=DATA / "tle/hst.tle", norad=20580,
                         attitude={"mode": "nadir"}, materials="film_silvered")
    span = ("maui", "2018-01-21T04:00Z", "2018-01-21T07:00Z")
    magnitudes = np.sort(np.asarray(umov.passes(hst, *span, cache=False)["mag_min"], dtype=float))
    assert len(magnitudes) == 2 and magnitudes[1] - magnitudes[0] > 0.01
    between = magnitudes.mean()  # one pass is brighter
    for limit in (between, between * u.mag, 1e3 * between * u.mmag, between * u.ABmag):
        assert len(umov.passes(hst, *span, mag_max=limit, cache=False)) == 1
    t = np.arange(0, 120, 0.5)
    seen = {"mjd_utc": 60000 + t / 86400, "mag": 7 + 0.3 * np.sin(2 * np.pi * t / 8.2)}
    assert umov.period(seen, false_alarm=1 * u.percent) == umov.period(seen, false_alarm=0.01)


@pytest.mark.parametrize("key, given, told", [
    ("observation.exposure_s", 100 * u.ms, "0.1"), ("detector.dark_e_s", 60 * u.electron / u.min, "1.0"), ("object.attitude.rate_deg_s", 1 * u.rad / u.s, None),
    ("atmosphere.sky.mag", 20 * u.mag / u.arcsec**2, "20.0"), ("render.accuracy", 4 * u.percent, "0.04"), ("atmosphere.pressure_hpa", 70 * u.kPa, "700.0")])
def test_keys_of_a_scenario_take_units(key, given, told):
    assert float(plain_key(given, key)) == pytest.approx(np.degrees(1) if told is None else float(told), rel=1e-15)
    with pytest.raises(umov.UsageError, match="was expected"):
        plain_key(3 * u.kg, key)


def test_a_key_without_a_unit_takes_no_quantity():
    with pytest.raises(umov.UsageError, match="atmosphere.ozone_du is .*; a plain number was expected"):
        umov.Scenario(EXAMPLES / "hst_maui.toml", set={"atmosphere.ozone_du": 3 * u.m})


def test_the_dark_sky_of_a_filter_has_a_unit():
    sky = 21 * u.mag / u.arcsec**2
    assert plain_key(sky, "observer.dark_mag.V") == 21
    changed = [umov.Scenario(EXAMPLES / "hst_maui.toml", one) for one in (
        {"atmosphere.sky.dark_mag": {"V": sky}}, {"atmosphere.sky.dark_mag.V": sky}, {"atmosphere.sky.dark_mag": {"V": 21.0}})]
    assert changed[0] == changed[1] == changed[2]
    with pytest.raises(umov.UsageError, match="dark_mag.V is .*a magnitude"):
        plain_key(21 * u.mag / u.deg**2, "observer.dark_mag.V")
