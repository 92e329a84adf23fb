// SGP4 for other number types than those of the orbit module's tests: float and duals.

#include "kernel/sgp4.inl.h"
#include "kernel/tests/dual.h"
#include "orbit/sgp4_model.h"
#include "orbit/tests/fixed_columns.h"

#include <array>
#include <cstring>
#include <gtest/gtest.h>

namespace umov {
namespace {

using test::Dual;

template <class R> kernel::Sgp4Numbers<R> converted(const sgp4::Numbers &from) {
  std::array<double, kernel::sgp4_number_count> flat;
  std::memcpy(flat.data(), &from, sizeof flat);
  std::array<R, kernel::sgp4_number_count> to;
  for (std::size_t k = 0; k < to.size(); ++k)
    to[k] = R(flat[k]);
  kernel::Sgp4Numbers<R> out;
  static_assert(sizeof out == sizeof to);
  std::memcpy(static_cast<void *>(&out), to.data(), sizeof out);
  return out;
}

template <class R>
kernel::Sgp4State<R> state(const sgp4::Constants &c, const kernel::Sgp4Numbers<R> &numbers,
                           double minutes, R t) {
  const sgp4::Node node = sgp4::resonance_node(c, minutes);
  return kernel::sgp4_state(
      c.kind, numbers, kernel::ResonanceNode<R>{R(node.minutes), R(node.angle), R(node.motion)}, t);
}

TEST(KernelContract, Sgp4InFloatAndDuals) {
  int deep = 0, resonant = 0;
  for (const ElementSet &set :
       test::load_by_columns(UMOV_SOURCE_DIR "/tests/data/sgp4/SGP4-VER.TLE")) {
    const sgp4::Constants c = sgp4::initialise(set);
    const auto single = converted<float>(c.numbers);
    const auto dual = converted<Dual>(c.numbers);
    for (const double minutes : {0.25, 90.5}) {
      const auto wanted = state(c, c.numbers, minutes, minutes);
      if (wanted.code != 0)
        continue;
      deep += c.kind.is_deep ? 1 : 0;
      resonant += c.kind.resonance != kernel::Resonance::None ? 1 : 0;
      const auto rough = state(c, single, minutes, static_cast<float>(minutes));
      // Angles of some radians in float, at up to 42,000 km and steepest near perigee.
      EXPECT_NEAR(static_cast<double>(rough.x), wanted.x, 1) << set.norad_cat_id;
      EXPECT_NEAR(static_cast<double>(rough.z), wanted.z, 1) << set.norad_cat_id;
      const auto exact = state(c, dual, minutes, Dual(minutes, 1));
      EXPECT_NEAR(exact.y.value, wanted.y, 1e-9) << set.norad_cat_id;
      const double h = 1e-3; // [min]
      const double slope = (state(c, c.numbers, minutes, minutes + h).y -
                            state(c, c.numbers, minutes, minutes - h).y) /
                           (2 * h);
      EXPECT_NEAR(exact.y.slope, slope, 1e-4) << set.norad_cat_id; // [km/min]
    }
  }
  EXPECT_GT(deep, 20);
  EXPECT_GT(resonant, 5);
}

} // namespace
} // namespace umov
