#pragma once
// The driver of the cards, as much of it as we call. Its own header is not needed to build umov:
// these are its documented entry points (CUDA Driver API 12, the names that libcuda.so exports).

#include "backend/cuda/shared_library.h"

#include <cstdint>

namespace umov::backend {

using CudaCode = int;
using CudaDevice = int;
using CudaPointer = unsigned long long;
using CudaHandle = void *; ///< context, module, function, stream

/// What calls return that we tell apart.
inline constexpr CudaCode cuda_success = 0, cuda_out_of_memory = 2;

/// Functions of libcuda.so.1.
struct CudaDriver {
  CudaCode (*init)(unsigned flags) = nullptr;
  CudaCode (*driver_version)(int *version) = nullptr;
  CudaCode (*error_name)(CudaCode code, const char **name) = nullptr;
  CudaCode (*error_text)(CudaCode code, const char **text) = nullptr;
  CudaCode (*device_count)(int *count) = nullptr;
  CudaCode (*device_at)(CudaDevice *device, int index) = nullptr;
  CudaCode (*device_name)(char *name, int size, CudaDevice device) = nullptr;
  CudaCode (*device_attribute)(int *value, int attribute, CudaDevice device) = nullptr;
  CudaCode (*device_memory)(std::size_t *bytes, CudaDevice device) = nullptr;
  CudaCode (*retain_context)(CudaHandle *context, CudaDevice device) = nullptr;
  CudaCode (*release_context)(CudaDevice device) = nullptr;
  CudaCode (*use_context)(CudaHandle context) = nullptr;
  CudaCode (*current_context)(CudaHandle *context) = nullptr;
  CudaCode (*load_module)(CudaHandle *module, const void *image) = nullptr;
  CudaCode (*unload_module)(CudaHandle module) = nullptr;
  CudaCode (*function_of)(CudaHandle *function, CudaHandle module, const char *name) = nullptr;
  CudaCode (*memory_info)(std::size_t *free, std::size_t *total) = nullptr;
  CudaCode (*allocate)(CudaPointer *pointer, std::size_t bytes) = nullptr;
  CudaCode (*release)(CudaPointer pointer) = nullptr;
  CudaCode (*allocate_host)(void **pointer, std::size_t bytes) = nullptr;
  CudaCode (*release_host)(void *pointer) = nullptr;
  CudaCode (*copy_in)(CudaPointer to, const void *from, std::size_t bytes) = nullptr;
  CudaCode (*copy_in_later)(CudaPointer to, const void *from, std::size_t bytes,
                            CudaHandle stream) = nullptr;
  CudaCode (*copy_out_later)(void *to, CudaPointer from, std::size_t bytes,
                             CudaHandle stream) = nullptr;
  CudaCode (*make_stream)(CudaHandle *stream, unsigned flags) = nullptr;
  CudaCode (*release_stream)(CudaHandle stream) = nullptr;
  CudaCode (*wait_for)(CudaHandle stream) = nullptr;
  CudaCode (*launch)(CudaHandle function, unsigned grid_x, unsigned grid_y, unsigned grid_z,
                     unsigned block_x, unsigned block_y, unsigned block_z, unsigned shared_bytes,
                     CudaHandle stream, void **parameters, void **extra) = nullptr;

  /// Device if there is none here, or one that lacks what we call.
  static Result<CudaDriver> load(std::span<const std::filesystem::path> folders);
  /// Device with what was tried and what the driver calls the failure.
  [[nodiscard]] Result<void> check(CudaCode code, const std::string &what) const;
  std::string file; ///< where it came from
  int version = 0;  ///< of CUDA: 1000 major + 10 minor
};

/// "13.2" of 13020.
std::string cuda_version_text(int version);

} // namespace umov::backend
