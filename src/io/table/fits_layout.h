#pragma once
// Private: where the parts of a FITS file lie.

#include <string>
#include <string_view>
#include <umov/core/result.h>

namespace umov {

/// A copy of a file up to the end of its first table (all of it where there is none), whose headers
/// are such as FITS 4.0 has them (sections 3 and 4): with an end, the mandatory keywords as numbers
/// in printable ASCII, their data whole; BadInput for any other. What follows the table is not
/// looked at. Other cards have blanks and '?' for bytes that are no printable ASCII, and the last
/// block is filled up with zeros, which some writers leave out. CFITSIO 4.2 takes all this on
/// trust: it reads an incomplete last block to its end, and makes room for as many columns as
/// happen to stand on the stack where a keyword is no number.
Result<std::string> fits_up_to_table(std::string_view bytes, const std::string &file);

} // namespace umov
