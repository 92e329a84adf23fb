#pragma once
// Pictures of an object as the observer sees it.

#include <optional>
#include <string>
#include <umov/jobs/monitor.h>
#include <umov/jobs/requests.h>
#include <umov/picture/keyframe.h>
#include <vector>

namespace umov::jobs {

/// What is shown of a scenario, from where, and how large.
struct RenderRequest {
  /// What a pixel tells.
  enum class Shade { Intensity, Polarization, PositionAngle, Material, Colour };
  /// What is shown: one band's, or three bands as blue, green, red (Colour).
  Shade shade = Shade::Intensity;
  /// An OpenEXR file with I, Q, U, V of every band, instead of a PNG file with the shade.
  bool is_exr = false;
  std::string band;                 ///< of the picture; "": the middle one
  std::size_t object = 0;           ///< into the scenario's objects
  std::optional<KeyFrameView> view; ///< seen so, instead of along the scenario's orbit
  std::optional<Epoch<Utc>> time;   ///< on the orbit; absent: the brightest of the first pass
  std::size_t frames = 1;           ///< of the first pass: more than one is an animated PNG
  double frames_per_s = 10;
  std::uint32_t side = 512;  ///< pixels
  std::uint32_t samples = 3; ///< rays per pixel and axis
  std::size_t paths = 16;    ///< per ray, of light that touched several surfaces
  double half_width_m = 0;   ///< of the picture; 0: the whole object
};

/// A picture, or several of them in one file.
struct Rendered {
  std::string bytes; ///< the file
  std::size_t pictures = 0;
  double width_m = 0;              ///< of a picture
  std::string first_utc, last_utc; ///< "" without an orbit
};

/// Takes the pictures that a request asks for. Usage for what does not go together; Nothing if no
/// epoch of the scenario's span is lit; Interrupted after a stop.
Result<Rendered> render(const Scenario &scenario, const RenderRequest &request,
                        const JobOptions &options, const Monitor &monitor,
                        Diagnostics &diagnostics);

} // namespace umov::jobs
