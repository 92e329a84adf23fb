#pragma once
// Private: what the objects of a search for passes are taken for.

#include <map>
#include <optional>
#include <umov/jobs/passes.h>
#include <umov/lightcurve/pass_light.h>

namespace umov::jobs {

/// Objects of a scenario by their catalogue number, and one model for all others.
class PassModels {
public:
  static Result<PassModels> make(const PassModel &wanted, Diagnostics &diagnostics);
  /// Null: nothing is said about that object's light.
  [[nodiscard]] const PassLight *of(int norad) const;
  [[nodiscard]] std::size_t band() const { return band_; }
  [[nodiscard]] const std::string &description() const { return description_; }

private:
  static Result<PassModels> of_body(const PassModel &wanted, Diagnostics &diagnostics);
  static Result<PassModels> of_scene(const PassModel &wanted, Diagnostics &diagnostics);

  std::map<int, PassLight> by_number_;
  std::optional<PassLight> other_;
  std::size_t band_ = 0;
  std::string description_ = "none: no magnitudes";
};

} // namespace umov::jobs
