#pragma once
// How many poses are lit together: what a stop may cost, how often progress shows, how far threads
// are busy. Light between surfaces is shared by the poses of a block, so that its bytes come again
// only with these lengths.

#include <cstddef>
#include <umov/light/light_model.h>

namespace umov {

/// Of neighbours in a series, such as the rows of a light curve: short, as every finished block
/// stays after a stop, and who looks on waits for it.
std::size_t series_block(const LightModel &light, const LightOptions &options);

/// Of poses far apart, such as those of a signature, of which there are many.
std::size_t list_block(const LightModel &light, const LightOptions &options);

} // namespace umov
