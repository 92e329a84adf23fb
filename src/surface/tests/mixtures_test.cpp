// Two materials in one object: the paper's Eq. 22 with weights that differ between bands.

#include "core/tests/anchors.h"
#include "surface/tests/surface_cases.h"

#include <array>
#include <gtest/gtest.h>
#include <umov/core/random.h>

namespace umov {
namespace {

using Colour = std::array<double, 3>; ///< Q at 425, 550, 650 nm

/// Intensity and Q of one reflection per band.
struct Light {
  std::array<double, 3> i{}, q{};
};

Light light_of(const char *name, double phase_deg) {
  const Surface surface = make_surface(name, 200);
  Light out;
  for (std::size_t b = 0; b < 3; ++b) {
    const FresnelFactors f = surface.fresnel(b, std::cos(phase_deg * degree));
    out.i[b] = f.a;
    out.q[b] = f.b;
  }
  return out;
}

Colour mixed(const Light &a, const Light &b, double share) {
  Colour out{};
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = (share * a.q[k] + (1 - share) * b.q[k]) / (share * a.i[k] + (1 - share) * b.i[k]);
  return out;
}

struct Departure {
  double chord = 0, largest = 0;
};

Departure departure(const char *one, const char *other, double phase_deg) {
  const Light a = light_of(one, phase_deg), b = light_of(other, phase_deg);
  const Colour start = mixed(a, b, 0), end = mixed(a, b, 1);
  Departure out;
  for (std::size_t k = 0; k < 3; ++k)
    out.chord += std::pow(end[k] - start[k], 2);
  out.chord = std::sqrt(out.chord);
  for (int i = 1; i < 10'000; ++i) {
    const Colour at = mixed(a, b, i / 10'000.0);
    double along = 0, square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      along += (at[k] - start[k]) * (end[k] - start[k]) / out.chord;
      square += std::pow(at[k] - start[k], 2);
    }
    out.largest = std::max(out.largest, std::sqrt(std::max(0.0, square - along * along)));
  }
  return out;
}

TEST(Mixtures, DepartFromTheChordAsPrinted) {
  // Largest departure over all mixing ratios, in chord lengths; half a unit of the last digit.
  for (const AnchorRow &row : Anchors("departures")) {
    const Departure d =
        departure(row.text("one").c_str(), row.text("other").c_str(), row["phase_deg"]);
    EXPECT_NEAR(d.largest / d.chord, row["ratio"], 1.02 * row.half_digit("ratio"))
        << row.text("one") << " " << row.text("other") << " " << row["phase_deg"];
  }
  const Departure gold = departure("paper_au", "paper_al", 140);
  EXPECT_NEAR(gold.chord, anchor("gold_aluminium_chord"), 5.1e-6);
  EXPECT_NEAR(gold.largest, anchor("gold_aluminium_bow"), 5.1e-6);
  const Colour half = mixed(light_of("paper_au", 140), light_of("paper_al", 140), 0.5);
  for (const AnchorRow &row : Anchors("half_gold"))
    EXPECT_NEAR(half[band_of(row)], row["q"], 5.1e-7);
}

TEST(Mixtures, LieOnAPlaneThroughTheOrigin) {
  // The anchors' planes are those of other random mixtures: uniform weights of five materials here.
  // Both are thin (.01 to .018 of their size), so mixtures stay within .02 of one another's plane.
  const char *names[] = {"paper_au", "paper_al", "paper_bk7", "paper_asi", "paper_mylar"};
  for (const AnchorRow &row : Anchors("planes")) {
    if (row.text("phase_deg") == "all")
      continue;
    const double normal[3] = {row["blue"], row["green"], row["red"]};
    std::array<Light, 5> lights;
    for (std::size_t m = 0; m < 5; ++m)
      lights[m] = light_of(names[m], row["phase_deg"]);
    double rms_out = 0, rms = 0;
    constexpr int count = 2000;
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto u = uniform4(6, 1, i), w = uniform4(6, 2, i);
      const double weight[5] = {u[0], u[1], u[2], u[3], w[0]};
      double out = 0, size = 0;
      for (std::size_t b = 0; b < 3; ++b) {
        double q = 0, in = 0;
        for (std::size_t m = 0; m < 5; ++m) {
          q += weight[m] * lights[m].q[b];
          in += weight[m] * lights[m].i[b];
        }
        out += normal[b] * q / in;
        size += std::pow(q / in, 2);
      }
      rms_out += out * out;
      rms += size;
    }
    EXPECT_LT(std::sqrt(rms_out / rms), .02) << row["phase_deg"];
  }
}

} // namespace
} // namespace umov
