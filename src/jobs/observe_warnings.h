#pragma once
// Private: what an observation warns of before its first exposure.

#include "jobs/observe_exposure.h"

#include <span>
#include <string>
#include <umov/core/diagnostics.h>

namespace umov::jobs {

/// The sampling of a mosaic's image and the edge of its aperture, in figures.
void warn_of_mosaic(const Setup &setup, Diagnostics &diagnostics);

/// A trail longer than the detector, whose light and pixels are counted as if it fitted.
void warn_of_trails(const Setup &setup, std::span<const Exposure> exposures,
                    Diagnostics &diagnostics);

/// An exposure (`name`: as it is told) in which the air's pattern does not cross the aperture;
/// empty of a longer one.
std::string brief_words(const std::string &name, double exposure_s, double aperture_m);

/// What the instrument and the site say that can hardly be meant.
void warn_of_setup(const Setup &setup, Diagnostics &diagnostics);

} // namespace umov::jobs
