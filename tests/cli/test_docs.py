"""The conventions are normative: every line of a table names a test, and the test exists."""
import re

from conftest import ROOT


def test_every_convention_names_a_test_that_exists():
    sources = "\n".join(path.read_text(encoding="utf-8") for folder in ("src", "tests/cli")
                        for path in (ROOT / folder).rglob("*test*") if path.suffix in (".cpp", ".py"))
    lines = [line for line in (ROOT / "docs/conventions.md").read_text().splitlines()
             if line.startswith("|") and not line.startswith(("| what", "|---"))]
    assert len(lines) > 30
    for line in lines:
        names = re.findall(r"`(\w+\.\w+|test_\w+)`", line.rsplit("|", 2)[1])
        assert names, f"no test named: {line}"
        for name in names:
            if name.startswith("test_"):
                assert f"def {name}(" in sources, name
            else:
                suite, case = name.split(".")
                assert re.search(rf"TEST(_F|_P)?\(\s*{suite},\s*{case}\)", sources), name
