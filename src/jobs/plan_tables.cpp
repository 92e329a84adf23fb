#include "jobs/plan_tables.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/core/version.h>

namespace umov::jobs {
namespace {

using Numbers = std::vector<double>;
using Words = std::vector<std::string>;

std::string pair_of(const Plan &plan, const Discrimination &told) {
  return plan.names[told.hardest_a] + " | " + plan.names[told.hardest_b];
}

const char *state_of(bool has_polarization) { return has_polarization ? "I,q,u" : "I"; }

std::string id_of(const Plan &plan, const PlannedPass &pass) {
  return plan.kept.passes[pass.pass].id;
}

/// The band that tells most by itself; "all" where there is one.
const PlanChoice &best_band(const PlannedPass &pass) {
  const PlanChoice *out = &pass.choices.front();
  double most = -1;
  for (const PlanChoice &choice : pass.choices)
    if (choice.bands != "all" && choice.has_polarization && choice.told.information_bits > most) {
      out = &choice;
      most = choice.told.information_bits;
    }
  return *out;
}

void note(Table &table, const Plan &plan) {
  note_conventions(table);
  table.note("noise", plan.noise);
}

Table pass_table(const Plan &plan) {
  Words id, first, last, band, hardest;
  std::vector<std::int64_t> rows;
  Numbers altitude, phase_min, phase_max, bits, of_i, adds, of_band, decided, bayes, bayes_i;
  for (const PlannedPass &pass : plan.passes) {
    const auto &geometry = plan.kept.geometry;
    const auto phase = [&](std::size_t e) { return geometry[e].phase_angle.degrees(); };
    const auto [low, high] = std::ranges::minmax(pass.epochs, {}, phase);
    const Discrimination &all = pass.choices[0].told, &alone = pass.choices[1].told;
    id.push_back(id_of(plan, pass));
    first.push_back(to_iso(geometry[pass.epochs.front()].time));
    last.push_back(to_iso(geometry[pass.epochs.back()].time));
    rows.push_back(static_cast<std::int64_t>(pass.epochs.size()));
    altitude.push_back(plan.kept.passes[pass.pass].culmination_altitude.degrees());
    phase_min.push_back(phase(low));
    phase_max.push_back(phase(high));
    bits.push_back(all.information_bits);
    of_i.push_back(alone.information_bits);
    adds.push_back(all.information_bits - alone.information_bits);
    band.push_back(best_band(pass).bands);
    of_band.push_back(best_band(pass).told.information_bits);
    decided.push_back(all.decided);
    bayes.push_back(all.hardest_log_bayes);
    bayes_i.push_back(alone.hardest_log_bayes);
    hardest.push_back(pair_of(plan, all));
  }
  Table out;
  out.add("pass_id", "", "object and time of culmination", std::move(id));
  out.add("first_utc", "", "first row that can be observed", std::move(first));
  out.add("last_utc", "", "last one", std::move(last));
  out.add("epochs", "", "rows between them", std::move(rows));
  out.add("alt_max", "deg", "of the pass", std::move(altitude));
  out.add("phase_min", "deg", "Sun-object-observer", std::move(phase_min));
  out.add("phase_max", "deg", "the same, largest", std::move(phase_max));
  out.add("information", "bit", "all bands, I, q and u: of data about which alternative it is",
          std::move(bits));
  out.add("information_i", "bit", "all bands, I alone", std::move(of_i));
  out.add("polarization_adds", "bit", "the difference", std::move(adds));
  out.add("best_band", "", "the one that tells most by itself", std::move(band));
  out.add("information_band", "bit", "of that band alone, I, q and u", std::move(of_band));
  out.add("decided", "", "chance that the true one gets more than 95 %", std::move(decided));
  out.add("ln_bayes", "", "expected ln Bayes factor of the hardest pair", std::move(bayes));
  out.add("ln_bayes_i", "", "the same by I alone", std::move(bayes_i));
  out.add("hardest", "", "that pair, the true one first", std::move(hardest));
  note(out, plan);
  return out;
}

Table choices_table(const Plan &plan) {
  Words id, bands, state, hardest;
  Numbers bits, right, decided, bayes;
  for (const PlannedPass &pass : plan.passes)
    for (const PlanChoice &choice : pass.choices) {
      id.push_back(id_of(plan, pass));
      bands.push_back(choice.bands);
      state.emplace_back(state_of(choice.has_polarization));
      bits.push_back(choice.told.information_bits);
      right.push_back(choice.told.right);
      decided.push_back(choice.told.decided);
      bayes.push_back(choice.told.hardest_log_bayes);
      hardest.push_back(pair_of(plan, choice.told));
    }
  Table out;
  out.add("pass_id", "", "as in plan", std::move(id));
  out.add("bands", "", "all, or one", std::move(bands));
  out.add("measured", "", "I, or I, q and u", std::move(state));
  out.add("information", "bit", "of data about which alternative it is", std::move(bits));
  out.add("right", "", "chance that the likeliest alternative is the true one", std::move(right));
  out.add("decided", "", "chance that the true one gets more than 95 %", std::move(decided));
  out.add("ln_bayes", "", "expected ln Bayes factor of the hardest pair", std::move(bayes));
  out.add("hardest", "", "that pair, the true one first", std::move(hardest));
  note(out, plan);
  return out;
}

Table pairs_table(const Plan &plan) {
  const std::size_t n = plan.names.size();
  Words id, truth, other;
  Numbers bayes, bayes_i;
  for (const PlannedPass &pass : plan.passes)
    for (std::size_t k = 0; k < n * n; ++k)
      if (k / n != k % n) {
        id.push_back(id_of(plan, pass));
        truth.push_back(plan.names[k / n]);
        other.push_back(plan.names[k % n]);
        bayes.push_back(pass.log_bayes[k]);
        bayes_i.push_back(pass.log_bayes_of_i[k]);
      }
  Table out;
  out.add("pass_id", "", "as in plan", std::move(id));
  out.add("true", "", "what is the case", std::move(truth));
  out.add("other", "", "what it is told from", std::move(other));
  out.add("ln_bayes", "", "expected ln Bayes factor, all bands, I, q and u", std::move(bayes));
  out.add("ln_bayes_i", "", "the same by I alone", std::move(bayes_i));
  note(out, plan);
  return out;
}

Table sequence_table(const Plan &plan) {
  std::vector<std::int64_t> step;
  Words id, hardest;
  Numbers bits, right, decided, bayes;
  for (const PlanStep &one : plan.sequence) {
    step.push_back(static_cast<std::int64_t>(step.size()) + 1);
    id.push_back(id_of(plan, plan.passes[one.pass]));
    bits.push_back(one.told.information_bits);
    right.push_back(one.told.right);
    decided.push_back(one.told.decided);
    bayes.push_back(one.told.hardest_log_bayes);
    hardest.push_back(pair_of(plan, one.told));
  }
  Table out;
  out.add("step", "", "this pass on top of those before", std::move(step));
  out.add("pass_id", "", "as in plan", std::move(id));
  out.add("information", "bit", "of all passes so far", std::move(bits));
  out.add("right", "", "chance that the likeliest alternative is the true one", std::move(right));
  out.add("decided", "", "chance that the true one gets more than 95 %", std::move(decided));
  out.add("ln_bayes", "", "expected ln Bayes factor of the hardest pair", std::move(bayes));
  out.add("hardest", "", "that pair, the true one first", std::move(hardest));
  note(out, plan);
  return out;
}

Table light_table(const Plan &plan) {
  Words time, id, band, name;
  Numbers i, q, u, i_sd, q_sd;
  const std::size_t bands = plan.bands.size();
  for (const PlannedPass &pass : plan.passes)
    for (const std::size_t e : pass.epochs)
      for (std::size_t b = 0; b < bands; ++b)
        for (const Alternative &a : plan.alternatives) {
          const std::size_t k = e * bands + b;
          const double light = a.light.i[k];
          time.push_back(to_iso(plan.kept.geometry[e].time));
          id.push_back(id_of(plan, pass));
          band.push_back(plan.bands[b]);
          name.push_back(a.light.name);
          i.push_back(light);
          q.push_back(light > 0 ? a.light.q[k] / light : std::nan(""));
          u.push_back(light > 0 ? a.light.u[k] / light : std::nan(""));
          i_sd.push_back(a.errors.i_sd[k]);
          q_sd.push_back(a.errors.q_sd[k]);
        }
  Table out;
  out.add("time_utc", "", "UTC", std::move(time));
  out.add("pass_id", "", "as in plan", std::move(id));
  out.add("band", "", "band", std::move(band));
  out.add("alternative", "", "if this is the case", std::move(name));
  out.add("intensity", "m2 / sr", "its light", std::move(i));
  out.add("q_scat", "", "Q/I in the scattering plane", std::move(q));
  out.add("u_scat", "", "U/I in the scattering plane", std::move(u));
  out.add("intensity_err", "m2 / sr", "of an observer, nan: saturated", std::move(i_sd));
  out.add("q_err", "", "of q and of u, nan: too faint, saturated or not measured", std::move(q_sd));
  note(out, plan);
  return out;
}

nlohmann::ordered_json json_of(const Plan &plan, const Discrimination &told) {
  return {{"information_bits", told.information_bits},
          {"right", told.right},
          {"decided", told.decided},
          {"ln_bayes", told.hardest_log_bayes},
          {"hardest", {plan.names[told.hardest_a], plan.names[told.hardest_b]}}};
}

} // namespace

std::vector<NamedTable> plan_tables(const Plan &plan) {
  return {{"plan", pass_table(plan)},
          {"choices", choices_table(plan)},
          {"pairs", pairs_table(plan)},
          {"sequence", sequence_table(plan)},
          {"light", light_table(plan)}};
}

std::string plan_summary(const Plan &plan) {
  const PlannedPass &best = plan.passes.front();
  const Discrimination &all = best.choices[0].told, &alone = best.choices[1].told;
  const double most = std::log2(static_cast<double>(plan.names.size()));
  std::string out = fmt::format(
      "{}: {} told apart by {}; best pass {}: {:.3g} of {:.3g} bit, I alone {:.3g}; decided with a "
      "chance of {} %, I alone {} %\n",
      name_of(plan.verdict), counted(plan.names.size(), "alternative"),
      counted(plan.passes.size(), "pass", "passes"), id_of(plan, best), all.information_bits, most,
      alone.information_bits, percent(all.decided), percent(alone.decided));
  out +=
      fmt::format("expected ln Bayes factor of the hardest pair there ({}): {:.3g}, I alone "
                  "{:.3g}; noise: {}\n",
                  pair_of(plan, all), all.hardest_log_bayes, alone.hardest_log_bayes, plan.noise);
  if (plan.sequence.size() > 1) {
    const PlanStep &last = plan.sequence.back();
    out += fmt::format("{} of them together: decided with a chance of {} %\n", plan.sequence.size(),
                       percent(last.told.decided));
  }
  for (const std::string &text : plan.notes)
    out += "- " + text + "\n";
  return out;
}

std::string plan_json(const Plan &plan) {
  using nlohmann::ordered_json;
  ordered_json out;
  out["program"] = "umov";
  out["version"] = version;
  out["question"] = "plan";
  out["verdict"] = name_of(plan.verdict);
  out["alternatives"] = plan.names;
  out["bands"] = plan.bands;
  out["noise"] = plan.noise;
  ordered_json passes = ordered_json::array();
  for (const PlannedPass &pass : plan.passes)
    passes.push_back({{"pass_id", id_of(plan, pass)},
                      {"epochs", pass.epochs.size()},
                      {"all", json_of(plan, pass.choices[0].told)},
                      {"i_alone", json_of(plan, pass.choices[1].told)},
                      {"best_band", best_band(pass).bands}});
  out["passes"] = passes;
  ordered_json steps = ordered_json::array();
  for (const PlanStep &one : plan.sequence) {
    ordered_json step = json_of(plan, one.told);
    step["pass_id"] = id_of(plan, plan.passes[one.pass]);
    steps.push_back(std::move(step));
  }
  out["sequence"] = steps;
  out["notes"] = plan.notes;
  return out.dump(1) + "\n";
}

} // namespace umov::jobs
