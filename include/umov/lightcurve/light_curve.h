#pragma once
// A light curve as rows: one per epoch, object and band (product columns).

#include <cmath>
#include <limits>
#include <string>
#include <umov/attitude/attitude.h>
#include <umov/light/light_model.h>
#include <umov/optics/stokes.h>
#include <umov/orbit/ephemeris.h>
#include <vector>

namespace umov {

/// What all bands of one epoch share.
struct LightCurveEpoch {
  ObservingGeometry geometry;
  Quaternion body_from_gcrs;
  Pose pose;                            ///< Sun and observer in the body frame
  std::vector<double> joint_angles_rad; ///< of the object's moving parts, if any
  double airmass = 0;                   ///< Kasten & Young 1989; NaN below the horizon
  std::string pass_id;                  ///< "" outside a pass
  double elset_age_days = 0;            ///< time minus element epoch
  bool has_glint = false;
  bool is_dark = true; ///< nothing lit and seen
  PoseMethod method = PoseMethod::Rays;
};

/// One band at one epoch.
struct LightCurveSample {
  /// I [W m-2 nm-1] at the observer above the atmosphere; the photon-weighted mean of a curve.
  double irradiance = 0;
  double intensity = 0; ///< [m2/sr]
  Stokes<SkyNorth> sky; ///< q, u, v as fractions in the chosen sky frame, i = 1; NaN if dark
  Stokes<ScatteringPlane> scattering; ///< q_scat, u_scat, v as fractions; NaN if dark
  double p = 0, dop = 0;              ///< NaN if dark
  double pa_deg = 0;                  ///< [0, 180), NaN if p is 0 or dark
  double magnitude = 0; ///< of the curve's system, a limit where `has_magnitude_limit`; NaN if dark
                        ///< or in the umbra
  Stokes<ScatteringPlane> half_width; ///< numerical 95 % half-widths [m2/sr]
  /// What summing a band from few wavelengths may leave out [m2/sr]; 0 at one wavelength.
  Stokes<ScatteringPlane> band_err;
  /// Light of more than one surface, part of `intensity`, as fractions of it; with bounces > 1.
  Stokes<ScatteringPlane> indirect;
};

/// The magnitude is a limit, the object fainter: beyond `faintest_magnitude`, or I is not three
/// times its half-width, and the magnitude that of I and half-width together.
bool has_magnitude_limit(const LightCurveSample &sample);

/// What lights the object besides the Sun.
enum class SecondSource { Earth, Moon };
/// "earth" or "moon": begins the names of its columns.
const char *name_of(SecondSource source);

/// Light of the object by another source than the Sun, not in I; [epoch * bands + band], in the sky
/// axes of the curve.
struct SecondLight {
  SecondSource source = SecondSource::Earth;
  std::vector<Stokes<SkyNorth>> intensity;  ///< [m2/sr] per unit solar irradiance
  std::vector<Stokes<SkyNorth>> half_width; ///< numerical 95 % half-widths of `intensity`
  std::vector<double> irradiance;           ///< I at the observer [W m-2 nm-1]
};

/// Smallest and largest value, NaN where there is none.
struct Extent {
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();

  /// Holds `value` too, unless that is NaN.
  void take(double value) {
    low = std::fmin(low, value);
    high = std::fmax(high, value);
  }
};

/// What a sample becomes over the ranges that are stated of its materials.
struct SampleSpread {
  Extent intensity, magnitude, p; ///< [m2/sr], of the curve's system, fraction
};

/// Epochs, and the light of each in every band.
struct LightCurve {
  std::string object;
  std::size_t bounces = 1; ///< surfaces that the light may have touched
  int norad_cat_id = 0;
  std::vector<Band> bands;
  MagnitudeSystem magnitudes = MagnitudeSystem::AB;
  LightMethod method = LightMethod::Rays; ///< of the whole; rows say theirs
  std::vector<std::string> materials;     ///< in order of first use in the scene
  std::vector<LightCurveEpoch> epochs;
  std::vector<LightCurveSample> samples;  ///< [epoch * bands.size() + band]
  std::vector<double> transmission;       ///< of the air, like samples; empty: none was asked for
  std::vector<SampleSpread> spread;       ///< of each sample, where asked for; else empty
  std::vector<SecondLight> second_lights; ///< those asked for
  std::vector<double> material_i; ///< direct light: [(epoch * materials + material) * bands + band]
};

/// Takes the samples of `other`, the same epochs in other circumstances, into the spread of
/// `curve`. Epochs that `other` does not reach have none.
void widen_spread(LightCurve &curve, const LightCurve &other);

} // namespace umov
