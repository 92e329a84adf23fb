#pragma once
// Private: where the name of an output leads.

#include <filesystem>
#include <string>
#include <umov/core/result.h>

namespace umov {

struct OutputPlace {
  enum class Kind {
    File,      ///< a regular file, there or not: replaced as a whole
    Stream,    ///< a pipe, a device, a terminal: written to, never replaced
    Descriptor ///< open already, such as /dev/stdout
  };
  Kind kind = Kind::File;
  std::filesystem::path path; ///< behind all links
  int descriptor = -1;
};

/// Follows links as a shell does. Device for a folder, a circle of links, and a link that somebody
/// else put into a folder of everybody's.
Result<OutputPlace> output_place(const std::filesystem::path &path);

/// A name in the same folder: the file's between two more parts, cut where it gets longer than
/// names may be (255 bytes).
std::filesystem::path beside(const std::filesystem::path &path, const std::string &before,
                             const std::string &after);

} // namespace umov
