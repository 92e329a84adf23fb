#pragma once
// Private: answers of an inversion as tables and words.

#include "jobs/body_words.h"
#include "jobs/contribution_words.h"

#include <optional>
#include <umov/inverse/unmix.h>
#include <umov/jobs/invert.h>

namespace umov::jobs {

struct Judgement;

/// modes.ecsv; with rates where they were free.
Table modes_table(const PoseAnswer &answer, bool has_rates);
/// What `umov invert track` needs to know of modes: of which body they are, when they hold, up to
/// when they had data, how bright those are and in which unit, the floor and the verdict that they
/// rest on.
void note_start(Table &modes, const BodyWords &body, const ObservedLightCurve &observed,
                const PoseAnswer &answer, const Judgement &judgement);
/// Keys of those notes, which are of one answer alone.
inline constexpr const char *epoch_note = "epoch_utc", *until_note = "data_until_utc",
                            *median_note = "median_intensity", *floor_note = "floor",
                            *verdict_note = "search_verdict", *doubt_note = "search_doubt",
                            *unit_note = "light_unit";
/// Of a search that is undetermined because many attitudes fit, and for nothing else: its samples
/// are the posterior.
inline constexpr const char *width_alone = "width alone";
/// Keys of those that are of all answers about a body.
inline constexpr const char *mesh_note = "object_mesh", *materials_note = "object_materials";
/// What I is in: known only where the light is absolute.
inline const char *unit_of_light(bool is_absolute) { return is_absolute ? "m2 / sr" : "relative"; }
/// set95.ecsv.
Table set_table(const PoseAnswer &answer);
/// samples.ecsv.
Table samples_table(const PoseAnswer &answer, bool has_rates);
/// twins.ecsv: for every mode those of the body's own turns and of the other modes.
Table twins_table(const PoseAnswer &answer, const std::vector<BodySymmetry> &symmetries);
/// Columns qw to qz of a table, one half of the unit quaternions of attitudes: w is not negative.
void add_attitude_columns(Table &table, const std::vector<Quaternion> &attitudes,
                          const char *description);
/// fit.ecsv: what was measured, over its best scale, beside a model's light.
Table fit_table(const ObservedLightCurve &observed, const EndMember &model,
                const CurveErrors &errors);
/// The same of the best turning, with the errors that the answer rests on.
Table fit_table(const ObservedLightCurve &observed, const CurveModel &model,
                const PoseAnswer &answer);
/// Light of the best turning, its parts as they fit best; empty without modes.
struct BestLight {
  EndMember light;
  std::vector<double> half_width;
  std::vector<double> parts; ///< as CurveLikelihood::FittedLight::off
};
BestLight best_light(const CurveModel &model, const PoseAnswer &answer);

/// How far the samples spread about the mean direction of each body axis [deg], root mean square.
std::array<double, 3> axis_spread_deg(const PoseAnswer &answer);
/// Modes that are one and the same up to the body's own turns.
struct Families {
  std::size_t count = 0;
  double heaviest = 0;   ///< share of the posterior
  double spread_deg = 0; ///< of all samples about the heaviest mode and its twins, root mean square
};
Families families_of(const PoseAnswer &answer, const std::vector<BodySymmetry> &symmetries);

/// What an answer is worth. `floor`: as it was told.
Verdict verdict_of(const PoseAnswer &answer, const Families &families, double floor);

/// The chance of a best fit as bad as this one, where it is below .001. Such a fit is either not
/// the best there is (a spin that a search passed by had a chi-square 100 lower,
/// bench/inverse/blind_set.py), or its errors are too small. Nothing where rows may be outliers, of
/// which chi-square says less.
std::optional<double> chance_of_bad_fit(const PoseAnswer &answer, const CurveErrors &errors);

/// Everything that the summary and verdict.json say.
struct Judgement {
  Verdict verdict = Verdict::Undetermined;
  Families families;
  std::array<double, 3> axis_spread_deg{};
  NullTest null_test;
  Contributions contributions;                 ///< none where nothing fits
  std::size_t epochs = 0, epochs_searched = 0; ///< before and after some were joined
  std::vector<std::string> notes;
  std::vector<Parameter> nuisances;
  std::vector<double> fitted; ///< of those that are parts of the light, the last ones: [sd]
  std::optional<double> light_between; ///< `share_between` of the best attitude, if it was asked
  bool is_between_fitted = false;      ///< the search had that light
};
/// An answer is undetermined because its posterior is wide, and for nothing else that is known.
bool is_wide_alone(const PoseAnswer &answer, const ObservedCurve &curve,
                   const Judgement &judgement);
/// All of it, of an answer to the curve of `searched`; `whole` has that curve before its epochs
/// were joined.
Judgement judge(const PoseAnswer &answer, const CurveModel &searched, const CurveModel &whole,
                const CurveErrors &errors, const std::vector<BodySymmetry> &symmetries);
std::string json_of(const char *question, const PoseAnswer &answer, const Judgement &judgement,
                    const std::vector<BodySymmetry> &symmetries);
/// How well the best fit does.
std::string fit_words(double chi2, double dof);
/// Two digits, or all of those before the point.
std::string in_digits(double number);
std::string summary_of(const PoseAnswer &answer, const Judgement &judgement);

} // namespace umov::jobs
