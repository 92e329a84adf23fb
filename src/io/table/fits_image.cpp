#include <umov/io/fits_image.h>

#include "io/table/fits_written.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fitsio.h>
#include <fmt/format.h>

namespace umov {
namespace {

Result<void> check(int status, const std::filesystem::path &path, int trouble) {
  if (status == 0)
    return {};
  char text[FLEN_STATUS] = {};
  fits_get_errstatus(status, text);
  fits_clear_errmsg();
  const std::string why = trouble != 0 ? std::strerror(trouble) : text;
  return fail(ErrorCode::Device,
              fmt::format("cannot be written: {} (CFITSIO {}). Choose another folder or free some "
                          "space.",
                          why, status),
              {path.string()});
}

/// Cards are printable ASCII.
std::string plain(std::string text) {
  for (char &c : text)
    c = c < 32 || c > 126 ? '?' : c;
  return text;
}

void write_card(fitsfile *file, const FitsCard &card, int &status) {
  const std::string note = plain(card.comment);
  const char *key = card.key.c_str(), *comment = note.c_str();
  if (const auto *text = std::get_if<std::string>(&card.value)) {
    fits_write_key_str(file, key, plain(*text).c_str(), comment, &status);
  } else if (const auto *number = std::get_if<double>(&card.value)) {
    constexpr int digits = -15; // as many as are needed, up to 15
    fits_write_key_dbl(file, key, *number, digits, comment, &status);
  } else if (const auto *whole = std::get_if<std::int64_t>(&card.value)) {
    fits_write_key_lng(file, key, *whole, comment, &status);
  } else {
    fits_write_key_log(file, key, std::get<bool>(card.value) ? 1 : 0, comment, &status);
  }
}

/// Whether the pixels of a file are those of the image.
bool holds(const std::filesystem::path &path, const FitsImage &image) {
  int status = 0, none = 0;
  fitsfile *file = nullptr;
  fits_open_diskfile(&file, path.c_str(), READONLY, &status);
  LONGLONG first = 1;
  bool is_same = status == 0;
  std::vector<std::int32_t> found;
  for (const auto plane : image.planes) {
    const auto count = static_cast<LONGLONG>(plane.size());
    found.resize(plane.size());
    fits_read_img(file, TINT, first, count, nullptr, found.data(), &none, &status);
    is_same = is_same && status == 0 && std::ranges::equal(found, plane);
    first += count;
  }
  int closed = 0;
  if (file != nullptr)
    fits_close_file(file, &closed);
  fits_clear_errmsg();
  return is_same;
}

} // namespace

Result<void> write_fits_image(const std::filesystem::path &path, const FitsImage &image) {
  int status = 0;
  fitsfile *file = nullptr;
  errno = 0;
  fits_create_diskfile(&file, path.c_str(), &status); // no extended file-name syntax
  if (status != 0)
    return check(status, path, errno);
  long sizes[3] = {image.columns, image.rows, static_cast<long>(image.planes.size())};
  fits_create_img(file, image.is_16_bit ? USHORT_IMG : LONG_IMG, image.planes.size() > 1 ? 3 : 2,
                  sizes, &status);
  for (const FitsCard &card : image.cards)
    write_card(file, card, status);
  LONGLONG first = 1;
  for (const auto plane : image.planes) {
    const auto count = static_cast<LONGLONG>(plane.size());
    // CFITSIO does not change the numbers, though its interface is not const.
    fits_write_img(file, TINT, first, count, const_cast<std::int32_t *>(plane.data()), &status);
    first += count;
  }
  FitsWritten written;
  written.close(file, status);
  UMOV_TRY(check(status, path, 0));
  if (!written.stands_in(path) || !holds(path, image))
    return fail(ErrorCode::Device,
                fmt::format("cannot be written: {} Choose another folder or free some space.",
                            fits_is_incomplete),
                {path.string()});
  return {};
}

} // namespace umov
