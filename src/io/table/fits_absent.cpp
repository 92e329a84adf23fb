// In the place of fits_table.cpp, fits_read.cpp and fits_image.cpp where umov is built without
// CFITSIO.
#include "io/table/fits_read.h"
#include "io/table/fits_table.h"

#include <umov/io/fits_image.h>

namespace umov {
namespace {

tl::unexpected<Error> absent(const std::filesystem::path &path = {}) {
  return fail(ErrorCode::Device,
              "this build has no FITS: write .csv or .ecsv, or build with -DUMOV_WITH_FITS=ON",
              {path.string()});
}

} // namespace

FitsTable::Memory::~Memory() = default;
FitsTable::FitsTable(FitsTable &&other) noexcept = default;
FitsTable &FitsTable::operator=(FitsTable &&other) noexcept = default;
FitsTable::~FitsTable() = default;

Result<FitsTable> FitsTable::create(const std::filesystem::path &path, const Table & /*columns*/) {
  return absent(path);
}
Result<FitsTable> FitsTable::create_in_memory(const Table & /*columns*/) { return absent(); }
Result<void> FitsTable::encode(const Table & /*table*/, std::size_t /*begin*/, std::size_t /*end*/,
                               std::string & /*out*/) const {
  return absent();
}
Result<void> FitsTable::append(std::size_t /*rows*/, const std::string & /*bytes*/) {
  return absent();
}
Result<void> FitsTable::note(const std::string & /*text*/) { return absent(); }
Result<void> FitsTable::close() { return absent(); }
Result<std::string> FitsTable::take() { return absent(); }

bool is_fits(std::string_view bytes) { return bytes.starts_with("SIMPLE  ="); }
Result<TextTable> read_fits_table(std::string_view /*bytes*/, const std::string &file) {
  return fail(ErrorCode::BadInput,
              "this build reads no FITS: give .csv or .ecsv, or build with -DUMOV_WITH_FITS=ON",
              {file});
}
Result<std::string> to_fits(const Table & /*table*/) { return absent(); }
Result<void> write_fits_image(const std::filesystem::path &path, const FitsImage & /*image*/) {
  return absent(path);
}

} // namespace umov
