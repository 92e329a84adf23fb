#pragma once
#include <umov/lightcurve/light_curve.h>

namespace umov::test {

/// A made-up light curve for looking at the page: two passes eleven hours apart, three bands, two
/// materials, a dark stretch and an umbra stretch in the first
/// pass, a glint, a position angle that goes round. Not physics: smooth functions of the row.
LightCurve synthetic_curve(std::size_t rows_per_pass = 240);

} // namespace umov::test
