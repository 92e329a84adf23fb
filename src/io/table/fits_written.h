#pragma once
// Private: whether a FITS file holds what was written into it.

#include <cstdint>
#include <filesystem>
#include <fitsio.h>
#include <string>
#include <string_view>
#include <vector>

namespace umov {

/// What a closed file must hold. CFITSIO 4.2 does not look whether a seek failed, and it is while
/// seeking that the C library writes out what it had kept: on a disk that is full a file without
/// its last blocks, or with some in wrong places, was closed as one that is complete.
class FitsWritten {
public:
  /// Bytes of the data of the file's last part, in order.
  void add(std::string_view bytes);
  /// Closes the file, whether or not it is fine so far, and keeps where its parts lie.
  void close(fitsfile *file, int &status);
  /// Whether the closed file has its size, header and data.
  [[nodiscard]] bool stands_in(const std::filesystem::path &path) const;

private:
  struct Piece {
    std::size_t bytes;
    std::uint64_t hash;
  };
  std::vector<Piece> pieces_;
  std::string header_; ///< its cards
  LONGLONG begin_ = 0; ///< of the last part's header
  LONGLONG data_ = 0, end_ = 0;
};

/// What users are told of one that does not.
inline constexpr const char *fits_is_incomplete =
    "what stands in it is not what was written; is the disk full?";

} // namespace umov
