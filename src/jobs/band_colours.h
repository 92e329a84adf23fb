#pragma once
// Private: colours of bands on pages, those of a report.

#include <string>
#include <vector>

namespace umov::jobs {

/// Of each band a colour of the list (plot_colour), from blue for the shortest wavelength to red;
/// bands that are not known by name stand in their order.
std::vector<std::size_t> band_colours(const std::vector<std::string> &names);

} // namespace umov::jobs
