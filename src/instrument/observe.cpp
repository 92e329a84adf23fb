#include <umov/instrument/observe.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/optics/band.h>
#include <umov/photometry/radiometry.h>

namespace umov {
namespace {

constexpr double planck_j_s = 6.62607015e-34, light_m_s = 299792458; // exact, SI 2019

/// Random streams of one exposure.
enum Stream : std::uint32_t { Light = 0, Sky = 1, Air = 2 };

} // namespace

Result<BandResponse> narrow_band(std::string name, double nm, double width_nm) {
  UMOV_ASSIGN(sun, solar_irradiance(Wavelength::nm(nm)));
  BandResponse out{std::move(name), {nm}, {1}, nm, sun, 0, 0};
  out.photons_per_flux = width_nm * nm * 1e-9 / (planck_j_s * light_m_s);
  out.zero_flux = std::pow(10, 0.4 * ab_magnitude(1, Wavelength::nm(nm)));
  return out;
}

Result<BandResponse> curve_band(const Passband &curve) {
  UMOV_ASSIGN(sun, sunlight_in(curve));
  UMOV_ASSIGN(zero, zero_irradiance(curve, MagnitudeSystem::AB));
  const double pivot = pivot_nm(curve);
  return BandResponse{curve.name, {pivot}, {1}, pivot, sun.value, ab_zero_photons(curve) / zero,
                      zero};
}

Result<BandObserver> BandObserver::make(const Instrument &instrument, BandResponse band,
                                        const ObservingConditions &conditions,
                                        const std::vector<std::complex<double>> &mirror_eta) {
  if (const auto &table = conditions.air.measured;
      table && (table->nm.empty() || table->nm.size() != table->mag.size()))
    return fail(ErrorCode::BadInput,
                fmt::format("measured extinction of {} wavelengths and {} magnitudes: as many of "
                            "both, one or more, were expected",
                            table->nm.size(), table->mag.size()));
  BandObserver out;
  out.instrument_ = instrument;
  out.conditions_ = conditions;
  const double area = collecting_area_m2(instrument.telescope);
  for (std::size_t k = 0; k < band.nm.size(); ++k) {
    UMOV_ASSIGN(throughput, value_at(instrument.telescope.throughput, Wavelength::nm(band.nm[k]),
                                     "telescope.throughput"));
    out.rate_.push_back(area * throughput * band.photons_per_flux * band.weight[k]);
  }
  out.mirror_eta_ = mirror_eta;
  if (instrument.telescope.port != TelescopePort::Train)
    for (const std::complex<double> &eta : mirror_eta)
      out.mirror_.push_back(mirror_element(eta, std::sqrt(0.5)));
  out.band_ = std::move(band);
  out.pixel_arcsec_ = pixel_scale_arcsec(instrument.telescope, instrument.detector.pixel_um);
  return out;
}

InstrumentMueller BandObserver::port(std::size_t node, Angle altitude, Angle azimuth) const {
  const TelescopePort where = instrument_.telescope.port;
  if (where == TelescopePort::Cassegrain || mirror_eta_.empty())
    return identity_element();
  if (where == TelescopePort::Train) {
    const std::size_t mirrors = port_mirrors(instrument_.telescope);
    return trace_train(instrument_.telescope.train,
                       std::span(mirror_eta_).subspan(node * mirrors, mirrors), altitude, azimuth)
        .matrix;
  }
  return nasmyth_port(mirror_[node],
                      where == TelescopePort::NasmythRight ? NasmythSide::Right : NasmythSide::Left,
                      altitude);
}

Stokes<InstrumentAxes> BandObserver::at_polarimeter(std::size_t node, const Stokes<SkyNorth> &s,
                                                    Angle altitude, Angle axis_zenith,
                                                    Angle azimuth) const {
  if (mirror_eta_.empty())
    return rotate_to<InstrumentAxes>(s, axis_zenith);
  // Behind mirrors the x axis is counted from what stands there: at a Nasmyth focus the vertical.
  const Stokes<InstrumentAxes> up{s.i, s.q, s.u, s.v};
  return axes_turned(axis_zenith) * (port(node, altitude, azimuth) * up);
}

Result<void> BandObserver::prepare(const PolarimeterState &state) {
  Channels channels;
  for (const double nm : band_.nm) {
    UMOV_ASSIGN(one, polarimeter_channels(instrument_.polarimeter, state, nm));
    channels.push_back(std::move(one));
  }
  channels_[{state.analyser_deg, state.plate_deg, state.plate_turn_deg}] = std::move(channels);
  return {};
}

const BandObserver::Channels *BandObserver::channels_of(const PolarimeterState &state) const {
  const auto found = channels_.find({state.analyser_deg, state.plate_deg, state.plate_turn_deg});
  return found == channels_.end() ? nullptr : &found->second;
}

double BandObserver::fwhm_arcsec(double airmass) const {
  return seeing_fwhm_arcsec(conditions_.seeing, band_.pivot_nm, airmass);
}

double BandObserver::pixels_within(double radius_fwhm, double airmass, double trail_px) const {
  const double radius = radius_fwhm * fwhm_arcsec(airmass) / pixel_arcsec_;
  const double parts = pixel_parts(instrument_.polarimeter);
  // No less than a pixel is read of each channel: of lenses whose pixels are wider than stars, sky
  // and reading are those of a whole one, and the ring about it is as much wider.
  const double ratio = radius_fwhm / conditions_.aperture_fwhm;
  const double beside_trail = 2 * std::max(radius, ratio * std::sqrt(parts / pi)) * trail_px;
  return std::max(pi * radius * radius / parts, ratio * ratio) + beside_trail / parts;
}

double BandObserver::aperture_pixels(double airmass, double trail_px) const {
  return pixels_within(conditions_.aperture_fwhm, airmass, trail_px);
}

double BandObserver::sky_pixels(double airmass, double trail_px) const {
  return pixels_within(conditions_.sky_outer_fwhm, airmass, trail_px) -
         pixels_within(conditions_.sky_inner_fwhm, airmass, trail_px);
}

double BandObserver::rate_per_flux() const {
  double out = 0;
  for (const double rate : rate_)
    out += rate;
  return out;
}

double BandObserver::mean_transmission(double airmass) const {
  double sum = 0;
  for (std::size_t k = 0; k < band_.nm.size(); ++k)
    sum += rate_[k] * transmission(band_.nm[k], conditions_.air, airmass);
  return sum / rate_per_flux();
}

double BandObserver::port_transmission(Angle altitude, Angle azimuth) const {
  double sum = 0;
  for (std::size_t k = 0; k < band_.nm.size(); ++k)
    sum += rate_[k] * port(k, altitude, azimuth).m[0][0];
  return sum / rate_per_flux();
}

double BandObserver::scintillation_sd(double exposure_s, double airmass, double rate_rad_s) const {
  if (!conditions_.scintillation)
    return 0;
  return slewing_scintillation_sd(*conditions_.scintillation, instrument_.telescope.aperture_m,
                                  exposure_s, airmass,
                                  conditions_.has_slewing_factor ? rate_rad_s : 0);
}

double BandObserver::peak_share(double airmass, double trail_px) const {
  const double width = fwhm_arcsec(airmass) / pixel_arcsec_;
  const double sharp = peak_along(conditions_.seeing.profile, trail_px / width);
  // No pixel has more of a trail than the time for which it passes over it.
  return std::min(1 / std::max(1.0, trail_px), sharp / (width * width));
}

void BandObserver::draw(const ExposurePlan &plan, const ExposureLight &light, std::size_t channel,
                        double factor, double share, ChannelCounts &out) const {
  const Detector &d = instrument_.detector;
  const DrawKey key{conditions_.seed, conditions_.object, plan.index,
                    static_cast<std::uint32_t>(channel), Stream::Light};
  Draws draws(key);
  const double star = out.mean_star * factor;
  out.recorded = draw_aperture(d, star + out.mean_sky, out.pixels, out.seconds, draws);
  const CorrectedCount corrected = corrected_count(d, out.recorded, out.seconds);
  out.counts = corrected.electrons;
  out.excess2 = corrected.excess2;
  out.var_read = out.pixels * fixed_variance(d);
  const double ring = sky_pixels(light.airmass, light.trail_px);
  const double per_pixel = out.excess2 * out.mean_sky / out.pixels + fixed_variance(d);
  out.sky_err = out.pixels * std::sqrt(per_pixel / ring);
  DrawKey of_sky = key;
  of_sky.pixel = Stream::Sky;
  Draws sky_draws(of_sky);
  out.sky = out.mean_sky + out.sky_err * sky_draws.normal();
  const double lattice = pixel_parts(instrument_.polarimeter);
  const double peak = star * lattice / share * peak_share(light.airmass, light.trail_px) +
                      out.mean_sky / out.pixels;
  const double rate = (star + out.mean_sky) / out.seconds;
  out.is_saturated = corrected.is_saturated || peak > saturation_e(d) || is_paralysed(d, rate);
}

Result<std::vector<ChannelCounts>> BandObserver::expected(const ExposurePlan &plan,
                                                          const ExposureLight &light, double share,
                                                          double arcsec2) const {
  const Channels *channels = channels_of(plan.state);
  if (channels == nullptr)
    return fail(ErrorCode::Internal, "a state of the polarimeter was not prepared");
  const Polarimeter &polarimeter = instrument_.polarimeter;
  const InstrumentMueller own = instrumental_polarization(polarimeter.q0, polarimeter.u0);
  std::vector<ChannelCounts> out(channels->front().size());
  for (std::size_t k = 0; k < band_.nm.size(); ++k) {
    const double bare = rate_[k] * plan.exposure_s;
    const double through = transmission(band_.nm[k], conditions_.air, light.airmass);
    const auto sky = at_polarimeter(k, light.sky, light.altitude, light.axis_zenith, light.azimuth);
    const InstrumentMueller from_sky = axes_turned(light.axis_zenith) *
                                       port(k, light.altitude, light.azimuth) *
                                       axes_turned(light.zenith);
    for (std::size_t c = 0; c < out.size(); ++c) {
      const PolarimeterChannel &channel = (*channels)[k][c];
      const StokesRow real = channel.row * own;
      out[c].mean_star += bare * through * share * respond(real, light.flux[k]);
      out[c].mean_sky += bare * arcsec2 * respond(real, sky);
      out[c].row = out[c].row + (channel.row * from_sky) * (bare * through * share);
    }
  }
  const double sd = scintillation_sd(plan.exposure_s, light.airmass, light.rate_rad_s);
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c].channel = (*channels)[0][c].name;
    out[c].analyser_deg = (*channels)[0][c].analyser_deg;
    out[c].scintillation = sd;
    out[c].seconds = plan.exposure_s * (*channels)[0][c].time_share;
  }
  return out;
}

double BandObserver::transparency(const ExposurePlan &plan, const ExposureLight &light,
                                  std::size_t channel) const {
  const double sd = scintillation_sd(plan.exposure_s, light.airmass, light.rate_rad_s);
  const bool is_apart = instrument_.polarimeter.has_separate_pupils;
  const auto pupil = is_apart ? static_cast<std::uint32_t>(channel) : 0;
  Draws air({conditions_.seed, conditions_.object, plan.index, pupil, Stream::Air});
  const double variance = std::log1p(sd * sd); // of the logarithm, for sd to be the factor's
  return light.transparency *
         (sd > 0 ? std::exp(std::sqrt(variance) * air.normal() - variance / 2) : 1);
}

Result<std::vector<ChannelCounts>> BandObserver::observe(const ExposurePlan &plan,
                                                         const ExposureLight &light) const {
  const double width = fwhm_arcsec(light.airmass) / pixel_arcsec_;
  const double share =
      share_along(conditions_.seeing.profile, conditions_.aperture_fwhm, light.trail_px / width);
  const double pixels = aperture_pixels(light.airmass, light.trail_px);
  const double arcsec2 =
      pixels * pixel_parts(instrument_.polarimeter) * pixel_arcsec_ * pixel_arcsec_;
  UMOV_ASSIGN(out, expected(plan, light, share, arcsec2));
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c].pixels = pixels;
    out[c].mean_sky += instrument_.detector.dark_e_s * out[c].seconds * pixels;
    draw(plan, light, c, transparency(plan, light, c), share, out[c]);
  }
  return out;
}

} // namespace umov
