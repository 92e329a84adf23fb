#include "surface/tests/surface_cases.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <umov/core/random.h>
#include <umov/surface/measured.h>

namespace umov {
namespace {

/// A model sampled in the plane of incidence, as a goniometer would.
std::vector<BrdfSample> sampled_in_plane(const Surface &surface) {
  std::vector<BrdfSample> out;
  for (double i = 0; i <= 80; i += 10)
    for (double o = 0; o <= 85; o += 1)
      for (const double phi : {0., 180.}) {
        const auto at = directions_from_angles(i * degree, o * degree, phi * degree);
        out.push_back({550, i, o, phi, {surface.brdf(0, at).m[0][0]}});
      }
  return out;
}

/// The white paint of examples/panel_brdf.csv on any grid.
Material paint() {
  Material out;
  out.index = constant_index(1.5);
  out.distribution = {"beckmann", {{"alpha", .3}}, {}, {}, {}};
  out.body = BodyLobe{{{}, {.8}}, true};
  return out;
}

std::vector<BrdfSample> sampled(const Surface &surface, const std::vector<double> &theta_i,
                                const std::vector<double> &theta_o,
                                const std::vector<double> &phi) {
  std::vector<BrdfSample> out;
  for (const double i : theta_i)
    for (const double o : theta_o)
      for (const double p : phi)
        out.push_back({550,
                       i,
                       o,
                       p,
                       {surface.brdf(0, directions_from_angles(i * degree, o * degree, p * degree))
                            .m[0][0]}});
  return out;
}

std::vector<double> steps(double last, double step) {
  std::vector<double> out;
  for (int k = 0; k * step <= last + 1e-9; ++k)
    out.push_back(k * step);
  return out;
}

/// Lambert's law at as many wavelengths as a spectrometer has, a hundredth of a nanometre apart.
std::vector<BrdfSample> lambert_spectrum(std::size_t brighter, double m00, double brighter_m00) {
  std::vector<BrdfSample> out;
  for (std::size_t k = 0; k < 600; ++k)
    for (const double o : {0., 45., 90.})
      for (const double phi : {0., 90., 180.})
        out.push_back(
            {500 + .01 * static_cast<double>(k), 0, o, phi, {k == brighter ? brighter_m00 : m00}});
  return out;
}

/// What a table in place of its surface gets wrong, at most, in parts of the larger value.
double true_error(const MeasuredBrdf &table, const Surface &surface, double last) {
  double worst = 0, largest = 0;
  for (int pass = 0; pass < 2; ++pass)
    for (double i = 1.2; i < last; i += 2.3)
      for (double o = 0.7; o < last; o += 2.1)
        for (double phi = 1.1; phi < 180; phi += 6.1) {
          const double truth =
              surface.brdf(0, directions_from_angles(i * degree, o * degree, phi * degree)).m[0][0];
          const double ours = table(550, i * degree, o * degree, phi * degree)[0];
          const double larger = std::max(truth, ours);
          const double light = larger * std::cos(i * degree) * std::cos(o * degree);
          largest = std::max(largest, light);
          if (pass == 1 && light > 0.01 * largest)
            worst = std::max(worst, std::abs(truth - ours) / larger);
        }
  return worst;
}

bool says(const std::vector<std::string> &remarks, const std::string &words) {
  return std::any_of(remarks.begin(), remarks.end(), [&](const std::string &remark) {
    return remark.find(words) != std::string::npos;
  });
}

TEST(Measured, ALobeSampledInThePlaneComesBackOutOfIt) {
  // Beckmann, alpha .15, on a conductor: its BRDF depends on the tilt of h mostly, on the rest
  // slowly.
  Material metal;
  metal.index = constant_index({.359, 2.69});
  metal.distribution = {"beckmann", {{"alpha", .15}}, {}, {}, {}};
  const Surface surface = compiled(metal, "nm:550");
  std::vector<std::string> remarks;
  const auto measured = MeasuredBrdf::from(sampled_in_plane(surface), false, false, remarks);
  ASSERT_TRUE(measured) << measured.error().message;
  // Of what one plane says about all, and of the lobe at grazing angles between steps of 10 deg.
  EXPECT_EQ(remarks.size(), 2u);
  EXPECT_NEAR(measured->grid_error().share, true_error(*measured, surface, 85), .2);
  EXPECT_NEAR(measured->albedo(550, 30 * degree),
              surface.specular_albedo(0, tilted(std::cos(30 * degree))), .02);
  double worst = 0, peak = 0;
  for (std::uint64_t k = 0; k < 500; ++k) {
    const auto u = uniform4(8, 3, k);
    const double i = 60 * u[0], o = 60 * u[1], phi = 360 * u[2];
    const double truth =
        surface.brdf(0, directions_from_angles(i * degree, o * degree, phi * degree)).m[0][0];
    const double ours = (*measured)(550, i * degree, o * degree, phi * degree)[0];
    worst = std::max(worst, std::abs(ours - truth));
    peak = std::max(peak, truth);
    // Reciprocity is exact by construction.
    EXPECT_NEAR((*measured)(550, o * degree, i * degree, phi * degree)[0], ours, 1e-9 * (1 + ours));
  }
  // Steps of 10 deg of incidence: linear between curves whose masking and Fresnel factors differ.
  EXPECT_LT(worst, 0.08 * peak);
}

TEST(Measured, OneWavelengthOfManyThatGivesMoreThanItGetsIsFound) {
  // A Lambert surface of m00 sends pi m00 of what it gets: .63, and 1.26 at one wavelength of 600.
  std::vector<std::string> remarks;
  for (const std::size_t at : {5, 599}) {
    const auto refused = MeasuredBrdf::from(lambert_spectrum(at, .2, .4), false, false, remarks);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("albedo 1.257 at 0 deg"), std::string::npos)
        << refused.error().message;
  }
  EXPECT_TRUE(MeasuredBrdf::from(lambert_spectrum(5, .2, .3), false, false, remarks));
}

/// Wavelengths of 18 incidences, which are the observer's angles too: ten of them two tenths of a
/// degree apart, where a lobe stands in the mirror direction, and at the last wavelength m00 = .4
/// everywhere.
std::vector<BrdfSample> lobes_and_one_lambert(int wavelengths, const std::vector<double> &phi) {
  std::vector<double> theta{0, 10, 20, 28};
  for (int k = 0; k < 10; ++k)
    theta.push_back(29 + .2 * k);
  theta.insert(theta.end(), {32, 40, 60, 80});
  const auto is_dense = [](double angle) { return angle >= 29 && angle < 31; };
  std::vector<BrdfSample> out;
  for (int w = 1; w <= wavelengths; ++w)
    for (const double i : theta)
      for (const double o : theta)
        for (const double p : phi) {
          const double lobe = is_dense(i) && is_dense(o) && p == 180 ? 3 : .1;
          out.push_back({500. + w, i, o, p, {w == wavelengths ? .4 : lobe}});
        }
  return out;
}

TEST(Measured, ABroadLobeIsFoundBesideDenseNodesOfANarrowOne) {
  // Lambert's albedo is pi m00 = 1.257; that of the others is below 1: .314 + 2.9 pi sin(30 deg)
  // cos(30 deg) 3 deg < .53.
  for (const auto &phi : {std::vector<double>{0, 180}, {0, 90, 180}})
    for (const int wavelengths : {2, 10}) { // few enough that all are asked, and not
      std::vector<std::string> remarks;
      const auto refused =
          MeasuredBrdf::from(lobes_and_one_lambert(wavelengths, phi), false, false, remarks);
      ASSERT_FALSE(refused) << phi.size() << " azimuths, " << wavelengths << " wavelengths";
      // (At which of its incidences is a matter of the last digits.)
      EXPECT_EQ(refused.error().message.find("the table gives more than it gets: albedo 1.257 at "),
                0u)
          << refused.error().message;
      EXPECT_EQ(says(remarks, "asked at the 100 brightest of 180 pairs of wavelength and theta_i"),
                wavelengths == 10);
      auto narrow = lobes_and_one_lambert(2, phi);
      std::erase_if(narrow, [](const BrdfSample &s) { return s.wavelength_nm > 501; });
      EXPECT_TRUE(MeasuredBrdf::from(narrow, false, false, remarks));
    }
}

TEST(Measured, AnExcessAtOneGrazingIncidenceIsFound) {
  std::vector<BrdfSample> samples;
  for (const double nm : {500., 600.})
    for (const double i : steps(90, 1))
      for (const double o : steps(90, 1))
        samples.push_back({nm, i, o, 0, {nm == 600 && (i == 88 || o == 88) ? .4 : .2}});
  std::vector<std::string> remarks;
  const auto refused = MeasuredBrdf::from(samples, false, false, remarks);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("albedo 1.257 at 88 deg"), std::string::npos)
      << refused.error().message; // pi m00
}

TEST(Measured, AMuellerTableIsReciprocalToTheLastBit) {
  Material paint;
  paint.index = constant_index(1.5);
  paint.distribution = {"beckmann", {{"alpha", .4}}, {}, {}, {}};
  paint.body = BodyLobe{{{}, {.5}}, true};
  const Surface surface = compiled(paint, "nm:550");
  std::vector<BrdfSample> samples;
  for (const double i : {0., 20., 40., 60., 80.})
    for (const double o : {0., 20., 40., 60., 80.})
      for (const double phi : {0., 45., 90., 135., 180.}) {
        BrdfSample s{550, i, o, phi, {}};
        const auto m =
            surface.brdf(0, directions_from_angles(i * degree, o * degree, phi * degree)).m;
        for (std::size_t k = 0; k < 16; ++k)
          s.mueller[k] = m[k / 4][k % 4];
        samples.push_back(s);
      }
  std::vector<std::string> remarks;
  const auto measured = MeasuredBrdf::from(samples, true, false, remarks);
  ASSERT_TRUE(measured) << measured.error().message;
  EXPECT_LT(measured->worst_asymmetry(), 1e-12);
  Material material;
  material.name = "m";
  material.measured = std::make_shared<MeasuredBrdf>(*measured);
  const Surface table = compiled(material, "nm:550");
  for (std::uint64_t k = 0; k < 300; ++k) {
    const auto u = uniform4(8, 4, k);
    const Vec3<Facet> l = direction_from(u[0], u[1]), v = direction_from(u[2], u[3]);
    const auto there = table.brdf(0, directions(l, v)).m, back = table.brdf(0, directions(v, l)).m;
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(back[r][c], ((r == 2) != (c == 2) ? -1 : 1) * there[c][r], 1e-12 * there[0][0]);
  }
}

TEST(Measured, ACoarseGridSaysHowFarOffItIs) {
  const Surface surface = compiled(paint(), "nm:550");
  const std::vector<double> coarse{0, 15, 30, 45, 60, 75, 85}; // examples/panel_brdf.csv
  std::vector<std::string> remarks;
  const auto few =
      MeasuredBrdf::from(sampled(surface, coarse, coarse, steps(180, 30)), false, false, remarks);
  ASSERT_TRUE(few) << few.error().message;
  EXPECT_TRUE(says(remarks, "between its nodes the table may be off by"));
  const double truth = true_error(*few, surface, 85);
  EXPECT_GT(truth, 0.5);
  EXPECT_NEAR(few->grid_error().share, truth, 0.25 * truth);
  EXPECT_TRUE(few->grid_error().is_phi);

  // Steps of 2.5 degrees up to 80 follow every lobe of it.
  remarks.clear();
  const auto many = MeasuredBrdf::from(
      sampled(surface, steps(80, 2.5), steps(80, 2.5), steps(180, 2.5)), false, false, remarks);
  ASSERT_TRUE(many) << many.error().message;
  EXPECT_LT(true_error(*many, surface, 80), 0.15);
  for (const std::string &remark : remarks)
    ADD_FAILURE() << remark << " (true error " << true_error(*many, surface, 80) << ")";
}

TEST(Measured, TheEndOfTheIncidencesIsTold) {
  const Surface surface = compiled(paint(), "nm:550");
  std::vector<std::string> remarks;
  const auto table = MeasuredBrdf::from(
      sampled(surface, steps(60, 2.5), steps(80, 2.5), steps(180, 2.5)), false, false, remarks);
  ASSERT_TRUE(table) << table.error().message;
  ASSERT_EQ(remarks.size(), 1u) << remarks[0];
  EXPECT_TRUE(says(remarks, "both directions lie beyond 60 deg, or one of them beyond 80 deg"));
  // Known from the way back: 75 deg in, 50 deg out.
  const double truth =
      surface.brdf(0, directions_from_angles(75 * degree, 50 * degree, 180 * degree)).m[0][0];
  EXPECT_NEAR((*table)(550, 75 * degree, 50 * degree, 180 * degree)[0] / truth, 1, 1e-9);
  // Held: 75 in, 75 out is what 60 gives.
  EXPECT_EQ((*table)(550, 75 * degree, 75 * degree, 0)[0],
            ((*table)(550, 60 * degree, 75 * degree, 0)[0]));
}

TEST(Measured, TheFloorOfAnInstrumentIsTold) {
  const Surface surface = compiled(paint(), "nm:550");
  const auto grid = [&] {
    return sampled(surface, steps(60, 5), {0, 10, 20, 30, 40, 50, 60, 65, 70, 75, 80, 85, 88, 89},
                   steps(180, 15));
  };
  const auto floor_of = [](std::vector<BrdfSample> samples) {
    std::vector<std::string> remarks;
    const auto table = MeasuredBrdf::from(std::move(samples), false, true, remarks);
    EXPECT_TRUE(table);
    EXPECT_EQ(says(remarks, "floor of an instrument"), table->floor_from_deg() < 90);
    return table->floor_from_deg();
  };
  EXPECT_EQ(floor_of(grid()), 90);
  auto clamped = grid(); // a least value that the instrument gives at the end of its arm
  for (BrdfSample &s : clamped)
    if (s.theta_o_deg >= 88)
      s.mueller[0] = 1e-4;
  EXPECT_EQ(floor_of(clamped), 88);
  auto dark = grid(); // a dark signal of 1 % of the signal at normal incidence
  for (BrdfSample &s : dark)
    s.mueller[0] += 0.01 * 0.25 / std::cos(s.theta_o_deg * degree);
  EXPECT_LE(floor_of(dark), 89);
  auto lambert = grid();
  for (BrdfSample &s : lambert)
    s.mueller[0] = 0.2;
  EXPECT_EQ(floor_of(lambert), 90);
}

} // namespace
} // namespace umov
