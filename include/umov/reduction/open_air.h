#pragma once
// What is not known of the air over the exposures of a set.

#include <cstdint>
#include <umov/reduction/sequence.h>

namespace umov {

struct AirOfCounts; ///< private: the same as matrices

/// A count's place under the air.
struct AirPlace {
  double time_s = 0;
  std::int64_t exposure = 0; ///< counts of one see one cloud, as those of one time do
  double flicker = 0;        ///< relative standard deviation by scintillation
};

/// Logarithms of the transparencies of a set's exposures, normal with means of transparency 1:
/// scintillation of each exposure (of each count behind pupils of their own), and a cloud that all
/// pupils of a moment share and that wanders as umov observe draws it (an Ornstein-Uhlenbeck
/// process). In logarithms a cloud over all of a set and a brighter object are the same, whatever
/// else the air does.
class OpenAir {
public:
  /// `places` of counts, in any order.
  OpenAir(std::span<const AirPlace> places, bool has_separate_pupils, const CloudPrior &cloud);

  /// Neither flickers nor has a cloud.
  [[nodiscard]] bool is_known() const;
  /// Of a count's transparency before anything was counted: the mean of its logarithm, -s^2/2 where
  /// that has the standard deviation s, so that the mean transparency is 1.
  [[nodiscard]] double mean_logarithm(std::size_t count) const;
  /// The most likely transparency of each count, for the light of a model.
  [[nodiscard]] std::vector<double> transparencies(std::span<const ChannelDatum> data,
                                                   const std::array<double, 4> &stokes) const;

private:
  friend AirOfCounts air_of(const OpenAir &air);
  std::vector<AirPlace> places_;
  std::vector<std::size_t> pupil_; ///< of each count: an exposure of a pupil
  std::vector<double> flicker_;    ///< of each of those
  CloudPrior cloud_;
};

/// Common errors, and what is left open of the air before counts whose rows are behind the
/// transparencies found; both act on the light of a model, `stokes`. BadInput as of `fit_stokes`.
Result<StokesFit> fit_stokes(std::span<const ChannelDatum> data, std::size_t parameters,
                             std::span<const CommonError> common, const OpenAir &air,
                             const std::array<double, 4> &stokes);

} // namespace umov
