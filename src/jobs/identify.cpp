#include <umov/jobs/identify.h>

#include "jobs/curve_questions.h"
#include "jobs/identify_tables.h"
#include "jobs/invert_between.h"
#include "jobs/invert_page.h"
#include "jobs/invert_tables.h"
#include "jobs/job_journal.h"
#include "jobs/ready_objects.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <umov/core/text.h>
#include <umov/io/signature_file.h>

namespace umov::jobs {
namespace {

namespace fs = std::filesystem;

/// Where in `known` the bands of a curve stand; BadInput for one that is not there.
Result<std::vector<std::size_t>> columns_in(const std::vector<std::string> &known,
                                            const ObservedCurve &curve, const std::string &file) {
  std::vector<std::size_t> out;
  out.reserve(curve.bands.size());
  for (const std::string &band : curve.bands) {
    const auto at = std::ranges::find(known, band);
    if (at == known.end())
      return fail(ErrorCode::BadInput,
                  fmt::format("has no light in band \"{}\", in which the object was observed; it "
                              "has {}. Build the library with that band in its scenarios",
                              printable(band), fmt::join(known, ", ")),
                  {file});
    out.push_back(static_cast<std::size_t>(at - known.begin()));
  }
  return out;
}

std::vector<std::string> names_of(const std::vector<Band> &bands) {
  std::vector<std::string> out;
  out.reserve(bands.size());
  for (const Band &band : bands)
    out.push_back(band.name);
  return out;
}

/// Files of a folder, as candidates.
class Library {
public:
  static Result<Library> open(const std::string &folder);

  [[nodiscard]] std::size_t size() const { return files_.size(); }
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] const fs::path &file(std::size_t k) const { return files_[k]; }
  /// Lends the signature of a file that is mapped for as long as it is looked at. No two threads
  /// may have the same one.
  Result<void> lend(std::size_t k, const ObservedCurve &curve, const LookAtCandidate &look);
  /// Errors of the tables that were lent.
  [[nodiscard]] const std::vector<double> &errors() const { return errors_; }
  /// SHA-256 of what the objects that were lent were made from.
  [[nodiscard]] std::string identity() const;

private:
  std::vector<fs::path> files_;
  std::vector<double> errors_;
  std::vector<std::string> jobs_;
};

Result<Library> Library::open(const std::string &folder) {
  Library out;
  std::error_code problem;
  for (auto at = fs::directory_iterator(folder, problem);
       !problem && at != fs::directory_iterator(); at.increment(problem))
    if (at->path().extension() == ".umovsig")
      out.files_.push_back(at->path());
  if (problem)
    return fail(ErrorCode::BadInput,
                "cannot read the folder: " + problem.message() +
                    "; a library was expected: make one with umov library build",
                {folder});
  if (out.files_.empty())
    return fail(ErrorCode::BadInput,
                "holds no signature (NAME.umovsig): make some with umov library build", {folder});
  std::ranges::sort(out.files_);
  out.errors_.resize(out.files_.size());
  out.jobs_.resize(out.files_.size());
  return out;
}

std::vector<std::string> Library::names() const {
  std::vector<std::string> out;
  out.reserve(files_.size());
  for (const fs::path &file : files_)
    out.push_back(file.stem().string());
  return out;
}

std::string Library::identity() const {
  std::string all;
  for (std::size_t k = 0; k < files_.size(); ++k)
    all += files_[k].stem().string() + " " + jobs_[k] + "\n";
  return sha256_hex(all);
}

Result<void> Library::lend(std::size_t k, const ObservedCurve &curve, const LookAtCandidate &look) {
  UMOV_ASSIGN(file, SignatureFile::open(files_[k]));
  errors_[k] = file.view().signature.error;
  jobs_[k] = file.view().text.job;
  UMOV_ASSIGN(columns, columns_in(file.view().text.bands, curve, files_[k].string()));
  look(file.view().signature, columns);
  return {};
}

/// Own light of candidates whose scenarios are named.
class OwnLights {
public:
  OwnLights(const IdentifyRequest &request, const JobOptions &options, ReadyObjects &ready,
            const Monitor &monitor, Diagnostics &diagnostics)
      : request_(request), options_(options), ready_(ready), monitor_(monitor),
        diagnostics_(diagnostics) {}

  /// Which scenario belongs to which object; Usage for one that has none.
  Result<void> assign(const Library &library);
  /// BadInput for a scenario that lacks a band of the curve, whether or not it will be asked.
  Result<void> check(const ObservedCurve &curve);
  [[nodiscard]] bool has(std::size_t k) const { return scenarios_.contains(k); }
  Result<std::optional<OwnAnswer>> answer(const Library &library, std::size_t k,
                                          const ObservedCurve &curve, const SearchOptions &search);
  /// What light from surface to surface that fits leave out makes of the verdict, and notes of it:
  /// of the best candidate, and where it is to be none of these of all that were asked.
  Result<std::vector<std::string>> doubt(std::size_t best, const ObservedCurve &curve,
                                         IdentityWords &words);
  /// Light of a candidate that has answered.
  [[nodiscard]] const SearchedLight *light(std::size_t k) const {
    const auto at = lights_.find(k);
    return at == lights_.end() ? nullptr : at->second;
  }
  [[nodiscard]] const std::vector<std::size_t> &columns(std::size_t k) const {
    return columns_.at(k);
  }
  /// How it was lit.
  [[nodiscard]] const ManifestInput::Light &used(std::size_t k) const { return used_.at(k); }

private:
  /// `share_between` of a candidate that has answered.
  Result<double> missing_of(std::size_t k, const ObservedCurve &curve, const PoseAnswer &pose);

  const IdentifyRequest &request_;
  const JobOptions &options_;
  ReadyObjects &ready_;
  const Monitor &monitor_;
  Diagnostics &diagnostics_;
  std::map<std::size_t, std::string> scenarios_;
  std::map<std::size_t, const SearchedLight *> lights_;
  std::map<std::size_t, std::vector<std::size_t>> columns_;
  std::map<std::size_t, ManifestInput::Light> used_;
};

Result<void> OwnLights::assign(const Library &library) {
  const auto names = library.names();
  std::string unknown;
  for (const std::string &path : request_.objects) {
    const std::string name = fs::path(path).stem().string();
    const auto at = std::ranges::find(names, name);
    if (at != names.end()) {
      scenarios_[static_cast<std::size_t>(at - names.begin())] = path;
      continue;
    }
    const auto near = nearest_name(name, names);
    unknown += fmt::format("{}\"{}\" ({}){}", unknown.empty() ? "" : " and no ", printable(name),
                           printable(path),
                           near ? fmt::format(", did you mean \"{}\"?", printable(*near)) : "");
  }
  if (unknown.empty())
    return {};
  constexpr std::size_t most = 20; // libraries may have thousands
  const std::vector<std::string> shown(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(most, names.size())));
  return fail(
      ErrorCode::Usage,
      fmt::format("--objects: the library has no object of the name {}. It has {}{}", unknown,
                  printable(fmt::format("{}", fmt::join(shown, ", "))),
                  names.size() > most ? fmt::format(" and {} more", names.size() - most) : ""));
}

Result<void> OwnLights::check(const ObservedCurve &curve) {
  for (const auto &[k, path] : scenarios_) {
    UMOV_ASSIGN(scenario, ready_.scenario(path));
    UMOV_ASSIGN(columns, columns_in(names_of(scenario->bands), curve, path));
    columns_[k] = columns;
  }
  return {};
}

Result<std::optional<OwnAnswer>> OwnLights::answer(const Library &library, std::size_t k,
                                                   const ObservedCurve &curve,
                                                   const SearchOptions &search) {
  const auto named = scenarios_.find(k);
  if (named == scenarios_.end())
    return std::optional<OwnAnswer>();
  UMOV_ASSIGN(read, ready_.scenario(named->second));
  const Scenario &scenario = *read;
  const std::vector<std::size_t> &columns = columns_.at(k);
  UMOV_ASSIGN(made, ready_.light(named->second, request_.observed, options_, diagnostics_,
                                 monitor_.cancel));
  const SearchedLight &light = *made;
  UMOV_ASSIGN(file, SignatureFile::open(library.file(k)));
  const SignatureText &text = file.view().text;
  const auto is_made_from = [&](const Scenario &one) {
    return text.job ==
           signature_job(one, light.light.inputs(), file.view().signature.cells, text.device);
  };
  Scenario direct = scenario; // the library's light, where that between surfaces is the fit's alone
  direct.light.bounces = 1;
  if (!is_made_from(scenario) && !is_made_from(direct))
    diagnostics_.warn("is not what its signature was made from, or another umov made that; its own "
                      "light is taken as it is now",
                      {named->second});
  lights_[k] = made;
  const CurveModel model(curve, whole_lighting(light, options_.threads, monitor_), columns);
  const CurveModel first(curve, first_lighting(light, options_.threads, monitor_), columns);
  const CurveModel quick(curve, quick_lighting(light, options_.threads, monitor_), columns);
  UMOV_ASSIGN(found, search_pose({model, first, quick}, search));
  used_[k] = light_used(light, scenario, diagnostics_);
  return std::optional(
      OwnAnswer{std::move(found), CurveLikelihood(curve, search.errors).log_variance()});
}

Result<double> OwnLights::missing_of(std::size_t k, const ObservedCurve &curve,
                                     const PoseAnswer &pose) {
  if (pose.modes.empty())
    return 0.0;
  UMOV_ASSIGN(scenario, ready_.scenario(scenarios_.at(k)));
  return share_between(*scenario, *lights_.at(k), curve, pose.modes.front().turning, options_,
                       monitor_);
}

Result<std::vector<std::string>> OwnLights::doubt(std::size_t best, const ObservedCurve &curve,
                                                  IdentityWords &words) {
  std::vector<std::string> out;
  const auto &candidates = words.answer->candidates;
  const double floor = request_.observed.errors.floor;
  if (light(best) != nullptr) {
    UMOV_ASSIGN(share, missing_of(best, curve, candidates[best].answer));
    words.light_between = share;
    words.is_between_fitted = light(best)->between.has_value();
    if (words.verdict != Verdict::NoFit && !words.is_between_fitted)
      doubt_direct_light(share, floor, "the name may be wrong", words.verdict, out);
  }
  if (words.verdict != Verdict::NoFit)
    return out;
  // "None of these" rests on what the light of each would be: where that of one is not known, it
  // may be that one.
  for (const auto &[k, own] : lights_) {
    if (own->between)
      continue;
    double missing = words.light_between.value_or(0);
    if (k != best) {
      UMOV_ASSIGN(of_other, missing_of(k, curve, candidates[k].answer));
      missing = of_other;
    }
    doubt_direct_light(missing, floor,
                       fmt::format("that {} does not explain the data may be its doing",
                                   printable(words.names[k])),
                       words.verdict, out);
    if (is_too_much_between(missing, floor))
      words.verdict = Verdict::Undetermined;
  }
  return out;
}

/// Verdict and notes, and what light between surfaces makes of them.
Result<IdentityWords> words_of(const Library &library, OwnLights &own, const IdentityAnswer &answer,
                               const ObservedCurve &curve, const CurveErrors &errors) {
  IdentityWords words{
      library.names(), library.errors(), &answer, jobs::verdict_of(answer, curve, errors), {}};
  UMOV_ASSIGN(doubts, own.doubt(best_searched(answer), curve, words));
  words.notes = jobs::notes_of(words, curve, errors);
  words.notes.insert(words.notes.end(), doubts.begin(), doubts.end());
  return words;
}

} // namespace

Result<std::string> library_text(const std::string &folder) {
  UMOV_ASSIGN(library, Library::open(folder));
  std::string out;
  for (std::size_t k = 0; k < library.size(); ++k) {
    UMOV_ASSIGN(file, SignatureFile::open(library.file(k)));
    out += library.file(k).stem().string() + " " + file.view().text.job + "\n";
  }
  return out;
}

std::vector<NamedTable> no_identity_tables() {
  const IdentityAnswer none;
  IdentityWords words;
  words.answer = &none;
  return {{"identity", identity_table(words).part(0, 0)},
          {"modes", modes_table({}, false)},
          {"fit", fit_table({}, EndMember(), {})}};
}

Result<Inversion> identify_object(const Scenario &scenario, const IdentifyRequest &request,
                                  const JobOptions &options, const Monitor &monitor,
                                  Diagnostics &diagnostics) {
  ReadyObjects ready;
  auto out = identity_answer(scenario, request, options, ready, monitor, diagnostics);
  ready.keep();
  return out;
}

Result<Inversion> identity_answer(const Scenario &scenario, const IdentifyRequest &request,
                                  const JobOptions &options, ReadyObjects &ready,
                                  const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(library, Library::open(request.library));
  OwnLights own(request, options, ready, monitor, diagnostics);
  UMOV_TRY(own.assign(library));
  Inversion out;
  UMOV_ASSIGN(files, read_observations(request.observed.observations,
                                       request.observed.errors.has_polarization, options.threads,
                                       out.inputs, diagnostics));
  UMOV_ASSIGN(observed, observed_light_curve(scenario, files, request.observed.allow_old_elements,
                                             diagnostics, false));
  const ObservedCurve &curve = observed.curve;
  UMOV_TRY(own.check(curve));
  IdentifyOptions how;
  how.search = search_options(scenario, request.observed, options, monitor);
  how.search.largest_floor = 0; // evidences of candidates are those of the same errors
  how.none_prior = request.none_prior;
  SearchOptions own_search = how.search;
  own_search.progress = {};
  own_search.needs_set = false;
  how.own_light = [&](std::size_t k) { return own.answer(library, k, curve, own_search); };
  how.has_own_light = [&](std::size_t k) { return own.has(k); };
  const Candidates candidates{
      library.size(), [&](std::size_t k, const LookAtCandidate &look) -> Result<void> {
        if (monitor.is_cancelled())
          return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
        return library.lend(k, curve, look);
      }};
  UMOV_ASSIGN(answer, identify(curve, candidates, how));
  const CurveErrors &errors = request.observed.errors;
  UMOV_ASSIGN(words, words_of(library, own, answer, curve, errors));
  const std::size_t best = best_searched(answer);
  PoseAnswer pose = answer.candidates[best].answer;
  pose.errors = errors;
  Table fit;
  Contributions contributions{{}, curve.bands};
  const auto look = [&](const CurveModel &model) {
    fit = fit_table(observed, model, pose);
    contributions.all = contributions_to(pose, model, 1);
  };
  if (const SearchedLight *light = own.light(best)) {
    look(CurveModel(curve, whole_lighting(*light, options.threads, monitor), own.columns(best)));
    out.light = own.used(best);
  } else {
    UMOV_TRY(library.lend(best, curve, [&](const Signature &s, std::span<const std::size_t> c) {
      look(CurveModel(curve, lighting_of(s, options.threads), {c.begin(), c.end()}));
    }));
  }
  out.verdict = words.verdict;
  out.summary = summary_of(words);
  out.json = json_of(words, library.identity());
  out.tables = {{"identity", identity_table(words)},
                {"modes", modes_table(pose, false)},
                {"fit", std::move(fit)}};
  out.page = inversion_page(
      fmt::format("Which object: {} at its best", printable(words.names[best])),
      out.tables[2].table, pose, out.verdict, contributions, out.summary + odds_of(words));
  out.inputs.insert(out.inputs.end(), observed.inputs.begin(), observed.inputs.end());
  out.seed = scenario.seed;
  return out;
}

} // namespace umov::jobs
