#pragma once
// A driver of graphics cards that runs their kernels on the host
// (backend/cuda/tests/fake_driver.cpp), in the place of a real one.

#include "light/tests/engine_cases.h"

#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <unistd.h>

namespace umov::cases {

/// A variable of the environment for as long as the object lives.
class Setting {
public:
  Setting(const char *name, const std::string &value) : name_(name) {
    ::setenv(name, value.c_str(), 1);
  }
  ~Setting() { ::unsetenv(name_); }
  Setting(const Setting &) = delete;
  Setting &operator=(const Setting &) = delete;

private:
  const char *name_;
};

/// Cards anew: each caller's cache folder is another one.
inline std::filesystem::path new_cache() {
  static int number = 0;
  return std::filesystem::path(testing::TempDir()) /
         ("umov_cards_" + std::to_string(::getpid()) + "_" + std::to_string(++number));
}

/// The card on paper, whatever else there is. For tools/gpu_check, UMOV_TEST_CUDA names the folders
/// of a real one's driver and compiler ("system": where the system has them).
inline DeviceOptions with_fakes(const std::filesystem::path &cache = new_cache()) {
  if (const char *real = std::getenv("UMOV_TEST_CUDA")) {
    const char *const active = std::getenv("VIRTUAL_ENV");
    const std::filesystem::path environments[] = {active == nullptr ? "" : active};
    return {DeviceChoice::Cuda, device_folders(real, environments),
            std::filesystem::path(testing::TempDir()) / "umov_kernels"};
  }
  return {DeviceChoice::Cuda, {UMOV_FAKE_CUDA}, cache};
}

inline Engine on_card(const Scene &scene, Visibility visibility) {
  Engine out = engine_of(scene, visibility);
  const auto cards = open_cards(with_fakes());
  EXPECT_TRUE(cards) << cards.error().text();
  const auto used = out.use_cards(*cards);
  EXPECT_TRUE(used) << used.error().text();
  return out;
}

/// A function of the driver on paper.
template <class Function> Function *of_driver(const char *name) {
  void *const driver =
      ::dlopen((std::string(UMOV_FAKE_CUDA) + "/libcuda.so.1").c_str(), RTLD_NOW | RTLD_LOCAL);
  EXPECT_NE(driver, nullptr);
  return reinterpret_cast<Function *>(::dlsym(driver, name));
}
/// Calls of the driver for kernels since it was started.
inline std::size_t launches() { return of_driver<std::size_t()>("umov_fake_launches")(); }

} // namespace umov::cases
