#pragma once
// Private: where the parts of a FITS file lie.

#include <cstddef>
#include <string>
#include <string_view>
#include <umov/core/result.h>

namespace umov {

/// Bytes of the parts of a file whose headers are such as FITS 4.0 has them (sections 3 and 4): of
/// printable ASCII, with an end and the mandatory keywords as numbers, their data within whole
/// blocks of the file; BadInput for any other. CFITSIO 4.2 takes these on trust: it reads an
/// incomplete last block to its end, and makes room for as many columns as happen to stand on the
/// stack where a keyword is no number.
Result<std::size_t> fits_size(std::string_view bytes, const std::string &file);

} // namespace umov
