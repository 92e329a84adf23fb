#include <umov/light/thermal.h>

#include "kernel/microfacet.inl.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>
#include <umov/core/stop.h>
#include <umov/surface/rough_emission.h>

namespace umov {
namespace {

/// Steps of the angle from the normal. The last node lies short of grazing, where the integral over
/// the lobe ends.
constexpr std::size_t steps = 90;
constexpr double last_rad = 89.9 * pi / 180;

/// Emissivity of a surface over the angle, band after band.
std::vector<Emissivity> emissivities(const Surface &surface, const std::atomic<bool> *cancel) {
  std::vector<Emissivity> out;
  for (std::size_t band = 0; band < surface.band_count(); ++band)
    for (std::size_t k = 0; k <= steps; ++k) {
      leave_if_stopped(cancel);
      out.push_back(rough_emissivity(surface, band, last_rad * static_cast<double>(k) / steps));
    }
  return out;
}

} // namespace

Result<ThermalEmission> ThermalEmission::make(const Scene &scene,
                                              std::span<const double> temperature_k,
                                              const std::atomic<bool> *cancel) {
  if (temperature_k.size() != scene.mesh.groups.size())
    return fail(ErrorCode::BadInput,
                fmt::format("{} temperatures for a mesh of {} groups; one for each was expected",
                            temperature_k.size(), scene.mesh.groups.size()));
  ThermalEmission out;
  out.bands_ = scene.grid.nodes().size();
  std::vector<Table> tables;
  std::vector<std::pair<const Surface *, std::vector<Emissivity>>> known; // groups share materials
  for (std::size_t group = 0; group < temperature_k.size(); ++group) {
    const double kelvin = temperature_k[group];
    if (!(kelvin >= 0) || !std::isfinite(kelvin))
      return fail(ErrorCode::BadInput,
                  fmt::format("the temperature of \"{}\" is {} K; 0 or more was expected",
                              scene.mesh.groups[group], kelvin));
    for (const Surface *surface : {&scene.front[group], &scene.back[group]}) {
      if (surface->is_anisotropic())
        return fail(ErrorCode::BadInput,
                    "material \"" + surface->material().name +
                        "\" reflects differently along and across its grain; emission is known of "
                        "isotropic surfaces alone");
      const auto same = std::find_if(known.begin(), known.end(), [&](const auto &other) {
        return other.first->is_same(*surface);
      });
      const std::vector<Emissivity> &of =
          same != known.end() ? same->second
                              : known.emplace_back(surface, emissivities(*surface, cancel)).second;
      for (std::size_t band = 0; band < out.bands_; ++band) {
        const double planck = planck_radiance(scene.grid.nodes()[band].wavelength, kelvin);
        Table &table = tables.emplace_back();
        for (std::size_t k = 0; k <= steps; ++k) {
          const Emissivity &e = of[band * (steps + 1) + k];
          table.i.push_back(planck * e.i);
          table.q.push_back(planck * e.q);
        }
      }
    }
  }
  out.tables_ = std::make_shared<const std::vector<Table>>(std::move(tables));
  return out;
}

ThermalEmission::Radiance ThermalEmission::radiance(std::uint32_t group, bool is_front,
                                                    std::size_t band, double cosine) const {
  const Table &table = (*tables_)[(group * 2 + (is_front ? 0 : 1)) * bands_ + band];
  const double x = std::min(std::acos(std::clamp(cosine, 0.0, 1.0)) / last_rad, 1.0) * steps;
  const std::size_t first = std::clamp<std::size_t>(static_cast<std::size_t>(x), 1, steps - 2) - 1;
  const double t = x - static_cast<double>(first + 1);
  return {kernel::cubic(table.i.data() + first, t), kernel::cubic(table.q.data() + first, t)};
}

} // namespace umov
