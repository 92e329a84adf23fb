#pragma once
// Private: what an observation warns of before its first exposure.

#include "jobs/observe_exposure.h"

#include <umov/core/diagnostics.h>

namespace umov::jobs {

/// The sampling of a mosaic's image and the edge of its aperture, in figures.
void warn_of_mosaic(const Setup &setup, Diagnostics &diagnostics);

/// What the instrument and the site say that can hardly be meant.
void warn_of_setup(const Setup &setup, Diagnostics &diagnostics);

} // namespace umov::jobs
