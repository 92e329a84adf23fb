#pragma once
// Private: a plan of observations as numbers, tables, words and a page.

#include <umov/inverse/design.h>
#include <umov/jobs/plan.h>
#include <umov/observation/epochs.h>

namespace umov::jobs {

/// One choice of what is measured in a pass.
struct PlanChoice {
  std::string bands; ///< "all", or the name of one
  bool has_polarization = true;
  Discrimination told;
};
/// A pass with all choices.
struct PlannedPass {
  std::size_t pass = 0;               ///< into KeptEpochs::passes
  std::vector<std::size_t> epochs;    ///< into the geometry
  std::vector<PlanChoice> choices;    ///< all bands with polarization first, without it second
  std::vector<double> log_bayes;      ///< all bands with polarization: [truth * n + other]
  std::vector<double> log_bayes_of_i; ///< the same of I alone
};
/// Passes together, one more with each step.
struct PlanStep {
  std::size_t pass = 0; ///< into the planned passes
  Discrimination told;
};
/// Everything that was computed.
struct Plan {
  std::vector<std::string> names; ///< of the alternatives
  std::vector<std::string> bands;
  KeptEpochs kept;
  std::vector<Alternative> alternatives; ///< [epoch * bands + band]
  std::vector<PlannedPass> passes;       ///< best first
  std::vector<PlanStep> sequence;
  std::string noise; ///< in words
  std::vector<std::string> notes;
  Verdict verdict = Verdict::Undetermined;
};

/// plan, choices, pairs, sequence and light, in this order.
std::vector<NamedTable> plan_tables(const Plan &plan);
std::string plan_summary(const Plan &plan);
std::string plan_json(const Plan &plan);
/// Information against time, and the light of the best pass under every alternative. Empty where
/// this build makes none.
std::string plan_page(const std::string &title, const Plan &plan);

} // namespace umov::jobs
