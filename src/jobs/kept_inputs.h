#pragma once
// Private: copies of what a job read, beside its results.

#include <string>
#include <umov/io/run_folder.h>
#include <utility>
#include <vector>

namespace umov::jobs {

/// Copies of `inputs` (path, SHA-256) under inputs/, whose names are added to `files`, and a lock
/// that names those. Device where one is not any more what was read.
Result<void> keep_inputs(const std::vector<std::pair<std::string, std::string>> &inputs,
                         RunFolder &folder, std::string &lock, std::vector<std::string> &files);

} // namespace umov::jobs
