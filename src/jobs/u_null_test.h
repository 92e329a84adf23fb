#pragma once
// Private: whether U of the scattering plane is what a fit has, as every inversion asks it.

#include <string>
#include <umov/inverse/null_test.h>
#include <umov/inverse/unmix.h>
#include <vector>

namespace umov::jobs {

/// The null test of a curve less U/I of a fit (without light: none): bodies of paint have some
/// without any instrument.
NullTest null_test_of(const ObservedCurve &curve, const EndMember &fitted);

/// A note where the test is flagged. `whose`: of which observations, with a colon, if not those
/// asked about.
void note_null_test(const NullTest &u, std::vector<std::string> &notes,
                    const std::string &whose = {});

} // namespace umov::jobs
