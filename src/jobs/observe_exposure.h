#pragma once
// Private: an observation as it is carried out, exposure by exposure.

#include "jobs/observe_plan.h"
#include "jobs/observe_sky.h"

#include <optional>
#include <umov/atmosphere/refraction.h>
#include <umov/instrument/exposure.h>
#include <umov/instrument/frame_observer.h>
#include <umov/io/stars_file.h>
#include <umov/jobs/monitor.h>
#include <umov/light/light_model.h>
#include <umov/observation/track.h>

namespace umov::jobs {

/// What an exposure is made of, before anything is computed.
struct Exposure {
  PlannedExposure planned;
  ObservingGeometry middle;
  Epoch<Utc> stamp; ///< as the clock of the telescope says
  double cloud = 1;
};

/// Everything of one object that does not change from exposure to exposure.
struct Setup {
  const Scenario &scenario;
  const ScenarioObservation &observation;
  std::vector<std::vector<BandTerm>> terms; ///< [band]: nodes of the light that it is summed from
  const Track &track;
  std::vector<BandObserver> observers; ///< per band
  std::vector<double> zero_flux;       ///< per band, of magnitude 0 in the scenario's system
  std::vector<ExposureNode> nodes;
  std::string object;
  SurfaceAir surface;
  SkyModel sky;
  std::vector<FieldStar> stars; ///< of the frames' field
  PixelImages &images;
  unsigned threads = 0;
};

/// A piece of a trail, or all of an exposure where none is cut.
struct RecordedSlice {
  double offset_s = 0; ///< from the middle of the exposure
  std::vector<ChannelCounts> channels;
  Stokes<SkyNorth> truth;
};

/// One exposure, finished.
struct Recorded {
  std::vector<ChannelCounts> channels;
  Stokes<SkyNorth> truth;            ///< in the frame of the files [W m-2 nm-1]
  std::vector<RecordedSlice> slices; ///< where trails are cut
  Angle axis;                        ///< of the instrument's x axis in that frame
  double airmass = 0, k_mag = 0, rate_rad_s = 0;
  bool is_rolled = false;               ///< a rolling shutter exposes its trail longer or shorter
  std::optional<FramedExposure> frames; ///< where they are made
  std::optional<Error> error;
};

/// The light of all nodes of some exposures.
struct LitBlock {
  std::vector<TrackPoint> points; ///< [exposure * nodes + node]
  StokesTable table;
};

/// Position angle of the zenith in the frame of the files.
Angle zenith_in(PolarizationFrame frame, const ObservingGeometry &g);
/// Of the instrument's x axis in the focus, from the zenith.
Angle x_axis_from_zenith(const Instrument &instrument, const ObservingGeometry &g);
/// Of `exposures`; Interrupted when `monitor` says so.
Result<LitBlock> light_of(const Setup &setup, const LightModel &light,
                          std::span<const Exposure> exposures, const Monitor &monitor);
/// What is recorded of exposure `number` of a block.
Recorded record(const Setup &setup, const Exposure &exposure, std::size_t number,
                const LitBlock &lit);

} // namespace umov::jobs
