#include "lightcurve/row_bytes.h"

#include <cstring>
#include <type_traits>

namespace umov {
namespace {

/// The three columns of a second light.
template <class Light, class Each> void for_columns(Light &light, const Each &each) {
  each(light.intensity);
  each(light.half_width);
  each(light.irradiance);
}

template <class Column> constexpr std::size_t cell_bytes(const Column &) {
  static_assert(std::is_trivially_copyable_v<typename Column::value_type>);
  return sizeof(typename Column::value_type);
}

} // namespace

std::string row_bytes(const StokesTable &table, std::size_t begin, std::size_t count,
                      const LightCurve &curve) {
  const std::size_t first = begin * curve.bands.size(), cells = count * curve.bands.size();
  std::string out;
  for (const SecondLight &light : curve.second_lights)
    for_columns(light, [&](const auto &column) {
      out.append(reinterpret_cast<const char *>(column.data() + first), cells * cell_bytes(column));
    });
  return out + to_bytes(table);
}

bool take_row_bytes(std::string_view bytes, std::size_t begin, std::size_t count,
                    StokesTable &table, LightCurve &curve) {
  const std::size_t first = begin * curve.bands.size(), cells = count * curve.bands.size();
  bool is_long_enough = true;
  for (SecondLight &light : curve.second_lights)
    for_columns(light, [&](auto &column) {
      const std::size_t size = cells * cell_bytes(column);
      is_long_enough = is_long_enough && bytes.size() >= size;
      if (!is_long_enough || size == 0)
        return;
      std::memcpy(column.data() + first, bytes.data(), size);
      bytes.remove_prefix(size);
    });
  return is_long_enough && from_bytes(bytes, table) && table.poses() == count &&
         table.bands == curve.bands.size() && table.glint_share.size() == count &&
         table.material_i.size() == cells * curve.materials.size();
}

} // namespace umov
