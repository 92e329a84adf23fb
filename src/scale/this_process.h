#pragma once
// Private: who works here, how much of the processor it has used, and how much memory it may.

#include <cstddef>
#include <string>

namespace umov::scale {

/// Name of this machine; "unknown" where it has none.
std::string this_host();
/// CPU seconds of this process, all threads.
double cpu_seconds();
/// Megabytes that processes started here may have together: nine tenths of what the machine has or
/// its control groups (of a container or a batch system) allow.
std::size_t memory_here_mb();

} // namespace umov::scale
