"""Attitudes, moving parts and several objects in one scenario."""
import math

import numpy as np
import pytest
from astropy.table import Table

from conftest import ROOT, read_csv

HST = ROOT / "data/tle/hst.tle"
AEM = """CCSDS_AEM_VERS = 1.0
CREATION_DATE = 2018-01-20T00:00:00
ORIGINATOR = TEST
META_START
OBJECT_NAME = HST
OBJECT_ID = 1990-037B
CENTER_NAME = EARTH
REF_FRAME_A = EME2000
REF_FRAME_B = SC_BODY_1
ATTITUDE_DIR = A2B
TIME_SYSTEM = UTC
START_TIME = 2018-01-21T05:00:00
STOP_TIME = {stop}
ATTITUDE_TYPE = QUATERNION
META_STOP
DATA_START
{rows}
DATA_STOP
"""


def quaternions(rows):
    return [tuple(float(row[name]) for name in ("qw", "qx", "qy", "qz")) for row in rows]


def turn_between(a, b):
    return 2 * math.degrees(math.acos(min(1.0, abs(sum(x * y for x, y in zip(a, b))))))


def light_curve(umov, name, folder, *options):
    done = umov("run", name, "--quiet", *options)
    assert done.code == 0, done.err
    return read_csv(folder / "out/lightcurve.csv")


def test_an_attitude_message_is_what_the_run_uses(umov, scenario, tmp_path):
    """A turn of 0.6 deg/s about the body's z axis, in rows a minute apart; CCSDS has the scalar last."""
    lines = []
    for k in range(31):
        half = math.radians(0.3 * 60 * k)
        lines.append(f"2018-01-21T05:{k:02d}:00 0 0 {math.sin(half):.12f} {math.cos(half):.12f}")
    (tmp_path / "hst.aem").write_text(AEM.format(stop="2018-01-21T05:30:00", rows="\n".join(lines)))
    rows = light_curve(umov, scenario(('mode = "nadir"', 'mode = "aem", file = "hst.aem"')), tmp_path,
                       "--set", 'output.csv_digits="all"')
    for row, q in zip(rows, quaternions(rows)):
        minutes, seconds = map(float, row["time_utc"][14:-1].split(":"))
        half = math.radians(0.3 * (60 * minutes + seconds))
        # EME2000 is taken for GCRS, and rows of 12 digits.
        assert turn_between(q, (math.cos(half), 0, 0, math.sin(half))) < 1e-5


def test_an_attitude_message_that_ends_keeps_the_rows(umov, scenario, tmp_path):
    rows = "\n".join(f"2018-01-21T05:{k:02d}:00 0 0 0 1" for k in range(11))
    (tmp_path / "hst.aem").write_text(AEM.format(stop="2018-01-21T05:10:00", rows=rows))
    done = umov("run", scenario(('mode = "nadir"', 'mode = "aem", file = "hst.aem"')), "--quiet")
    assert done.code == 4 and "is not given for 2018-01-21T05:10:" in done.err, done.err
    assert read_csv(tmp_path / "out/lightcurve.csv")[-1]["time_utc"] <= "2018-01-21T05:10:00.000Z"


def test_a_tumbling_cube_turns_at_its_rate(umov, scenario, tmp_path):
    """All axes of a cube are alike: it spins steadily about the rate's axis."""
    law = ('mode = "tumble", inertia = "solid", rate_deg_s = [1, 2, 2], '
           'epoch = 2018-01-21T05:00:00Z, start = { mode = "inertial", quaternion = [1, 0, 0, 0] }')
    rows = light_curve(umov, scenario(('mode = "nadir"', law), ("step_s = 20", "step_s = 5")), tmp_path)
    q = quaternions(rows)[:: len({row["band"] for row in rows})]
    assert all(abs(turn_between(a, b) - 15) < 1e-4 for a, b in zip(q, q[1:]))


def test_a_panel_follows_the_sun(umov, scenario, tmp_path):
    """A plate turned to the Sun by its part is as bright as one that the attitude turns there."""
    assert umov("mesh", "make", "plate", "-o", "plate.obj").code == 0
    cube = ('"cube.obj"', '"plate.obj"')
    rays = '[render]\nmethod = "rays"\n[bands]'  # to rounding, which masks in single precision are not
    plain = light_curve(
        umov, scenario(cube, ('attitude = { mode = "nadir" }',
                              'attitude = { point = "+Z", at = "sun", then = "+Y", toward = "nadir" }')),
        tmp_path)
    group = next(line.split()[1] for line in (tmp_path / "plate.obj").read_text().splitlines()
                 if line.startswith("usemtl"))
    parts = "".join(f'[[object.part]]\nname = "{name}"\ngroups = ["{group}"]\naxis = "{axis}"\n{more}'
                    for name, axis, more in (("panel", "+X", ""),))
    turned = light_curve(
        umov, scenario(cube, ('attitude = { mode = "nadir" }',
                              'attitude = { point = "+X", at = "velocity", then = "+Z", toward = "sun" }'),
                       ("[bands]", parts + rays)), tmp_path)
    # +X along the velocity and Z as near to the Sun as may be: the part has nothing left to turn, and
    # the incidence is the sine of the angle between axis and Sun.
    still = light_curve(
        umov, scenario(cube, ('attitude = { mode = "nadir" }',
                              'attitude = { point = "+X", at = "velocity", then = "+Z", toward = "sun" }'),
                       ("[bands]", rays)), tmp_path)
    assert len(plain) == len(turned) == len(still) > 0
    for one, two in zip(turned, still):
        assert float(one["intensity"]) == pytest.approx(float(two["intensity"]), rel=1e-9)


def test_two_objects_make_one_table(umov, scenario, tmp_path):
    second = f"""[[object]]
name = "second"
orbit = {{ file = "{HST}", norad = 20580 }}
mesh = {{ file = "cube.obj", unit = "m", up = "+Z" }}
attitude = {{ mode = "spin", period_s = 60, epoch = 2018-01-21T05:00:00Z }}
[object.materials]
default = "paper_au"
[bands]"""
    alone = light_curve(umov, scenario(), tmp_path)
    done = umov("run", scenario(("[bands]", second)))
    assert done.code == 0, done.err
    both = read_csv(tmp_path / "out/lightcurve.csv")
    assert both[: len(alone)] == alone
    assert {row["name"] for row in both[len(alone):]} == {"second"}
    assert (tmp_path / "out/report_2.html").exists()
    assert "HST" in done.out and "second" in done.out
    # The locked scenario repeats both.
    lock = (tmp_path / "out/scenario.lock.toml").read_text()
    (tmp_path / "lock.toml").write_text(lock)
    assert light_curve(umov, "lock.toml", tmp_path) == both


def test_a_state_written_in_place(umov, scenario, tmp_path):
    done = umov("orbit", "propagate", "--orbit", HST, "--at", "2018-01-21T05:08:00Z", "-o", "s.csv")
    assert done.code == 0, done.err
    s = read_csv(tmp_path / "s.csv")[0]
    state = ('epoch = 2018-01-21T05:08:00Z, frame = "teme", norad = 20580, '
             f'position_km = [{s["teme_x"]}, {s["teme_y"]}, {s["teme_z"]}], '
             f'velocity_km_s = [{s["teme_vx"]}, {s["teme_vy"]}, {s["teme_vz"]}]')
    plain = light_curve(umov, scenario(), tmp_path)
    other = light_curve(umov, scenario((f'file = "{HST}", norad = 20580', state)), tmp_path)
    assert len(plain) == len(other) > 0
    for one, two in zip(plain, other):  # four minutes without drag and high harmonics
        assert float(one["range"]) == pytest.approx(float(two["range"]), abs=0.2)


@pytest.mark.parametrize("replacement, words", [
    (('mode = "nadir"', 'mode = "tumble", inertia = [1, 1, 9], rate_deg_s = [1, 0, 0], epoch = '
      '2018-01-21T05:00:00Z'), ["16:12", "principal moments 1, 1 and 9"]),
    (('mode = "nadir"', 'mode = "aem", file = "no.aem"'), ["no.aem", "no such file"]),
    (('mode = "nadir"', 'mode = "pieces", pieces = []'), ["has none"]),
    (('mode = "nadir"', 'mode = "nadir", libration = { rms_deg = 99 }'), ["99 deg"]),
    (("[bands]", '[[object.part]]\ngroups = ["wing"]\n[bands]'), ['no group "wing"']),
    (("[bands]", '[[object.part]]\naxis = "+X"\n[bands]'), ['has no "groups"']),
    (('norad = 20580 }', 'norad = 20580, position_km = [1, 2, 3] }'), ["no meaning with file"]),
])
def test_refuses(umov, scenario, tmp_path, replacement, words):
    done = umov("run", scenario(replacement))
    assert done.code == 3 and not (tmp_path / "out").exists(), done.err
    for word in words:
        assert word in done.err, done.err


@pytest.mark.parametrize("row, words", [
    ("2018-01-21T05:01:00 0 0 0 1.01", ["length 1.01", "hst.aem:18"]),
    ("2018-01-21T05:01:00 0 0 0", ["an epoch and 4 numbers"]),
    ("2018-01-21T05:01:00 0 0 0 nan", ["QC is \"nan\""]),
    ("2018-01-21T04:01:00 0 0 0 1", ["a later time was expected", "hst.aem:18"]),
])
def test_refuses_bad_attitude_messages(umov, scenario, tmp_path, row, words):
    (tmp_path / "hst.aem").write_text(
        AEM.format(stop="2018-01-21T05:01:00", rows="2018-01-21T05:00:00 0 0 0 1\n" + row))
    done = umov("run", scenario(('mode = "nadir"', 'mode = "aem", file = "hst.aem"')))
    assert done.code == 3, done.err
    for word in words:
        assert word in done.err, done.err


def test_the_spin_comes_back_from_the_light_curve(umov, scenario, tmp_path):
    """A plate with two different sides spins with 41 s in the geostationary ring, where the view hardly
    changes: the periodogram has its peak there."""
    from astropy.timeseries import LombScargle
    import numpy as np

    assert umov("mesh", "make", "plate", "--two-sided", "-o", "cube.obj").code == 0
    law = 'mode = "spin", axis = [1, 2, 0.5], period_s = 41, epoch = 2018-01-21T05:00:00Z'
    name = scenario(('mode = "nadir"', law), ('default = "paper_al"',
                                              'front = "paper_spectralon"\nback = "paper_asi"'),
                    (f'"{HST}", norad = 20580', f'"{ROOT}/tests/data/tle/mixed_979_2018-01-20.tle", norad = 36411'),
                    ("alt_min_deg = 10, sun_alt_max_deg = -6", "alt_min_deg = 10"),
                    ('set = "paper_rgb"', 'set = ["nm:550"]'), ("step_s = 20", "step_s = 1.7"),
                    ("05:12:00Z", "05:38:00Z"))
    rows = light_curve(umov, name, tmp_path)
    seconds = (np.array([float(row["mjd_utc"]) for row in rows]) - 58139) * 86400
    light = np.array([float(row["intensity"]) for row in rows])
    frequency = np.linspace(1 / 120, 1 / 5, 40000)
    power = LombScargle(seconds, light, nterms=4).power(frequency)
    # Sun and observer turn by 8 deg against each other in half an hour: a fiftieth of a turn in 44.
    assert abs(1 / frequency[np.argmax(power)] / 41 - 1) < 1e-3


def test_earthshine_has_columns_of_its_own(umov, scenario, tmp_path):
    plain = light_curve(umov, scenario(), tmp_path)
    rows = light_curve(umov, scenario(("[output]", "[render]\nearthshine = { albedo = 0.3 }\n[output]"),
                                      ('dir = "out"', 'dir = "out"')), tmp_path)
    assert len(rows) == len(plain) > 0
    for one, two in zip(plain, rows):
        assert "earth_I" not in one and one["I"] == two["I"]
        assert 0 <= float(two["earth_I"])
        if two["earth_q"]:
            # What was asked of it (0.02 unless said), and the light's own accuracy.
            assert 0 < float(two["earth_I_err"]) < 0.03 * float(two["earth_I"])
            assert 0 <= float(two["earth_q_err"]) < 0.03 and 0 <= float(two["earth_u_err"]) < 0.03
            assert float(two["earth_q"]) ** 2 + float(two["earth_u"]) ** 2 <= 1
    part = '[[object.part]]\ngroups = ["cube"]\naxis = "+X"\nangle_deg = 0\n'
    turned = light_curve(umov, scenario(("[output]", "[render]\nearthshine = { albedo = 0.3 }\n[output]"),
                                        ("[bands]", part + "[bands]")), tmp_path)
    for one, two in zip(rows, turned):  # turned by nothing: the engine of turning parts says the same
        assert float(one["earth_I"]) == pytest.approx(float(two["earth_I"]), rel=1e-3, abs=1e-30)
    done = umov("run", scenario(("[output]", "[render]\nearthshine = { albedo = 3 }\n[output]")))
    assert done.code == 3 and "albedo = 3; 0 to 1 was expected" in done.err
    done = umov("run", scenario(("[output]", "[render]\nearthshine = { accuracy = 2 }\n[output]")))
    assert done.code == 3 and "accuracy = 2; 1e-4 to 1 was expected" in done.err


def test_the_shadows_edge_bent_and_reddened(umov, scenario, tmp_path):
    """HST goes into the shadow at 05:13:46: with refraction blue fades before red, and light lasts longer."""
    span = ("05:08:00Z", "05:13:20Z"), ("05:12:00Z", "05:14:10Z"), ("step_s = 20", "step_s = 2"), ("sunlit = true",
                                                                                             "sunlit = false")
    plain = light_curve(umov, scenario(*span), tmp_path)
    rows = light_curve(umov, scenario(*span, ("[output]",
                                              '[render]\nshadow_edge = "refracted"\nmoonlight = true\n[output]')),
                       tmp_path)
    assert len(rows) == len(plain) and {row["sunlit"] for row in rows} == {row["sunlit"] for row in plain}
    part = {}
    for one, two in zip(plain, rows):
        if float(one["intensity"]) > 0:
            part.setdefault(one["band"], []).append((float(one["sunlit"]), float(two["I"]), float(one["I"])))
        assert 0 <= float(two["moon_I"])
    blue, red = part["nm:425"], part["nm:650"]
    full = [k for k, row in enumerate(blue) if row[0] == 1][0]
    assert all(row[1] <= row[2] * (1 + 1e-12) for row in blue[:full + 1])
    penumbra = [k for k, row in enumerate(blue) if 0.05 < row[0] < 0.6]
    assert penumbra and all(blue[k][1] / blue[k][2] < red[k][1] / red[k][2] for k in penumbra)
    assert any(row[0] == 0 and row[1] > 0 for row in red)  # into the umbra


def test_a_panel_follows_the_sun_in_a_signature(umov, scenario, tmp_path):
    """Directions alone are enough for a part that follows the Sun: a plate turned about +Y towards a Sun in
    the plane across +Y is lit and seen as one that the directions themselves were turned for."""
    assert umov("mesh", "make", "plate", "-o", "plate.obj").code == 0
    group = next(line.split()[1] for line in (tmp_path / "plate.obj").read_text().splitlines()
                 if line.startswith("usemtl"))
    part = (f'[[object.part]]\nname = "panel"\ngroups = ["{group}"]\naxis = "+Y"\nface = "+Z"\n'
            '[render]\nmethod = "rays"\n[bands]')
    plain = '[render]\nmethod = "rays"\n[bands]'
    a, b = np.radians(35), np.radians(20)
    # In the body: the Sun 35 deg from +Z about +Y, the observer 20 deg beyond it.
    (tmp_path / "turned.csv").write_text(
        "sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n"
        f"{np.sin(a)},0,{np.cos(a)},{np.sin(a + b)},0,{np.cos(a + b)}\n")
    # The same from the plate: the Sun at +Z, the observer 20 deg from it.
    (tmp_path / "plain.csv").write_text("sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n"
                                        f"0,0,1,{np.sin(b)},0,{np.cos(b)}\n")
    cube = ('"cube.obj"', '"plate.obj"')
    turned = umov("signature", scenario(cube, ("[bands]", part)), "--geometry", "turned.csv", "-o", "a.csv")
    still = umov("signature", scenario(cube, ("[bands]", plain)), "--geometry", "plain.csv", "-o", "b.csv")
    assert turned.code == still.code == 0, turned.err + still.err
    one, two = (Table.read(tmp_path / name, format="ascii.csv", comment="#") for name in ("a.csv", "b.csv"))
    assert np.allclose(one["intensity"], two["intensity"], rtol=1e-9) and two["intensity"][0] > 0
