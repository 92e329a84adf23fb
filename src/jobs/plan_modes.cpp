// Attitudes that a light curve left open, as alternatives of a plan.

#include <umov/jobs/plan.h>

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/modes_file.h>

namespace umov::jobs {
namespace {

/// A body that stands still among the stars, or turns about one of its axes from an epoch on.
AttitudeLaw law_of(const ModesRow &mode, Epoch<Utc> epoch) {
  const InertialLaw start{mode.attitude};
  const double rate = std::sqrt(dot(mode.rate_rad_s, mode.rate_rad_s));
  if (!(rate > 0))
    return start;
  return SpinLaw{start, mode.rate_rad_s * (1 / rate), rate, epoch};
}

Result<Epoch<Utc>> epoch_of(const ModesFile &modes, const std::string &file) {
  if (!modes.has_rates)
    return Epoch<Utc>{};
  const auto note = modes.notes.find("epoch_utc");
  if (note == modes.notes.end())
    return fail(
        ErrorCode::BadInput,
        "has rates, and its header no epoch_utc, from which on the body turned; modes.ecsv of an "
        "inversion has it",
        {file});
  const auto epoch = utc_from_iso(note->second);
  return epoch ? epoch : fail(ErrorCode::BadInput, epoch.error().message, {file});
}

} // namespace

Result<std::vector<PlanAlternative>> alternatives_of_modes(const Scenario &scenario,
                                                           const std::string &answer) {
  const std::string file = std::filesystem::is_directory(answer)
                               ? (std::filesystem::path(answer) / "modes.ecsv").string()
                               : answer;
  constexpr std::size_t largest = 1u << 26;
  UMOV_ASSIGN(text, read_file(file, largest));
  UMOV_ASSIGN(modes, read_modes_text(text, file));
  UMOV_ASSIGN(epoch, epoch_of(modes, file));
  double sum = 0;
  for (const ModesRow &mode : modes.rows)
    sum += mode.weight;
  std::vector<PlanAlternative> out;
  constexpr double least = 0.01; // of the probability
  for (std::size_t k = 0; k < modes.rows.size(); ++k) {
    const ModesRow &mode = modes.rows[k];
    if (!(mode.weight > least * sum))
      continue;
    PlanAlternative one{fmt::format("mode {}", k + 1), scenario, mode.weight};
    ScenarioObject &object = one.scenario.objects.front();
    object.attitude = law_of(mode, epoch);
    object.has_assumed_epoch = object.lacks_epoch = false;
    out.push_back(std::move(one));
  }
  if (out.empty())
    return fail(ErrorCode::BadInput,
                fmt::format("{}, none above 1 % of the probability: too much is open for a plan",
                            counted(modes.rows.size(), "mode")),
                {file});
  if (out.size() < 2)
    return fail(ErrorCode::BadInput,
                fmt::format("{} above 1 % of the probability: nothing is left to decide",
                            counted(out.size(), "mode")),
                {file});
  return out;
}

} // namespace umov::jobs
