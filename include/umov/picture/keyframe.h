#pragma once
// Pictures of the object as the observer sees it: parallel rays, celestial north up, east left.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <umov/core/result.h>
#include <umov/light/between_light.h>
#include <umov/light/light_model.h>
#include <umov/picture/channel.h>
#include <umov/scene/articulation.h>
#include <umov/scene/scene.h>
#include <umov/shape/occluder.h>
#include <vector>

namespace umov {

/// Where the Sun and the observer stand, and what is up in the picture (any vector not along the
/// line of sight; its part across the line of sight counts).
struct KeyFrameView {
  Pose pose;
  Vec3<Body> up;
};

/// Which band, how fine, and how well lit.
struct KeyFrameOptions {
  std::uint32_t size = 320;  ///< pixels per side, 1..4096
  std::uint32_t samples = 2; ///< rays per pixel and axis, 1..8
  std::size_t band = 0;      ///< into Scene::bands
  double half_width_m = 0;   ///< half the picture's side; 0: 1.04 bounding radii of the mesh
  unsigned threads = 0;      ///< the pixels do not depend on it
  std::size_t bounces = 1;   ///< surfaces that the light may touch, 1..64
  std::size_t paths = 16;    ///< per ray, of light that touched several; their noise shows
  std::uint64_t seed = 0;    ///< of those paths
  const std::atomic<bool> *cancel = nullptr; ///< Interrupted where it comes true
};

/// What one ray found.
struct KeyFrameSample {
  std::uint32_t material = no_index; ///< into KeyFrameRaster::materials; no_index: sky
  bool is_lit = false;               ///< the Sun reaches the point
  float radiance = 0;                ///< [1/sr] per unit solar irradiance
  float p = 0;                       ///< linear degree of that light; NaN where there is none
  float q = 0, u = 0, v = 0; ///< fractions of it in the scattering frame; 0 where there is none
  float facing = 0;          ///< cosine of the shown normal to the observer, 0..1
};

/// The picture's pixels before any shading.
struct KeyFrameRaster {
  std::uint32_t side = 0; ///< samples per side: size * samples
  std::uint32_t samples = 1;
  double half_width_m = 0;
  /// Position angle of +Q of the scattering frame in the picture, from up over left; 0 where Sun
  /// and observer are in line.
  double pa_scat_rad = 0;
  std::vector<std::string> materials; ///< names, in order of first use in the scene
  std::vector<KeyFrameSample> points; ///< [row * side + column], rows from the top
};

/// What the colours of a picture tell.
enum class KeyFrameShading { Intensity, Polarization, PositionAngle, Material };

/// Casts the rays of one picture. BadInput for sizes out of range, a band that is not there or an
/// `up` along the line of sight.
Result<KeyFrameRaster> trace_key_frame(const Scene &scene, const Occluder &occluder,
                                       const KeyFrameView &view, const KeyFrameOptions &options);
/// The same in several bands, with the rays cast once; `options.band` is not asked. `between`, of
/// the same scene: finds the light that touched several surfaces; null: there is none of it.
Result<std::vector<KeyFrameRaster>> trace_key_frames(const Scene &scene, const Occluder &occluder,
                                                     const KeyFrameView &view,
                                                     const KeyFrameOptions &options,
                                                     std::span<const std::size_t> bands,
                                                     const BetweenLight *between = nullptr);

/// A scene ready for pictures with its parts at any angles; it must outlive this.
class KeyFrameStage {
public:
  /// `bounces`: as in the options of the pictures to come; above 1 more has to be made ready.
  /// Throws as Occluder.
  explicit KeyFrameStage(const Scene &scene, std::vector<Joint> joints = {},
                         std::size_t bounces = 1, const std::atomic<bool> *cancel = nullptr);
  /// As trace_key_frames; no angles: as the mesh has its parts.
  [[nodiscard]] Result<std::vector<KeyFrameRaster>>
  trace(const KeyFrameView &view, const std::vector<double> &joint_angles_rad,
        const KeyFrameOptions &options, std::span<const std::size_t> bands) const;

private:
  const Scene &scene_;
  std::vector<Joint> joints_;
  Occluder still_;
  std::unique_ptr<BetweenLight> between_; ///< of the mesh as it is
};

/// The radiance shown as white: the 99th percentile over the lit points of all pictures, so that
/// one exposure holds for a whole series and a glint does not hide the rest. 1 if nothing is lit.
double common_exposure(std::span<const KeyFrameRaster> rasters);

/// Colours of a raster, 3 size size bytes. Intensity: grey by asinh(L / (0.02 white)), so faint
/// light stays visible; Polarization: the map of `polarization_scale`; PositionAngle: hue, once
/// round in 180 deg from up (red) over left, paler below p = 10 %; Material: its colour, darker
/// in shadow. What is seen but gives no light is slate blue, the sky is near black.
/// Of no use once `cancel` became true.
std::vector<std::uint8_t> shade(const KeyFrameRaster &raster, KeyFrameShading shading, double white,
                                const std::atomic<bool> *cancel = nullptr);

/// Puts a bar of the colours with its numbers into the lower left corner of a picture of p or of
/// the position angle; other and small pictures stay as they are.
void draw_colour_bar(std::span<std::uint8_t> rgb, std::uint32_t side, KeyFrameShading shading);

/// The object in colour, from rasters of one view in three bands: red, green, blue. Each channel is
/// compressed alike, so what is grey reflects all three alike. BadInput unless they fit. Of no use
/// once `cancel` became true.
Result<std::vector<std::uint8_t>> shade_colour(std::span<const KeyFrameRaster> red_green_blue,
                                               double white,
                                               const std::atomic<bool> *cancel = nullptr);

/// Channels of a raster averaged over the samples of each pixel: "I", "Q", "U", "V" [1/sr] per unit
/// solar irradiance, +Q along the picture's up and +U 45 deg from it to the left (IAU), and "A",
/// the share of the pixel that the object covers; names begin with `prefix`.
std::vector<PictureChannel> stokes_channels(const KeyFrameRaster &raster,
                                            const std::string &prefix);

/// What a polarizer lets through: radiance times (1 + q)/2, the field perpendicular to the
/// scattering plane, or (1 - q)/2, the field in it.
void apply_polarizer(KeyFrameRaster &raster, bool is_perpendicular);

} // namespace umov
