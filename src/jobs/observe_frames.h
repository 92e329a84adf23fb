#pragma once
// Private: exposures as frames: what the telescope follows, where things fall, what headers say.

#include "jobs/observe_exposure.h"

#include <umov/io/fits_image.h>
#include <umov/io/stars_file.h>

namespace umov::jobs {

/// The field of the observation; none without a file. `inputs` gets it.
Result<std::vector<FieldStar>> field_of(const ScenarioObservation &observation,
                                        std::vector<InputFile> &inputs, Diagnostics &diagnostics);
/// Time in which a trail grows by half a width where it grows fastest; 0 where the object is
/// followed, or no frames are made.
double trail_feature_s(const ScenarioObservation &observation, const Track &track,
                       std::span<const Exposure> exposures, double fwhm_arcsec);

/// How fast the object moves over the detector [rad/s]: against what the telescope follows.
double rate_over_detector(Tracking tracking, const ObservingGeometry &first,
                          const ObservingGeometry &last);

/// Of the exposures' trails over the detector [px]; of fifty of them.
double longest_trail_px(const Setup &setup, std::span<const Exposure> exposures);

/// Where things fall on the frames of one exposure.
class FrameView {
public:
  FrameView(const Setup &setup, const Exposure &exposure);
  /// What falls on them; `points`: of the exposure's nodes, `flux` of each of them.
  [[nodiscard]] FramePlan plan(std::span<const TrackPoint> points,
                               std::vector<std::vector<Stokes<InstrumentAxes>>> flux,
                               double fwhm_px) const;
  /// How many times as long as its rows, under a rolling shutter, the object is exposed: it runs
  /// along with the read-out, or against it.
  [[nodiscard]] double stretch(std::span<const TrackPoint> points) const;
  /// How many rows a second the fastest of what trails runs over, the object or the stars.
  [[nodiscard]] double rows_per_s(std::span<const TrackPoint> points) const;
  /// The world coordinates of the frame in the middle of the exposure, as header lines.
  [[nodiscard]] std::vector<FitsCard> world() const;

private:
  struct Axes {
    Vec3<Gcrs> centre, x, y;
  };
  /// What moves over the frame: pixels a second.
  struct Speed {
    double x = 0, y = 0;
  };
  [[nodiscard]] Speed speed_of(std::span<const TrackPoint> points) const;
  [[nodiscard]] double stretch(Speed speed) const;
  [[nodiscard]] FramePoint rolled(FramePoint at, Speed speed) const;
  [[nodiscard]] Axes at(const ObservingGeometry &g) const;
  [[nodiscard]] Angle axis_pa(const ObservingGeometry &g) const;
  [[nodiscard]] std::optional<FramePoint> image(const Axes &axes, Vec3<Gcrs> direction) const;
  [[nodiscard]] std::optional<FrameStar>
  star(const FieldStar &star, std::span<const TrackPoint> points, double fwhm_px) const;

  const Setup &s_;
  const Exposure &e_;
  Axes middle_;
  FramePoint origin_; ///< where the telescope points: the middle, but for its error
  bool is_mirrored_;
};

/// "frame_000012.fits", of further objects "frame_2_000012.fits".
std::string frame_name(std::uint32_t object, std::uint32_t exposure);
/// A finished exposure with what its header says.
FitsImage fits_of(const Setup &setup, const Exposure &exposure, const Recorded &recorded);

} // namespace umov::jobs
