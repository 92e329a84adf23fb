#include "backend/cuda/shared_library.h"

#include <algorithm>
#include <dlfcn.h>
#include <vector>

namespace umov::backend {
namespace {

namespace fs = std::filesystem;

/// Files of a folder that begin with `stem`, the longest and highest names first: libx.so.13 before
/// libx.so.12 before libx.so.
std::vector<fs::path> files_of(const fs::path &folder, const std::string &stem) {
  std::vector<fs::path> out;
  std::error_code code;
  for (const auto &entry : fs::directory_iterator(folder, code))
    if (entry.path().filename().string().starts_with(stem))
      out.push_back(entry.path());
  std::sort(out.begin(), out.end(), [](const fs::path &a, const fs::path &b) {
    const std::string x = a.filename().string(), y = b.filename().string();
    return x.size() != y.size() ? x.size() > y.size() : x > y;
  });
  return out;
}

} // namespace

Result<SharedLibrary> SharedLibrary::open(const std::string &stem,
                                          std::span<const std::string> names,
                                          std::span<const fs::path> folders) {
  std::vector<std::string> places;
  for (const fs::path &folder : folders)
    for (const fs::path &file : files_of(folder, stem))
      places.push_back(file.string());
  places.insert(places.end(), names.begin(), names.end());
  std::string said;
  for (const std::string &place : places) {
    if (void *handle = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL))
      return SharedLibrary(handle, place);
    // What is there and does not load says more than what is not there.
    const char *why = ::dlerror();
    if (said.empty() || place.find('/') != std::string::npos)
      said = why == nullptr ? place : why;
  }
  return fail(ErrorCode::Device, stem + " was not found (" + said + ")");
}

void *SharedLibrary::symbol(const char *name) const { return ::dlsym(handle_, name); }

} // namespace umov::backend
