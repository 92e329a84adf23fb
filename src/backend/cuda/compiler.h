#pragma once
// Makes the program for a card out of the text that the library carries, with NVIDIA's run-time
// compiler (NVRTC), which needs neither a toolkit nor a card.

#include "backend/cuda/shared_library.h"

#include <memory>
#include <string_view>
#include <vector>

namespace umov::backend {

/// A text under the name by which others include it.
struct CardText {
  const char *name;
  std::string_view text;
};
/// The program first, then everything it includes.
const std::vector<CardText> &card_texts();

/// What a card loads.
struct CardImage {
  std::string bytes;
  // Of what was compiled just now:
  std::string assembly; ///< PTX, to be read
  std::string log;      ///< registers and memory of each entry
};

/// libnvrtc.so
class CardCompiler {
public:
  /// Device if there is none: with what to install.
  static Result<CardCompiler> load(std::span<const std::filesystem::path> folders);
  /// "13.2", and the file it came from.
  [[nodiscard]] const std::string &version() const { return version_; }
  [[nodiscard]] const std::string &file() const { return file_; }
  /// Compute capabilities that it compiles for (75: 7.5).
  [[nodiscard]] const std::vector<int> &capabilities() const { return capabilities_; }

  /// For a card of that capability: machine code if the compiler knows it, else the assembly of
  /// the newest one before it, which the driver translates. Device for cards too old.
  /// `cache`: folder for what was compiled before; empty: none.
  [[nodiscard]] Result<CardImage> image_for(int capability,
                                            const std::filesystem::path &cache) const;
  /// Machine code (is_assembly: PTX) for a capability that the compiler knows.
  [[nodiscard]] Result<CardImage> compile(int capability, bool is_assembly) const;

private:
  struct Functions;
  [[nodiscard]] std::vector<std::string> options_for(int capability, bool is_assembly) const;
  std::shared_ptr<const Functions> functions_;
  std::string version_, file_;
  std::vector<int> capabilities_;
};

} // namespace umov::backend
