"""Observations as they are: the same numbers as CSV, FITS table and tracking data message give the same answer."""
import json

import pytest
from astropy.table import Table

from test_invert import KNOWN, TRUTHS, observe, scene  # noqa: F401


def asked(umov, name, fit):
    """Of any search: what is asked is whether two forms give the same."""
    done = umov("invert", "pose", name, "--scenario", fit, "--grid", "1000", "--json", *KNOWN)
    assert done.code == 0, done.err
    return json.loads(done.out)


@pytest.fixture
def seen(umov, scene, tmp_path):
    """obs.csv of a cubesat; the rows, and the scenario to fit."""
    assert umov("run", scene(TRUTHS[0], "rays", "truth", step=40), "-q").code == 0
    observe(tmp_path, "obs.csv", 50, 1)
    return Table.read(tmp_path / "obs.csv", format="ascii.csv", comment="#"), scene([1, 0, 0, 0], "masks", "fit")


def test_a_fits_table_is_the_csv(umov, seen, tmp_path):
    rows, fit = seen
    rows.meta["comments"] = ["pol_frame: altaz"]
    rows.write(tmp_path / "obs.fits")
    assert asked(umov, "obs.fits", fit)["modes"] == asked(umov, "obs.csv", fit)["modes"]
    del rows.meta["comments"]
    rows.write(tmp_path / "bare.fits")
    done = umov("invert", "pose", "bare.fits", "--scenario", fit)
    assert done.code == 3 and "COMMENT pol_frame" in done.err
    whole = (tmp_path / "obs.fits").read_bytes()
    begin = whole.index(b"XTENSION")
    width, count = (int(whole[whole.index(key, begin) + 10:][:20]) for key in (b"NAXIS1  =", b"NAXIS2  ="))
    rows_end = whole.index(b"END" + b" " * 77, begin) // 2880 * 2880 + 2880 + width * count
    # Within the table's header, without its rows, within them (CFITSIO read on behind its end), without the last byte, within the first block.
    for kept, words in ((begin + 1120, "part 2 of the FITS file has a header without an END"), (begin + 300, "part 2 of the FITS file has a header without an END"),
                        (rows_end - width * count, f"part 2 of the FITS file tells of {width * count} bytes of data, of which 0 are there"),
                        (rows_end - 1000, f"of which {width * count - 1000} are there"), (rows_end - 1, f"of which {width * count - 1} are there"),
                        (100, "shorter than a block of FITS")):
        (tmp_path / "cut.fits").write_bytes(whole[:kept])
        done = umov("invert", "pose", "cut.fits", "--scenario", fit)
        assert done.code == 3 and "cut.fits: " in done.err and words in done.err, (kept, done.err)
    (tmp_path / "unfilled.fits").write_bytes(whole[:rows_end])  # by a writer that does not fill the last block
    assert asked(umov, "unfilled.fits", fit)["modes"] == asked(umov, "obs.fits", fit)["modes"]


def test_the_fits_table_of_a_run_is_taken_as_it_is(umov, scene, tmp_path):
    name = scene(TRUTHS[0], "rays", "truth", step=40)
    text = (tmp_path / name).read_text().replace('formats = ["csv", "ecsv"]', 'formats = ["ecsv", "fits"]')
    (tmp_path / name).write_text(text)
    assert umov("run", name, "-q").code == 0
    fit = scene([1, 0, 0, 0], "masks", "fit")
    assert asked(umov, "truth/lightcurve.fits", fit)["modes"] == asked(umov, "truth/lightcurve.ecsv", fit)["modes"]


def tdm(rows, system="UTC"):
    head = ["CCSDS_TDM_VERS = 2.0", "CREATION_DATE = 2018-01-22T00:00:00", "ORIGINATOR = TEST"]
    for band in sorted(set(rows["band"])):
        head += ["META_START", f"COMMENT MAG: AB magnitude above the air in {band}", f"TIME_SYSTEM = {system}", "PARTICIPANT_1 = Maui",
                 "PARTICIPANT_2 = CUBESAT", "MODE = SEQUENTIAL", "PATH = 2,1", "META_STOP", "DATA_START"]
        head += [f"MAG = {r['time_utc'].rstrip('Z')} {r['mag']:.5f}" for r in rows if r["band"] == band]
        head += ["DATA_STOP"]
    return "\n".join(head) + "\n"


def test_magnitudes_of_a_tracking_data_message(umov, scene, tmp_path):
    assert umov("run", scene(TRUTHS[0], "rays", "truth", step=40), "-q").code == 0
    rows = Table.read(tmp_path / "truth/lightcurve.ecsv")
    rows = rows[[bool(m == m) for m in rows["mag"]]]
    fit = scene([1, 0, 0, 0], "masks", "fit")
    (tmp_path / "mag.csv").write_text("time_utc,band,mag\n" + "".join(f"{r['time_utc']},{r['band']},{r['mag']:.5f}\n" for r in rows))
    (tmp_path / "obs.tdm").write_text(tdm(rows))
    assert asked(umov, "obs.tdm", fit)["modes"] == asked(umov, "mag.csv", fit)["modes"]
    (tmp_path / "tai.tdm").write_text(tdm(rows, "TAI"))
    done = umov("invert", "pose", "tai.tdm", "--scenario", fit)
    assert done.code == 3 and "UTC was expected" in done.err and "tai.tdm:6" in done.err
