#pragma once
// Private: how warm the groups of a mesh are.

#include <string>
#include <umov/core/result.h>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov::jobs {

/// [K] of each mesh group, from "300" for all and "panels=340" for one. Usage for what cannot be
/// read or is said twice, and for a group that is not told.
Result<std::vector<double>> temperatures_of(const std::vector<std::string> &told_of,
                                            const Mesh &mesh);

} // namespace umov::jobs
