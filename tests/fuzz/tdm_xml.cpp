// Tracking data messages as XML.

#include "fuzz/ccsds.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string_view text = fuzz::text_of(data, size);
  if (text.substr(0, 200).find('<') != std::string_view::npos)
    fuzz::message_of(text, ccsds::Kind::Tdm);
  return 0;
}
