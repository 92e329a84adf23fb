#include "backend/cuda/driver.h"

#include <array>

namespace umov::backend {

std::string cuda_version_text(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

namespace {

std::string bind_all(const SharedLibrary &library, CudaDriver &to) {
  std::string lacking;
  const auto bind = [&](const char *name, auto &function) {
    library.bind(name, function, lacking);
  };
  bind("cuInit", to.init);
  bind("cuDriverGetVersion", to.driver_version);
  bind("cuGetErrorName", to.error_name);
  bind("cuGetErrorString", to.error_text);
  bind("cuDeviceGetCount", to.device_count);
  bind("cuDeviceGet", to.device_at);
  bind("cuDeviceGetName", to.device_name);
  bind("cuDeviceGetAttribute", to.device_attribute);
  bind("cuDeviceTotalMem_v2", to.device_memory);
  bind("cuDevicePrimaryCtxRetain", to.retain_context);
  bind("cuDevicePrimaryCtxRelease_v2", to.release_context);
  bind("cuCtxSetCurrent", to.use_context);
  bind("cuCtxGetCurrent", to.current_context);
  bind("cuModuleLoadData", to.load_module);
  bind("cuModuleUnload", to.unload_module);
  bind("cuModuleGetFunction", to.function_of);
  bind("cuMemGetInfo_v2", to.memory_info);
  bind("cuMemAlloc_v2", to.allocate);
  bind("cuMemFree_v2", to.release);
  bind("cuMemAllocHost_v2", to.allocate_host);
  bind("cuMemFreeHost", to.release_host);
  bind("cuMemcpyHtoD_v2", to.copy_in);
  bind("cuMemcpyHtoDAsync_v2", to.copy_in_later);
  bind("cuMemcpyDtoHAsync_v2", to.copy_out_later);
  bind("cuStreamCreate", to.make_stream);
  bind("cuStreamDestroy_v2", to.release_stream);
  bind("cuStreamSynchronize", to.wait_for);
  bind("cuLaunchKernel", to.launch);
  return lacking;
}

} // namespace

Result<CudaDriver> CudaDriver::load(std::span<const std::filesystem::path> folders) {
  static const std::array<std::string, 1> names{"libcuda.so.1"};
  auto library = SharedLibrary::open("libcuda.so", names, folders);
  if (!library)
    return fail(ErrorCode::Device, "no NVIDIA driver: " + library.error().message +
                                       ". Install the driver of the card, or take --device cpu");
  CudaDriver out;
  const std::string lacking = bind_all(*library, out);
  if (!lacking.empty())
    return fail(ErrorCode::Device, library->name() + " is too old: it lacks " + lacking +
                                       ". Install a newer NVIDIA driver");
  out.file = library->name();
  UMOV_TRY(out.check(out.init(0), "starting the driver"));
  UMOV_TRY(out.check(out.driver_version(&out.version), "asking the driver for its version"));
  return out;
}

Result<void> CudaDriver::check(CudaCode code, const std::string &what) const {
  if (code == cuda_success)
    return {};
  const char *name = nullptr, *text = nullptr;
  error_name(code, &name);
  error_text(code, &text);
  return fail(ErrorCode::Device, what + ": " + (name == nullptr ? "unknown failure" : name) + " (" +
                                     std::to_string(code) +
                                     (text == nullptr ? "" : std::string(", ") + text) + ")");
}

} // namespace umov::backend
