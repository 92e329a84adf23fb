#pragma once
// What the objects of umov passes are taken for.

#include "console.h"
#include <map>
#include <optional>
#include <umov/lightcurve/pass_light.h>

namespace umov::cli {

struct PassModelOptions {
  std::string scene, shape, material, band;
  double size_m = 1;
};
void add_pass_model(CLI::App &verb, PassModelOptions &options);

/// Objects of a scenario by their catalogue number, and one model for all others.
class PassModels {
public:
  static Result<PassModels> make(const PassModelOptions &options, Diagnostics &diagnostics);
  /// Null: nothing is said about that object's light.
  [[nodiscard]] const PassLight *of(int norad) const;
  [[nodiscard]] std::size_t band() const { return band_; }
  [[nodiscard]] const std::string &description() const { return description_; }

private:
  std::map<int, PassLight> by_number_;
  std::optional<PassLight> other_;
  std::size_t band_ = 0;
  std::string description_ = "none: no magnitudes";
};

} // namespace umov::cli
