#pragma once
// Which machine adds up the light of the facets: the processor, or graphics cards.
// docs/theory/device.md

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// Who computes.
enum class DeviceChoice : std::uint8_t {
  Cpu,  ///< the processor
  Cuda, ///< NVIDIA cards, or it ends with what lacks
  Auto  ///< cards if they are there and take the scene, else the processor
};

/// What is asked of a machine with cards.
struct DeviceOptions {
  DeviceChoice choice = DeviceChoice::Cpu;
  /// Folders that are looked into for the driver (libcuda.so.1) and its run-time compiler
  /// (libnvrtc.so) before the places where the system has them.
  std::vector<std::filesystem::path> folders = {};
  /// Folder for kernels that were compiled before; empty: none are kept.
  std::filesystem::path cache = {};
};

/// Folders with a driver or its compiler that the system does not look into: those of `named`, with
/// colons between them (UMOV_CUDA_PATH), then what pip has installed in `environments`
/// (lib/python*/site-packages/nvidia/*/lib of each), each folder once. Empty: none.
std::vector<std::filesystem::path>
device_folders(const std::string &named, std::span<const std::filesystem::path> environments);

/// Cards with the kernels in them. Engines share them.
class Cards;

/// Finds the cards and makes the kernels for them: a quarter of a minute where the cache has none.
/// The same cards again for whoever asks for the same. Device with what lacks and how to get it.
Result<std::shared_ptr<const Cards>> open_cards(const DeviceOptions &options);

/// What is there, in a line, without compiling anything; the error says what lacks.
Result<std::string> describe_cards(const std::vector<std::filesystem::path> &folders);

/// "NVIDIA ..." or "2 x NVIDIA ...".
std::string name_of(const Cards &cards);
/// What bytes depend on of cards, and not on how many share the poses: "NVIDIA ..., compute 9.0,
/// compiler 13.0", and the driver where it is that which translates the kernels.
std::string identity_of(const Cards &cards);
/// "cpu", "cuda" or "auto".
const char *name_of(DeviceChoice choice);

} // namespace umov
