#pragma once
// Pictures of numbers as FITS files.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <umov/core/result.h>
#include <variant>
#include <vector>

namespace umov {

/// A line of the header.
struct FitsCard {
  std::string key;
  std::variant<std::string, double, std::int64_t, bool> value;
  std::string comment;
};

/// One picture, or several of one size as planes.
struct FitsImage {
  int columns = 0, rows = 0;
  std::vector<std::span<const std::int32_t>> planes; ///< first row first
  bool is_16_bit = true; ///< 0 to 65535, as unsigned numbers of 16 bits; else signed ones of 32
  std::vector<FitsCard> cards;
};

/// Writes a file that does not exist yet. Device with the reason if it cannot be written, or
/// in a build without FITS.
Result<void> write_fits_image(const std::filesystem::path &path, const FitsImage &image);

} // namespace umov
