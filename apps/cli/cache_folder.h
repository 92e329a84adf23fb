#pragma once
#include <cstdint>
#include <filesystem>

namespace umov::cli {

/// Where umov keeps what can be made anew: $XDG_CACHE_HOME/umov, else ~/.cache/umov; empty if there
/// is neither.
std::filesystem::path cache_folder();

/// It is there and can be written, or could be made.
bool can_be_kept(std::filesystem::path folder);

/// What lies in a folder and below it; nothing where there is none.
struct FolderFacts {
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
};
FolderFacts cache_facts(const std::filesystem::path &folder);

} // namespace umov::cli
