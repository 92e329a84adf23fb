// Light of rows that a job kept, behind the journal's hashes, which everyone can make.

#include "fuzz/target.h"
#include "lightcurve/row_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string_view bytes = fuzz::text_of(data, size);
  StokesTable table;
  if (from_bytes(bytes, table)) {
    fuzz::require(table.i.size() == table.poses() * table.bands &&
                      table.v_err.size() == table.i.size(),
                  "light of all poses in all bands");
    for (std::size_t pose = 0; pose < table.poses(); ++pose)
      fuzz::require(name_of(table.method[pose])[0] != '\0', "a method has a name");
    fuzz::require(to_bytes(table) == bytes, "what is read is what was written");
  }
  constexpr std::size_t rows = 2;
  LightCurve curve;
  curve.bands = {{"a", Wavelength::nm(500)}, {"b", Wavelength::nm(600)}};
  curve.materials = {"one"};
  curve.second_lights.resize(1);
  for (auto *column : {&curve.second_lights[0].intensity, &curve.second_lights[0].half_width})
    column->resize(rows * curve.bands.size());
  curve.second_lights[0].irradiance.resize(rows * curve.bands.size());
  if (take_row_bytes(bytes, 0, rows, table, curve))
    fuzz::require(row_bytes(table, 0, rows, curve) == bytes, "rows come back as they were");
  return 0;
}
