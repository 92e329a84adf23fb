// The manifest that makes a folder ours.

#include "fuzz/target.h"

#include "io/run/manifest_read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  umov::read_manifest(umov::fuzz::text_of(data, size));
  return 0;
}
