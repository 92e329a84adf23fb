#include "io/report/base64.h"

#include <openssl/evp.h>

namespace umov {

std::string base64(std::string_view bytes) {
  // A block at a time: OpenSSL counts in int. Blocks of whole triples need no padding inside.
  constexpr std::size_t block = 3U << 20;
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4 + 1);
  for (std::size_t at = 0; at < bytes.size(); at += block) {
    const std::string_view part = bytes.substr(at, block);
    std::string text((part.size() + 2) / 3 * 4 + 1, '\0'); // with the zero that OpenSSL ends with
    const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char *>(text.data()),
                                       reinterpret_cast<const unsigned char *>(part.data()),
                                       static_cast<int>(part.size()));
    out.append(text, 0, static_cast<std::size_t>(length));
  }
  return out;
}

} // namespace umov
