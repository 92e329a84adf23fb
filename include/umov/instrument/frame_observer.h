#pragma once
// Exposures as frames, and counts from them.

#include <umov/instrument/frame_photometry.h>
#include <umov/instrument/observe.h>
#include <umov/instrument/trail_slices.h>

namespace umov {

/// The object during a part of an exposure.
struct FrameMoment {
  FramePoint at;       ///< its image
  double weight = 1;   ///< part of the exposure
  double offset_s = 0; ///< from its middle
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
  bool cuts_trail = false; ///< counts also of pieces of the trail, each as long as a star is wide
};

/// A piece of a trail.
struct FramedSlice {
  std::vector<double> weight;          ///< of the object's moments in its light, sum 1
  double offset_s = 0;                 ///< mean time of that light, from the middle of the exposure
  std::vector<ChannelCounts> channels; ///< counts - sky = row . S of those moments' mean
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
  std::vector<FramedSlice> slices;   ///< where they are asked for
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
