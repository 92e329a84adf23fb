// umov invert plan: which observations would tell alternatives apart.

#include "verb_invert.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <umov/core/text.h>
#include <umov/jobs/plan.h>

namespace umov::cli {
namespace {

struct PlanOptions {
  std::vector<std::string> alternatives;
  std::string modes; ///< an answer whose attitudes are alternatives
  jobs::PlanRequest request;
};

/// An alternative of the command line: its name, keys that are changed, or another scenario.
struct Named {
  std::string name, file;
  std::vector<std::string> overrides;
};

/// "NAME", "NAME:FILE.toml" or "NAME:KEY=VALUE"; words of one name are one alternative.
Result<std::vector<Named>> named(const std::vector<std::string> &words) {
  std::vector<Named> out;
  for (const std::string &word : words) {
    const std::size_t colon = word.find(':');
    const std::string name = word.substr(0, colon);
    const std::string what = colon == word.npos ? "" : word.substr(colon + 1);
    const bool is_key = what.find('=') != what.npos;
    if (name.empty() || name.find('=') != name.npos || (colon != word.npos && what.empty()) ||
        (!is_key && !what.empty() && !what.ends_with(".toml")))
      return fail(ErrorCode::Usage,
                  fmt::format("--alternative {}: NAME (the scenario as it is), NAME:KEY=VALUE or "
                              "NAME:FILE.toml was expected, as gold:object.materials.default=gold",
                              printable(word)));
    auto one = std::ranges::find(out, name, &Named::name);
    if (one == out.end())
      one = out.insert(out.end(), {name, "", {}});
    else if (!is_key)
      return fail(ErrorCode::Usage, fmt::format("--alternative {}: {} is named already",
                                                printable(word), printable(name)));
    if (is_key)
      one->overrides.push_back(what);
    else
      one->file = what;
  }
  return out;
}

Result<std::vector<jobs::PlanAlternative>> alternatives_of(const PlanOptions &plan,
                                                           const InvertVerb &asked) {
  UMOV_ASSIGN(names, named(plan.alternatives));
  std::vector<jobs::PlanAlternative> out;
  for (const Named &one : names) {
    std::vector<std::string> keys = one.file.empty() ? asked.keys() : std::vector<std::string>();
    keys.insert(keys.end(), one.overrides.begin(), one.overrides.end());
    UMOV_ASSIGN(scenario, read_scenario(one.file.empty() ? asked.scenario : one.file, keys));
    out.push_back({one.name, std::move(scenario), 1});
  }
  if (!plan.modes.empty()) {
    UMOV_ASSIGN(scenario, read_scenario(asked.scenario, asked.keys()));
    UMOV_ASSIGN(modes, jobs::alternatives_of_modes(scenario, plan.modes));
    std::ranges::move(modes, std::back_inserter(out));
  }
  return out;
}

} // namespace

void add_invert_plan(CLI::App &invert, const Exit &exit_with) {
  auto *verb = invert.add_subcommand(
      "plan",
      "Before the night: which passes, bands and Stokes components tell alternatives apart");
  auto o = std::make_shared<InvertVerb>();
  auto plan = std::make_shared<PlanOptions>();
  verb->add_option("--alternative", plan->alternatives,
                   "NAME: the scenario as it is; NAME:KEY=VALUE: with a key changed (again for "
                   "more keys); NAME:FILE.toml: the object of another scenario. Two or more");
  verb->add_option(
      "--modes", plan->modes,
      "Answer of umov invert pose or spin, its folder or its modes.ecsv: each attitude "
      "above 1 % of the probability is an alternative");
  const auto span = [&](const char *option, const char *key, const char *text) {
    verb->add_option_function<std::string>(
        option, [o, key](const std::string &time) { o->own_keys.push_back(key + time); }, text);
  };
  span("--start", "time.start=", "Begin, such as 2018-01-21T04:00:00Z, in place of time.start");
  span("--stop", "time.stop=", "End, in place of time.stop");
  verb->add_option("--snr", plan->request.snr,
                   "S/N of I in a row of median brightness; else what [observation] reaches, or "
                   "100 without one")
      ->check(CLI::Range(0.1, 1e6));
  verb->add_option("--sky-mag", plan->request.sky_mag,
                   "Sky of the instrument of [observation], AB in the band [mag / arcsec2]")
      ->check(CLI::Range(-5.0, 40.0))
      ->capture_default_str();
  add_model_options(*verb, o);
  run_invert(*verb, o, exit_with,
             [plan](const Scenario &scenario, const InvertVerb &asked, const jobs::Monitor &monitor,
                    Diagnostics &diagnostics) -> Result<jobs::Inversion> {
               UMOV_ASSIGN(alternatives, alternatives_of(*plan, asked));
               jobs::PlanRequest request = plan->request;
               request.errors = asked.request.errors;
               request.method = asked.request.method;
               request.allow_old_elements = asked.request.allow_old_elements;
               return jobs::plan_observations(scenario, alternatives, request,
                                              job_options(asked.common), monitor, diagnostics);
             });
}

} // namespace umov::cli
