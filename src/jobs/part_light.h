#pragma once
// Private: light of an object taken apart by material, or by group of the mesh, and how little of
// it is known.

#include <map>
#include <mutex>
#include <umov/inverse/curve_model.h>
#include <umov/jobs/invert.h>
#include <umov/light/light_model.h>
#include <umov/light/light_sums.h>

namespace umov::jobs {

/// Light of all poses by sums before any colour: whole, and of each material its lobe, with three
/// roughnesses, and what it scatters beside it. Thread safe.
class LightByPart {
public:
  /// None where an object has no such sums: parts that turn, measured or brushed
  /// surfaces. Masks that `elder` has traced are not traced again, unless groups that share a
  /// material are taken apart: masks are of what shares one.
  static std::unique_ptr<LightByPart> make(const LightModel &elder, const MaterialErrors &errors,
                                           const JobOptions &options,
                                           const std::atomic<bool> *cancel = nullptr);
  /// In the order of the table's blocks of bands.
  [[nodiscard]] const std::vector<PartKind> &kinds() const { return kinds_; }
  /// As CurveModel has it. False where a card failed or `cancel` became true. `is_quick`: masks as
  /// they are, without half-widths; else mended by rays.
  [[nodiscard]] bool evaluate(std::span<const Pose> poses, StokesTable &out, unsigned threads,
                              bool is_quick = false,
                              const std::atomic<bool> *cancel = nullptr) const;
  /// For later jobs.
  void keep_masks() const;

private:
  LightByPart() = default;
  bool name_parts(const AbundanceTable &sums, const MaterialErrors &errors);
  /// Light of one unit of each sum at one phase angle: [((level * columns + column) * bands + band)
  /// * 3 + stokes].
  using Colours = std::vector<double>;
  [[nodiscard]] std::shared_ptr<const Colours> colours_at(double cos_phase, bool has_plane,
                                                          const AbundanceTable &like) const;
  void put(const AbundanceTable &sums, std::size_t row, const Colours &colours,
           StokesTable &out) const;

  /// Columns of the sums that one part consists of.
  using Columns = std::vector<std::size_t>;
  std::unique_ptr<LightSums> sums_, quick_;
  std::vector<Scene> scenes_;          ///< as it is, smoother, rougher
  std::vector<MaterialTables> tables_; ///< of each
  std::vector<PartKind> kinds_;
  std::vector<Columns> columns_; ///< of each kind
  std::size_t blocks_ = 1;
  /// Epochs of a curve have few phase angles, and attitudes do not change them.
  mutable std::mutex lock_;
  mutable std::map<std::pair<std::int64_t, bool>, std::shared_ptr<const Colours>> colours_;
};

} // namespace umov::jobs
