"""Reduced light in the forms in which others take it."""
from __future__ import annotations

import datetime
from typing import Any

from . import _umov
from ._jobs import Watch
from .errors import UsageError
from .observing import AnyCounts, _text_of
from .tables import Table
from .times import AnyTime, utc

__all__ = ["score", "tdm"]


def _text(stokes: Table, counts: AnyCounts, form: str, ecsv: str = "", created: AnyTime | None = None) -> str:
    if not isinstance(stokes, Table):
        raise UsageError(f"stokes is a {type(stokes).__name__}; the Table that umov.reduce gave was expected")
    when: Any = datetime.datetime.now(datetime.timezone.utc) if created is None else created
    text, path = _text_of(counts, "counts")
    return _umov.measurements(stokes._table, text, path, form, str(ecsv), utc(when)[:19], Watch(None))


def tdm(stokes: Table, counts: AnyCounts, *, ecsv: str = "", created: AnyTime | None = None) -> str:
    """Magnitudes and directions as a CCSDS Tracking Data Message: the text that `umov reduce --tdm` writes.

    Parameters
    ----------
    stokes
        What `umov.reduce` gave.
    counts
        What it was given: its header tells of site and instrument.
    ecsv
        Name of the file that has the Stokes parameters, for which a message has no words.
    created
        Time that the message says it was made at; None: now.

    Notes
    -----
    `InputError` where no row has a magnitude. Source: CCSDS 503.0-B-2.

    Examples
    --------
    >>> seen = umov.observe(EXAMPLES / "observe_hst.toml", set={"observation.cadence_s": 20})
    >>> umov.tdm(umov.reduce(seen), seen).splitlines()[0]
    'CCSDS_TDM_VERS = 2.0'
    """
    return _text(stokes, counts, "tdm", ecsv, created)


def score(stokes: Table, counts: AnyCounts) -> str:
    """Magnitudes as a table for SCORE, the repository of the IAU's centre for a dark sky: the text that
    `umov reduce --score` writes.

    Parameters
    ----------
    stokes
        What `umov.reduce` gave.
    counts
        What it was given: its header tells of site and instrument.

    Notes
    -----
    Columns that only the observer knows are empty. `InputError` where the counts do not tell the site.

    Examples
    --------
    >>> seen = umov.observe(EXAMPLES / "observe_hst.toml", set={"observation.cadence_s": 20})
    >>> umov.score(umov.reduce(seen), seen).split(",")[0]
    'satellite_name'
    """
    return _text(stokes, counts, "score")
