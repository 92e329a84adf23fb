"""Draws from a posterior in the form that arviz and corner read."""
import math

import numpy as np
import pytest
import umov
from umov.tables import Table, _unpack


def table(**columns):
    return Table(_unpack([(name, "", "", np.array(values, float), ("", 0, 0)) for name, values in columns.items()], []))


def answer(samples, modes):
    return umov.Inversion("ambiguous", {"samples": samples, "modes": modes}, {}, "", "")


def test_turns_are_counted_from_a_mode_in_body_axes():
    # Half angles of 5 and -10 deg about X and Y: turns of 10 and -20 deg; and -q is the same attitude as q.
    c, s, d, t = math.cos(math.radians(5)), math.sin(math.radians(5)), math.cos(math.radians(10)), math.sin(math.radians(10))
    samples = table(weight=[0.5, 0.25, 0.25], qw=[c, d, -c], qx=[s, 0, -s], qy=[0, -t, 0], qz=[0, 0, 0], rate_x=[1, 2, 3])
    draws = answer(samples, table(qw=[1, c], qx=[0, s], qy=[0, 0], qz=[0, 0])).posterior(8)
    assert list(draws) == ["turn_x", "turn_y", "turn_z", "rate_x"]
    assert all(values.shape == (1, 8) for values in draws.values())
    np.testing.assert_allclose(draws["turn_x"][0], [10, 10, 10, 10, 0, 0, 10, 10], atol=1e-12)
    np.testing.assert_allclose(draws["turn_y"][0], [0, 0, 0, 0, -20, -20, 0, 0], atol=1e-12)
    np.testing.assert_array_equal(draws["rate_x"][0], [1, 1, 1, 1, 2, 2, 3, 3])
    second = answer(samples, table(qw=[1, c], qx=[0, s], qy=[0, 0], qz=[0, 0])).posterior(4, mode=2)
    np.testing.assert_allclose(second["turn_x"][0][[0, 1, 3]], 0, atol=1e-12)


def test_what_has_no_samples_or_mode_is_refused():
    with pytest.raises(umov.UsageError, match="has no samples"):
        umov.Inversion("determined", {}, {}, "", "").posterior()
    one = table(weight=[1], qw=[1], qx=[0], qy=[0], qz=[0])
    with pytest.raises(umov.UsageError):
        answer(one, one).posterior(10, mode=2)
    with pytest.raises(umov.UsageError):
        answer(one, one).posterior(0)
