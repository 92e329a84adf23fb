#pragma once
// Names under which outputs grow, and what killed processes leave of them.

#include <filesystem>
#include <string>
#include <vector>

namespace umov {

/// "NAME.part-PID-RANDOM" in the folder of an output, so that a rename puts it in place; different
/// for every process, also where containers share a folder and number their processes alike.
/// `before`: what the name begins with, "." to hide it. Never longer than a name may be.
std::filesystem::path temporary_name(const std::filesystem::path &output,
                                     const std::string &before = "");

/// Marks an open temporary file or folder as in use, for as long as the descriptor is open.
void hold_temporary(int descriptor);

/// Files and folders with temporary names of that output that nobody has held for a minute: their
/// process was killed.
std::vector<std::filesystem::path> abandoned_temporaries(const std::filesystem::path &output,
                                                         const std::string &before = "");

} // namespace umov
