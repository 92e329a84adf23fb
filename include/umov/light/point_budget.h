#pragma once
// How many ray-tested points a pose may take where nobody says: each figure's only place.

#include <cstddef>

/// Most points per pose (`LightOptions::max_points`, `IntegrationOptions::max_points`), past which
/// an error is reported as it is. Direct light by rays has IntegrationOptions' own.
namespace umov::most_points {

/// Of what masks and rays by class could not settle, which is slivers: four times the points would
/// halve their half-width at best, and most would miss the accuracy all the same.
inline constexpr std::size_t beside_masks = 1u << 20;
inline constexpr std::size_t of_paths = 1u << 19;    ///< a sampled path costs more than a point
inline constexpr std::size_t of_a_node = 1u << 15;   ///< of light between surfaces in a table
inline constexpr std::size_t over_a_pass = 1u << 17; ///< for ranges of magnitude and polarization
inline constexpr std::size_t to_find_the_brightest = 1u << 14; ///< of a pass, for its picture

} // namespace umov::most_points
