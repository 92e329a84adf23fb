#include "cache_folder.h"

#include <cstdlib>
#include <unistd.h>

namespace umov::cli {

std::filesystem::path cache_folder() {
  // XDG Base Directory Specification 0.8: relative paths are to be ignored.
  if (const char *base = std::getenv("XDG_CACHE_HOME"); base != nullptr && base[0] == '/')
    return std::filesystem::path(base) / "umov";
  if (const char *home = std::getenv("HOME"); home != nullptr && home[0] == '/')
    return std::filesystem::path(home) / ".cache" / "umov";
  return {};
}

bool can_be_kept(std::filesystem::path folder) {
  std::error_code unknown;
  while (!std::filesystem::exists(folder, unknown) && folder.has_relative_path())
    folder = folder.parent_path();
  return std::filesystem::is_directory(folder, unknown) &&
         ::access(folder.c_str(), W_OK | X_OK) == 0;
}

FolderFacts cache_facts(const std::filesystem::path &folder) {
  namespace fs = std::filesystem;
  FolderFacts out;
  std::error_code code;
  const auto options = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator at(folder, options, code), end; !code && at != end;
       at.increment(code)) {
    std::error_code gone; // another run may clear the folder meanwhile
    if (!at->is_regular_file(gone))
      continue;
    if (const std::uintmax_t bytes = at->file_size(gone); !gone) {
      ++out.files;
      out.bytes += bytes;
    }
  }
  return out;
}

} // namespace umov::cli
