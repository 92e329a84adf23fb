#pragma once
// The report of a run: one HTML file that needs no network.

#include <span>
#include <string>
#include <umov/core/result.h>
#include <umov/lightcurve/compute.h>
#include <utility>
#include <vector>

namespace umov {

/// q_scat of a surface of one material alone (B/A at half the phase angle, no body light), drawn
/// behind the light curve.
struct PureMaterialCurve {
  std::string material;
  std::size_t band = 0; ///< into LightCurve::bands
  std::vector<double> phase_deg, q_scat;
};

/// A picture of a key frame and what it shows.
struct ReportPicture {
  std::string label; ///< "brightness"
  std::string png;   ///< bytes of the file
};

/// The object at one epoch.
struct ReportKeyFrame {
  std::string time; ///< UTC
  std::string caption;
  double width_m = 0;               ///< side of the pictures
  double sun_right = 0, sun_up = 0; ///< unit vector to the Sun, its part in the picture plane
  std::vector<ReportPicture> pictures;
  double white = 0; ///< radiance that is white in the picture of brightness; 0: not told
};

/// One picture of the object as it turns.
struct ReportFilmFrame {
  std::string time; ///< UTC
  std::string png;  ///< bytes of the file
};

/// A point of a whole pass, shadowed parts included, for the sky track.
struct SkyTrackPoint {
  Epoch<Utc> time{};
  std::string pass_id;
  Angle azimuth, altitude;
  double sunlit = 1;
};

/// A period that the attitude's law has: "spin", "precession", "rotation in the body".
struct TurningPeriod {
  std::string name;
  double seconds = 0;
};

/// All that the report shows.
struct ReportInput {
  const LightCurve &curve;
  std::string title;
  Site site;
  PolarizationFrame frame = PolarizationFrame::Equatorial; ///< axes of q, u and pa
  std::vector<Pass> passes;
  std::vector<SkyTrackPoint> sky_track = {}; ///< empty: the epochs of the curve alone
  std::vector<PureMaterialCurve> pure_materials = {};
  std::vector<ReportKeyFrame> key_frames = {};
  std::vector<ReportFilmFrame> film = {};            ///< in order of time; empty: none is shown
  std::vector<std::string> key_frame_materials = {}; ///< material_names(scene): fixes the colours
  std::vector<std::pair<std::string, std::string>> manifest = {}; ///< shown as given, in order
  std::vector<TurningPeriod> turning = {}; ///< not empty: periodogram and folded curve are shown
  std::vector<std::string> warnings = {};
  std::vector<std::string> conventions = {}; ///< one sentence each; empty: the standard ones
};

/// Most epochs that go into one page; a longer curve is thinned evenly and the page says so.
inline constexpr std::size_t report_max_epochs = 20'000;

/// True if this build has the plotting script.
bool has_report();

/// The page. The bytes depend on the input alone. Internal if this build has no plotting script,
/// if the curve's arrays do not fit together or a pure-material curve names a band that is missing.
Result<std::string> make_report(const ReportInput &input);

/// B/A against phase angle, 0..180 deg in steps of 1 deg, for each band of each material (by name,
/// the first of that name counts). Materials whose interface reflects nothing (n = 1) have none.
std::vector<PureMaterialCurve> pure_material_curves(std::span<const Surface> surfaces,
                                                    const BandGrid &grid);

} // namespace umov
