#include "light/fast/mask_cache.h"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

namespace umov {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t bytes_max = std::uintmax_t{1} << 30;
constexpr const char *suffix = ".masks";

fs::path name_of(const fs::path &folder, std::uint64_t key) {
  return folder / (fmt::format("{:016x}", key) + suffix);
}

struct CachedFile {
  fs::path path;
  std::uintmax_t bytes;
  fs::file_time_type time;
};

/// Removes the oldest files. Others may do the same at the same time: a file that is gone already
/// is as good as removed.
void trim(const fs::path &folder) {
  std::vector<CachedFile> files;
  std::uintmax_t bytes = 0;
  std::error_code code;
  for (const auto &entry : fs::directory_iterator(folder, code)) {
    std::error_code gone;
    if (entry.path().extension() != suffix || !entry.is_regular_file(gone))
      continue;
    const CachedFile file{entry.path(), entry.file_size(gone), entry.last_write_time(gone)};
    if (gone)
      continue;
    files.push_back(file);
    bytes += file.bytes;
  }
  std::sort(files.begin(), files.end(),
            [](const CachedFile &a, const CachedFile &b) { return a.time < b.time; });
  for (std::size_t k = 0; k < files.size() && bytes > bytes_max; ++k) {
    fs::remove(files[k].path, code);
    bytes -= files[k].bytes;
  }
}

} // namespace

std::optional<MaskStore> read_cached_masks(const fs::path &folder, std::uint64_t key,
                                           const GroupPlan &plan, const MaskSize &size) {
  if (folder.empty())
    return {};
  const fs::path path = name_of(folder, key);
  auto found = read_masks(path, key, plan, size);
  if (!found)
    return {};
  std::error_code code;
  fs::last_write_time(path, fs::file_time_type::clock::now(), code); // asked for just now
  return std::move(*found);
}

void cache_masks(const fs::path &folder, std::uint64_t key, const GroupPlan &plan,
                 const MaskSize &size, const MaskStore &masks) {
  if (folder.empty() || memory_of(masks) > bytes_max / 2)
    return;
  std::error_code code;
  fs::create_directories(folder, code);
  const fs::path path = name_of(folder, key);
  auto whole = read_masks(path, key, plan, size); // what others have kept meanwhile
  if (whole)
    add_rows(masks, *whole);
  if (write_masks(path, whole ? *whole : masks, key))
    trim(folder);
}

} // namespace umov
