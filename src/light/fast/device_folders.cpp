#include <algorithm>
#include <umov/light/device.h>

namespace umov {
namespace {

namespace fs = std::filesystem;

/// Folders of a folder, in the order of their names: a file system has none.
std::vector<fs::path> folders_of(const fs::path &folder) {
  std::vector<fs::path> out;
  std::error_code code;
  for (const auto &entry : fs::directory_iterator(folder, code))
    if (std::error_code none; fs::is_directory(entry.path(), none))
      out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

} // namespace

std::vector<fs::path> device_folders(const std::string &named,
                                     std::span<const fs::path> environments) {
  std::vector<fs::path> out;
  const auto add = [&](fs::path folder) {
    if (std::find(out.begin(), out.end(), folder) == out.end())
      out.push_back(std::move(folder));
  };
  for (std::size_t begin = 0; begin <= named.size();) {
    const std::size_t end = std::min(named.find(':', begin), named.size());
    if (end > begin)
      add(named.substr(begin, end - begin));
    begin = end + 1;
  }
  for (const fs::path &environment : environments) {
    if (environment.empty())
      continue;
    for (const fs::path &python : folders_of(environment / "lib"))
      if (python.filename().string().starts_with("python"))
        for (const fs::path &part : folders_of(python / "site-packages" / "nvidia"))
          if (std::error_code none; fs::is_directory(part / "lib", none))
            add(part / "lib");
  }
  return out;
}

} // namespace umov
