"""umov period: how the light of anybody's table repeats."""
import json
import re

import pytest


def test_the_period_of_a_table_of_anybodys_is_that_of_astropy(umov, tmp_path):
    import numpy as np
    from astropy.timeseries import LombScargle
    seconds = np.sort(np.random.default_rng(3).uniform(0, 300, 200))
    mag = 7 + 0.3 * np.sin(2 * np.pi * seconds / 13.7) + np.random.default_rng(4).normal(0, 0.1, 200)
    days = 60000 + seconds / 86400
    rows = "\n".join(f"{day:.12f},{m:.6f}" for day, m in zip(days, mag))
    (tmp_path / "mine.csv").write_text("mjd_utc,mag\n" + rows + "\n")
    done = umov("period", "mine.csv", "--peaks", 1, "--json")
    assert done.code == 0, done.err
    found = json.loads(done.out)[0]
    x = (seconds - seconds[0]) / (seconds[-1] - seconds[0])
    rest = mag - np.polyval(np.polyfit(x, mag, 2), x)
    search = LombScargle(seconds, rest)
    near = np.linspace(0.95 / 13.7, 1.05 / 13.7, 20001)
    power = search.power(near)
    # A parabola through three of five values a peak finds its top to a few hundredths of the error of the period.
    assert found["period"] == pytest.approx(1 / near[power.argmax()], abs=0.3 * found["period_err"])
    assert found["power"] == pytest.approx(power.max(), rel=0.1)  # the highest of the grid, not of the parabola
    assert abs(found["period"] - 13.7) < 4 * found["period_err"]
    # Noise alone: 200 values of it are hardly ever as high.
    assert found["false_alarm"] < 1e-10
    assert umov("period", "mine.csv", "--band", "V").code == 3


def noisy_sine(path, period_s, seed, amplitude=0.3):
    import numpy as np
    noise = np.random.default_rng(seed)
    seconds = np.arange(0, 300, 1.5)
    mag = 7 + amplitude * np.sin(2 * np.pi * seconds / period_s) + noise.normal(0, 0.1, len(seconds))
    path.write_text("mjd_utc,mag\n" + "\n".join(f"{60000 + t / 86400:.12f},{m:.6f}" for t, m in zip(seconds, mag)) + "\n")


def test_a_period_says_which_spins_it_may_mean_and_noise_is_none(umov, tmp_path):
    noisy_sine(tmp_path / "sine.csv", 13.7, 5)
    done = umov("period", "sine.csv", "--json")
    rows = json.loads(done.out)
    # White noise has a peak above the chance of .01 in one series of a hundred: of this seed none.
    assert [row["meaning"] for row in rows] == ["period"] and rows[0]["false_alarm"] < 1e-10, rows
    twice = float(re.search(r"twice that, ([0-9.]+) s", done.err).group(1))
    assert abs(twice - 2 * rows[0]["period"]) < 0.01 and "half of it" in done.err
    everything = json.loads(umov("period", "sine.csv", "--json", "--false-alarm", 1).out)
    assert len(everything) == 5 and all(row["false_alarm"] > 0.01 for row in everything[1:])
    noisy_sine(tmp_path / "noise.csv", 13.7, 6, amplitude=0)
    done = umov("period", "noise.csv")
    assert done.code == 5 and "stands out of noise" in done.err and "--false-alarm 1" in done.err, done.err


def test_parts_and_multiples_of_a_period_are_named(umov, tmp_path):
    """A spin of 40 s with two sides that differ a little: half of it is the highest, the spin itself lower."""
    import numpy as np
    seconds = np.arange(0, 600, 1.0)
    turn = 2 * np.pi * seconds / 40
    mag = 7 + 0.4 * np.sin(2 * turn) + 0.2 * np.sin(turn) + 0.1 * np.sin(4 * turn)
    (tmp_path / "two.csv").write_text("mjd_utc,mag\n" + "\n".join(
        f"{60000 + t / 86400:.12f},{m:.6f}" for t, m in zip(seconds, mag)) + "\n")
    rows = json.loads(umov("period", "two.csv", "--json", "--peaks", 3).out)
    assert [row["meaning"] for row in rows] == ["period", "twice rank 1", "half of rank 1"], rows
    assert rows[0]["period"] == pytest.approx(20, abs=0.1) and rows[1]["period"] == pytest.approx(40, abs=0.4)
