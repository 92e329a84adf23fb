#pragma once
// When the objects of a file pass over a site, and in which light.

#include <optional>
#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/table.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/requests.h>
#include <umov/lightcurve/pass_light.h>
#include <umov/orbit/passes.h>
#include <vector>

namespace umov::jobs {

/// What the objects are taken for: those of a scene by their catalogue number, or all the same
/// simple body. Neither: nothing is said about their light.
struct PassModel {
  /// A simple body that stands for every object; a cube flies in nadir attitude.
  enum class Body { None, Sphere, Cube };
  std::optional<Scenario> scene; ///< an object without orbit stands for all others
  Body body = Body::None;
  double size_m = 1;    ///< of the body: radius, or edge
  std::string material; ///< of the body: a name or a file
  std::string band;     ///< of the magnitudes; "": the middle one
};

/// What comes first: the earliest, the brightest, or what stands highest while visible. Passes
/// without a magnitude, or never visible, come last.
enum class PassOrder { Rise, Magnitude, Altitude };

/// Orbits, a site, a span, and what a pass is.
struct PassesRequest {
  std::string orbit;      ///< file of elements or of an ephemeris
  std::vector<int> norad; ///< empty: all objects of the file
  Site site;
  Epoch<Utc> start{}, stop{};
  Angle altitude_min = Angle::degrees(10);
  Angle sun_altitude_max = Angle::degrees(-6); ///< the sky is dark below it
  ShadowModel shadow = ShadowModel::Ellipsoid;
  bool is_visible_only = false; ///< sunlit in a dark sky for some time
  /// Only passes that get as bright as this while sunlit; those without a magnitude are left out.
  std::optional<double> magnitude_max;
  PassOrder order = PassOrder::Rise;
  bool keep_going = false; ///< bad sets of the file are reported, the others kept
  PassModel model;
};

/// A pass, whose it is and its light.
struct ObjectPass {
  std::size_t object = 0; ///< into PassesResult::orbits
  SitePass pass;
  PassBrightness light; ///< where a model says what the object is
};

/// Passes found, and how the search ended.
struct PassesResult {
  std::vector<Trajectory> orbits; ///< of the objects that were to be searched
  std::vector<ObjectPass> found;  ///< in PassesRequest::order
  std::string model;              ///< what the objects were taken for, in words
  MagnitudeSystem magnitudes = MagnitudeSystem::AB;
  bool has_air = false;         ///< the scene has an atmosphere: magnitudes behind it too
  std::optional<Error> stopped; ///< Interrupted: passes of some objects are not there
};

/// Searches all objects side by side, or those that JobOptions::part has of them. Usage where
/// magnitudes are asked about and no model gives them; Nothing if there is no pass; Physics if
/// every orbit ends within the span; warnings tell of old elements and of objects that failed.
Result<PassesResult> passes(const PassesRequest &request, const JobOptions &options,
                            const Monitor &monitor, Diagnostics &diagnostics);

/// A row per pass, with what was asked in the header.
Table passes_table(const PassesRequest &request, const PassesResult &result);

/// A page with the tracks over the site's sky, coloured by magnitude, sunlit parts full and
/// shadowed ones dotted, and a table that can be sorted. The best thousand where there are more.
std::string sky_chart(const PassesRequest &request, const PassesResult &result);

} // namespace umov::jobs
