// Which object of a library gave a light curve.

#include <umov/jobs/library.h>

#include "jobs/invert_tables.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/inverse/identify.h>
#include <umov/io/signature_file.h>

namespace umov::jobs {
namespace {

namespace fs = std::filesystem;

/// All files of a library, in the order of their names.
Result<std::vector<SignatureFile>> open_library(const std::string &folder) {
  std::vector<fs::path> paths;
  std::error_code problem;
  for (const auto &entry : fs::directory_iterator(folder, problem))
    if (entry.path().extension() == ".umovsig")
      paths.push_back(entry.path());
  if (problem)
    return fail(ErrorCode::BadInput, "cannot be read: " + problem.message(), {folder});
  if (paths.empty())
    return fail(ErrorCode::BadInput,
                "holds no signature (*.umovsig); umov library build A.toml B.toml -o makes them",
                {folder});
  std::ranges::sort(paths);
  std::vector<SignatureFile> out;
  for (const fs::path &path : paths) {
    UMOV_ASSIGN(file, SignatureFile::open(path));
    if (!out.empty()) {
      const SignatureView &first = out.front().view(), &own = file.view();
      if (own.text.bands != first.text.bands || own.signature.cells != first.signature.cells)
        return fail(
            ErrorCode::BadInput,
            fmt::format("has other bands or another grid than {}: {} in {} cells, not {} in "
                        "{}; make the library anew",
                        first.text.name, fmt::join(own.text.bands, ", "), own.signature.cells,
                        fmt::join(first.text.bands, ", "), first.signature.cells),
            {path.string()});
    }
    out.push_back(std::move(file));
  }
  return out;
}

/// Which band of the library each band of the curve is.
Result<std::vector<std::size_t>> columns_of(const ObservedCurve &curve,
                                            const std::vector<std::string> &bands,
                                            const std::string &folder) {
  std::vector<std::size_t> out;
  for (const std::string &band : curve.bands) {
    const auto at = std::ranges::find(bands, band);
    if (at == bands.end())
      return fail(ErrorCode::BadInput,
                  fmt::format("has no band {}; it has {}", printable(band), fmt::join(bands, ", ")),
                  {folder});
    out.push_back(static_cast<std::size_t>(at - bands.begin()));
  }
  return out;
}

Verdict verdict_of(const IdentityAnswer &answer, const ObservedCurve &curve) {
  constexpr double sure = 0.95;
  if (answer.none > 0.5)
    return Verdict::NoFit;
  const IdentityCandidate &best = answer.candidates.front();
  if (best.probability > sure && curve.epochs.size() > 1 && !is_steady(curve))
    return Verdict::Determined;
  std::size_t likely = 0;
  for (const IdentityCandidate &c : answer.candidates)
    likely += c.probability > 0.05 * best.probability ? 1u : 0u;
  return 2 * likely > std::min<std::size_t>(answer.candidates.size(), 6) ? Verdict::Undetermined
                                                                         : Verdict::Ambiguous;
}

Table identity_table(const IdentityAnswer &answer, const std::vector<Signature> &library) {
  std::vector<std::string> name;
  std::vector<double> probability, evidence, chi2, rank;
  std::vector<std::int64_t> measurements;
  const auto add = [&](std::string what, double share, double log_evidence, double fit,
                       std::int64_t numbers, double score) {
    name.push_back(std::move(what));
    probability.push_back(share);
    evidence.push_back(log_evidence);
    chi2.push_back(fit);
    measurements.push_back(numbers);
    rank.push_back(score);
  };
  for (const IdentityCandidate &c : answer.candidates) {
    if (!c.is_finalist)
      break;
    add(library[c.which].name, c.probability, c.log_evidence, c.chi2,
        static_cast<std::int64_t>(c.measurements), c.rank_score);
  }
  add("none of these", answer.none, answer.none_log_evidence, std::nan(""), 0, std::nan(""));
  Table out;
  out.add("name", "", "of the library; those of the last look, and none of these", std::move(name));
  out.add("probability", "", "that the curve is of it", std::move(probability));
  out.add("log_evidence", "", "over all attitudes; differences count", std::move(evidence));
  out.add("chi2", "", "of its best attitude", std::move(chi2));
  out.add("measurements", "", "that it was held against", std::move(measurements));
  out.add("first_look", "", "-2 ln of the best rough likelihood, which chose those fitted",
          std::move(rank));
  note_conventions(out);
  return out;
}

std::string json_of(const IdentityAnswer &answer, const std::vector<Signature> &library,
                    Verdict verdict, const std::vector<std::string> &notes) {
  using nlohmann::ordered_json;
  ordered_json out;
  out["program"] = "umov";
  out["version"] = version;
  out["question"] = "identity";
  out["verdict"] = name_of(verdict);
  out["objects"] = library.size();
  ordered_json list = ordered_json::array();
  for (const IdentityCandidate &c : answer.candidates)
    if (c.is_finalist)
      list.push_back({{"name", library[c.which].name},
                      {"probability", c.probability},
                      {"log_evidence", c.log_evidence},
                      {"chi2", c.chi2},
                      {"q", {c.attitude.w, c.attitude.x, c.attitude.y, c.attitude.z}}});
  out["candidates"] = list;
  out["none_of_these"] = answer.none;
  out["none_log_evidence"] = answer.none_log_evidence;
  out["notes"] = notes;
  return out.dump(1) + "\n";
}

} // namespace

Result<Inversion> identify_object(const Scenario &scenario, const InvertRequest &request,
                                  const std::string &folder, const JobOptions &options,
                                  const Monitor &monitor, Diagnostics &diagnostics) {
  std::vector<InputFile> inputs;
  UMOV_ASSIGN(files, read_observations(request.observations, inputs, diagnostics));
  UMOV_ASSIGN(observed,
              observed_light_curve(scenario, files, request.allow_old_elements, diagnostics));
  UMOV_ASSIGN(opened, open_library(folder));
  UMOV_ASSIGN(columns, columns_of(observed.curve, opened.front().view().text.bands, folder));
  std::vector<Signature> library;
  for (const SignatureFile &file : opened)
    library.push_back(file.view().signature);
  IdentifyOptions how;
  how.search.errors = request.errors;
  how.search.grid = std::min<std::size_t>(request.grid, 20'000); // a table tells no more
  how.search.samples = 400;
  how.search.seed = scenario.seed;
  how.search.threads = options.threads;
  how.search.progress = [&monitor](const char *what, std::size_t done, std::size_t total) {
    monitor.advance(what, done, total);
  };
  UMOV_ASSIGN(answer, identify(observed.curve, columns, library, how));
  Inversion out;
  out.verdict = verdict_of(answer, observed.curve);
  std::vector<std::string> notes = limits_of(observed.curve);
  if (answer.candidates.front().is_broad)
    notes.emplace_back("the most probable object explains the curve in a wide region of attitudes: "
                       "little of its shape was seen");
  const IdentityCandidate &best = answer.candidates.front();
  out.summary = fmt::format("{}: {} with {:.3g} %, none of these with {:.3g} %, of {}\n",
                            name_of(out.verdict), library[best.which].name, 100 * best.probability,
                            100 * answer.none, counted(library.size(), "object"));
  for (const std::string &text : notes)
    out.summary += "- " + text + "\n";
  out.json = json_of(answer, library, out.verdict, notes);
  out.tables = {{"identity", identity_table(answer, library)}};
  out.inputs = observed.inputs;
  for (InputFile &input : inputs)
    out.inputs.push_back(std::move(input));
  out.seed = scenario.seed;
  return out;
}

} // namespace umov::jobs
