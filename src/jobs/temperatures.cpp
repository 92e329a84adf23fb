#include "jobs/temperatures.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <set>

namespace umov::jobs {

/// [K] of each mesh group, from "300" for all and "panels=340" for one.
Result<std::vector<double>> temperatures_of(const std::vector<std::string> &told_of,
                                            const Mesh &mesh) {
  std::vector<double> out(mesh.groups.size(), std::numeric_limits<double>::quiet_NaN());
  std::set<std::string> told;
  for (const std::string &text : told_of) {
    const std::size_t equals = text.rfind('=');
    const std::string group = equals == std::string::npos ? "" : text.substr(0, equals);
    const std::string number = equals == std::string::npos ? text : text.substr(equals + 1);
    double kelvin = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), kelvin);
    if (error != std::errc() || end != number.data() + number.size() || !(kelvin >= 0) ||
        !std::isfinite(kelvin) || equals == 0)
      return fail(ErrorCode::Usage,
                  fmt::format("--temperature {}: K of all, or GROUP=K, was expected", text));
    const auto found = std::find(mesh.groups.begin(), mesh.groups.end(), group);
    if (!group.empty() && found == mesh.groups.end())
      return fail(ErrorCode::Usage, fmt::format("--temperature {}: the mesh has the groups {}",
                                                text, fmt::join(mesh.groups, ", ")));
    if (!told.insert(group).second)
      return fail(ErrorCode::Usage,
                  fmt::format("--temperature {}: that was said before; once was expected", text));
    for (std::size_t g = 0; g < out.size(); ++g)
      if (group.empty() ? std::isnan(out[g]) : mesh.groups[g] == group)
        out[g] = kelvin;
  }
  for (std::size_t g = 0; g < out.size(); ++g)
    if (std::isnan(out[g]))
      return fail(ErrorCode::Usage,
                  fmt::format("--source thermal: how warm is \"{}\"? Give --temperature K for all "
                              "groups, or {}=K",
                              mesh.groups[g], mesh.groups[g]));
  return out;
}

} // namespace umov::jobs
