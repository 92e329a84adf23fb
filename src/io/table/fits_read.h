#pragma once
// Private: a table of a FITS file, read through CFITSIO.

#include "io/table/text_table.h"

namespace umov {

/// The bytes begin as a FITS file does (standard 4.0, section 4.4.1.1).
bool is_fits(std::string_view bytes);
/// Its first table, binary or ASCII, as cells of text: numbers to all digits, what has no value
/// empty; COMMENT and HISTORY cards of "key: value" and cards of a keyword of its own as notes, of
/// the primary header too. Rows count from 1 where files of text count lines. BadInput for a file
/// that is damaged or without a table, columns of vectors or complex numbers, and in a build
/// without CFITSIO.
Result<TextTable> read_fits_table(std::string_view bytes, const std::string &file);

} // namespace umov
