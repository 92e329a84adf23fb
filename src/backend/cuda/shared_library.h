#pragma once
// A library that is looked for when the program runs: it may be on this machine or not.

#include <filesystem>
#include <span>
#include <string>
#include <umov/core/result.h>
#include <vector>

namespace umov::backend {

/// Stays loaded for as long as the program runs: drivers do not bear being closed.
class SharedLibrary {
public:
  /// The first of `folders` that holds a file whose name begins with `stem`, the newest version
  /// first; else the first of `names` that the system finds. Device if there is none.
  static Result<SharedLibrary> open(const std::string &stem, std::span<const std::string> names,
                                    std::span<const std::filesystem::path> folders);
  /// All of them that load, each once, in that order; `said`: what is told of the rest.
  static std::vector<SharedLibrary> all(const std::string &stem, std::span<const std::string> names,
                                        std::span<const std::filesystem::path> folders,
                                        std::string &said);
  /// Null if it has none of that name.
  [[nodiscard]] void *symbol(const char *name) const;
  /// Sets `function` to what `name` is, or says in `lacking` that it is not there.
  template <class Function>
  void bind(const char *name, Function &function, std::string &lacking) const {
    function = reinterpret_cast<Function>(symbol(name));
    if (function == nullptr)
      lacking += (lacking.empty() ? "" : ", ") + std::string(name);
  }
  /// File it came from, as far as known.
  [[nodiscard]] const std::string &name() const { return name_; }

private:
  SharedLibrary(void *handle, std::string name) : handle_(handle), name_(std::move(name)) {}
  void *handle_;
  std::string name_;
};

} // namespace umov::backend
