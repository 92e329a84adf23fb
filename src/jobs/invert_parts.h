#pragma once
// Private: what each band and Stokes component says by itself.

#include <string>
#include <umov/inverse/observed_curve.h>
#include <vector>

namespace umov::jobs {

/// Some bands of a curve, with or without q and u.
struct DataPart {
  std::string bands, measured; ///< "all" or one; "I" or "I,q,u"
  ObservedCurve curve;
  [[nodiscard]] std::string name() const {
    return (bands == "all" ? "all bands" : bands) + ", " + measured;
  }
};
/// All of it first, then I alone, then each band by itself where there are several. Parts with q
/// and u stand only where some were measured, and bands only where they hold light.
std::vector<DataPart> parts_of(const ObservedCurve &curve, bool has_polarization);

} // namespace umov::jobs
