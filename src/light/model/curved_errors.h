#pragma once
// Private: what the engine errs by lighting elements of curved parts by the normal at their middle.

#include <atomic>
#include <span>
#include <umov/light/engine.h>
#include <vector>

namespace umov {

/// Measured by the reference, nothing hidden, on random poses at some phase angles: classes that
/// turn over their own width err little where much of the object is lit and seen, and much where
/// only a narrow strip of it is, above 150 deg. docs/theory/engine.md.
class CurvedErrors {
public:
  /// 1e-4 of I where every facet is flat. `unhidden`: the scene's engine without visibility. Throws
  /// Failure (Interrupted) once `cancel`, which may be null, became true.
  static CurvedErrors measure(const Scene &scene, const Engine &unhidden, unsigned threads,
                              const std::atomic<bool> *cancel = nullptr);

  /// In parts of I, at phase angles up to 110 deg.
  [[nodiscard]] double typical() const;
  /// Adds to the half-widths of I, Q and U [m2/sr] what each pose's light may err by.
  void add_to(StokesTable &table, std::span<const Pose> poses) const;

private:
  /// What holds for all poses that were looked at about one phase angle.
  struct Node {
    double phase_rad = 0;
    /// Of I; and of I or, where that is less, of `dim_i`: the error falls with I, but not to 0
    /// where a class is dark by its middle. Both hold, so that the smaller does.
    double of_own = 0, of_lit = 0;
    std::vector<double> dim_i; ///< per band [m2/sr]
    [[nodiscard]] double at(std::size_t band, double i) const;
  };
  [[nodiscard]] double at(double phase_rad, std::size_t band, double i) const;

  std::vector<Node> nodes_; ///< phase angles rise; none where all is flat
};

} // namespace umov
