#include "core/tests/anchors.h"

#include <gtest/gtest.h>
#include <limits>
#include <umov/instrument/polarimeter.h>
#include <umov/reduction/ratio.h>

namespace umov {
namespace {

/// Beams of light (1, .2, -.1, .05) behind a plate.
BeamPair beams(double plate_deg, double gain_o, double gain_x, double air,
               double retardance_deg = 180,
               double extinction = std::numeric_limits<double>::infinity()) {
  Polarimeter p;
  p.type = PolarimeterType::HwpDualBeam;
  p.retardance_deg = {{}, {retardance_deg}};
  p.extinction = {{}, {extinction}};
  const auto c = polarimeter_channels(p, {0, plate_deg, 0}, 550);
  const Stokes<InstrumentAxes> light{1, .2, -.1, .05};
  return {respond(c->at(0).row, light) * gain_o * air, respond(c->at(1).row, light) * gain_x * air};
}

TEST(Ratio, IsExactUnderGainsAndTransparency) {
  for (const double gain : {.5, .95, 1.7})
    for (const double air : {.1, .8, 3.}) {
      EXPECT_NEAR(ratio_method(beams(0, gain, 1, 1), beams(45, gain, 1, air)), .2, 1e-12);
      EXPECT_NEAR(ratio_method(beams(22.5, gain, 1, 1), beams(67.5, gain, 1, air)), -.1, 1e-12);
    }
}

TEST(Ratio, DoubleDifferenceLosesTheGainsSquare) {
  const double g = .05, q = .2; // gains .95 and 1.05: q (1 - g^2)/(1 - g^2 q^2)
  EXPECT_NEAR(double_difference(beams(0, .95, 1.05, 1), beams(45, .95, 1.05, .8)),
              q * (1 - g * g) / (1 - g * g * q * q), 1e-12);
}

/// Unequal beams under changing air, a plate of 185 deg, prisms of E = 300: both ways, from fields.
TEST(Ratio, BothMethodsUnderEveryImperfection) { // nine digits
  const Anchors table("observing_instrument");
  const auto of = [&](const std::string &name) { return table.row({name.c_str()})["value"]; };
  struct Case {
    const char *name;
    double gain_o, gain_x, retardance, extinction;
    std::array<double, 4> air;
  };
  constexpr double perfect = std::numeric_limits<double>::infinity();
  for (const Case &one : {Case{"gains", .95, 1.05, 180, perfect, {1, .8, .9, 1.1}},
                          {"retardance", 1, 1, 185, perfect, {1, 1, 1, 1}},
                          {"extinction", 1, 1, 180, 300, {1, 1, 1, 1}}}) {
    std::array<BeamPair, 4> n;
    const double plates[] = {0, 45, 22.5, 67.5};
    for (std::size_t k = 0; k < 4; ++k)
      n[k] = beams(plates[k], one.gain_o, one.gain_x, one.air[k], one.retardance, one.extinction);
    const std::string name = one.name;
    EXPECT_NEAR(ratio_method(n[0], n[1]), of(name + "_ratio_q"), 1e-9) << name;
    EXPECT_NEAR(ratio_method(n[2], n[3]), of(name + "_ratio_u"), 1e-9) << name;
    EXPECT_NEAR(double_difference(n[0], n[1]), of(name + "_difference_q"), 1e-9) << name;
    EXPECT_NEAR(double_difference(n[2], n[3]), of(name + "_difference_u"), 1e-9) << name;
  }
}

TEST(Ratio, EightPositionsHaveANull) {
  std::array<BeamPair, 8> b;
  for (std::size_t k = 0; k < 8; ++k)
    b[k] = beams(22.5 * static_cast<double>(k), .95, 1.05, 1 + .1 * static_cast<double>(k), 185);
  const EightPositions found = eight_positions(b);
  EXPECT_NEAR(found.q, .1996195, 2e-6); // q (1 + cos e)/2; the ratio's second order
  EXPECT_NEAR(found.null_q, .05 * std::sin(5 * 3.14159265 / 180) / 2, 2e-5); // V leaks into both
}

} // namespace
} // namespace umov
