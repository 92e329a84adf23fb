#pragma once
// Private: colour and polarization, applied to the sums of a pose.

#include "backend/colours.h"
#include "light/fast/fresnel_table.h"
#include "light/fast/surface_fit.h"

namespace umov {

/// Light of a pose in all bands per unit of `sum_area`, and squared standard deviations.
struct BandLight {
  std::vector<double> i, q, u, v;
  std::vector<double> var_i, var_q, var_u, var_v;
  std::vector<double> bias; ///< bound of what is known to be left out of I
  /// Zeros; U and V only if something gives them.
  void reset(std::size_t bands, bool has_u_or_v = false);
  void add(const BandLight &other);
  /// The same with the other's unit of area changed into this one's.
  void add_scaled(const BandLight &other, double scale);
  [[nodiscard]] std::size_t size() const { return i.size(); }
  [[nodiscard]] backend::LightColumns<double> columns() {
    return {i.data(),     q.data(),     u.data(),     v.data(),   var_i.data(),
            var_q.data(), var_u.data(), var_v.data(), bias.data()};
  }
};

using SlotSums = backend::SlotSums<double>;

/// Reflection of all microfacets at one phase angle, and room to work in.
struct PhaseFactors {
  std::vector<double> a, b; ///< by column: M00, M10; b = 0 without a plane
  /// Of one slot: M10/M00, and deviations of I, Q, U.
  std::vector<double> ratio, dev_i, dev_q, dev_u;
  FresnelTable::Recent recent;
};

/// What a set of materials makes of sums, in single precision and in one piece of memory each.
struct RoundedColours {
  struct Slot {
    std::vector<std::uint32_t> lobe;
    std::vector<float> single_bounce, whole, q, u;
    backend::SlotColour<float> colour; ///< without views
  };
  std::vector<Slot> slots;
  std::vector<float> reflection;
  std::uint32_t columns = 0, steps = 1;
};

/// What one set of materials makes of sums.
class Colours {
public:
  Colours() = default;
  /// `light` per slot, empty where a slot has no kernel. With `is_intensity_only` all Q are left 0.
  Colours(std::vector<const Surface *> surfaces, std::vector<std::optional<SurfaceLight>> light,
          const std::vector<backend::SlotTerms> &terms, bool is_intensity_only = false);
  // Views of slots stay where these are moved, not where they are copied.
  Colours(Colours &&) = default;
  Colours &operator=(Colours &&) = default;
  Colours(const Colours &) = delete;
  Colours &operator=(const Colours &) = delete;
  ~Colours() = default;

  void prepare(double cos_phase, bool has_plane, PhaseFactors &out) const;
  /// Adds the light of one slot with kernels.
  void add_slot(std::size_t slot, const SlotSums &sums, PhaseFactors &at, BandLight &out) const;

  [[nodiscard]] std::size_t band_count() const { return bands_; }
  /// Some slot gives U: BandLight needs room for it.
  [[nodiscard]] bool has_u() const;
  [[nodiscard]] const Surface &surface(std::size_t slot) const { return *slots_[slot].surface; }
  /// Reflection is interpolated for all of them: nothing is computed anew for each pose.
  [[nodiscard]] bool is_tabulated() const { return !fresnel_.has_exact(); }
  [[nodiscard]] RoundedColours rounded() const;
  /// First column of a slot in PhaseFactors.
  [[nodiscard]] std::size_t column(std::size_t slot) const { return slots_[slot].column; }

private:
  struct Slot {
    const Surface *surface = nullptr;
    std::size_t column = 0;
    std::vector<std::uint32_t> lobe;                ///< per band
    std::vector<double> single_bounce, whole, q, u; ///< [product * bands + band]
    backend::SlotColour<double> colour;             ///< views of these
    void look_at_own();
  };
  std::vector<Slot> slots_;
  FresnelTable fresnel_;
  std::size_t bands_ = 0;
};

} // namespace umov
