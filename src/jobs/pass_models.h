#pragma once
// Private: what the objects of a search for passes are taken for.

#include <map>
#include <optional>
#include <umov/jobs/passes.h>
#include <umov/lightcurve/pass_light.h>

namespace umov::jobs {

/// What magnitudes of passes are made of, for people: PassLight::describe of the samples of
/// find_passes.
inline constexpr const char *how_magnitudes_are_sampled =
    "of samples 5 s apart (a two-thousandth of visits over 2.7 h), of glints of flats and of times "
    "beside the brightest samples, to a few hundredths: a flash of a curved part that comes and "
    "goes between two samples is missed; umov run with a shorter step shows it";

/// Objects of a scenario by their catalogue number, and one model for all others.
class PassModels {
public:
  static constexpr const char *unknown = "none: no magnitudes"; ///< description of no model
  static Result<PassModels> make(const PassModel &wanted, const JobOptions &options,
                                 Diagnostics &diagnostics,
                                 const std::atomic<bool> *cancel = nullptr);
  /// Null: nothing is said about that object's light.
  [[nodiscard]] const PassLight *of(int norad) const;
  /// There is light for some objects; those without are to be told.
  [[nodiscard]] bool is_by_number() const { return !by_number_.empty() && !other_; }
  [[nodiscard]] Result<void> keep_masks() const;
  [[nodiscard]] std::size_t band() const { return band_; }
  /// Magnitudes behind the air are told too.
  [[nodiscard]] bool has_air() const { return has_air_; }
  [[nodiscard]] const std::string &description() const { return description_; }

private:
  static Result<PassModels> of_body(const PassModel &wanted, Diagnostics &diagnostics);
  static Result<PassModels> of_scene(const PassModel &wanted, const JobOptions &options,
                                     Diagnostics &diagnostics, const std::atomic<bool> *cancel);

  std::map<int, PassLight> by_number_;
  std::optional<PassLight> other_;
  std::size_t band_ = 0;
  bool has_air_ = false;
  std::string description_ = unknown;
};

} // namespace umov::jobs
