#pragma once
// Private: what the pages of all inversions have in common.

#include <array>
#include <string>
#include <umov/io/plot_page.h>
#include <umov/io/table.h>
#include <vector>

namespace umov::jobs {

/// When rows were measured, from the first on; long gaps, as between passes, are left out.
struct TimeAxis {
  std::vector<double> x;            ///< empty where a text is no time
  std::vector<std::size_t> stretch; ///< of each row: those of one have no gap between them
  std::string title;
};
TimeAxis time_axis(const std::vector<std::string> &utc);

/// Data and fit against time, and what is left over. `fit`: as of fit_table.
void add_data_figures(std::vector<PlotFigure> &figures, const Table &fit);

/// Numbers that were fitted together, by name, with their errors.
struct FittedNumbers {
  std::vector<std::string> name;
  std::vector<double> value, covariance; ///< [row * size + column]
};
/// Ellipses of one and two standard deviations for every two of them, six figures at most.
void add_error_figures(std::vector<PlotFigure> &figures, const FittedNumbers &numbers);

/// What a part of the data says by itself about a number.
struct PartAnswer {
  std::string part; ///< bands and Stokes components, in words
  double value = 0, error = 0;
};
/// One below the other, with bars of one standard deviation.
PlotFigure parts_figure(const std::string &title, const std::string &x_title,
                        const std::vector<PartAnswer> &parts);

/// Lines of a summary as the page has them: its marks are its own.
std::vector<std::string> page_lines(const std::string &summary);

} // namespace umov::jobs
