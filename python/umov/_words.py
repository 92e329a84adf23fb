"""The library speaks of options and verbs as the command has them; here they are said as arguments and functions of Python."""
from __future__ import annotations

import re
from typing import Any

#: Options whose argument has another name than theirs with underscores for hyphens.
_ARGUMENTS = {"alt": "alt_deg", "alternative": "alternatives", "phase": "phase_deg", "period": "period_s", "seeing": "seeing_arcsec",
              "std": "standards", "tilt-sd": "tilt_sd_deg", "temperature": "temperatures", "state": "laser", "masks": "mask_file", "visibility": "method"}
#: The others. What is not here is none of ours: a name of a file may begin so.
_SAME = frozenset((
    "accept allow-bad-checksum allow-old-elements aperture-fwhm band bands by-group calibration candidates cells change-per-s clouds "
    "colour device drift exposure-s false-alarm floor frames gap-s grid haze-sd height-m knot-s largest-floor longest-s mag mag-max method modes nm "
    "norad object objects observer outliers peaks rate-noise rate-sd reflectance-sd samples scale-sd sd-p set shade shadow shortest-s side sky-mag sky-sd "
    "slope-sd sort start step-s stop sun sun-alt-max-deg threads time transparency-sd transparency-time-s up unit width-nm zero-point-sd").split())
#: What several words of the command are together, and what is said of it alone.
_TOGETHER = (("--visibility masks of signature and invert", 'method="masks" of umov.Engine and umov.Fit'),
             ("--model fourier:PERIOD", "period_s"), ("--source laser", "laser"), ("--source thermal", "temperatures"), (" or --eop", ""))
#: "--device cpu" is device="cpu".
_WITH_WORD = re.compile(r"--(device|visibility|sort) (cpu|cuda|auto|masks|rays|mag)\b")
_TOLD_TWICE = re.compile(r"--allow-[a-z-]+ \(in Python (allow_[a-z_]+=True)\)")
_OPTION = re.compile(r"(?<![\w/.-])--([a-z]+(?:-[a-z]+)*)(?![\w/=-]|\.\w)")
#: Verbs by what does the same here. A verb of a table such as "material list" stands before one that its name begins with.
_VERBS = {"bands list": "bands()", "calibrate": "calibrate", "exposure": "exposure", "identify": "identify",
          "instrument list": "instruments()", "invert health": "invert_health", "invert material": "invert_material", "invert plan": "invert_plan",
          "invert pose": "invert_pose", "invert spin": "invert_spin", "invert track": "invert_track", "library build": "build_library",
          "material list": "materials()",
          "observe": "observe", "orbit ephemeris": "ephemeris", "orbit propagate": "propagate", "passes": "passes", "period": "period",
          "reduce": "reduce", "render": "render", "run": "run", "signature": "Engine"}
#: What only the command tells, which comes with the package.
_OF_A_SHELL = ("doctor", "material index", "mesh check")
_VERB = re.compile(rf"(?<![\w./-])umov ({'|'.join([*_VERBS, *_OF_A_SHELL])})\b(?! -)")
#: A file that adapters made of what was given.
_MADE = re.compile(r"[^\s\"']*/umov-[a-z0-9_]{8}/(mesh\.obj|orbit\.tle|orbit\.json|modes\.ecsv|alternatives\.ecsv|state\.json|(?:light|baseline)(?:_\d+)?\.ecsv)")
_GIVEN = {"mesh.obj": "mesh of arrays", "orbit.tle": "orbit", "orbit.json": "orbit", "modes.ecsv": "start", "alternatives.ecsv": "modes", "state.json": "start"}


def _curve(file: str) -> str:
    """light.ecsv is the argument `light`, light_2.ecsv its third."""
    name, _, number = file.removesuffix(".ecsv").partition("_")
    return f"{name}[{number}]" if number else name


def _argument(option: str) -> str | None:
    return _ARGUMENTS.get(option) or (option.replace("-", "_") if option in _SAME else None)


def _function(verb: re.Match[str]) -> str:
    name = _VERBS.get(verb[1])
    return f"umov.{name}" if name else f"\"{verb[0]}\" in a shell"


def in_python(text: str) -> str:
    """A message with the names of arguments and functions in place of options and verbs: "a larger --floor" is "a larger floor",
    "Known: umov material list" is "Known: umov.materials()"."""
    text = text.removeprefix("-o ")  # that option is a path here
    if "/umov-" in text:  # the pattern takes the square of the length of a word
        text = _MADE.sub(lambda m: _GIVEN.get(m[1]) or _curve(m[1]), text)
    text = _VERB.sub(_function, text)
    if "--" not in text:
        return text
    for ours, theirs in _TOGETHER:
        text = text.replace(ours, theirs)
    text = _TOLD_TWICE.sub(r"\1", text)
    text = _WITH_WORD.sub(lambda m: f'{_argument(m[1])}="{m[2]}"', text)
    return _OPTION.sub(lambda m: _argument(m[1]) or m[0], text)


def told_in_python(value: Any) -> Any:
    """The same for every text of what JSON has told."""
    if isinstance(value, dict):
        return {key: told_in_python(one) for key, one in value.items()}
    if isinstance(value, list):
        return [told_in_python(one) for one in value]
    return in_python(value) if isinstance(value, str) else value
