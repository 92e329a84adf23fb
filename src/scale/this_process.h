#pragma once
// Private: who works here, and how much of the processor it has used.

#include <string>

namespace umov::scale {

/// Name of this machine; "unknown" where it has none.
std::string this_host();
/// CPU seconds of this process, all threads.
double cpu_seconds();

} // namespace umov::scale
