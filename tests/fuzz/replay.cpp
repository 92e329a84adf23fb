// Runs a fuzz target over files and the files of folders: what a corpus found once stays found,
// with any compiler and without libFuzzer.

#include "fuzz/target.h"

#include <algorithm>
#include <filesystem>
#include <umov/core/files.h>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(int count, char **names) {
  std::vector<fs::path> out;
  for (int k = 1; k < count; ++k) {
    if (!fs::is_directory(names[k])) {
      out.emplace_back(names[k]);
      continue;
    }
    for (const auto &entry : fs::directory_iterator(names[k]))
      if (entry.is_regular_file())
        out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

} // namespace

int main(int count, char **names) {
  const auto files = files_of(count, names);
  for (const fs::path &file : files) {
    const auto bytes = umov::read_file(file);
    if (!bytes) {
      std::fprintf(stderr, "%s\n", bytes.error().text().c_str());
      return 3;
    }
    std::fprintf(stderr, "%s\n", file.c_str()); // the last one named is the one that broke
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t *>(bytes->data()), bytes->size());
  }
  std::printf("%zu files replayed\n", files.size());
  return files.empty() ? 3 : 0;
}
