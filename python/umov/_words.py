"""The library speaks of options as the command has them; here they are said as arguments of Python."""
from __future__ import annotations

import re

#: Options whose argument has another name than theirs with underscores for hyphens.
_ARGUMENTS = {"alt": "alt_deg", "alternative": "alternatives", "phase": "phase_deg", "period": "period_s", "seeing": "seeing_arcsec",
              "std": "standards", "temperature": "temperatures", "state": "laser", "masks": "mask_file", "visibility": "method"}
#: The others. What is not here is none of ours: a name of a file may begin so.
_SAME = frozenset((
    "accept allow-bad-checksum allow-old-elements band bands calibration candidates cells change-per-s clouds colour device drift "
    "exposure-s false-alarm floor frames gap-s grid haze-sd height-m knot-s largest-floor longest-s mag method nm norad object "
    "objects observer outliers peaks reflectance-sd samples scale-sd sd-p set shade shadow shortest-s side sky-mag sky-sd slope-sd "
    "start step-s stop sun sun-alt-max-deg threads time transparency-sd up unit width-nm zero-point-sd").split())
#: "--device cpu" is device="cpu".
_WITH_WORD = re.compile(r"--(device|visibility) (cpu|cuda|auto|masks|rays)\b")
_TOLD_TWICE = re.compile(r"--allow-[a-z-]+ \(in Python (allow_[a-z_]+=True)\)")
_OPTION = re.compile(r"(?<![\w/.-])--([a-z]+(?:-[a-z]+)*)(?![\w/=-]|\.\w)")
#: A file that adapters made of what was given.
_MADE = re.compile(r"[^\s\"']*/umov-[a-z0-9_]{8}/(mesh\.obj|orbit\.tle)")
_GIVEN = {"mesh.obj": "mesh of arrays", "orbit.tle": "orbit"}


def _argument(option: str) -> str | None:
    return _ARGUMENTS.get(option) or (option.replace("-", "_") if option in _SAME else None)


def in_python(text: str) -> str:
    """A message with the names of arguments in place of options: "a larger --floor" is "a larger floor"."""
    text = _MADE.sub(lambda m: _GIVEN[m[1]], text.removeprefix("-o "))  # that option is a path here
    if "--" not in text:
        return text
    text = text.replace("--model fourier:PERIOD", "period_s")
    text = _TOLD_TWICE.sub(r"\1", text)
    text = _WITH_WORD.sub(lambda m: f'{_argument(m[1])}="{m[2]}"', text)
    return _OPTION.sub(lambda m: _argument(m[1]) or m[0], text)
