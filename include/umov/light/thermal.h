#pragma once
// What a warm body sends out by itself.

#include <atomic>
#include <memory>
#include <span>
#include <umov/core/result.h>
#include <umov/optics/stokes.h>
#include <umov/scene/scene.h>
#include <vector>

namespace umov {

/// Emitted radiance of the surfaces of a scene at given temperatures, tabulated over the angle from
/// the normal (Kirchhoff's law for each polarization, `rough_emissivity`). Copies share the tables.
class ThermalEmission {
public:
  /// temperature_k: [K] of each mesh group, both sides. BadInput for other numbers of them, a
  /// temperature below 0 or no number, and surfaces whose lobe depends on the azimuth. Throws
  /// Failure (Interrupted) once `cancel` became true.
  static Result<ThermalEmission> make(const Scene &scene, std::span<const double> temperature_k,
                                      const std::atomic<bool> *cancel = nullptr);

  /// Spectral radiance [W m-2 sr-1 nm-1] towards a cosine from the normal: i, and q referred to
  /// s = n x v.
  struct Radiance {
    double i = 0, q = 0;
  };
  /// Of one side of a mesh group in a band, at its temperature.
  [[nodiscard]] Radiance radiance(std::uint32_t group, bool is_front, std::size_t band,
                                  double cosine) const;

private:
  struct Table {
    std::vector<double> i, q; ///< over the angle
  };
  std::size_t bands_ = 0;
  std::shared_ptr<const std::vector<Table>> tables_; ///< [(group * 2 + side) * bands + band]
};

} // namespace umov
