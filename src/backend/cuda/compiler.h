#pragma once
// Makes the program for a card out of the text that the library carries, with NVIDIA's run-time
// compiler (NVRTC), which needs neither a toolkit nor a card.

#include "backend/cuda/shared_library.h"

#include <algorithm>
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
  /// All that there are, in the order in which a driver of that CUDA (1000 major + 10 minor) is to
  /// be tried with them: the newest that is no newer than the driver first, then newer ones, the
  /// least new first, of which a driver takes machine code at best. Device if there is none: with
  /// what to install.
  static Result<std::vector<CardCompiler>> load(std::span<const std::filesystem::path> folders,
                                                int driver_version);
  /// "13.2", and the file it came from.
  [[nodiscard]] std::string version() const;
  [[nodiscard]] const std::string &file() const { return file_; }
  /// Compute capabilities that it compiles for (75: 7.5).
  [[nodiscard]] const std::vector<int> &capabilities() const { return capabilities_; }

  /// Newer than a driver of that CUDA.
  [[nodiscard]] bool is_newer_than(int driver_version) const { return version_ > driver_version; }
  /// Makes something for a card of that capability; else it is too old for the compiler.
  [[nodiscard]] bool knows(int capability) const { return capability >= capabilities_.front(); }
  /// What it makes for a card is assembly, which the driver translates.
  [[nodiscard]] bool makes_assembly_for(int capability) const {
    return std::find(capabilities_.begin(), capabilities_.end(), capability) == capabilities_.end();
  }

  /// For a card of that capability: machine code if the compiler knows it, else the assembly of
  /// the newest one before it, which the driver translates. Device for cards too old.
  /// `cache`: folder for what was compiled before; empty: none.
  [[nodiscard]] Result<CardImage> image_for(int capability,
                                            const std::filesystem::path &cache) const;
  /// Machine code (is_assembly: PTX) for a capability that the compiler knows.
  [[nodiscard]] Result<CardImage> compile(int capability, bool is_assembly) const;

private:
  struct Functions;
  static Result<CardCompiler> of(const SharedLibrary &library);
  [[nodiscard]] std::vector<std::string> options_for(int capability, bool is_assembly) const;
  std::shared_ptr<const Functions> functions_;
  std::string file_;
  int version_ = 0; ///< 1000 major + 10 minor
  std::vector<int> capabilities_;
};

} // namespace umov::backend
