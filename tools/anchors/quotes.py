"""Numbers of the tables that stand as literals in what `umov paper` compares with, and their check.

The program cannot read tests/data when it runs, so that these sources carry the numbers themselves."""

import re

# File, table, columns, and which rows (a condition on the cells) it quotes.
QUOTES = (
    ("src/paper/figures/materials.cpp", "table1", ("f0", "f_mean"), lambda row: True),
    ("src/paper/figures/lobes.cpp", "masking", ("p",), lambda row: row["theta_deg"] in ("60", "75")),
    ("src/paper/figures/single_material.cpp", "q_140", ("q",), lambda row: True),
    ("src/paper/figures/single_material.cpp", "singles", ("value",),
     lambda row: row["name"] in ("gold_aluminium_chord", "gold_aluminium_bow")),
    ("src/paper/claims/shape.cpp", "silicon_cube", ("cube_median",), lambda row: True),
    ("src/paper/claims/clouds.cpp", "departures", ("ratio",), lambda row: True),
    ("src/paper/claims/clouds.cpp", "planes", ("blue", "green", "red"),
     lambda row: row["phase_deg"] != "all"),
    ("src/paper/claims/clouds.cpp", "planes", ("thickness",), lambda row: row["phase_deg"] == "all"),
)


def numbers_in(text):
    """Every number that a C++ source spells, without a zero before the point."""
    return {word.lstrip("-").removeprefix("0") for word in re.findall(r"-?\d*\.\d+|-?\d+", text)}


def missing_quotes(root, texts):
    for path, table, columns, wanted in QUOTES:
        source = (root / path).read_text()
        spelled = numbers_in(source)
        lines = [line.split(",") for line in texts[table].splitlines()[1:]]
        for cells in lines[1:]:
            row = dict(zip(lines[0], cells))
            for column in columns if wanted(row) else ():
                number = row[column].lstrip("-").removeprefix("0")
                if number not in spelled and number != "1.000000":
                    yield f"{path}: {row[column]} of tests/data/anchors/{table}.csv does not stand there"
        if f"anchors/{table}" not in source:
            yield f"{path}: does not name tests/data/anchors/{table}.csv"
