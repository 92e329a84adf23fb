"""Scenes: an object without time, lit from any direction."""
import pytest

import umov
import umov.turnable
from conftest import DATA

TURNING = {"spin": {"mode": "spin", "axis": "+Z", "period_s": 5}, "tumble": {"mode": "tumble", "rate_deg_s": [1, 2, 3], "inertia": "shell"}}


def _turning(mode):
    return umov.Satellite(DATA / "mesh/agena.obj", unit="m", up="+Z", materials="paper_al", orbit=DATA / "tle/hst.tle", norad=20580,
                          attitude=TURNING[mode])


@pytest.mark.parametrize("mode", TURNING)
def test_a_spin_without_an_epoch_is_lit_and_drawn(mode):
    """Nothing here asks how it is turned at a time: the light is that of the same object in any attitude."""
    turning = _turning(mode)
    still = umov.Satellite(DATA / "mesh/agena.obj", unit="m", up="+Z", materials="paper_al")
    sun, observer = umov.random_poses(20, phase_deg=60)
    light = [umov.Engine(one, bands=["nm:550"], method="masks").evaluate(sun, observer).tobytes() for one in (turning, still)]
    assert light[0] == light[1]
    assert umov.mesh(turning).vertices.tobytes() == umov.mesh(still).vertices.tobytes()
    pictures = [umov.render(one, sun=[1, 1, 1], observer=[0, 1, 1], side=16, samples=1).png for one in (turning, still)]
    assert pictures[0] == pictures[1]
    assert len(umov.turnable.mesh(turning).data) > 0
    assert umov.Sums(turning).abundances(sun, observer) is not None


@pytest.mark.parametrize("mode", TURNING)
def test_its_scenario_says_what_was_given_and_no_more(mode):
    text = umov.Scenario(_turning(mode)).to_toml()
    assert f'mode = "{mode}"' in text and "epoch" not in text
    assert umov.Scenario.from_toml(text).to_toml() == text


@pytest.mark.parametrize("mode", TURNING)
def test_who_asks_at_a_time_needs_the_epoch(mode):
    with pytest.raises(umov.InputError, match='no "epoch", and there is no time.start'):
        umov.passes(_turning(mode), "maui", "2018-01-21T04:00Z", "2018-01-21T07:00Z")
