#pragma once
// Pictures of an object as the observer sees it.

#include <functional>
#include <optional>
#include <string>
#include <umov/jobs/index_range.h>
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
  std::size_t frames = 1;           ///< of the first pass: more than one is an animated PNG ...
  bool has_file_each = false;       ///< ... or a file for each of them
  JobPart part;                     ///< of the frames; less than all of OpenEXR files alone
  double frames_per_s = 10;
  std::uint32_t side = 512;  ///< pixels
  std::uint32_t samples = 3; ///< rays per pixel and axis
  std::size_t paths = 16;    ///< per ray, of light that touched several surfaces
  double half_width_m = 0;   ///< of the picture; 0: the whole object
};

/// Takes a file and the number of its frame, in order; frame 0 for a file that holds all.
using PictureSink = std::function<Result<void>(std::size_t frame, std::string &&bytes)>;

/// What was made.
struct Rendered {
  std::size_t pictures = 0;
  double width_m = 0;              ///< of a picture
  std::string first_utc, last_utc; ///< "" without an orbit
};

/// Takes the pictures that a request asks for and gives them to `sink`: an OpenEXR file when its
/// picture is made, PNG files when all are, since they share an exposure. Usage for what does not
/// go together; Nothing if no epoch of the scenario's span is lit; Interrupted after a stop.
Result<Rendered> render(const Scenario &scenario, const RenderRequest &request,
                        const PictureSink &sink, const JobOptions &options, const Monitor &monitor,
                        Diagnostics &diagnostics);

} // namespace umov::jobs
