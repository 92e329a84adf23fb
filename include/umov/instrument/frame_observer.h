#pragma once
// Exposures as frames, and counts from them.

#include <umov/instrument/frame_photometry.h>
#include <umov/instrument/observe.h>

namespace umov {

/// The object during a part of an exposure.
struct FrameMoment {
  FramePoint at;     ///< its image
  double weight = 1; ///< part of the exposure
  /// At each node, as `ExposureLight::flux`.
  std::vector<Stokes<InstrumentAxes>> flux;
};

/// A star of the field: unpolarized, of sunlight's colour.
struct FrameStar {
  std::vector<FramePoint> path; ///< parts of the exposure with these weights
  std::vector<double> weight;
  double flux = 0; ///< above the air, photon-weighted mean [W m-2 nm-1]
};

/// How counts are taken from a frame.
enum class FramePhotometry { Aperture, Image }; ///< summed, or fitted by the star's image

/// What falls on a frame.
struct FramePlan {
  int columns = 256, rows = 256;
  std::vector<FrameMoment> object;
  std::vector<FrameStar> stars;
  FramePhotometry photometry = FramePhotometry::Aperture;
};

/// One detector, beam or phase: a mosaic has one for all its orientations.
struct FramePlane {
  std::string channel;
  RawFrame frame;
};

/// An exposure as frames with what was found in them.
struct FramedExposure {
  std::vector<FramePlane> planes;
  std::vector<ChannelCounts> channels;
  bool has_star_in_aperture = false; ///< other light of more than a hundredth of the object's
  bool is_cut = false;               ///< the aperture reaches over the frame's edge
};

/// Draws the frames of one exposure and takes counts from them; of a state that was prepared, from
/// any thread. Rows are those of the light within the aperture, without what a mosaic's sampling
/// does to its orientations: that is in the counts.
Result<FramedExposure> observe_frames(const BandObserver &observer, PixelImages &images,
                                      const ExposurePlan &plan, const ExposureLight &light,
                                      const FramePlan &scene);

} // namespace umov
