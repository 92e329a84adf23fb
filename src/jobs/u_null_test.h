#pragma once
// Private: whether U of the scattering plane is what a fit has, as every inversion asks it.

#include <optional>
#include <span>
#include <string>
#include <umov/inverse/null_test.h>

namespace umov::jobs {

/// The null test of a curve less U/I of a fit, whose light stands at [epoch * bands + band] (empty:
/// none): bodies of paint have some without any instrument.
NullTest null_test_of(const ObservedCurve &curve, std::span<const double> fitted_i,
                      std::span<const double> fitted_u);

/// The note of an answer, where the test is flagged.
std::optional<std::string> words_of(const NullTest &u);

} // namespace umov::jobs
