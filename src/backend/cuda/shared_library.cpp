#include "backend/cuda/shared_library.h"

#include <algorithm>
#include <dlfcn.h>

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

/// Where it may be: files of the folders, then what the system finds by itself.
std::vector<std::string> places_of(const std::string &stem, std::span<const std::string> names,
                                   std::span<const fs::path> folders) {
  std::vector<std::string> out;
  for (const fs::path &folder : folders)
    for (const fs::path &file : files_of(folder, stem))
      out.push_back(file.string());
  out.insert(out.end(), names.begin(), names.end());
  return out;
}

/// Null if it does not load: then `said` has why.
void *load(const std::string &place, std::string &said) {
  if (void *handle = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL))
    return handle;
  // What is there and does not load says more than what is not there.
  const char *why = ::dlerror();
  if (said.empty() || place.find('/') != std::string::npos)
    said = why == nullptr ? place : why;
  return nullptr;
}

} // namespace

Result<SharedLibrary> SharedLibrary::open(const std::string &stem,
                                          std::span<const std::string> names,
                                          std::span<const fs::path> folders) {
  std::string said;
  for (const std::string &place : places_of(stem, names, folders))
    if (void *handle = load(place, said))
      return SharedLibrary(handle, place);
  return fail(ErrorCode::Device, stem + " was not found (" + said + ")");
}

std::vector<SharedLibrary> SharedLibrary::all(const std::string &stem,
                                              std::span<const std::string> names,
                                              std::span<const fs::path> folders,
                                              std::string &said) {
  std::vector<SharedLibrary> out;
  for (const std::string &place : places_of(stem, names, folders)) {
    void *handle = load(place, said);
    // Other names of one file are the same to the loader.
    if (handle != nullptr && std::none_of(out.begin(), out.end(), [&](const SharedLibrary &one) {
          return one.handle_ == handle;
        }))
      out.push_back(SharedLibrary(handle, place));
  }
  return out;
}

void *SharedLibrary::symbol(const char *name) const { return ::dlsym(handle_, name); }

} // namespace umov::backend
