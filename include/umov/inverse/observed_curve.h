#pragma once
// What an observer measured, in the terms of the light of an object: docs/theory/inverse.md.

#include <cstddef>
#include <limits>
#include <string>
#include <umov/core/vec3.h>
#include <vector>

namespace umov {

/// One moment: where the Sun and the observer stood, as seen from the object.
struct ObservedEpoch {
  double seconds = 0;             ///< since the first epoch of the curve
  Vec3<Gcrs> to_sun, to_observer; ///< unit vectors at the object
  double sun_radius_rad = 0;      ///< of its disk; 0: a point
  double scattering_axis_rad = 0; ///< position angle of +Q_scat in the frame of the instrument
  double flux_per_intensity = 1;  ///< what arrives of I here, up to a constant of the curve
};

/// Not of counts.
inline constexpr std::size_t no_set = std::numeric_limits<std::size_t>::max();

/// One band at one epoch. NaN: not measured.
struct ObservedSample {
  std::size_t epoch = 0, band = 0;
  /// I in the units of the model [m2/sr], up to the unknown scale: distance and sunlight are taken
  /// out; and its standard deviation.
  double i = std::numeric_limits<double>::quiet_NaN();
  double i_sd = 0;
  /// Q/I and U/I in the scattering plane, with their covariance.
  double q = std::numeric_limits<double>::quiet_NaN();
  double u = std::numeric_limits<double>::quiet_NaN();
  double cov_qq = 0, cov_uu = 0, cov_qu = 0;
  std::size_t set = no_set; ///< of counts that it was reduced from
};

/// Electrons of one channel of one exposure: by_i I + by_q Q + by_u U of them are the object's in
/// the mean, I in the units of `ObservedSample::i`, Q and U in the scattering plane.
struct ObservedCount {
  std::size_t epoch = 0, band = 0;
  double net = 0;             ///< the sky taken off
  double sky = 0;             ///< what was taken off; its noise is there still
  double fixed_variance = 0;  ///< of reading, rounding and the error of the sky
  double excess2 = 1;         ///< of a multiplying register
  double scintillation = 0;   ///< relative standard deviation of the exposure's transparency
  bool has_own_pupil = false; ///< which is then not that of the exposure's other channels
  double by_i = 0, by_q = 0, by_u = 0;
  std::size_t set = no_set; ///< those of one were reduced to a sample together
};

/// All that was measured of one object.
struct ObservedCurve {
  std::vector<std::string> bands;
  std::vector<ObservedEpoch> epochs;   ///< in order of time
  std::vector<ObservedSample> samples; ///< in order of epochs
  /// In order of epochs and bands. Where there are any, `CurveLikelihood` is of them, and `samples`
  /// are what was reduced from them.
  std::vector<ObservedCount> counts;
  bool is_absolute = false; ///< `i` is [m2/sr] itself: the scale is near 1
};

} // namespace umov
