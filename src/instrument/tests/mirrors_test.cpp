#include "instrument/tests/anchor.h"

#include <gtest/gtest.h>
#include <umov/instrument/mirrors.h>
#include <umov/instrument/polarimeter.h>

namespace umov {
namespace {

/// Aluminium of data/nk (Rakic 1995), linear between its points, at the wavelengths of the anchors.
std::complex<double> aluminium(double nm) {
  std::ifstream file(UMOV_SOURCE_DIR "/data/nk/Al_Rakic.yml");
  double before[3]{}, now[3]{};
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    double row[3];
    if (!(words >> row[0] >> row[1] >> row[2]))
      continue;
    std::copy(now, now + 3, before);
    std::copy(row, row + 3, now);
    if (now[0] * 1000 >= nm)
      break;
  }
  const double t = (nm / 1000 - before[0]) / (now[0] - before[0]);
  return {before[1] + t * (now[1] - before[1]), before[2] + t * (now[2] - before[2])};
}

const double at_45 = std::sqrt(0.5);

TEST(Mirror, PolarizesAndTurnsLinearIntoCircular) { // nine digits
  for (const int nm : {425, 550, 650}) {
    const auto m = mirror_element(aluminium(nm), at_45).m;
    EXPECT_NEAR(m[1][0] / m[0][0], of("aluminium_q_" + std::to_string(nm)), 1e-9);
    EXPECT_NEAR(m[3][2] / m[0][0], of("aluminium_u_to_v_" + std::to_string(nm)), 1e-9);
  }
}

TEST(Mirror, WholeInstrumentAsFieldsGiveIt) { // nine digits
  const auto train = mirror_element(aluminium(550), at_45) * axes_turned(Angle::degrees(25));
  for (const auto &[name, angle] : {std::pair{"chain_o_", 0.}, {"chain_x_", 90.}}) {
    const auto row = first_row(behind(polarizer(300, Angle::degrees(angle)),
                                      retarder(Angle::degrees(183), Angle::degrees(23)) * train));
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(row[k], of(name + std::to_string(k)), 1e-9);
  }
}

TEST(Mirror, TwoCrossedOnesCancel) {
  const auto flat = mirror_element(aluminium(550), at_45);
  const auto both = turned(flat, Angle::degrees(90)) * flat;
  EXPECT_NEAR(both.m[1][0] / both.m[0][0], 0, 1e-15);
  EXPECT_NEAR(both.m[3][2] / both.m[0][0], 0, 1e-15);
}

/// Light of a star at an altitude in the south, through a Cassegrain-like primary and secondary and
/// the flat mirror on the altitude axis, its axes carried along.
TEST(TracedBeam, NasmythIsTheClosedRule) {
  const double altitude = 55.844337 * pi / 180;
  const std::complex<double> eta = aluminium(550);
  const Vec3<Enu> to_star{0, -std::cos(altitude), std::sin(altitude)};
  const Vec3<Enu> zenith_side = normalized(Vec3<Enu>{0, 0, 1} - to_star * to_star.z);
  for (const auto &[side, out] : {std::pair{NasmythSide::Right, Vec3<Enu>{-1, 0, 0}},
                                  {NasmythSide::Left, Vec3<Enu>{1, 0, 0}}}) {
    TracedBeam beam(zenith_side, -to_star);
    beam.reflect(to_star, eta); // primary and secondary: normal incidence
    beam.reflect(to_star, eta);
    const double twice = std::pow(mirror_element(eta, 1).m[0][0], 2);
    beam.reflect(normalized(beam.direction() - out), eta);
    EXPECT_NEAR(norm(beam.direction() - out), 0, 1e-15);
    beam.turn_to({0, 0, 1});
    const auto closed = nasmyth_port(mirror_element(eta, at_45), side, Angle::radians(altitude));
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t c = 0; c < 4; ++c) // V keeps its sign: two turns of the field
        EXPECT_NEAR(beam.matrix().m[r][c] / twice, closed.m[r][c], 1e-12) << r << c;
    // The image of the zenith direction stands at +-altitude from the vertical.
    const Vec3<Enu> image = beam.image_of_x();
    EXPECT_NEAR(std::acos(image.z), altitude, 1e-12);
  }
}

TEST(TracedBeam, EveryMirrorTurnsCircularLightOver) {
  // The field goes on turning as it did while the light comes back.
  TracedBeam beam({1, 0, 0}, {0, 0, -1});
  beam.reflect({0, 0, 1}, aluminium(550));
  EXPECT_LT(beam.matrix().m[3][3], 0);
  beam.reflect({0, 0, 1}, aluminium(550));
  EXPECT_GT(beam.matrix().m[3][3], 0);
}

} // namespace
} // namespace umov
