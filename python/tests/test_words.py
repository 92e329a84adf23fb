"""Messages speak to who calls from Python: of arguments and functions, not of options and verbs of the command."""
import re
import warnings

import pytest
import umov
from conftest import DATA, EXAMPLES, ROOT
from umov._words import in_python, told_in_python

LITERALS = re.compile(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*')
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
#: An option, or a verb: what stands behind "umov" in a sentence about the program itself is none.
COMMAND = re.compile(r"--[a-z]|\bumov (?!(?:did|does|has|is|maps|journal|scenario|made|wrote|writes|reads|1)\b)[a-z]+ ?[a-z]*")
#: Files of messages that Python cannot bring about, and why.
NOT_OF_PYTHON = {
    "src/backend/cuda/compiler.cpp": "words for NVIDIA's compiler",
    "src/io/scenario/keys.cpp": "help of the scenario's keys, the same in every language",
    "src/jobs/index_range.cpp": "parts of jobs, which umov.scale asks the command for",
    "src/jobs/observe_ranged.cpp": "the same",
    "src/jobs/orbit_files.cpp": "orbits written in another format, which the command alone does",
    "src/jobs/sky_chart.cpp": "the page of the command's passes",
}
#: Messages that are checked before here.
REFUSED_BEFORE = (
    "--shard and --range take frames", "--model needs --material", "band needs --scene or --model", "--scene has no object of norad",
    "nothing is known of magnitudes", "pass --force to put the files",
)


def messages():
    """Texts of the library, as its messages are put together from them."""
    for folder in ("src", "include"):
        for path in sorted((ROOT / folder).rglob("*.[ch]*")):
            name = path.relative_to(ROOT).as_posix()
            if "/tests/" in name or name in NOT_OF_PYTHON or name.startswith(("src/paper", "src/bench", "src/scale", "src/jobs/job_journal")):
                continue
            code = re.sub(r"^\s*#.*|//.*", "", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
            for found in LITERALS.finditer(code):
                yield name, "".join(LITERAL.findall(found[0]))


def test_no_message_speaks_of_the_command():
    told = [(name, text) for name, text in messages() if COMMAND.search(text)]
    assert len(told) > 80  # of which the sources have many
    said = [(name, in_python(text)) for name, text in told]
    assert not [(name, text) for name, text in said
                if COMMAND.search(re.sub(r'"umov [a-z ]+" in a shell', "", text)) and not any(one in text for one in REFUSED_BEFORE)]


def test_what_python_says_of_the_command_in_a_shell():
    assert in_python("Known: umov material index.") == 'Known: "umov material index" in a shell.'
    assert in_python("Known: umov material list.") == "Known: umov.materials()."
    assert in_python("umov run also needs x; it is a scene for umov signature") == "umov.run also needs x; it is a scene for umov.Engine"
    assert in_python("/home/umov run/a.toml: no such file") == "/home/umov run/a.toml: no such file"
    assert told_in_python({"notes": ["a larger --floor"], "p": 1.0}) == {"notes": ["a larger floor"], "p": 1.0}


REFUSED = {
    "scenario without orbit": lambda hst: umov.run(umov.Scenario(hst.to_scenario_dict())),
    "unknown material": lambda hst: umov.Material("gld"),
    "unknown band": lambda hst: umov.Engine(hst, bands=["Bessell.Q"]),
    "unknown index": lambda hst: umov.Material.from_dict("m", {"index": "Auu", "distribution": {"model": "ggx", "alpha": 0.1}}),
    "unknown instrument": lambda hst: umov.instrument("c11"),
    "no observation": lambda hst: umov.observe(EXAMPLES / "hst_maui.toml"),
    "no library": lambda hst: umov.identify(DATA / "none.ecsv", EXAMPLES / "hst_maui.toml", DATA),
    "shape of no groups": lambda hst: umov.Engine(hst, temperatures=["wing=300"]),
    "temperature twice": lambda hst: umov.Engine(hst, temperatures=[300, 300]),
    "cuda of rays": lambda hst: umov.Engine(hst, method="rays", device="cuda"),
    "cuda of heat": lambda hst: umov.Engine(hst, temperatures=[300], device="cuda"),
    "band of a picture": lambda hst: umov.render(hst, sun=[1, 1, 1], observer=[0, 1, 1], band="nm:1"),
    "up along the sight": lambda hst: umov.render(hst, sun=[1, 1, 1], observer=[0, 0, 1], up=[0, 0, 1]),
    "colour of one band": lambda hst: umov.render(umov.Scenario(hst, set={"bands.set": "nm:550"}), sun=[1, 1, 1], observer=[0, 1, 1],
                                                  shade="colour"),
    "old elements": lambda hst: umov.passes(hst.orbit_file, "maui", "2030-01-01T00:00Z", "2030-01-02T00:00Z"),
    "old elements of states": lambda hst: umov.propagate(hst.orbit_file, "2030-01-01T00:00Z"),
    "old elements of a run": lambda hst: hst.light_curve("maui", "2030-01-01T00:00Z", "2030-01-01T01:00Z"),
    "beyond the tables": lambda hst: umov.ephemeris(hst.orbit_file, "maui", "2060-01-01T00:00Z", "2060-01-01T00:01Z", allow_old_elements=True),
    "no pass": lambda hst: umov.passes(hst.orbit_file, "maui", "2018-01-21T05:00Z", "2018-01-21T05:00:10Z"),
    "bad step": lambda hst: umov.Scenario(EXAMPLES / "hst_maui.toml", set={"time.step_s": -1}),
    "wrong key": lambda hst: umov.Scenario(EXAMPLES / "hst_maui.toml", set={"time.stp_s": 1}),
    "one alternative": lambda hst: umov.invert_plan(EXAMPLES / "hst_maui.toml", {"a": {}}),
    "no group": lambda hst: umov.invert_material(
        DATA / "none.ecsv", EXAMPLES / "hst_maui.toml", group="wing", candidates=["gold", "gold"]),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused_names_arguments(name, hst):
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        told = []
        try:
            REFUSED[name](hst)
        except umov.Error as error:
            told.append(str(error))
    told += [str(one.message) for one in warned]
    assert told, "taken without a word"
    for text in told:
        assert not re.search(r"(?<![\w/])--[a-z]|\bumov (?:run|signature|observe|passes|material list|bands list)\b", text), text
