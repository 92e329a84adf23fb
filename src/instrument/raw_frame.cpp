#include <umov/instrument/raw_frame.h>

#include "instrument/pixel_table.h"

namespace umov {

RawFrame draw_frame(const Detector &detector, const PixelFrame &light,
                    const LatticeValues &background, double exposure_s, const DrawKey &key) {
  std::array<std::optional<PixelTable>, 4> tables;
  for (std::size_t k = 0; k < 4; ++k)
    tables[k] = k > 0 && background[k] == background[0] ? tables[0]
                                                        : PixelTable::make(detector, background[k]);
  RawFrame out{light.columns, light.rows, {}, {}};
  out.adu.resize(light.value.size());
  constexpr std::uint32_t of_row = 1u << 31, of_frame = 1u << 21; // apart from sums and from pixels
  DrawKey own = key;
  own.channel ^= of_frame;
  for (int row = 0; row < light.rows; ++row) {
    own.pixel = of_row | static_cast<std::uint32_t>(row);
    Draws words(own);
    for (int column = 0; column < light.columns; ++column) {
      const std::size_t at = light.index(column, row), place = lattice_place(column, row);
      if (light.value[at] == 0 && tables[place]) {
        out.adu[at] = tables[place]->draw(words());
        continue;
      }
      DrawKey of_pixel = own;
      of_pixel.pixel = static_cast<std::uint32_t>(at);
      Draws draws(of_pixel);
      const PixelReading reading =
          read_pixel(detector, light.value[at] + background[place], exposure_s, draws);
      out.adu[at] = reading.adu;
      if (reading.is_saturated)
        out.saturated.push_back(static_cast<std::uint32_t>(at));
    }
  }
  return out;
}

} // namespace umov
