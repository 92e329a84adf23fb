#include "jobs/contribution_words.h"

#include <algorithm>
#include <cstdint>
#include <umov/jobs/invert.h>

namespace umov::jobs {
namespace {

const char *name_of(CurveLikelihood::Measured what) {
  return what == CurveLikelihood::Measured::Intensity      ? "I"
         : what == CurveLikelihood::Measured::Polarization ? "q,u"
                                                           : "counts";
}

} // namespace

Table contributions_table(const Contributions &contributions) {
  std::vector<std::string> band, measured;
  std::vector<std::int64_t> numbers;
  std::vector<double> chi2, share;
  for (const Contribution &one : contributions.all) {
    band.push_back(contributions.bands[one.band]);
    measured.emplace_back(name_of(one.what));
    numbers.push_back(static_cast<std::int64_t>(one.numbers));
    chi2.push_back(one.chi2);
    share.push_back(one.share);
  }
  Table out;
  out.add("band", "", "", std::move(band));
  out.add("measured", "", "I, q and u, or counts of analysers", std::move(measured));
  out.add("numbers", "", "that were measured", std::move(numbers));
  out.add("chi2", "", "their part of that of the heaviest attitude", std::move(chi2));
  out.add("share", "", "of what is known of the heaviest attitude; the rest is of priors",
          std::move(share));
  note_conventions(out);
  return out;
}

PlotFigure contributions_figure(const Contributions &contributions) {
  PlotFigure out{
      "What each band and Stokes component contributed", "share of what is known [%]", "", {}};
  double most = 0;
  for (std::size_t k = 0; k < contributions.all.size(); ++k) {
    const Contribution &one = contributions.all[k];
    const double y = static_cast<double>(k) + 1, share = 100 * one.share;
    out.y_names.push_back(contributions.bands[one.band] + ", " + name_of(one.what));
    PlotLine bar{{}, {0, share}, {y, y}, k};
    PlotLine end{out.y_names.back(), {share}, {y}, k};
    end.has_markers = true;
    out.lines.push_back(std::move(bar));
    out.lines.push_back(std::move(end));
    most = std::max(most, share);
  }
  out.x_span = {0, 1.1 * most};
  out.y_span = {static_cast<double>(contributions.all.size()) + 0.5, 0.5}; // the first on top
  return out;
}

nlohmann::ordered_json contributions_json(const Contributions &contributions) {
  auto out = nlohmann::ordered_json::array();
  for (const Contribution &one : contributions.all)
    out.push_back({{"band", contributions.bands[one.band]},
                   {"measured", name_of(one.what)},
                   {"numbers", one.numbers},
                   {"chi2", one.chi2},
                   {"share", one.share}});
  return out;
}

} // namespace umov::jobs
