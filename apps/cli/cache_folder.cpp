#include "cache_folder.h"

#include <cstdlib>

namespace umov::cli {

std::filesystem::path cache_folder() {
  // XDG Base Directory Specification 0.8: relative paths are to be ignored.
  if (const char *base = std::getenv("XDG_CACHE_HOME"); base != nullptr && base[0] == '/')
    return std::filesystem::path(base) / "umov";
  if (const char *home = std::getenv("HOME"); home != nullptr && home[0] == '/')
    return std::filesystem::path(home) / ".cache" / "umov";
  return {};
}

} // namespace umov::cli
