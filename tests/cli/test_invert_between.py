"""umov invert with light between surfaces in the fit: data by paths, of a body a quarter of whose light touches several surfaces;
the fit interpolates what chains light (docs/theory/inverse.md, 6.1). Truth is known from how the data were made."""
import json

import pytest
from conftest import processor_s_of_children
from test_invert import apart, in_set, observe, scene  # noqa: F401

METALS = 'bus = "gold"\npanels = "silicon"\ndish = "aluminium"\ntank = "smooth"'
INDICES = """
[material.{name}]
index = {{ n = {n}, k = {k} }}
distribution = {{ model = "ggx", alpha = {alpha} }}
shadowing = "separable"
"""
TRUTH = [0.5, 0.5, -0.5, 0.5]


def body(umov, scene, folder, *arguments):
    """scene() of a box-wing of rough metals; the light between its surfaces is .11 of I in the median."""
    file = scene(*arguments, mesh="wing", materials=METALS, step=16)
    with open(folder / file, "a", encoding="utf-8") as text:
        for name, n, k, alpha in (("gold", 0.4, 2.4, 0.3), ("silicon", 4, 0.5, 0.2), ("aluminium", 0.96, 6.69, 0.25), ("smooth", 0.4, 2.4, 0.2)):
            text.write(INDICES.format(name=name, n=n, k=k, alpha=alpha))
    return file


def ask(umov, folder, *words):
    done = umov("invert", "pose", "obs.csv", "--scenario", "fit.toml", "-o", "answer", "--force", "--json", "--grid", "30000",
                "--slope-sd", 0, "--reflectance-sd", 0, "--haze-sd", 0, *words)
    assert done.code in (0, 4), done.err
    return json.loads(done.out), in_set(folder / "answer", TRUTH) or in_set(folder / "answer", HALF_TURN)


# The body looks alike after half a turn about +Z: q times k.
HALF_TURN = [-TRUTH[3], TRUTH[2], -TRUTH[1], TRUTH[0]]


@pytest.mark.long
def test_an_attitude_is_found_by_light_that_touched_several_surfaces(umov, scene, tmp_path):
    assert umov("mesh", "make", "box-wing", "--facets", 600, "-o", "wing.obj", "-q").code == 0
    truth = body(umov, scene, tmp_path, TRUTH, "rays", "truth")
    assert umov("run", truth, "-q", "--set", "render.bounces=3").code == 0
    observe(tmp_path, "obs.csv", 100, 1)
    body(umov, scene, tmp_path, [1, 0, 0, 0], "masks", "fit")
    without, _ = ask(umov, tmp_path)
    assert without["light_between"] > 0.05 and not without["light_between_fitted"]
    assert without["verdict"] != "determined"  # a tenth of the light is missing
    found, is_in_set = ask(umov, tmp_path, "--set", "render.bounces=3")
    assert found["light_between_fitted"] and found["light_between"] > 0.05
    assert is_in_set and found["verdict"] in ("determined", "ambiguous")
    best = found["modes"][0]["q"]
    assert min(apart(best, TRUTH), apart(best, HALF_TURN)) < 2  # deg: light is known to 2 % (--floor), lobes are 10 to 17 deg wide
    bytes_of = {name: (tmp_path / "answer" / name).read_bytes() for name in ("modes.ecsv", "set95.ecsv", "samples.ecsv")}
    ask(umov, tmp_path, "--set", "render.bounces=3", "--threads", 1)
    assert all((tmp_path / "answer" / name).read_bytes() == content for name, content in bytes_of.items())


@pytest.mark.long
def test_chains_are_drawn_once_for_all_materials(umov, scene, tmp_path):
    """Of four metals on the panels, one of them true; each candidate took a drawing of its own."""
    assert umov("mesh", "make", "box-wing", "--facets", 600, "-o", "wing.obj", "-q").code == 0
    truth = body(umov, scene, tmp_path, TRUTH, "rays", "truth")
    assert umov("run", truth, "-q", "--set", "render.bounces=3").code == 0
    observe(tmp_path, "obs.csv", 100, 1)
    body(umov, scene, tmp_path, TRUTH, "auto", "fit")

    def ask(*words):
        before = processor_s_of_children()
        done = umov("invert", *words, "--scenario", "fit.toml", "-o", "answer", "--force", "--json", "--set", "render.bounces=3",
                    "--set", "render.between=chains")
        assert done.code == 0, done.err
        return json.loads(done.out), processor_s_of_children() - before

    _, of_two = ask("material", "obs.csv", "--group", "panels", "--candidates", "silicon,gold")
    found, of_four = ask("material", "obs.csv", "--group", "panels", "--candidates", "gold,silicon,aluminium,smooth")
    assert of_four < 1.6 * of_two  # twice as much with a drawing each; direct light is made for each
    assert found["verdict"] == "determined"
    turned, _ = ask("material", "obs.csv", "--group", "panels", "--candidates", "smooth,aluminium,silicon,gold")
    fractions = [{"|".join(sorted(one["materials"])): one["fraction"] for one in answer["materials"]} for answer in (found, turned)]
    assert fractions[0] == pytest.approx(fractions[1], abs=1e-9)  # whoever draws the chains for all
    probability = {"|".join(one["materials"]): one["probability"] for one in found["materials"]}
    assert probability["silicon"] > 0.95 and sum(probability.values()) > 0.999
    health, _ = ask("health", "obs.csv", "--drift", "panels=gold")
    assert health["verdict"] == "determined"  # nothing has changed, and a change would have shown
