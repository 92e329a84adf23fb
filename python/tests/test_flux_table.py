"""Light curves as lightkurve and archives have them. The times expected are astropy's, made here the other way round."""
import numpy as np
import pytest
from astropy import units as u
from astropy.io import fits
from astropy.table import MaskedColumn, Table
from astropy.time import Time, TimeDelta
from astropy.timeseries import TimeSeries
from astropy.utils.masked import Masked

import umov
from conftest import EXAMPLES

UTC = Time("2018-01-21T05:09:00", scale="utc") + TimeDelta(np.arange(4) * 20, format="sec")
FLUX = np.array([1.0, 2.0, np.nan, 4.0])
HIDDEN = [False, True, False, False]
CORRECTION = np.array([0.004, 0.0041, 0.0042, 0.0043])  # days: the barycentre hears of it later


def seconds_off(table, expected):
    found = Time([text.rstrip("Z") for text in table["time_utc"]], scale="utc")
    return np.abs((found - expected).to_value("s")).max()


def tess_file(path, flags=(0, 0, 0, 0), timecorr=True, **cards):
    """As the archive has them: BTJD of TDB at the barycentre."""
    bary = UTC.tdb + TimeDelta(CORRECTION, format="jd")
    bjd = (bary.jd1 - 2457000) + bary.jd2
    columns = [fits.Column("TIME", "D", array=bjd), fits.Column("SAP_FLUX", "E", array=FLUX),
               fits.Column("SAP_FLUX_ERR", "E", array=0.1 * FLUX), fits.Column("QUALITY", "J", array=np.array(flags))]
    if timecorr:
        columns.append(fits.Column("TIMECORR", "D", array=CORRECTION))
    table = fits.BinTableHDU.from_columns(columns)
    table.header.update({"TIMEREF": "SOLARSYSTEM", "TIMESYS": "TDB", "BJDREFI": 2457000, "BJDREFF": 0.0, **cards})
    fits.HDUList([fits.PrimaryHDU(), table]).writeto(path, overwrite=True)
    return path


def test_a_file_of_tess_is_brought_back_from_the_barycentre(tmp_path):
    with pytest.warns(umov.UmovWarning, match="TDB since JD 2457000.*brought back by timecorr.*2 of 4 rows"):
        found = umov.flux_table(tess_file(tmp_path / "t.fits", flags=(0, 16, 0, 0)), "nm:550", flux="sap_flux")
    # A double of days since JD 2457000 tells 1e-8 s of time, the text a microsecond.
    assert seconds_off(found, UTC[[0, 3]]) < 1e-5
    assert list(found["band"]) == ["nm:550"] * 2
    assert np.allclose(found["flux_err"], 0.1 * FLUX[[0, 3]], rtol=1e-6)  # single precision


def test_a_time_series_of_any_scale_is_brought_to_utc():
    series = TimeSeries({"flux": [1, 2, 3, 4] * u.electron / u.s, "flux_err": [.1] * 4 * u.electron / u.s}, time=UTC.tai)
    with pytest.warns(umov.UmovWarning, match="TAI"):
        found = umov.flux_table(series, "nm:550")
    assert seconds_off(found, UTC) < 1e-5 and list(found["flux"]) == [1, 2, 3, 4]


def test_what_cannot_be_known_is_refused(tmp_path):
    with pytest.raises(umov.InputError, match="8.3 min"):
        umov.flux_table(tess_file(tmp_path / "t.fits", timecorr=False), "nm:550", flux="sap_flux")
    with pytest.raises(umov.InputError, match="no column 'flux'; there are TIME, SAP_FLUX"):
        umov.flux_table(tess_file(tmp_path / "t.fits"), "nm:550")
    with pytest.raises(umov.InputError, match="without a scale"):
        umov.flux_table(Table({"time": [1.0, 2.0], "flux": [1.0, 2.0]}), "nm:550")
    with pytest.raises(umov.InputError, match="no row with a finite flux"):
        umov.flux_table(TimeSeries({"flux": [np.nan]}, time=UTC[:1]), "nm:550")
    (tmp_path / "text.fits").write_text("no FITS")
    with pytest.raises(umov.InputError, match="cannot be read as FITS"):
        umov.flux_table(tmp_path / "text.fits", "nm:550")
    with pytest.raises(umov.UsageError, match="lightkurve"):
        umov.flux_table([1, 2], "nm:550")


def test_an_inversion_takes_it():
    """Light of a part that is painted white, of a table of lightkurve's kind: it is told from black."""
    scene = EXAMPLES / "agena_maui.toml"
    asked = {"object.attitude": {"mode": "inertial", "quaternion": [0.8, 0.0, 0.6, 0.0]}, "bands.set": ["nm:550"]}
    curve = umov.run(scene, set={**asked, "time.step_s": 20})
    light = np.asarray(curve["I"]).ravel()
    series = TimeSeries({"flux": light, "flux_err": 0.01 * light}, time=curve.time)
    found = umov.invert_material(umov.flux_table(series, "nm:550"), scene, group="paint_white", candidates=["paint_white", "paint_black"], set=asked)
    of = found.tables["materials"]
    assert found.verdict == "determined" and of["material"][int(np.argmax(of["probability"]))] == "paint_white"
    assert len(found.tables["fit"]) == len(series)


def series(**columns):
    return TimeSeries(time=UTC, data={"flux": np.array([1.0, 2.0, 3.0, 4.0]), **columns})


def test_errors_are_taken_in_the_unit_of_the_flux():
    """A thousand of the one are one of the other: the numbers alone made errors a thousand times too large."""
    found = umov.flux_table(series(flux=np.arange(1, 5) * u.Jy, flux_err=[100, 200, 300, 400] * u.mJy), "nm:550")
    np.testing.assert_allclose(found["flux_err"], [0.1, 0.2, 0.3, 0.4], rtol=1e-15)


@pytest.mark.parametrize("unit", ["Jy", "mJy"])
@pytest.mark.parametrize("made", [lambda values, unit: MaskedColumn(values, mask=HIDDEN, unit=unit),
                                  lambda values, unit: Masked(values * u.Unit(unit), mask=HIDDEN)], ids=["column", "quantity"])
def test_a_masked_error_is_none_in_any_unit(made, unit):
    """A change of unit brought out the number behind the mask."""
    light = Table({"time": UTC, "flux": np.arange(1, 5) * u.Jy, "flux_err": made([1, 2, 3, 4], unit)})
    found = umov.flux_table(light, "nm:550")["flux_err"]
    scale = u.Unit(unit).to("Jy")
    np.testing.assert_allclose(found, [scale, np.nan, 3 * scale, 4 * scale], rtol=1e-15)


@pytest.mark.parametrize(("columns", "words"), [
    ({"flux": [7.0, 7, 7, 7] * u.mag}, "column flux in mag; a flux, linear in light"),
    ({"flux": [7.0, 7, 7, 7] * u.ABmag}, r"column flux in mag\(AB\); a flux"),
    ({"flux_err": [1.0, 1, 1, 1] * u.mag}, "column flux_err in mag; a flux"),
    ({"flux": ["a", "b", "c", "d"]}, r"column flux has shape \(4,\) of <U1; one number a row"),
    ({"flux": np.ones((4, 3))}, r"column flux has shape \(4, 3\) of float64; one number a row"),
    ({"quality": ["good"] * 4}, "column quality has shape .* of <U4; one number a row"),
    ({"timecorr": [1.0, 1, 1, 1] * u.km}, "column timecorr is in km; what goes into d")])
def test_columns_that_are_no_flux_are_told_of(columns, words):
    with pytest.raises(umov.UsageError, match=words):
        umov.flux_table(series(**columns), "nm:550", is_barycentric="timecorr" in columns)


def test_a_correction_in_minutes_is_in_minutes():
    for correction in (CORRECTION, CORRECTION * u.one, CORRECTION * u.d, (CORRECTION * u.d).to(u.min)):
        bary = TimeSeries(time=UTC.tdb + TimeDelta(CORRECTION, format="jd"), data={"flux": np.ones(4), "timecorr": correction})
        with pytest.warns(umov.UmovWarning, match="brought back by timecorr"):
            assert seconds_off(umov.flux_table(bary, "nm:550", is_barycentric=True), UTC) < 2e-6  # the text tells a microsecond


@pytest.mark.parametrize(("options", "words"), [({"band": 5}, "band is 5; a text"), ({"flux": 5}, "flux is 5; a text"),
                                                ({"is_barycentric": "no"}, "is_barycentric is 'no'; True or False")])
def test_words_of_a_flux_table(options, words):
    with pytest.raises(umov.UsageError, match=words):
        umov.flux_table(series(), **{"band": "nm:550", **options})


def _columns(**more):
    return {"time": UTC, "flux": [1.0, 2, 3, 4], "flux_err": [.1] * 4, **more}


def test_a_dictionary_keeps_units_and_masks():
    with_units = umov.flux_table(_columns(flux=[1000.0, 2000, 3000, 4000] * u.mJy, flux_err=[.1, .2, .3, .4] * u.Jy), "nm:550")
    assert np.allclose(with_units["flux_err"] / with_units["flux"], 0.1, rtol=1e-12)  # 0.1 Jy of 1000 mJy; doubles
    listed = umov.flux_table(_columns(flux=[1000 * u.mJy, 2 * u.Jy, 3 * u.Jy, 4 * u.Jy], flux_err=[.1] * 4 * u.Jy), "nm:550")
    assert np.allclose(listed["flux_err"] / listed["flux"], [.1, .05, .1 / 3, .025], rtol=1e-12)
    with pytest.raises(umov.UsageError, match="linear in light"):
        umov.flux_table(_columns(flux=[1.0, 2, 3, 4] * u.mag, flux_err=[.1] * 4 * u.mag), "nm:550")
    for hidden in (np.ma.array([1.0, 2, 3, 4], mask=HIDDEN), Masked([1.0, 2, 3, 4], mask=HIDDEN)):
        with pytest.warns(umov.UmovWarning, match="1 of 4 rows"):
            found = umov.flux_table(_columns(flux=hidden), "nm:550")
        assert list(found["flux"]) == [1, 3, 4]


@pytest.mark.parametrize("flux", ([1.0, 2.0], 5.0, [[1.0], [2.0, 3.0], [], []], None))
def test_columns_of_no_length_in_common_are_told(flux):
    with pytest.raises(umov.UsageError, match="light"):
        umov.flux_table(_columns(flux=flux), "nm:550")
