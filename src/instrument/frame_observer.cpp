#include <fmt/format.h>
#include <umov/instrument/frame_observer.h>

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

/// Electrons of the whole star, channel by channel, of one moment if it lasted all the exposure.
using ChannelLight = std::vector<double>;

/// An exposure that is being made.
class Exposing {
public:
  Exposing(const BandObserver &observer, const PixelImage &image, const ExposurePlan &plan,
           const ExposureLight &light, const FramePlan &scene)
      : o_(observer), image_(image), plan_(plan), light_(light), scene_(scene),
        is_mosaic_(o_.instrument().polarimeter.type == PolarimeterType::Mosaic) {}

  Result<FramedExposure> make();

private:
  Result<void> expect();
  [[nodiscard]] std::vector<FramePoint> path() const;
  [[nodiscard]] LatticeValues lattice(const ChannelLight &of, std::size_t plane,
                                      double factor) const;
  [[nodiscard]] PixelFrame stars(std::size_t plane) const;
  [[nodiscard]] PixelFrame object(std::size_t plane) const;
  [[nodiscard]] double share(const FrameAperture &aperture, const PixelFrame &others) const;
  void cut(const FrameAperture &aperture);
  void measure_slices(std::size_t plane, const RawFrame &raw, const std::array<FrameSum, 4> &sums,
                      FramedExposure &out) const;
  void measure(std::size_t plane, const RawFrame &raw, const PixelFrame &others,
               const FrameAperture &aperture, FramedExposure &out) const;
  void fit(std::size_t plane, const RawFrame &raw, FramedExposure &out) const;
  void put(ChannelCounts &c, double share) const;
  void take(const FrameSum &sum, ChannelCounts &c) const;

  const BandObserver &o_;
  const PixelImage &image_;
  const ExposurePlan &plan_;
  const ExposureLight &light_;
  const FramePlan &scene_;
  bool is_mosaic_;
  std::vector<ChannelCounts> whole_;  ///< of all of the star, and of the sky in a pixel
  std::vector<ChannelLight> moments_; ///< [moment][channel]
  ChannelLight of_unit_;              ///< of an unpolarized flux of 1
  std::vector<double> transparency_;
  TrailSlices slices_;
  std::vector<FramedSlice> pieces_; ///< without channels
  /// Of a star that stood in all moments as long, in each: as if all pixels were of the place.
  std::vector<LatticeValues> piece_share_;
};

Result<void> Exposing::expect() {
  // A place of a mosaic has a quarter of the pixels and of the light.
  const double arcsec2 = o_.pixel_arcsec() * o_.pixel_arcsec() * (is_mosaic_ ? 4 : 1);
  UMOV_ASSIGN(whole, o_.expected(plan_, light_, 1, arcsec2));
  whole_ = std::move(whole);
  ExposureLight part = light_;
  for (const FrameMoment &moment : scene_.object) {
    part.flux = moment.flux;
    UMOV_ASSIGN(now, o_.expected(plan_, part, 1, 0));
    moments_.emplace_back();
    for (const ChannelCounts &c : now)
      moments_.back().push_back(c.mean_star);
  }
  if (!scene_.stars.empty()) {
    part.flux.assign(light_.flux.size(), {1, 0, 0, 0});
    UMOV_ASSIGN(unit, o_.expected(plan_, part, 1, 0));
    for (const ChannelCounts &c : unit)
      of_unit_.push_back(c.mean_star);
  }
  for (std::size_t c = 0; c < whole_.size(); ++c) {
    whole_[c].mean_sky += o_.instrument().detector.dark_e_s * whole_[c].seconds;
    transparency_.push_back(o_.transparency(plan_, light_, c));
  }
  return {};
}

std::vector<FramePoint> Exposing::path() const {
  std::vector<FramePoint> out;
  constexpr std::size_t pieces = 8; // a trail is all but straight
  const std::size_t n = scene_.object.size(),
                    step = std::max<std::size_t>(1, (n + pieces - 1) / pieces);
  for (std::size_t k = 0; k < n; k += step)
    out.push_back(scene_.object[k].at);
  out.push_back(scene_.object.back().at);
  const bool stands = std::ranges::all_of(out, [&](const FramePoint &p) {
    return std::hypot(p.x - out.front().x, p.y - out.front().y) < .01;
  });
  if (stands)
    out.resize(1);
  return out;
}

/// Light of a star in the plane's pixels, as if each place had them all.
LatticeValues Exposing::lattice(const ChannelLight &of, std::size_t plane, double factor) const {
  LatticeValues out;
  for (std::size_t p = 0; p < 4; ++p)
    out[p] =
        factor * (is_mosaic_ ? 4 * of[p] * transparency_[p] : of[plane] * transparency_[plane]);
  return out;
}

PixelFrame Exposing::object(std::size_t plane) const {
  PixelFrame out = PixelFrame::blank(scene_.columns, scene_.rows);
  LatticeValues waiting{}; // moments at one place are added as one
  for (std::size_t k = 0; k < scene_.object.size(); ++k) {
    const FrameMoment &moment = scene_.object[k];
    const LatticeValues light = lattice(moments_[k], plane, moment.weight);
    for (std::size_t p = 0; p < 4; ++p)
      waiting[p] += light[p];
    const bool stays =
        k + 1 < scene_.object.size() && std::hypot(scene_.object[k + 1].at.x - moment.at.x,
                                                   scene_.object[k + 1].at.y - moment.at.y) < 1e-3;
    if (stays)
      continue;
    image_.add(out, moment.at.x, moment.at.y, waiting);
    waiting = {};
  }
  return out;
}

PixelFrame Exposing::stars(std::size_t plane) const {
  if (scene_.stars.empty())
    return {};
  PixelFrame out = PixelFrame::blank(scene_.columns, scene_.rows);
  for (const FrameStar &star : scene_.stars)
    for (std::size_t k = 0; k < star.path.size(); ++k)
      image_.add(out, star.path[k].x, star.path[k].y,
                 lattice(of_unit_, plane, star.flux * star.weight[k]));
  return out;
}

/// Of the object's light, in counts less sky, if all pixels answered alike.
double Exposing::share(const FrameAperture &aperture, const PixelFrame &others) const {
  PixelFrame out = PixelFrame::blank(scene_.columns, scene_.rows);
  double whole = 0;
  for (std::size_t k = 0; k < scene_.object.size(); ++k) {
    double light = 0;
    for (const double of_channel : moments_[k])
      light += of_channel * scene_.object[k].weight;
    whole += light;
    image_.add(out, scene_.object[k].at.x, scene_.object[k].at.y, {light, light, light, light});
  }
  if (whole > 0)
    return share_of(out, whole, aperture, others);
  image_.add(out, scene_.object.front().at.x, scene_.object.front().at.y, {1, 1, 1, 1});
  return share_of(out, 1, aperture, others); // a dark object: as if it stood still
}

/// What counts of a part of the star's light mean.
void Exposing::put(ChannelCounts &c, double share) const {
  c.row = c.row * share;
  c.mean_star *= share;
}

/// What pixels hold.
void Exposing::take(const FrameSum &sum, ChannelCounts &c) const {
  const Detector &d = o_.instrument().detector;
  c.counts = sum.electrons;
  c.recorded = sum.adu / adu_per_electron(d);
  c.sky = sum.sky;
  c.sky_err = sum.sky_sd;
  c.pixels = sum.pixels;
  c.mean_sky *= sum.pixels;
  c.var_read = sum.pixels * fixed_variance(d);
  c.excess2 = excess_variance(d);
  c.is_saturated = sum.is_saturated;
}

void Exposing::measure(std::size_t plane, const RawFrame &raw, const PixelFrame &others,
                       const FrameAperture &aperture, FramedExposure &out) const {
  const Detector &d = o_.instrument().detector;
  const auto sums = sum_frame(d, raw, aperture, is_mosaic_, others);
  const double part = share(aperture, others);
  for (std::size_t p = 0; p < (is_mosaic_ ? 4u : 1u); ++p) {
    ChannelCounts c = whole_[is_mosaic_ ? p : plane];
    put(c, part);
    take(sums[p], c);
    out.channels.push_back(std::move(c));
  }
  if (scene_.cuts_trail)
    measure_slices(plane, raw, sums, out);
}

/// Which light each piece holds. A cut across a mosaic gives its places unequal numbers of pixels,
/// which rows know. Wings that reach the ring, some 4e-5 of the light, are taken for sky.
void Exposing::cut(const FrameAperture &aperture) {
  slices_ = cut_trail(aperture, scene_.columns, scene_.rows, image_.fwhm_px());
  const std::size_t moments = scene_.object.size();
  double all = 0;
  for (const FrameMoment &moment : scene_.object)
    all += moment.weight;
  pieces_.assign(slices_.count, {std::vector<double>(moments, 0), 0, {}});
  piece_share_.assign(slices_.count, {});
  std::vector<double> whole(slices_.count, 0);
  for (std::size_t n = 0; n < moments; ++n) {
    const FrameMoment &moment = scene_.object[n];
    const std::vector<LatticeValues> shares = shares_in(slices_, image_, moment.at);
    for (std::size_t k = 0; k < slices_.count; ++k)
      for (std::size_t p = 0; p < 4; ++p) {
        const double part = moment.weight / all * shares[k][p];
        pieces_[k].weight[n] += part;
        pieces_[k].offset_s += part * moment.offset_s;
        whole[k] += part;
        piece_share_[k][is_mosaic_ ? p : 0] += is_mosaic_ ? 4 * part : part;
      }
  }
  for (std::size_t k = 0; k < slices_.count; ++k) {
    const double share = std::max(whole[k], 1e-300);
    pieces_[k].offset_s /= share;
    for (double &weight : pieces_[k].weight)
      weight /= share;
  }
}

/// Channels of one plane into the pieces.
void Exposing::measure_slices(std::size_t plane, const RawFrame &raw,
                              const std::array<FrameSum, 4> &sums, FramedExposure &out) const {
  const Detector &d = o_.instrument().detector;
  if (out.slices.empty())
    out.slices = pieces_;
  const auto found = sum_slices(d, raw, slices_, is_mosaic_, sums);
  for (std::size_t k = 0; k < slices_.count; ++k)
    for (std::size_t p = 0; p < (is_mosaic_ ? 4u : 1u); ++p) {
      const std::size_t channel = is_mosaic_ ? p : plane;
      ChannelCounts c = whole_[channel];
      c.row = c.row * piece_share_[k][p];
      c.mean_star = 0;
      for (std::size_t n = 0; n < moments_.size(); ++n)
        c.mean_star += moments_[n][channel] * pieces_[k].weight[n] * piece_share_[k][p];
      take(found[k][p], c);
      out.slices[k].channels.push_back(std::move(c));
    }
}

void Exposing::fit(std::size_t plane, const RawFrame &raw, FramedExposure &out) const {
  const Detector &d = o_.instrument().detector;
  const double radius = o_.conditions().sky_outer_fwhm * image_.fwhm_px();
  const StarFit found = fit_star(d, raw, image_, scene_.object.front().at, radius, is_mosaic_);
  const double places = is_mosaic_ ? 4 : 1;
  for (std::size_t p = 0; p < (is_mosaic_ ? 4u : 1u); ++p) {
    ChannelCounts c = whole_[is_mosaic_ ? p : plane];
    c.counts = found.has_converged ? found.electrons[p] / places
                                   : std::numeric_limits<double>::quiet_NaN();
    c.recorded = c.counts;
    c.excess2 = excess_variance(d);
    // What a fit leaves beyond the star's own photons: sky, reading, and where it stands.
    c.var_read =
        std::max(0., found.variance[p] / (places * places) - c.excess2 * std::max(0., c.counts));
    c.pixels = std::pow(2 * std::floor(radius) + 1, 2) / places;
    c.mean_sky *= c.pixels;
    c.is_saturated = found.is_saturated;
    out.channels.push_back(std::move(c));
  }
}

Result<FramedExposure> Exposing::make() {
  UMOV_TRY(expect());
  const double width = image_.fwhm_px();
  const ObservingConditions &conditions = o_.conditions();
  const FrameAperture aperture{path(), conditions.aperture_fwhm * width,
                               conditions.sky_inner_fwhm * width,
                               conditions.sky_outer_fwhm * width};
  FramedExposure out;
  if (scene_.cuts_trail)
    cut(aperture);
  for (const FramePoint &p : aperture.path)
    out.is_cut = out.is_cut || p.x < aperture.radius || p.y < aperture.radius ||
                 p.x > scene_.columns - 1 - aperture.radius ||
                 p.y > scene_.rows - 1 - aperture.radius;
  const std::size_t planes = is_mosaic_ ? 1 : whole_.size();
  for (std::size_t plane = 0; plane < planes; ++plane) {
    PixelFrame light = object(plane);
    const PixelFrame others = stars(plane);
    if (!others.value.empty()) {
      const double own = light_in(light, aperture), foreign = light_in(others, aperture);
      out.has_star_in_aperture = out.has_star_in_aperture || foreign > .01 * own;
      for (std::size_t k = 0; k < light.value.size(); ++k)
        light.value[k] += others.value[k];
    }
    LatticeValues background;
    for (std::size_t p = 0; p < 4; ++p)
      background[p] = whole_[is_mosaic_ ? p : plane].mean_sky;
    const DrawKey key{conditions.seed, conditions.object, plan_.index,
                      static_cast<std::uint32_t>(plane), 0};
    RawFrame raw =
        draw_frame(o_.instrument().detector, light, background, whole_[plane].seconds, key);
    const bool is_fitted = scene_.photometry == FramePhotometry::Image && aperture.path.size() == 1;
    if (is_fitted)
      fit(plane, raw, out);
    else
      measure(plane, raw, others, aperture, out);
    out.planes.push_back({is_mosaic_ ? "mosaic" : whole_[plane].channel, std::move(raw)});
  }
  return out;
}

} // namespace

Result<FramedExposure> observe_frames(const BandObserver &observer, PixelImages &images,
                                      const ExposurePlan &plan, const ExposureLight &light,
                                      const FramePlan &scene) {
  if (scene.object.empty() || scene.columns < 1 || scene.rows < 1)
    return fail(ErrorCode::Internal, "a frame without pixels or object");
  const double fwhm_px = observer.fwhm_arcsec(light.airmass) / observer.pixel_arcsec();
  if (!(fwhm_px >= narrowest_image_px && fwhm_px <= widest_image_px))
    return fail(ErrorCode::BadInput,
                fmt::format("a star's image is {:.3g} px wide (a pixel is {:.3g} arcsec): frames "
                            "hold {} to {} px. Change atmosphere.seeing or the camera's pixels, or "
                            "take observation.level = \"aperture\".",
                            fwhm_px, observer.pixel_arcsec(), narrowest_image_px, widest_image_px));
  const PixelImage &image = images.of(fwhm_px);
  return Exposing(observer, image, plan, light, scene).make();
}

} // namespace umov
