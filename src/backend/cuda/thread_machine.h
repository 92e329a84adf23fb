#pragma once
// One thread of a graphics processor: a pose is its own, and it takes one facet after the other.
// The same text runs on the host, where tests hold it against the scalar reference.

#include "backend/cuda/running_sum.h"
#include "backend/one_facet_machine.h"

namespace umov::backend {

/// Groups whose facets a thread lists at a time: two kilobytes of its own memory.
inline constexpr std::size_t groups_per_thread = 4;

struct ThreadMachine : OneFacetMachine<float, RunningSum, groups_per_thread> {};

} // namespace umov::backend
