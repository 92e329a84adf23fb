#pragma once
// A page of line plots: one HTML file that needs no network.

#include <array>
#include <string>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// One line, or set of points, of a figure.
struct PlotLine {
  std::string name;           ///< "": not in the legend
  std::vector<double> x, y;   ///< NaN breaks the line
  std::size_t colour = 0;     ///< into the colour-blind safe list
  std::string dash = "solid"; ///< solid, dash, dot, dashdot: lines differ by more than colour
  std::vector<std::string> labels = {}; ///< of points of a sky figure, "" for none; may be empty
  bool has_markers = false;             ///< points without a line
  std::vector<double> z = {};           ///< of a figure in space
  bool is_faint = false;                ///< thin and pale: bars of errors behind their points
};
/// A way of drawing lines for each of the first four, and then again.
const char *plot_dash(std::size_t number);
/// One figure: its axes and lines.
struct PlotFigure {
  std::string title, x_title, y_title;
  std::vector<PlotLine> lines;
  bool has_log_y = false;
  bool is_sky = false; ///< x: azimuth from north through east, y: altitude [deg]; drawn as the sky
                       ///< overhead, north up and east left
  std::string z_title = {}; ///< not empty: in space, turnable; every line has z
  /// What the axes of the page show, from the first to the second; alike: all there is.
  std::array<double, 2> x_span{}, y_span{};
  bool has_log_x = false;
  std::vector<std::string> y_names = {}; ///< page: at y = 1, 2, ... for numbers and legend
};

/// The page: title, one card per figure (each can be saved as SVG), notes at the end. Same input,
/// same bytes. Internal if this build has no plotting script.
Result<std::string> make_plot_page(const std::string &title, const std::vector<PlotFigure> &figures,
                                   const std::vector<std::string> &notes);
/// The same where the first note is the answer: it stands below the title, not at the end.
Result<std::string> make_answer_page(const std::string &title,
                                     const std::vector<PlotFigure> &figures,
                                     const std::vector<std::string> &notes);

/// One figure as an SVG picture of 640 x 440, white ground; one in space as a parallel projection.
/// Same input, same bytes.
std::string plot_svg(const PlotFigure &figure);

} // namespace umov
