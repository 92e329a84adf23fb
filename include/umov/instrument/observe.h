#pragma once
// From light above the air to counts, one exposure at a time.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <umov/atmosphere/air.h>
#include <umov/atmosphere/scintillation.h>
#include <umov/instrument/detector.h>
#include <umov/instrument/mirrors.h>
#include <umov/instrument/polarimeter.h>
#include <umov/instrument/telescope.h>
#include <umov/optics/passband.h>
#include <vector>

namespace umov {

/// Telescope, detector and polarimeter.
struct Instrument {
  std::string name, description, source, assumed;
  Telescope telescope;
  Detector detector;
  Polarimeter polarimeter;
};

/// What a band needs for counts. A detected photon is weighed at a few wavelengths, the nodes:
/// between them light is smooth once the Sun's spectrum is divided out.
struct BandResponse {
  std::string name;
  std::vector<double> nm, weight; ///< weights of the nodes in photons of sunlight, sum 1
  double pivot_nm = 0;
  double solar_mean = 0;       ///< of the Sun at 1 au, photon-weighted [W m-2 nm-1]
  double photons_per_flux = 0; ///< [s-1 m-2] of a photon-weighted mean of 1 W m-2 nm-1
  double zero_flux = 0;        ///< photon-weighted mean of AB magnitude 0 [W m-2 nm-1]
};
/// Widths where nobody says one [nm]: of a band that is one wavelength, behind an interference
/// filter, and of a filter such as V.
inline constexpr double line_width_nm = 10, filter_width_nm = 80;

/// A band of constant response over a width, as narrow filters are.
Result<BandResponse> narrow_band(std::string name, double nm, double width_nm);

/// A band with a curve, at its pivot wavelength alone: nodes and weights are the caller's to
/// choose.
Result<BandResponse> curve_band(const Passband &curve);

/// Circumstances of an observation that do not change with time.
struct ObservingConditions {
  Air air;
  Seeing seeing;
  std::optional<ScintillationSite> scintillation; ///< absent: none
  bool has_slewing_factor = false;
  double aperture_fwhm = 2; ///< radius that counts are summed in
  double sky_inner_fwhm = 4, sky_outer_fwhm = 6;
  std::uint64_t seed = 0;
  std::uint32_t object = 0; ///< of the random streams
};

/// One exposure as it is planned.
struct ExposurePlan {
  std::uint32_t index = 0;
  double exposure_s = 1;
  PolarimeterState state;
};

/// What arrives during an exposure.
struct ExposureLight {
  /// Mean over the exposure at each node, above the air, in the axes that the port hands out,
  /// the Sun's spectrum replaced by its mean in the band [W m-2 nm-1].
  std::vector<Stokes<InstrumentAxes>> flux;
  Stokes<SkyNorth> sky; ///< per square arc second, zenith axes [W m-2 nm-1 arcsec-2]
  double airmass = 1;
  Angle altitude;        ///< of the object
  Angle axis_zenith;     ///< of the instrument's x axis in the focus (`axis_from_zenith`)
  Angle zenith;          ///< position angle of the zenith in the sky frame of the files
  double rate_rad_s = 0; ///< of the object over the sky
  double transparency = 1;
  Angle azimuth;       ///< of the object
  double trail_px = 0; ///< length of its trail on the detector, 0 where it is followed
};

/// One channel of one exposure, as a reduction gets it.
struct ChannelCounts {
  std::string channel;
  double analyser_deg = 0;
  double counts = 0;           ///< electrons in the aperture, sky included
  double recorded = 0;         ///< the same as the detector tells them: a counter misses some
  double sky = 0, sky_err = 0; ///< of them, as the annulus says: sky and dark
  double pixels = 0;
  double var_read = 0; ///< [e2] of reading and rounding, all pixels
  double excess2 = 1;
  double scintillation = 0; ///< relative standard deviation of the transparency
  bool is_saturated = false;
  StokesRow row{}; ///< counts - sky = row . S, S in the sky frame of the files [e W-1 m2 nm]
  double mean_star = 0, mean_sky = 0; ///< truth of the simulation
  double seconds = 0;                 ///< for which it collects: its part of the exposure
};

/// An instrument in one band under given conditions.
class BandObserver {
public:
  /// `mirror_eta`: of the port's flat mirrors, [node * mirrors + mirror]; empty at a Cassegrain
  /// focus.
  static Result<BandObserver> make(const Instrument &instrument, BandResponse band,
                                   const ObservingConditions &conditions,
                                   const std::vector<std::complex<double>> &mirror_eta);

  /// Light of one node in zenith axes, as it reaches the polarimeter.
  [[nodiscard]] Stokes<InstrumentAxes> at_polarimeter(std::size_t node,
                                                      const Stokes<SkyNorth> &zenith_axes,
                                                      Angle altitude, Angle axis_zenith,
                                                      Angle azimuth = {}) const;
  /// Expected and drawn counts of all channels; of a state that was prepared, from any thread.
  [[nodiscard]] Result<std::vector<ChannelCounts>> observe(const ExposurePlan &plan,
                                                           const ExposureLight &light) const;
  /// Expected counts and rows of all channels, of the part `share` of a star and `arcsec2` of sky
  /// for a channel that takes all of the light; without dark current and scintillation.
  [[nodiscard]] Result<std::vector<ChannelCounts>> expected(const ExposurePlan &plan,
                                                            const ExposureLight &light,
                                                            double share, double arcsec2) const;
  /// Transparency of a channel's air in an exposure: cloud, and scintillation as it is drawn.
  [[nodiscard]] double transparency(const ExposurePlan &plan, const ExposureLight &light,
                                    std::size_t channel) const;
  /// Makes the channels of a state.
  [[nodiscard]] Result<void> prepare(const PolarimeterState &state);
  /// It has them.
  [[nodiscard]] bool is_prepared(const PolarimeterState &state) const {
    return channels_of(state) != nullptr;
  }

  /// The band.
  [[nodiscard]] const BandResponse &band() const { return band_; }
  /// What it was made of.
  [[nodiscard]] const Instrument &instrument() const { return instrument_; }
  /// As above.
  [[nodiscard]] const ObservingConditions &conditions() const { return conditions_; }
  /// Full width of a star at an air mass [arcsec], and of a pixel.
  [[nodiscard]] double fwhm_arcsec(double airmass) const;
  /// As above.
  [[nodiscard]] double pixel_arcsec() const { return pixel_arcsec_; }
  /// Pixels in the aperture, of one channel; about a trail of that length.
  [[nodiscard]] double aperture_pixels(double airmass, double trail_px = 0) const;
  /// Electrons per second of a flux of 1 W m-2 nm-1, no air, no polarizer, all of the image.
  [[nodiscard]] double rate_per_flux() const;
  /// Mean transmission of the air in the band, photon-weighted.
  [[nodiscard]] double mean_transmission(double airmass) const;
  /// Mean transmission of the port's mirrors for unpolarized light, photon-weighted; 1 without.
  [[nodiscard]] double port_transmission(Angle altitude, Angle azimuth) const;
  /// Standard deviation of the transparency by scintillation.
  [[nodiscard]] double scintillation_sd(double exposure_s, double airmass, double rate_rad_s) const;
  /// Share of a star's light that falls on the brightest pixel; of a trail of that length.
  [[nodiscard]] double peak_share(double airmass, double trail_px = 0) const;

private:
  using StateKey = std::tuple<double, double, double>;
  using Channels = std::vector<std::vector<PolarimeterChannel>>; ///< [node][channel]
  BandObserver() = default;
  [[nodiscard]] const Channels *channels_of(const PolarimeterState &state) const;
  [[nodiscard]] InstrumentMueller port(std::size_t node, Angle altitude, Angle azimuth) const;
  void draw(const ExposurePlan &plan, const ExposureLight &light, std::size_t channel,
            double factor, double share, ChannelCounts &out) const;
  [[nodiscard]] double sky_pixels(double airmass, double trail_px) const;
  [[nodiscard]] double pixels_within(double radius_fwhm, double airmass, double trail_px) const;

  Instrument instrument_;
  BandResponse band_;
  ObservingConditions conditions_;
  std::vector<double> rate_; ///< per node: electrons per second of unit flux, no air
  std::vector<std::complex<double>> mirror_eta_;
  std::vector<InstrumentMueller> mirror_; ///< per node, of a Nasmyth port
  double pixel_arcsec_ = 1;
  std::map<StateKey, Channels> channels_;
};

} // namespace umov
