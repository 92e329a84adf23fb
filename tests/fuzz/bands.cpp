// Names of bands, one a line: wavelengths, curves that are compiled in, groups of them, files.

#include "fuzz/target.h"

#include <algorithm>
#include <filesystem>
#include <umov/core/text.h>
#include <umov/io/passband_file.h>

namespace {

using namespace umov;

/// Curves of one name in several folders, and one alone: of the sources, for a folder made here
/// would stay, since libFuzzer ends without destructors.
const std::filesystem::path &curves() {
  static const std::filesystem::path folder = [] {
    for (const char *name : {"one/my.dat", "two/my.dat", "one/deep/my.dat", "own.dat"})
      (void)fuzz::must(read_bands({{std::string("file:") + name, {}}}, UMOV_FUZZ_CURVES),
                       std::string(name) + " can be read");
    return std::filesystem::path(UMOV_FUZZ_CURVES);
  }();
  return folder;
}

/// Files outside the folder may be odd ones, of which a read may not come back.
bool stays_inside(const std::string &name) {
  const std::filesystem::path path(name.substr(std::min<std::size_t>(5, name.size())));
  return !name.starts_with("file:") ||
         (!path.is_absolute() && std::ranges::find(path, "..") == path.end());
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  constexpr std::size_t most = 64; // two bands of the same name are looked for among all pairs
  std::vector<BandEntry> entries;
  std::string_view text = fuzz::text_of(data, size);
  while (!text.empty() && entries.size() < most) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (std::string name(text.substr(0, end)); stays_inside(name))
      entries.push_back({std::move(name), {}});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  std::vector<BandFile> files;
  const auto bands = read_bands(entries, curves(), &files);
  if (!fuzz::is_read(bands))
    return 0;
  fuzz::require(bands->size() >= entries.size(), "each name is a band or more");
  std::vector<std::string> names;
  for (const Band &band : *bands) {
    fuzz::require(std::ranges::find(names, band.name) == names.end(), "no two of the same name");
    fuzz::require(!band.curve || band.curve->name == band.name, "a curve has its band's name");
    names.push_back(band.name);
  }
  if (files.empty()) // names of files have lost their folders
    fuzz::require(fuzz::must(bands_named(names), "the names of bands name them").size() ==
                      bands->size(),
                  "and as many");
  return 0;
}
