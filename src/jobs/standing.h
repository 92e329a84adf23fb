#pragma once
// Private: objects that stand still over a place of the Earth.

#include <string>
#include <umov/frames/site.h>
#include <umov/orbit/trajectory.h>

namespace umov::jobs {

/// For an object that turns with the Earth and that a site never sees above an altitude: over which
/// longitude it stands, and how near a site must be, as a sentence with a blank before it. "" for
/// all others.
std::string where_it_stands(const Trajectory &orbit, const Site &site, Epoch<Utc> time,
                            Angle altitude_min);

} // namespace umov::jobs
