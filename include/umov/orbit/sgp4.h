#pragma once
#include <memory>
#include <span>
#include <umov/core/result.h>
#include <umov/orbit/elements.h>
#include <umov/orbit/state.h>

namespace umov {

/// Codes of the reference implementation (Vallado et al. 2006); 0 = fine. SubOrbital is kept for
/// its number alone: the reference retired it and it is never returned (Decayed covers the case).
enum class Sgp4Code : int {
  Ok = 0,
  Eccentricity = 1,
  MeanMotion = 2,
  PerturbedEccentricity = 3,
  SemiLatusRectum = 4,
  SubOrbital = 5,
  Decayed = 6,
  OutOfRange = 7, ///< not in the reference: time not finite or beyond 1e8 min from the epoch
};
/// One plain sentence per code.
const char *to_text(Sgp4Code code);

/// SGP4/SDP4 in double precision, WGS 72, improved mode (Hoots & Roehrich 1980; Vallado, Crawford,
/// Hujsak & Kelso 2006). Immutable and thread safe; evaluation order does not matter.
class Sgp4 {
public:
  /// Initialises; the code tells whether the elements can be propagated at all.
  explicit Sgp4(const ElementSet &elements);
  /// Ok if the elements can be propagated.
  [[nodiscard]] Sgp4Code init_code() const;
  /// State `minutes` after the epoch (UTC clock). On failure the state is zero.
  Sgp4Code propagate(double minutes, TemeState &state) const;
  /// The same for many times at once, eight or so in the lanes of the vector unit; bit for bit what
  /// the other overload gives. The three spans have one length.
  void propagate(std::span<const double> minutes, std::span<TemeState> states,
                 std::span<Sgp4Code> codes) const;
  /// Period of 225 min or more: SDP4, with Sun, Moon and resonances.
  [[nodiscard]] bool is_deep_space() const;

private:
  friend void propagate_objects(std::span<const Sgp4> objects, std::span<const double> minutes,
                                std::span<TemeState> states, std::span<Sgp4Code> codes);
  struct Model;
  std::shared_ptr<const Model> model_;
};

/// States of many objects, each at its own time [min after its own epoch], in lanes; bit for bit
/// what Sgp4::propagate gives. All spans have one length.
void propagate_objects(std::span<const Sgp4> objects, std::span<const double> minutes,
                       std::span<TemeState> states, std::span<Sgp4Code> codes);

} // namespace umov
