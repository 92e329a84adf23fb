#pragma once
// Who computes: --device, and where drivers are looked for.

#include "console.h"

#include <umov/light/device.h>

namespace umov::cli {

/// --device, for verbs whose light may come from a card.
void add_device(CLI::App &verb, Common &common);
/// What it asks for. Cards' kernels are kept beside the masks.
DeviceOptions device_options(const Common &common);
/// Folders with a driver or its compiler that the system does not look into: those of
/// UMOV_CUDA_PATH, then what pip has installed beside umov or in the active environment.
std::vector<std::filesystem::path> cuda_folders();

} // namespace umov::cli
