#include "io/table/analyser_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <utility>

namespace umov {
namespace {

/// Analysers stand within a degree or two of where they are meant to, and rows are typed to four
/// digits; channels that are taken for each other are 45 or 60 deg apart.
constexpr double apart_deg = 5;

/// What a row says of its analyser, from the instrument's x axis, twice.
struct Axis {
  std::size_t row = 0;
  double told_deg = 0, weighed_deg = 0;
};

double turned_deg(double to, double from) { return std::remainder(to - from, 180); }

/// The axis of a row's linear answer; absent where there is none or V has a part in it.
std::optional<Axis> axis_of(const CountRow &row, std::size_t number) {
  const double linear = std::hypot(row.row[1], row.row[2]);
  constexpr double least = 0.05, most_circular = 0.01;
  if (!std::isfinite(row.analyser_deg) || linear < least * row.row[0] ||
      std::abs(row.row[3]) > most_circular * linear)
    return std::nullopt;
  const double axis = std::atan2(row.row[2], row.row[1]) / 2 * 180 / pi;
  return Axis{number, row.analyser_deg, axis - row.x_axis_pa_deg};
}

/// Rows that stand apart from where most of them put the x axis, and that axis.
struct Odd {
  std::vector<Axis> axes;
  double offset_deg = 0;
};

Odd odd_of(std::span<const Axis> group, double hand) {
  const auto offset = [hand](const Axis &a) { return a.weighed_deg - hand * a.told_deg; };
  Odd out;
  constexpr std::size_t tried = 8; // a set may be a whole night
  for (std::size_t k = 0; k < std::min(tried, group.size()); ++k) {
    Odd one{{}, offset(group[k])};
    for (const Axis &a : group)
      if (std::abs(turned_deg(offset(a), one.offset_deg)) > apart_deg)
        one.axes.push_back(a);
    if (k == 0 || one.axes.size() < out.axes.size())
      out = std::move(one);
  }
  return out;
}

/// All that is found in a file.
struct Found {
  std::size_t odd = 0, rows = 0;
  std::optional<Axis> first;
  double says_deg = 0;          ///< where the weights put the first's analyser
  const char *beside = nullptr; ///< whose other rows say so
  bool is_mirrored = true;      ///< angles that run the other way would explain all

  void add(std::span<const Axis> group, const char *of) {
    rows += group.size();
    const Odd one = odd_of(group, 1);
    if (one.axes.empty())
      return;
    is_mirrored = is_mirrored && odd_of(group, -1).axes.empty();
    odd += one.axes.size();
    if (first)
      return;
    first = one.axes.front();
    beside = of;
    const double says = first->weighed_deg - one.offset_deg;
    says_deg = says - 180 * std::floor(says / 180);
  }
};

/// No plate before the analysers.
bool is_plain(const CountsFile &file) {
  if (const auto told = file.notes.find("polarimeter"); told != file.notes.end()) {
    constexpr std::array plain{"polarizer_wheel", "four_camera", "mosaic"};
    return std::ranges::find(plain, told->second) != plain.end();
  }
  return std::ranges::all_of(file.rows, [](const CountRow &row) { return row.plate_deg == 0; });
}

bool is_same_exposure(const CountRow &a, const CountRow &b) {
  return std::tie(a.exposure, a.set, a.name, a.band) ==
             std::tie(b.exposure, b.set, b.name, b.band) &&
         seconds_between(a.time, b.time) == 0;
}

Found found_in(const CountsFile &file, bool has_axis) {
  Found out;
  std::map<std::tuple<std::string, std::string, std::int64_t>, std::vector<Axis>> alone;
  for (std::size_t k = 0, behind = 0; k < file.rows.size(); k = behind) {
    std::vector<Axis> group;
    for (behind = k; behind < file.rows.size() && is_same_exposure(file.rows[behind], file.rows[k]);
         ++behind)
      if (const auto axis = axis_of(file.rows[behind], behind))
        group.push_back(*axis);
    if (group.size() != behind - k) // something turns the light
      continue;
    const CountRow &row = file.rows[k];
    if (group.size() > 1)
      out.add(group, "exposure");
    else if (has_axis)
      alone[{row.name, row.band, row.set}].push_back(group.front());
  }
  for (const auto &[key, group] : alone) {
    // One analyser that never turns, before which something unnamed does.
    const double first_deg = group.front().told_deg;
    if (std::ranges::any_of(group, [=](const Axis &a) {
          return std::abs(turned_deg(a.told_deg, first_deg)) > apart_deg;
        }))
      out.add(group, "set");
  }
  return out;
}

} // namespace

void warn_of_analysers(const CountsFile &file, const std::vector<std::size_t> &lines, bool has_axis,
                       const std::string &name, Diagnostics &diagnostics) {
  if (!is_plain(file))
    return;
  const Found found = found_in(file, has_axis);
  if (!found.first)
    return;
  const Axis &first = *found.first;
  const StokesRow &w = file.rows[first.row].row;
  diagnostics.warn(
      fmt::format("analyser_deg = {:g}, but w1 = {:g}, w2 = {:g} are those of an analyser at "
                  "{:.3g} deg beside the others of its {} ({} of {} so). The fit takes w1 and w2: "
                  "if they are right, mend analyser_deg, else q and u are wrong{}",
                  first.told_deg, w[1], w[2], found.says_deg, found.beside, found.odd,
                  counted(found.rows, "row"),
                  found.is_mirrored ? ". Behind a mirror angles run the other way: then all agree"
                                    : ""),
      {name, lines[first.row]});
}

} // namespace umov
