#pragma once
#include <string>
#include <umov/core/result.h>
#include <umov/frames/site.h>
#include <vector>

namespace umov {

/// Names of the compiled-in sites (data/sites).
std::vector<std::string> site_names();

/// A site by name (case and blanks do not matter), or "lat,lon,alt_m" in degrees and metres;
/// without alt_m at 0 m on the ellipsoid. Usage error that says which names there are, with the
/// nearest one.
Result<Site> site_from(const std::string &text);

} // namespace umov
