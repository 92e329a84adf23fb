#include "io/table/fits_written.h"

#include <algorithm>
#include <cstring>
#include <fstream>

namespace umov {
namespace {

/// Fowler, Noll & Vo's hash over words of eight bytes and what is left: tells damage, keeps no
/// secrets.
std::uint64_t hash_of(std::string_view bytes) {
  std::uint64_t value = 0xCBF29CE484222325ull;
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t size = std::min<std::size_t>(bytes.size(), 8);
    std::memcpy(&word, bytes.data(), size);
    bytes.remove_prefix(size);
    value = (value ^ word) * 0x100000001B3ull;
    value ^= value >> 29; // what is high would never reach down
  }
  return value;
}

} // namespace

void FitsWritten::add(std::string_view bytes) { pieces_.push_back({bytes.size(), hash_of(bytes)}); }

void FitsWritten::close(fitsfile *file, int &status) {
  char *cards = nullptr;
  int count = 0;
  fits_flush_file(file, &status);
  fits_get_hduaddrll(file, &begin_, &data_, &end_, &status);
  fits_hdr2str(file, 0, nullptr, 0, &cards, &count, &status);
  if (status == 0)
    header_ = cards;
  int freed = 0;
  if (cards != nullptr)
    fits_free_memory(cards, &freed);
  fits_close_file(file, &status);
}

bool FitsWritten::stands_in(const std::filesystem::path &path) const {
  std::error_code failed;
  if (std::filesystem::file_size(path, failed) != static_cast<std::uintmax_t>(end_) || failed)
    return false;
  std::ifstream file(path, std::ios::binary);
  std::string found(header_.size(), '\0');
  file.seekg(begin_);
  if (!file.read(found.data(), static_cast<std::streamsize>(found.size())) || found != header_)
    return false;
  file.seekg(data_);
  for (const Piece &piece : pieces_) {
    found.resize(piece.bytes);
    if (!file.read(found.data(), static_cast<std::streamsize>(found.size())) ||
        hash_of(found) != piece.hash)
      return false;
  }
  return true;
}

} // namespace umov
