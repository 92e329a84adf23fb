"""Every long call hears Ctrl-C within a fifth of a second, and gives what is done.

The signal comes after so much of the processor's time, and how long the call goes on is counted in it too: what a busy
machine does besides is not the call's. SIGPROF has Python's handler of Ctrl-C; all that follows is that of SIGINT.
"""
import contextlib
import pathlib
import signal
import time

import numpy as np
import pytest
import umov
from astropy.time import Time
from conftest import DATA, EXAMPLES, ROOT

CATALOGUE = ROOT / "tests/data/tle/mixed_979_2018-01-20.tle"
#: A fifth of a second on one thread, and what pages take that are given back to the system.
LONGEST_S = 0.3


@contextlib.contextmanager
def ctrl_c(after_s):
    """Yields a call that says for how long the work went on after Ctrl-C."""
    before = signal.signal(signal.SIGPROF, signal.default_int_handler)
    begun = time.process_time()
    signal.setitimer(signal.ITIMER_PROF, after_s)
    try:
        yield lambda: time.process_time() - begun - after_s
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def many_times(count):
    """Times three seconds apart."""
    return Time(2458139.7 + np.arange(count) / 1440 / 20, format="jd")


def grid(*shape):
    return np.linspace(0, 89, shape[0])[:, None], np.linspace(0, 89, shape[1])[None, :]


def sums_of(scene):
    sums, poses = umov.Sums(scene, threads=1, cache=False), umov.random_poses(300_000, 60)
    return lambda: sums.abundances(*poses)


def colours_of(plate):
    sums = umov.Sums(plate, threads=1)
    made = sums.abundances(*umov.random_poses(2_000_000, 60))
    return lambda: sums.apply(made)


def states(_):
    times = many_times(20_000)
    return lambda: umov.propagate(CATALOGUE, times, threads=1, allow_bad_checksum=True)


def exposures(_):
    scenario = umov.Scenario(EXAMPLES / "observe_hst.toml", set={"observation.exposure_s": 0.02})
    return lambda: umov.observe(scenario, threads=1)


def poses_of_a_curve(_):
    scenario = EXAMPLES / "agena_maui.toml"
    curve = umov.run(scenario, set={"time.step_s": 20})
    return lambda: umov.invert_pose(curve, scenario, threads=1, cache=False)


pytestmark = [pytest.mark.alone, pytest.mark.filterwarnings("ignore::umov.UmovWarning")]  # warnings of old elements

#: What makes the call ready, and after how much of it Ctrl-C comes [s].
LONG = {
    "abundances": (sums_of, 0.5), "apply": (colours_of, 0.2), "propagate": (states, 0.3), "propagate later": (states, 1.0),
    "ephemeris": (lambda _: lambda: umov.ephemeris(DATA / "tle/hst.tle", "maui", "2018-01-20T00:00Z", "2018-01-24T00:00Z",
                                                   step_s=0.1, threads=1), 0.3),
    "brdf": (lambda _: lambda: umov.brdf("gold", 550.0, *grid(2000, 700)), 0.2),
    "render": (lambda hst: lambda: umov.render(hst, sun=[1, 1, 1], observer=[0, 1, 1], side=1500, threads=1), 0.5),
    "random poses": (lambda _: lambda: umov.random_poses(20_000_000, 60), 0.3),
    "grid of a run": (lambda _: lambda: umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 0.005}, threads=1), 0.3),
    "observe": (exposures, 1.5),
    "run by rays": (lambda _: lambda: umov.run(EXAMPLES / "hst_maui.toml", set={"render.method": "rays", "time.step_s": 0.5,
                                                                                "render.accuracy": 0.0005}, threads=1), 2.0),
    **{f"invert_pose at {after_s}": (poses_of_a_curve, after_s) for after_s in (0.1, 0.3, 0.5, 0.7, 1.0)},
}


@pytest.mark.parametrize("name", LONG)
def test_ctrl_c_is_heard(name, hst, plate):
    make, after_s = LONG[name]
    call = make(plate if name == "apply" else hst)
    with ctrl_c(after_s) as late:
        with pytest.raises(KeyboardInterrupt):
            call()
        assert late() < LONGEST_S


@pytest.fixture(scope="module")
def large(tmp_path_factory):
    """Two spheres side by side, 164,000 triangles with smooth normals, of which the one hides the other. Beside its file, the same in
    other formats, and one sphere alone."""
    import trimesh
    file = tmp_path_factory.mktemp("mesh") / "two.ply"
    one, other = (trimesh.creation.icosphere(subdivisions=6) for _ in range(2))
    one.export(file.with_name("one.ply"))
    other.apply_translation([3, 0, 0])
    for suffix in (".ply", ".obj", ".glb"):
        trimesh.util.concatenate([one, other]).export(file.with_suffix(suffix))
    return umov.Satellite(mesh=file, unit="m", up="+Z", materials="gold", normals="smooth", orbit=DATA / "tle/hst.tle",
                          attitude={"mode": "nadir"}, name="two")


AT_ONCE = {"threads": 1, "cache": False}
#: One pose of which takes a second: all the paths that a pose may have.
MANY_PATHS = {"render.bounces": 16, "render.accuracy": 1e-5}


def beside(large, name):
    """Another file of the fixture."""
    file = pathlib.Path(large.to_dict()["mesh"]["file"]).with_name(name)
    return umov.Satellite(mesh=file, unit="m", up="+Z", materials="gold")


def turning(**options):
    """A pose of a body whose one wing turns: another body at every pose."""
    wing = {"groups": [f"wing_py_{part}" for part in ("front", "back", "edge", "yoke")], "axis": "+Y", "angle_deg": 30}
    body = umov.Satellite(mesh=DATA / "mesh/box_wing.obj", unit="m", up="+Z", materials="aluminium", parts=[wing])
    return umov.Engine(body, ["nm:1000"], set=MANY_PATHS, **options, **AT_ONCE).evaluate([0.1, 0.4, 1], [0, 1, 1])


SET_UP = {
    "Engine of a ball": lambda large: umov.Engine(beside(large, "one.ply"), ["nm:550"], **AT_ONCE),
    "mesh of OBJ": lambda large: umov.mesh(beside(large, "two.obj")),
    "mesh of glTF": lambda large: umov.mesh(beside(large, "two.glb")),
    "light between surfaces": lambda large: umov.Engine(large, ["nm:550"], set={"render.bounces": 2, "render.accuracy": 0.002},
                                                        method="rays", **AT_ONCE).evaluate([0, 0, 1], [0, 1, 1]),
    "light between parts that turn": lambda _: turning(method="masks"),
    "heat of parts that turn": lambda _: turning(temperatures=[300]),
    "Engine": lambda large: umov.Engine(large, ["nm:550"], **AT_ONCE),
    "Engine by rays": lambda large: umov.Engine(large, ["nm:550"], method="rays", **AT_ONCE).evaluate([0, 0, 1], [0, 1, 1]),
    "Engine of heat": lambda large: umov.Engine(large, ["nm:1000"], temperatures=[300], **AT_ONCE),
    "Sums": lambda large: umov.Sums(large, **AT_ONCE),
    "mesh": umov.mesh,
    "light_curve": lambda large: large.light_curve("maui", "2018-01-21T05:10Z", "2018-01-21T05:10Z", bands=["nm:550"], **AT_ONCE),
    "passes": lambda large: umov.passes(large, "maui", "2018-01-21T05:00Z", "2018-01-21T05:20Z", bands=["nm:550"], **AT_ONCE),
}


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow) if name in ("light_curve", "passes") else name for name in SET_UP])
def test_what_takes_long_to_make_ready_may_be_stopped(name, large):
    """At any time of it: a large mesh is read, cleaned, cut and joined for seconds before the first pose."""
    def processor_s():
        begun = time.process_time()
        SET_UP[name](large)
        return time.process_time() - begun
    whole_s = min(processor_s(), processor_s())  # on a busy machine the same work takes up to 1.5 times as long
    for part in (0.1, 0.25, 0.4, 0.55):
        with ctrl_c(part * whole_s) as late:
            with pytest.raises(KeyboardInterrupt):
                SET_UP[name](large)
            assert late() < LONGEST_S, part


def test_poses_that_were_lit_are_given(hst):
    engine = umov.Engine(hst, bands=["nm:550"], method="rays", threads=1)
    sun, observer = (one.reshape(2, 10_000, 3) for one in umov.random_poses(20_000, 60))
    for call in (engine.evaluate, engine.light):
        with ctrl_c(0.3), pytest.raises(umov.Interrupted) as caught:
            call(sun, observer)
        part = caught.value.partial
        part, method = (part, None) if call == engine.evaluate else (part.stokes, part.method)
        assert part.shape[1:] == (1, 4) and 0 < len(part) < 20_000
        assert method is None or method.shape == part.shape[:1]
        few = min(len(part), 50)
        np.testing.assert_array_equal(part[:few], engine.evaluate(sun[0, :few], observer[0, :few]))


def test_sums_that_were_made_are_given(plate):
    sums, (sun, observer) = umov.Sums(plate, threads=1), umov.random_poses(3_000_000, 60)
    with ctrl_c(0.2), pytest.raises(umov.Interrupted, match="poses") as caught:
        sums.abundances(sun, observer)
    part = caught.value.partial
    assert 0 < len(part.sum) < len(sun)
    np.testing.assert_array_equal(part.sum, sums.abundances(sun[:len(part.sum)], observer[:len(part.sum)]).sum)
    assert sums.apply(part).stokes.shape == (len(part.sum), 3, 4)


def test_sums_tell_how_far_they_are(plate):
    seen = []
    umov.Sums(plate).abundances(*umov.random_poses(1_000_000, 60), progress=lambda *news: seen.append(news))
    assert {what for what, _, _ in seen} == {"poses"} and seen[-1][1:] == (1_000_000, 1_000_000)


def test_states_that_nobody_came_to_are_marked():
    times = many_times(20_000)
    with ctrl_c(1.5), pytest.raises(umov.Interrupted) as caught:
        umov.propagate(CATALOGUE, times, threads=1, allow_bad_checksum=True)
    part = caught.value.partial
    assert (part.error == -1).any() and (part.error == 0).any()
    np.testing.assert_array_equal(np.isnan(part.position_km[..., 0]), part.error != 0)
