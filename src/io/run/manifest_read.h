#pragma once
// Private: what the manifest of an earlier run says of its folder.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace umov {

struct OldManifest {
  std::string status;             ///< "complete" where it does not say
  std::string started_utc;        ///< "" where it does not say
  std::vector<std::string> files; ///< names besides those that every run writes
};

/// Empty for a text that umov did not write.
std::optional<OldManifest> read_manifest(std::string_view text);

} // namespace umov
