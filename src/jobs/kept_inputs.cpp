#include "jobs/kept_inputs.h"

#include <algorithm>
#include <filesystem>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/scenario.h>

namespace umov::jobs {
namespace {

namespace fs = std::filesystem;

fs::path absolute_path(const std::string &path) {
  std::error_code code;
  const auto full = fs::absolute(path, code);
  return tidy_path(code ? fs::path(path) : full);
}

/// The folder that all files are under: their places among each other stay (a mesh names its MTL).
fs::path common_folder(const std::vector<fs::path> &files) {
  fs::path out = files.front().parent_path();
  const auto is_under = [&](const fs::path &file) {
    return std::mismatch(out.begin(), out.end(), file.begin(), file.end()).first == out.end();
  };
  while (!std::ranges::all_of(files, is_under) && out.has_relative_path())
    out = out.parent_path();
  return out;
}

void replace_all(std::string &text, const std::string &from, const std::string &to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
}

} // namespace

Result<void> keep_inputs(const std::vector<std::pair<std::string, std::string>> &inputs,
                         RunFolder &folder, std::string &lock, std::vector<std::string> &files) {
  std::vector<fs::path> full;
  full.reserve(inputs.size());
  for (const auto &[path, hash] : inputs)
    full.push_back(absolute_path(path));
  if (full.empty())
    return {};
  const fs::path top = common_folder(full);
  for (std::size_t k = 0; k < full.size(); ++k) {
    UMOV_ASSIGN(bytes, read_file(full[k]));
    if (sha256_hex(bytes) != inputs[k].second)
      return fail(ErrorCode::Device,
                  "was changed while the run went on: no copy of it can be kept. Run again.",
                  {full[k].string()});
    const std::string name = "inputs/" + full[k].lexically_relative(top).generic_string();
    replace_all(lock, toml_text(full[k].string()), toml_text(name));
    folder.add(name, std::move(bytes));
    files.push_back(name);
  }
  return {};
}

} // namespace umov::jobs
