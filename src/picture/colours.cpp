#include <umov/picture/colours.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace umov {
namespace {

// Okabe & Ito (2008), in an order that keeps neighbours apart; black is left out because it is the
// sky of the pictures.
constexpr std::array<Rgb, 7> okabe_ito{{{230, 159, 0},
                                        {86, 180, 233},
                                        {0, 158, 115},
                                        {240, 228, 66},
                                        {0, 114, 178},
                                        {213, 94, 0},
                                        {204, 121, 167}}};

// viridis at 0, 1/8, ... 1 (Smith & van der Walt 2015, CC0).
constexpr std::array<Rgb, 9> viridis{{{68, 1, 84},
                                      {71, 45, 123},
                                      {59, 82, 139},
                                      {44, 114, 142},
                                      {33, 145, 140},
                                      {40, 174, 128},
                                      {94, 201, 98},
                                      {173, 220, 48},
                                      {253, 231, 37}}};

} // namespace

std::string plot_colour(std::size_t index) {
  return index == 3 ? "#857a00" : material_colour(index);
}

Rgb mix(Rgb a, Rgb b, double share_of_b) {
  Rgb out;
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = a[i] + (b[i] - a[i]) * share_of_b;
  return out;
}

std::string hex(Rgb colour) {
  const auto byte = [](double v) { return static_cast<int>(std::lround(std::clamp(v, 0., 255.))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour[0]), byte(colour[1]), byte(colour[2]));
}

Rgb material_rgb(std::size_t index) {
  const auto round = static_cast<double>(index / okabe_ito.size());
  return mix(okabe_ito[index % okabe_ito.size()], {255, 255, 255}, std::min(0.75, 0.45 * round));
}

Rgb polarization_rgb(double p) {
  const double x = std::clamp(p, 0., 1.) * (viridis.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), viridis.size() - 2);
  return mix(viridis[i], viridis[i + 1], x - static_cast<double>(i));
}

std::string material_colour(std::size_t index) { return hex(material_rgb(index)); }

std::vector<std::string> polarization_scale() {
  std::vector<std::string> out;
  for (const Rgb &colour : viridis)
    out.push_back(hex(colour));
  return out;
}

} // namespace umov
