// A material of one's own, and how it polarizes: glass under a thin film, rough by GGX.
#include <cstdio>
#include <umov/umov.h>

umov::Result<void> print_polarization() {
  umov::Material glass;
  glass.name = "coated glass";
  glass.index = umov::constant_index({1.52, 0});
  glass.layers.push_back({umov::constant_index({1.38, 0}), 100, true}); // magnesium fluoride
  glass.distribution = {"ggx", {{"alpha", 0.2}}, {}, {}};
  UMOV_ASSIGN(bands, umov::bands_from({"nm:450", "nm:650"}));
  UMOV_ASSIGN(surface, umov::Surface::compile(glass, bands));

  for (std::size_t band = 0; band < bands.size(); ++band)
    for (const double incidence_deg : {20.0, 40.0, 60.0}) {
      const double theta = umov::Angle::degrees(incidence_deg).radians();
      const auto mueller = surface.brdf(band, umov::directions_from_angles(theta, theta, umov::pi));
      std::printf("%s %2.0f deg: f %.4f 1/sr, Q/I %+.4f\n", bands[band].name.c_str(), incidence_deg,
                  mueller.m[0][0], mueller.m[1][0] / mueller.m[0][0]);
    }
  return {};
}

int main() {
  const auto done = print_polarization();
  if (!done)
    std::fprintf(stderr, "%s\n", done.error().text().c_str());
  return done ? 0 : static_cast<int>(done.error().code);
}
