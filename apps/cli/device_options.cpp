#include "device_options.h"

#include "cache_folder.h"

#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace umov::cli {
namespace {

namespace fs = std::filesystem;

/// nvidia/*/lib of the packages of an environment, as NVIDIA's wheels have it.
void add_packages_of(const fs::path &environment, std::vector<fs::path> &out) {
  std::error_code code;
  for (const auto &python : fs::directory_iterator(environment / "lib", code)) {
    if (!python.path().filename().string().starts_with("python"))
      continue;
    std::error_code none;
    for (const auto &part :
         fs::directory_iterator(python.path() / "site-packages" / "nvidia", none))
      if (fs::is_directory(part.path() / "lib", none))
        out.push_back(part.path() / "lib");
  }
}

const std::vector<std::string> &device_names() {
  static const std::vector<std::string> names{
      name_of(DeviceChoice::Cpu), name_of(DeviceChoice::Cuda), name_of(DeviceChoice::Auto)};
  return names;
}

} // namespace

void add_device(CLI::App &verb, Common &common) {
  verb.add_option("--device", common.device,
                  "Who adds up the light of the facets: cpu; cuda, NVIDIA cards; auto, cards if "
                  "they are there")
      ->check(CLI::IsMember(device_names()))
      ->capture_default_str();
}

DeviceOptions device_options(const Common &common) {
  DeviceOptions out;
  out.choice = common.device == name_of(DeviceChoice::Cuda)   ? DeviceChoice::Cuda
               : common.device == name_of(DeviceChoice::Auto) ? DeviceChoice::Auto
                                                              : DeviceChoice::Cpu;
  if (out.choice == DeviceChoice::Cpu)
    return out;
  out.folders = cuda_folders();
  if (!common.no_cache)
    out.cache = cache_folder();
  return out;
}

std::vector<fs::path> cuda_folders() {
  std::vector<fs::path> out;
  if (const char *named = std::getenv("UMOV_CUDA_PATH"); named != nullptr) {
    const std::string list = named;
    for (std::size_t begin = 0; begin <= list.size();) {
      const std::size_t end = std::min(list.find(':', begin), list.size());
      if (end > begin)
        out.emplace_back(list.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  if (const char *active = std::getenv("VIRTUAL_ENV"); active != nullptr && *active != '\0')
    add_packages_of(active, out);
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (!code)
    add_packages_of(program.parent_path().parent_path(), out);
  return out;
}

} // namespace umov::cli
