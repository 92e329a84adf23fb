#include "device_options.h"

#include "cache_folder.h"

#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace umov::cli {
namespace {

namespace fs = std::filesystem;

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
  const auto set = [](const char *name) {
    const char *value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code); // empty where there is none
  const fs::path environments[] = {set("VIRTUAL_ENV"), program.parent_path().parent_path()};
  return device_folders(set("UMOV_CUDA_PATH"), environments);
}

} // namespace umov::cli
