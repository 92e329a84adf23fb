#pragma once
// Private: what the engine errs by lighting elements of curved parts by the normal at their middle.

#include <array>
#include <atomic>
#include <mutex>
#include <span>
#include <umov/light/engine.h>
#include <vector>

namespace umov {

/// Measured by the reference, nothing hidden, on random poses about some phase angles: classes err
/// little where much of the object is lit and seen, and much where only a narrow strip of it is.
/// What is said of a phase angle is measured when a pose first has it; it does not depend on when.
/// docs/theory/engine.md.
class CurvedErrors {
public:
  /// `scene` must live as long. `unhidden`: its engine without visibility. Throws Failure
  /// (Interrupted) once `cancel`, which may be null, became true.
  CurvedErrors(const Scene &scene, const Engine &unhidden, unsigned threads,
               const std::atomic<bool> *cancel = nullptr);

  /// In parts of I, at small phase angles; 1e-4 where every facet is flat.
  [[nodiscard]] double typical() const;
  /// Adds to the half-widths of I, Q and U [m2/sr] what each pose's light may err by. Throws as
  /// above.
  void add_to(StokesTable &table, std::span<const Pose> poses, unsigned threads,
              const std::atomic<bool> *cancel) const;

private:
  /// What holds for all poses that were looked at about one phase angle.
  struct Node {
    /// Of I, where it is no less than that of the poses; and of I or, where that is less, of
    /// `dim_i`: the error falls with I, but not to 0 where a class is dark by its middle. Both
    /// hold, so that the smaller does.
    double of_own = 0, of_lit = 0;
    std::vector<double> least_i, dim_i; ///< per band [m2/sr]
    [[nodiscard]] double at(std::size_t band, double i) const;
  };
  static constexpr std::size_t node_count = 10;
  class Beside;
  void learn(std::size_t node, const Beside &beside, unsigned threads,
             const std::atomic<bool> *cancel) const;
  void learn_for(std::span<const Pose> poses, unsigned threads,
                 const std::atomic<bool> *cancel) const;
  [[nodiscard]] double at(double phase_rad, std::size_t band, double i) const;

  const Scene &scene_;
  bool is_flat_ = true; ///< nothing is curved
  mutable std::mutex mutex_;
  mutable std::array<std::atomic<bool>, node_count> is_known_{};
  mutable std::array<Node, node_count> nodes_; ///< phase angles rise
};

} // namespace umov
