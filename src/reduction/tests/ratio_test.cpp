#include <gtest/gtest.h>
#include <umov/instrument/polarimeter.h>
#include <umov/reduction/ratio.h>

namespace umov {
namespace {

/// Beams of light (1, .2, -.1, .05) behind a plate.
BeamPair beams(double plate_deg, double gain_o, double gain_x, double air,
               double retardance_deg = 180) {
  Polarimeter p;
  p.type = PolarimeterType::HwpDualBeam;
  p.retardance_deg = {{}, {retardance_deg}};
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
