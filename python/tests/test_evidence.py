"""Evidence of an answer against nested sampling and against weighted draws: tests/data/evidence, made by
tools/oracles/evidence_dynesty.py (dynesty; a likelihood written anew)."""
import csv
import math
import pathlib

import pytest
import umov

DATA = pathlib.Path(__file__).parents[2] / "tests/data/evidence"
HYPOTHESES = {"box": {}, "gold": {"object.materials.mx": "box_gold"}, "wider": {"object.mesh.file": str(DATA / "wider.obj")}}
#: As the oracle has it, materials taken for right.
FIT = umov.Fit(grid=2000, floor=0.01, zero_point_sd=0.02, slope_sd=0, reflectance_sd=0, haze_sd=0, largest_floor=0)


ORACLES = ("dynesty", "importance")


def rows():
    out = []
    for oracle in ORACLES:
        lines = (DATA / f"{oracle}.csv").read_text().splitlines()
        out += [(oracle, row) for row in csv.DictReader(line for line in lines if not line.startswith("#"))]
    return out


@pytest.fixture(scope="module")
def answers():
    known = {}

    def of(case, hypothesis):
        if (case, hypothesis) not in known:
            known[case, hypothesis] = umov.invert_pose(DATA / f"{case}.csv", DATA / "box.toml", set=HYPOTHESES[hypothesis] or None, fit=FIT,
                                                       threads=1, cache=False)
        return known[case, hypothesis]

    return of


@pytest.mark.parametrize("oracle, row", rows(), ids=lambda x: x if isinstance(x, str) else f"{x['case']}-{x['hypothesis']}")
def test_evidence_is_that_of_other_integrals(answers, oracle, row):
    found = answers(row["case"], row["hypothesis"])
    # Three standard deviations of both: the oracle's, and of umov what its runs of particles differ by, or what draws of so many
    # effective samples leave open.
    own = max(found.values["evidences_apart"] / 2, 1 / math.sqrt(found.values["effective_samples"]))
    assert found.values["log_evidence"] == pytest.approx(float(row["ln_evidence"]), abs=3 * math.hypot(own, float(row["ln_evidence_err"])))
