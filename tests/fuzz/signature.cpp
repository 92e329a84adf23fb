// Signatures of libraries. Everyone can make the checksums, which keep no secrets: they are put in,
// so that what is behind them is reached.

#include "fuzz/target.h"

#include <cstring>
#include <umov/io/signature_file.h>
#include <vector>

namespace {

constexpr std::size_t header_bytes = 80, checksum_at = 16, sums_checksum_at = 24, text_at = 32,
                      cells_at = 40, bands_at = 44;

/// Fowler, Noll & Vo's hash over words, as the format has it.
std::uint64_t hash_of(std::string_view words, std::uint64_t value = 0xCBF29CE484222325ull) {
  for (; words.size() >= 8; words.remove_prefix(8)) {
    std::uint64_t word = 0;
    std::memcpy(&word, words.data(), 8);
    value = (value ^ word) * 0x100000001B3ull;
    value ^= value >> 29;
  }
  return value;
}

template <class T> T at(const std::vector<std::uint64_t> &words, std::size_t byte) {
  T out{};
  std::memcpy(&out, reinterpret_cast<const char *>(words.data()) + byte, sizeof out);
  return out;
}

/// The bytes with their checksums, of a header that says where its parts lie.
void sign(std::vector<std::uint64_t> &words, std::size_t size) {
  auto *const bytes = reinterpret_cast<char *>(words.data());
  std::memset(bytes + checksum_at, 0, 16);
  const std::uint64_t nodes = (at<std::uint32_t>(words, cells_at) % 1000 + 1ull) *
                              (at<std::uint32_t>(words, cells_at) % 1000 + 1ull);
  const std::uint64_t light =
      nodes * (nodes + 1) / 2 * (at<std::uint32_t>(words, bands_at) % 1000) * 4;
  const std::uint64_t text = at<std::uint64_t>(words, text_at) % (1u << 24);
  const std::uint64_t sums =
      std::min<std::uint64_t>(size, header_bytes + text + (light + 7) / 8 * 8);
  const std::string_view all(bytes, size);
  const std::uint64_t head =
      hash_of(all.substr(header_bytes, sums - header_bytes), hash_of(all.substr(0, header_bytes)));
  const std::uint64_t rest = hash_of(all.substr(sums));
  std::memcpy(bytes + checksum_at, &head, 8);
  std::memcpy(bytes + sums_checksum_at, &rest, 8);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  std::vector<std::uint64_t> words((size + 7) / 8 + 1, 0); // what begins at a multiple of 8
  if (size > 0)
    std::memcpy(words.data(), data, size);
  const std::string_view bytes_here(reinterpret_cast<const char *>(words.data()), size);
  (void)fuzz::is_read(parse_signature(bytes_here, "input", true)); // most are refused by their sums
  if (size >= header_bytes)
    sign(words, size);
  const auto read = parse_signature(bytes_here, "input", true);
  if (!fuzz::is_read(read))
    return 0;
  const Signature &s = read->signature;
  fuzz::require(s.code.size() == signature_pairs(s.cells) * s.bands * 2, "light of all pairs");
  fuzz::require(read->text.bands.size() == s.bands, "a name for each band");
  fuzz::require(read->abundances.size() == signature_pairs(s.cells) * read->text.columns.size(),
                "abundances of all pairs");
  // Any code is light: what is looked up is a number.
  StokesTable light;
  const auto poses = signature_poses(s.cells, 0, 3, 0);
  fuzz::require(lighting_of(s, 1)(poses, light) && light.i.size() == 3 * s.bands, "light");
  for (const double i : light.i)
    fuzz::require(i >= 0, "light is not negative");
  // There and back.
  PackedLight packed{s.ln_least, s.ln_step, {s.code.begin(), s.code.end()}};
  const std::string bytes =
      signature_bytes(read->text, s.cells, packed, s.error, read->abundances).value();
  std::vector<std::uint64_t> again(bytes.size() / 8);
  std::memcpy(again.data(), bytes.data(), bytes.size());
  const auto second = fuzz::must(
      parse_signature({reinterpret_cast<const char *>(again.data()), bytes.size()}, "again", true),
      "what we write is read");
  fuzz::require(second.text.name == read->text.name, "names come back");
  return 0;
}
