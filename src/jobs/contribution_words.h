#pragma once
// Private: what each band and Stokes component gave to an answer, as table, figure and JSON.

#include <nlohmann/json.hpp>
#include <string>
#include <umov/inverse/contributions.h>
#include <umov/io/plot_page.h>
#include <umov/io/table.h>
#include <vector>

namespace umov::jobs {

/// Contributions of an answer, with the names of its bands.
struct Contributions {
  std::vector<Contribution> all;
  std::vector<std::string> bands;
};

/// contributions.ecsv.
Table contributions_table(const Contributions &contributions);
/// Shares one below the other.
PlotFigure contributions_figure(const Contributions &contributions);
/// `contributions` of verdict.json.
nlohmann::ordered_json contributions_json(const Contributions &contributions);

} // namespace umov::jobs
