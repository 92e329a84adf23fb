#pragma once
// Private: what an instrument gets of a star, and what a frame of it reaches.

#include <umov/instrument/observe.h>
#include <umov/jobs/exposure.h>

namespace umov::jobs {

/// What a request stands for: an instrument in a band under an air.
struct ExposureSetup {
  ExposureRequest request;
  Instrument instrument;
  BandObserver observer;
  double excess2 = 1; ///< of the detector
  /// sd of q and u is sqrt(factor/N) of N electrons: 2 of ideal analysers, 3 where all four
  /// parameters are told as well as can be, infinite where they are not told.
  double factor = 2;
  double states = 1;  ///< exposures one after the other, until p is known at all
  double through = 1; ///< of unpolarized light, all channels of an exposure together
  double port = 1;    ///< of it behind the mirrors of the port
  double frame_s = 0; ///< of a plate that turns by itself: the exposure that `factor` is of
  double airmass = 1;
  double to_ab = 0; ///< added to magnitudes of the request's system
};
/// Usage or BadInput for what cannot be meant.
Result<ExposureSetup> exposure_setup(const ExposureRequest &request);
/// Of an instrument and a band that were read already, with the states of a set; the request's own
/// are not looked at. BadInput where the states cannot tell what the type is made for.
Result<ExposureSetup> exposure_setup(const ExposureRequest &request, const Instrument &instrument,
                                     const BandResponse &band,
                                     const std::vector<PolarimeterState> &states);
/// The same with exposures of another length, in which a plate that turns by itself turns further.
ExposureSetup of_frames(const ExposureSetup &setup, double seconds);
/// One exposure, as its words go on: of each analyser, or of each part of a turn.
const char *of_each_state(const ExposureSetup &setup);
/// What changes from one exposure of a set to the next is taken for polarization.
bool mistakes_changes(const Polarimeter &polarimeter);

/// Rates of one instrument on one star [1/s], all channels together.
struct StarRates {
  double star = 0;                     ///< detected electrons in the apertures
  double whole = 0;                    ///< before polarizers, all of the image
  double sky = 0, dark = 0, fixed = 0; ///< fixed: variance of each exposure
  double peak = 0;                     ///< on the brightest pixel of the brightest channel
  double fills_s = 0;                  ///< exposure that fills the brightest pixel
};
/// Of a star of magnitude `mag` in the request's system.
Result<StarRates> star_rates(const ExposureSetup &setup, double mag);

/// One frame, or one of each analyser where they follow each other: how long, what it reaches, and
/// how full it makes the brightest pixel.
struct StarFrame {
  double seconds = 0, snr = 0, sd_p = 0, full = 0;
  double flicker_p = 0; ///< what scintillation adds to sd_p, in quadrature; 0 where it is shared
};
/// A frame of so many seconds.
StarFrame star_frame(const ExposureSetup &setup, const StarRates &rates, double seconds);

/// What the frame reaches that is asked for, or that a star would get, at what it fails, and what
/// helps.
std::string exposure_verdict(const ExposureSetup &setup, const StarRates &rates);

/// The magnitude asked about, in both systems where the band has both.
std::string magnitude_words(const ExposureSetup &setup);
/// What the signal to noise and the error of p count, and over what they are summed.
std::string exposure_terms(const ExposureSetup &setup);

/// Time in which p of a star is known to the wanted error [s], all states together, read once.
double time_for(const ExposureSetup &setup, const StarRates &rates);

} // namespace umov::jobs
