#pragma once
// Geometric sums of poses, before any colour: rendered once, they serve every band and every set of
// materials of the same roughness. docs/theory/engine.md

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <umov/core/result.h>
#include <umov/light/stokes_table.h>
#include <vector>

namespace umov {

/// What one column of the sums is.
struct AbundanceColumn {
  /// What is summed.
  enum class Kind {
    Specular, ///< sum of area D G2/4 over lit and seen facets [m2/sr], of one microfacet lobe
    /// Sum of area (n.l)(n.v) p(n.l) p'(n.v) [m2], of two profiles of the body light; for light
    /// polarized as it leaves, also with the sine or cosine of twice its plane's angle: any sign.
    Diffuse
  };
  /// A mesh group and which of its materials.
  struct Side {
    std::string group;
    bool is_back_surface = false;
  };
  std::vector<Side> sides; ///< that share the material and are summed together
  Kind kind = Kind::Specular;
  double shape = 0; ///< Specular: m of Blinn-Phong, alpha of Beckmann and GGX
};

/// Sums of many poses: [pose * columns + column], with 95 % half-widths of what visibility costs.
struct AbundanceTable {
  std::vector<AbundanceColumn> columns;
  std::vector<double> sum, half_width;
  std::vector<double> bias;      ///< error of joined normals and of rounding, added up
  std::vector<double> cos_phase; ///< per pose
  std::vector<char> has_plane;   ///< per pose: there is a scattering plane, and so a Q
  std::vector<char> is_dark;     ///< per pose: nothing is both lit and seen
  /// Number of poses.
  [[nodiscard]] std::size_t poses() const { return cos_phase.size(); }
};

/// A set of materials, one for each mesh group, ready to be applied to the sums of one engine.
/// Pure and thread safe; the engine need not live.
class MaterialTables {
public:
  /// Stokes of every pose of `from`, which must be of the engine that made these tables. `out` is
  /// resized. The same bits as Engine::evaluate gives for the engine's own materials, but for
  /// rounding. Of no use once `cancel` became true.
  void apply(const AbundanceTable &from, StokesTable &out, unsigned threads = 1,
             const std::atomic<bool> *cancel = nullptr) const;
  /// Bands of the materials.
  [[nodiscard]] std::size_t band_count() const;
  /// Largest relative error of the diffuse light from sums made for other materials; it is in the
  /// half-widths.
  [[nodiscard]] double diffuse_error() const;

  struct State;
  /// For Engine::tables_for, which makes them.
  explicit MaterialTables(std::shared_ptr<const State> state) : state_(std::move(state)) {}

private:
  std::shared_ptr<const State> state_;
};

} // namespace umov
