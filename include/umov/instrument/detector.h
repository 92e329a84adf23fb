#pragma once
// From electrons to what a camera hands out.

#include <array>
#include <string>
#include <umov/instrument/draws.h>
#include <vector>

namespace umov {

/// How electrons become numbers.
enum class DetectorModel {
  Ideal, ///< photons are counted, nothing else
  Ccd,
  Cmos,
  Emccd,  ///< with a multiplying register
  Counter ///< single photons, with a dead time
};

/// A detector.
struct Detector {
  DetectorModel model = DetectorModel::Ideal;
  double pixel_um = 0;
  std::array<int, 2> size_px{}; ///< columns, rows; 0: not known
  double read_e = 0;            ///< standard deviation of a pixel
  double dark_e_s = 0;          ///< per pixel
  double gain_e_adu = 1;        ///< electrons for one number
  int bits = 16;
  double well_e = 0; ///< 0: no limit
  double bias_adu = 100;
  double nonlinearity = 0; ///< kappa: a full well reads 1 - kappa of itself
  double em_gain = 1;
  int em_stages = 536;
  double dead_time_s = 0;      ///< of a counter, after each photon that it tells
  bool is_paralyzable = false; ///< after every photon: those that are lost prolong it
  bool has_rolling_shutter = false;
  double line_time_s = 0;
};

/// As written in files.
const char *name_of(DetectorModel model);
/// All names, in the order of the enumeration.
const std::vector<std::string> &detector_names();

/// A converter makes numbers of charge. Of the others, ideal detectors and counters, a photon that
/// is told is a number of 1: gain_e_adu, bits, bias_adu, well_e, read_e and nonlinearity say
/// nothing.
bool has_converter(const Detector &detector);
/// Numbers for an electron, before any multiplication.
double adu_per_electron(const Detector &detector);
/// The number that stands for none, and the largest.
double zero_adu(const Detector &detector);
/// As above.
double last_adu(const Detector &detector);
/// What electrons read as without noise, before it is rounded.
double number_of(const Detector &detector, double electrons);

/// Variance of the electrons over their Poisson variance: a multiplying register adds its own
/// (Robbins & Hadwen 2003, IEEE Trans. Electron Devices 50, 1227); 1 without one.
double excess_variance(const Detector &detector);
/// Variance of one pixel that does not come from light [e2], referred to electrons before any
/// multiplication: reading, and rounding to whole numbers.
double fixed_variance(const Detector &detector);
/// Largest number of electrons that is told: of the well, or of the last number.
double saturation_e(const Detector &detector);

/// What the CCD equation takes.
struct ApertureCounts {
  double star = 0;          ///< electrons
  double sky = 0, dark = 0; ///< electrons per pixel
  double pixels = 0;
  double sky_pixels = 0; ///< that the sky was taken from; 0: it is known
};
/// Variance of a star's counts [e2] (Merline & Howell 1995, Exp. Astron. 6, 163).
double aperture_variance(const Detector &detector, const ApertureCounts &counts);

/// A reading for electrons that bend as charge fills the well: x (1 - kappa x/well).
double bent(const Detector &detector, double electrons);
/// And back.
double straightened(const Detector &detector, double reading);
/// Mean rate that a counter tells, of a true rate [1/s].
double counted_rate(const Detector &detector, double rate);
/// Variance of its counts over their mean.
double counter_fano(const Detector &detector, double rate);
/// A rate at which counts do not tell how bright light is, though they may look sound: beyond a
/// photon in a dead time a counter that is prolonged tells fewer the more there are.
bool is_paralysed(const Detector &detector, double rate);

/// By which part of itself a rolling shutter's exposure is longer or shorter for something that
/// runs along the read-out by so many rows a second. 0 of a global shutter.
double rolling_change(const Detector &detector, double rows_per_s);

/// A sum of counts behind all corrections.
struct CorrectedCount {
  double electrons = 0, excess2 = 1; ///< variance over Poisson's
  bool is_saturated = false;
};
/// What a counter told, with those that fell into its dead time: n = m/(1 - m tau), whose variance
/// is n (1 + n tau); where photons prolong it, n tau = -W(-m tau) with the variance n (e^(n tau) -
/// 2 n tau)/(1 - n tau)^2. Of other detectors as it is.
CorrectedCount corrected_count(const Detector &detector, double told, double exposure_s);

/// One pixel, read out.
struct PixelReading {
  int adu = 0;
  bool is_saturated = false;
};
/// Draws what a pixel reads after an exposure that frees `mean` electrons.
PixelReading read_pixel(const Detector &detector, double mean, double exposure_s, Draws &draws);
/// Electrons that a reading stands for.
double electrons_of(const Detector &detector, const PixelReading &reading);

/// Draws the electrons of many pixels together: light by its own statistics, the rest as a normal
/// number of `pixels` times the fixed variance.
double draw_aperture(const Detector &detector, double mean, double pixels, double exposure_s,
                     Draws &draws);

} // namespace umov
