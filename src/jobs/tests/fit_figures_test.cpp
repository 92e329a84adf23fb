// Figures of a fit: what they draw and how far their axes go.

#include "jobs/band_colours.h"
#include "jobs/fit_figures.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <umov/picture/colours.h>

namespace umov::jobs {
namespace {

/// A fit of two rows in one band, q as given and its model's twice that.
Table fit_of(double first, double second) {
  Table out;
  out.add("time_utc", "", "",
          std::vector<std::string>{"2018-01-21T05:08:00Z", "2018-01-21T05:09:00Z"});
  out.add("band", "", "", std::vector<std::string>{"nm:550", "nm:550"});
  for (const char *name : {"intensity", "intensity_model", "intensity_err"})
    out.add(name, "m2/sr", "", std::vector<double>{1, 2});
  out.add("q_scat", "", "", std::vector<double>{first, second});
  out.add("q_scat_model", "", "", std::vector<double>{2 * first, 2 * second});
  out.add("q_err", "", "", std::vector<double>{0, std::nan("")});
  return out;
}

PlotFigure polarization_of(const Table &fit) {
  std::vector<PlotFigure> figures;
  add_data_figures(figures, fit);
  return *std::ranges::find(figures, std::string("q (scattering plane)"), &PlotFigure::y_title);
}

// As in reports, by wavelength and not by name: "nm:1100" stands before "nm:425" in an alphabet.
TEST(BandColours, GoFromBlueToRed) {
  constexpr std::size_t blue = 4, green = 2, red = 5; // of plot_colour: Okabe & Ito (2008)
  EXPECT_EQ(plot_colour(blue), "#0072b2");
  EXPECT_EQ(plot_colour(green), "#009e73");
  EXPECT_EQ(plot_colour(red), "#d55e00");
  using Colours = std::vector<std::size_t>;
  EXPECT_EQ(band_colours({"nm:1100", "nm:425", "nm:550"}), (Colours{red, blue, green}));
  EXPECT_EQ(band_colours({"Bessell.R", "Bessell.B"}), (Colours{green, blue}));
  EXPECT_EQ(band_colours({"mine", "other"}), (Colours{blue, green}));
}

// Polarization of 1e-12 is what is left of two numbers that are alike: drawn as none, on an axis of
// a per cent, which is what would be seen.
TEST(FitFigures, RoundingIsNoPolarization) {
  const PlotFigure drawn = polarization_of(fit_of(1e-12, -3e-12));
  for (const PlotLine &line : drawn.lines)
    for (const double y : line.y)
      EXPECT_TRUE(y == 0 || std::isnan(y)) << y;
  EXPECT_EQ(drawn.y_span[0], -0.01);
  EXPECT_EQ(drawn.y_span[1], 0.01);
}

TEST(FitFigures, SmallPolarizationIsDrawnAsItIs) {
  const PlotFigure drawn = polarization_of(fit_of(1e-4, 0.02));
  EXPECT_EQ(drawn.y_span[0], drawn.y_span[1]); // the page finds its own
  const auto &seen = drawn.lines[1].y;         // after the bars
  EXPECT_EQ(seen[0], 1e-4);
  EXPECT_EQ(seen[1], 0.02);
}

} // namespace
} // namespace umov::jobs
