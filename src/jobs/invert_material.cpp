#include "jobs/curve_limits.h"
#include "jobs/fit_figures.h"
#include "jobs/invert_group.h"
#include "jobs/invert_parts.h"
#include "jobs/invert_tables.h"
#include "jobs/u_null_test.h"
#include "jobs/verdict_json.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/inverse/unmix.h>
#include <umov/observation/track.h>

namespace umov::jobs {
namespace {

/// Probability of each candidate alone, all of them alike before.
std::vector<double> probabilities(const ObservedCurve &curve, const CurveErrors &errors,
                                  const std::vector<EndMember> &members, double &chi2) {
  const CurveLikelihood likelihood(curve, errors);
  std::vector<double> value;
  chi2 = 1e300;
  for (const EndMember &m : members) {
    const Comparison c = likelihood.compare({m.i, m.q, m.u});
    value.push_back(c.minus_2_log);
    chi2 = std::min(chi2, c.chi2);
  }
  const double best = *std::ranges::min_element(value);
  double sum = 0;
  for (double &v : value)
    sum += v = std::exp(-(v - best) / 2);
  for (double &v : value)
    v /= sum;
  return value;
}

/// A row of materials.ecsv.
struct Row {
  std::string names;
  double probability = 0;
  UnmixedGroup unmixed;
};

std::vector<Row> rows_of(const Unmixing &unmixed, const std::vector<EndMember> &members,
                         const std::vector<double> &probability) {
  std::vector<Row> out;
  for (const UnmixedGroup &group : unmixed.groups) {
    Row row{fmt::format("{}", fmt::join(group.names, "|")), 0, group};
    for (std::size_t k = 0; k < members.size(); ++k)
      if (std::ranges::find(group.names, members[k].name) != group.names.end())
        row.probability += probability[k];
    out.push_back(std::move(row));
  }
  return out;
}

Table materials_table(const std::string &group, const std::vector<Row> &rows) {
  std::vector<std::string> groups, names;
  std::vector<double> probability, fraction, error, detectable;
  for (const Row &row : rows) {
    groups.push_back(group);
    names.push_back(row.names);
    probability.push_back(row.probability);
    fraction.push_back(row.unmixed.fraction);
    error.push_back(row.unmixed.fraction_err);
    detectable.push_back(row.unmixed.detectable);
  }
  Table out;
  out.add("group", "", "of the mesh", std::move(groups));
  out.add("material", "", "those that cannot be told apart joined by |", std::move(names));
  out.add("probability", "", "that the group is of this one alone", std::move(probability));
  out.add("fraction", "", "of the group's area, if of several", std::move(fraction));
  out.add("fraction_err", "", "standard deviation", std::move(error));
  out.add("detectable", "", "smallest change of the fraction that shows at 3 sigma",
          std::move(detectable));
  note_conventions(out);
  return out;
}

std::string json_of(const std::string &group, const std::vector<Row> &rows, const Unmixing &unmixed,
                    const NullTest &u, Verdict verdict, double chi2,
                    const std::vector<std::string> &notes) {
  using nlohmann::ordered_json;
  ordered_json out;
  out["program"] = "umov";
  out["version"] = version;
  out["question"] = "material";
  out["verdict"] = name_of(verdict);
  out["group"] = group;
  out["chi2_of_one"] = chi2;
  out["chi2_of_mixture"] = unmixed.chi2;
  out["measurements"] = unmixed.measurements;
  out["condition"] = unmixed.condition;
  ordered_json list = ordered_json::array();
  for (const Row &row : rows)
    list.push_back({{"materials", row.unmixed.names},
                    {"probability", row.probability},
                    {"fraction", row.unmixed.fraction},
                    {"fraction_err", row.unmixed.fraction_err},
                    {"detectable", row.unmixed.detectable}});
  out["materials"] = list;
  put_null_test(u, out);
  out["notes"] = notes;
  return out.dump(1) + "\n";
}

/// A chi-square that neither noise nor the errors of a model explain.
bool is_misfit(double chi2, double dof) {
  constexpr double unlikely = 1e-6;
  return dof > 0 && chi2_probability(chi2, dof) < unlikely && chi2 > 2 * dof;
}

/// The group is of several, or of what is not among them: no candidate alone does what a mixture
/// does. `chi2`: of the best candidate alone, by the same errors.
bool is_of_several(const std::vector<Row> &rows, const Unmixing &unmixed, double chi2,
                   const CurveErrors &errors) {
  if (rows.size() < 2)
    return false;
  if (is_misfit(chi2, static_cast<double>(unmixed.measurements) - 1))
    return true;
  constexpr double unlikely = 1e-6;
  return !errors.has_clouds && !(errors.outlier_share > 0) &&
         chi2_probability(chi2 - unmixed.chi2, static_cast<double>(rows.size()) - 1) < unlikely;
}

/// One candidate (or what cannot be told from it) holds all; several do, or a mixture of them; or
/// none fits.
Verdict verdict_of(const std::vector<Row> &rows, const Unmixing &unmixed, bool is_several) {
  const auto count = static_cast<double>(unmixed.measurements);
  if (is_misfit(unmixed.chi2, count - static_cast<double>(rows.size())))
    return Verdict::NoFit;
  if (rows.size() < 2 || !(unmixed.scale > 0))
    return Verdict::Undetermined;
  const bool is_one = std::ranges::any_of(rows, [](const Row &r) { return r.probability > 0.95; });
  return is_one && !is_several ? Verdict::Determined : Verdict::Ambiguous;
}

bool is_dark(const std::vector<EndMember> &members) {
  return std::ranges::all_of(members, [](const EndMember &m) {
    return std::ranges::none_of(m.i, [](double light) { return light > 0; });
  });
}

/// What the answer rests on, and what it cannot tell.
std::vector<std::string> notes_of(const std::vector<Row> &rows, const Unmixing &unmixed,
                                  Verdict verdict, double chi2, bool is_several,
                                  const std::vector<EndMember> &members, bool has_clouds) {
  std::vector<std::string> out;
  if (unmixed.left_out > 0)
    out.push_back(fmt::format("{} with q and u but without light above 0: left out of the "
                              "mixture, whose q and u need the I that they are parts of",
                              counted(unmixed.left_out, "row")));
  if (has_clouds)
    out.emplace_back("--clouds: the probabilities allow for them, the fractions take the sky for "
                     "clear");
  for (const Row &row : rows)
    if (unmixed.scale > 0 && std::isnan(row.unmixed.fraction))
      out.push_back(fmt::format("{} gives next to no light here beside the others: how much of it "
                                "there is is not known, and their parts are of what is left",
                                row.names));
  if (is_dark(members))
    out.emplace_back(
        "in the scenario's attitude the object gives no light at these times, whatever "
        "the group is of: are attitude and times right?");
  else if (!(unmixed.scale > 0))
    out.emplace_back("the data hold no light above their errors: nothing is known of the group");
  else if (verdict == Verdict::NoFit)
    out.emplace_back("no candidate and no mixture of them explains the data within their errors "
                     "and --floor: is the attitude right, the object, the rest of its materials?");
  else if (members.size() < 2)
    out.emplace_back(
        "one candidate: that it explains the data is all that is told; name others for "
        "what it is to be told from");
  else if (rows.size() < 2)
    out.emplace_back("these observations tell none of the candidates from the others: the group "
                     "gives too little light, or their light is alike");
  else if (is_several)
    out.push_back(
        fmt::format("no candidate alone explains the data as a mixture does (chi-square "
                    "{:.4g} and {:.4g}): the group is of several, or of what is not among "
                    "them",
                    chi2, unmixed.chi2));
  return out;
}

std::string in_percent(double part) { return fmt::format("{:.3g} %", 100 * part); }

/// The first line: what it is, as far as that is told.
std::string headline(const std::string &group, const std::string &object, Verdict verdict,
                     const std::vector<Row> &rows, bool is_several) {
  std::string of = fmt::format("{}: {} of {}", name_of(verdict), group, object);
  const Row &likeliest = *std::ranges::max_element(rows, {}, &Row::probability);
  if (verdict == Verdict::Determined)
    return of + " is " + likeliest.names;
  if (verdict == Verdict::Ambiguous && is_several)
    return of + " is of several";
  if (verdict == Verdict::Ambiguous)
    return fmt::format("{} may be {}, with {} of the probability", of, likeliest.names,
                       in_percent(likeliest.probability));
  return of;
}

/// A line of each row, for the page.
std::string lines_of(const std::vector<Row> &rows, Verdict verdict, bool is_several) {
  std::string out;
  for (const Row &row : rows) {
    if (verdict == Verdict::NoFit || verdict == Verdict::Undetermined)
      break; // no row says anything
    const UnmixedGroup &part = row.unmixed;
    out += "- " + row.names + ": ";
    if (!is_several)
      out += in_percent(row.probability) + " of the probability; ";
    out += std::isnan(part.fraction)
               ? std::string("of a mixture not known\n")
               : fmt::format("of a mixture {} +- {} of the area\n", in_percent(part.fraction),
                             in_percent(part.fraction_err));
  }
  return out;
}

/// What each band and Stokes component says by itself of the candidates, two of them at least.
Table parts_table(const std::vector<DataPart> &parts, const CurveErrors &errors,
                  const std::vector<EndMember> &members, std::vector<PartAnswer> &of_first) {
  std::vector<std::string> material, bands, measured;
  std::vector<double> fraction, error, detectable;
  for (const DataPart &part : parts) {
    const Unmixing unmixed = unmix(part.curve, errors, members);
    for (const UnmixedGroup &group : unmixed.groups) {
      material.push_back(fmt::format("{}", fmt::join(group.names, "|")));
      bands.push_back(part.bands);
      measured.push_back(part.measured);
      fraction.push_back(group.fraction);
      error.push_back(group.fraction_err);
      detectable.push_back(group.detectable);
      const bool has_first =
          std::ranges::find(group.names, members.front().name) != group.names.end();
      if (has_first && group.names.size() < members.size() && !std::isnan(group.fraction))
        of_first.push_back({part.name(), group.fraction, group.fraction_err});
    }
  }
  Table out;
  out.add("material", "", "those that cannot be told apart joined by |", std::move(material));
  out.add("bands", "", "all, or one", std::move(bands));
  out.add("measured", "", "I, or I, q and u", std::move(measured));
  out.add("fraction", "", "of the group's area, by this part of the data", std::move(fraction));
  out.add("fraction_err", "", "standard deviation", std::move(error));
  out.add("detectable", "", "smallest change of the fraction that shows at 3 sigma",
          std::move(detectable));
  note_conventions(out);
  return out;
}

std::string material_page_of(const std::string &title, const Table &fit, const Unmixing &unmixed,
                             const std::string &first, const std::vector<PartAnswer> &parts,
                             const std::string &summary) {
  std::vector<PlotFigure> figures;
  add_data_figures(figures, fit);
  FittedNumbers numbers;
  for (const UnmixedGroup &group : unmixed.groups) {
    if (std::isnan(group.fraction))
      continue;
    numbers.name.push_back(fmt::format("part of {}", fmt::join(group.names, "|")));
    numbers.value.push_back(group.fraction);
  }
  numbers.covariance = unmixed.covariance;
  add_error_figures(figures, numbers);
  if (!parts.empty())
    figures.push_back(parts_figure("What each band and Stokes component says by itself",
                                   "part of " + first, parts));
  const auto page = make_answer_page(title, figures, page_lines(summary));
  return page ? *page : std::string();
}

/// Light of the object with the group of each candidate.
Result<std::vector<EndMember>> light_of(GroupLight &light, const std::vector<GroupMaterial> &all,
                                        const Monitor &monitor) {
  std::vector<EndMember> out;
  for (const GroupMaterial &candidate : all) {
    monitor.advance("candidates", out.size(), all.size());
    UMOV_ASSIGN(member, light.of(candidate, monitor));
    out.push_back(std::move(member));
  }
  return out;
}

/// Each once.
Result<void> check_candidates(const std::vector<std::string> &names) {
  for (std::size_t k = 1; k < names.size(); ++k)
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(k), names[k]) !=
        names.begin() + static_cast<std::ptrdiff_t>(k))
      return fail(ErrorCode::Usage, fmt::format("--candidates: {} stands twice; name each once",
                                                printable(names[k])));
  return {};
}

} // namespace

Result<Inversion> invert_material(const Scenario &scenario, const InvertRequest &request,
                                  const MaterialOptions &material, const JobOptions &options,
                                  const Monitor &monitor, Diagnostics &diagnostics) {
  std::vector<InputFile> inputs;
  UMOV_ASSIGN(files, read_observations(request.observations, request.errors.has_polarization,
                                       options.threads, inputs, diagnostics));
  UMOV_ASSIGN(observed, observed_light_curve(scenario, files, request.allow_old_elements,
                                             diagnostics, true, monitor.cancel));
  UMOV_TRY(check_candidates(material.candidates));
  if (std::ranges::all_of(observed.curve.samples,
                          [](const ObservedSample &s) { return std::isnan(s.i); }))
    return fail(ErrorCode::BadInput,
                "no row has light: materials are told apart by I, flux or mag, and by q and u in "
                "parts of it; add such a column",
                {request.observations.front()});
  std::vector<GroupMaterial> all;
  for (const std::string &name : material.candidates)
    all.push_back({material.group, name});
  GroupLight light(scenario, request, observed, options, all);
  UMOV_ASSIGN(members, light_of(light, all, monitor));
  tell_of_device(light.used().device, diagnostics);
  double chi2 = 0;
  const auto probability = probabilities(observed.curve, request.errors, members, chi2);
  const Unmixing unmixed = unmix(observed.curve, request.errors, members);
  const auto rows = rows_of(unmixed, members, probability);
  Inversion out;
  const bool is_several = is_of_several(rows, unmixed, chi2, request.errors);
  out.verdict = verdict_of(rows, unmixed, is_several);
  std::vector<std::string> notes = limits_of(observed.curve, request.errors, Asked::Part);
  std::ranges::move(
      notes_of(rows, unmixed, out.verdict, chi2, is_several, members, request.errors.has_clouds),
      std::back_inserter(notes));
  const NullTest u = null_test_of(observed.curve, unmixed.fitted);
  note_null_test(u, notes);
  out.summary =
      headline(material.group, scenario.objects.front().name, out.verdict, rows, is_several) +
      fmt::format("; {}a mixture: chi-square {:.4g} of {} measurements",
                  // Of clear sky as the mixture's, or it is no number beside it.
                  request.errors.has_clouds
                      ? std::string()
                      : fmt::format("one material alone: chi-square {:.4g}, ", chi2),
                  unmixed.chi2, unmixed.measurements);
  out.summary += std::isnan(unmixed.condition)
                     ? std::string("\n")
                     : fmt::format("; condition {:.3g}\n", unmixed.condition);
  for (const std::string &text : notes)
    out.summary += "- " + text + "\n";
  out.json = json_of(material.group, rows, unmixed, u, out.verdict, chi2, notes);
  std::vector<PartAnswer> of_first;
  const auto parts = parts_of(observed.curve, request.errors.has_polarization);
  out.tables = {{"materials", materials_table(material.group, rows)},
                {"parts", parts_table(parts, request.errors, members, of_first)},
                {"fit", fit_table(observed, unmixed.fitted, request.errors)}};
  out.page = material_page_of(
      fmt::format("What {} of {} is made of", material.group, scenario.objects.front().name),
      out.tables[2].table, unmixed, members.front().name, of_first,
      out.summary + lines_of(rows, out.verdict, is_several));
  out.inputs = observed.inputs;
  out.inputs.insert(out.inputs.end(), inputs.begin(), inputs.end());
  out.seed = scenario.seed;
  out.light = light.used();
  return out;
}

} // namespace umov::jobs
