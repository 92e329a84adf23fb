#include "signature_files.h"

#include <filesystem>
#include <fmt/format.h>

namespace umov::cli {

Result<void> check_mask_file(const std::string &file) {
  namespace fs = std::filesystem;
  const fs::path target(file);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code code;
  if (!file.empty() && fs::is_directory(target, code))
    return fail(ErrorCode::Device, "this is a folder; the name of a file was expected", {file});
  if (!file.empty() && !fs::is_directory(folder, code))
    return fail(ErrorCode::Device, "no such folder. Make the folder first or choose another one.",
                {folder.string()});
  return {};
}

Result<void> tell_size(const std::string &path, std::size_t rows, const Common &common) {
  // Of a row, measured: 27 numbers of eight bytes and the names; in CSV they take more digits.
  const double bytes = static_cast<double>(rows) * (path.ends_with(".fits") ? 316 : 430);
  if (path.empty() || path == "-" || bytes < 1e8)
    return {};
  namespace fs = std::filesystem;
  std::error_code code;
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : ".";
  const auto room = fs::space(folder, code);
  const std::string size =
      fmt::format("{} rows: {} will have about {:.2g} GB", rows, path, bytes / 1e9);
  if (!code && bytes > static_cast<double>(room.available))
    return fail(ErrorCode::Device,
                fmt::format("{}, and {:.2g} GB are free. Ask for fewer poses or bands, or write to "
                            "another disk.",
                            size, static_cast<double>(room.available) / 1e9),
                {folder.string()});
  note(common, size);
  return {};
}

} // namespace umov::cli
