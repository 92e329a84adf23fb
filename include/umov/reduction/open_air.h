#pragma once
// What is not known of the air over the exposures of a set.

#include <cstdint>
#include <umov/reduction/sequence.h>

namespace umov {

/// A count's place under the air.
struct AirPlace {
  double time_s = 0;
  std::int64_t exposure = 0; ///< counts of one see one cloud, as those of one time do
  double flicker = 0;        ///< relative standard deviation by scintillation
};

/// Logarithms of the transparencies of a set's exposures, normal about 0: scintillation of each
/// exposure (of each count behind pupils of their own), and a cloud that all pupils of a moment
/// share and that wanders as umov observe draws it (an Ornstein-Uhlenbeck process). In logarithms a
/// cloud over all of a set and a brighter object are the same, whatever else the air does.
class OpenAir {
public:
  /// `places` in the order of time.
  OpenAir(std::span<const AirPlace> places, bool has_separate_pupils, const CloudPrior &cloud);

  /// The most likely transparency of each count, for the light of a model.
  [[nodiscard]] std::vector<double> transparencies(std::span<const ChannelDatum> data,
                                                   const std::array<double, 4> &stokes) const;
  /// What is left open of it, as errors of counts whose rows are behind the transparencies found.
  void add_errors(std::vector<CommonError> &out, std::span<const ModelledDatum> model) const;

private:
  std::vector<std::size_t> pupil_; ///< of each count: an exposure of a pupil
  std::size_t causes_ = 0;
  /// [pupil * causes + cause]: the logarithm is the sum of these times numbers of mean 0 and
  /// variance 1.
  std::vector<double> root_;
};

} // namespace umov
