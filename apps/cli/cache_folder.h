#pragma once
#include <filesystem>

namespace umov::cli {

/// Where umov keeps what can be made anew: $XDG_CACHE_HOME/umov, else ~/.cache/umov; empty if there
/// is neither.
std::filesystem::path cache_folder();

} // namespace umov::cli
