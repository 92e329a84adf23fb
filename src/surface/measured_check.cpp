// What a measured table cannot know of itself: light between its nodes, beyond its ends, and the
// floor of the instrument.
#include <umov/surface/measured.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>

namespace umov {
namespace {

using Matrix = std::array<double, 16>;

/// Light off a facet, f cos(theta_i) cos(theta_o), below this share of the table's largest counts
/// for nothing.
constexpr double least_share = 0.01;

/// Nodes of an axis without every second inner one, from the first or the second of them on.
std::vector<double> every_second(const std::vector<double> &axis, std::size_t first) {
  std::vector<double> out;
  for (std::size_t j = 0; j < axis.size(); ++j)
    if (j == 0 || j + 1 == axis.size() || (j - first) % 2 != 0)
      out.push_back(axis[j]);
  return out;
}

bool has(const std::vector<double> &axis, double at) {
  return std::binary_search(axis.begin(), axis.end(), at);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace

template <class Take> void MeasuredBrdf::for_each_node(Take take) const {
  std::size_t at = 0;
  for (const double nm : axes_[0])
    for (const double i : axes_[1])
      for (const double o : axes_[2])
        for (const double phi : axes_[3])
          take(BrdfSample{nm, i, o, phi, values_[at++]});
}

MeasuredBrdf MeasuredBrdf::on_nodes(const std::array<std::vector<double>, 4> &axes) const {
  MeasuredBrdf out = *this;
  out.axes_ = axes;
  out.values_.clear();
  for_each_node([&](const BrdfSample &s) {
    if (has(axes[0], s.wavelength_nm) && has(axes[1], s.theta_i_deg) &&
        has(axes[2], s.theta_o_deg) && has(axes[3], s.phi_deg))
      out.values_.push_back(s.mueller);
  });
  return out;
}

MeasuredBrdf::GridError MeasuredBrdf::grid_error() const {
  const auto light = [](const BrdfSample &s, double f) {
    return f * std::cos(s.theta_i_deg * pi / 180) * std::cos(s.theta_o_deg * pi / 180);
  };
  double largest = 0;
  for_each_node([&](const BrdfSample &s) { largest = std::max(largest, light(s, s.mueller[0])); });
  GridError worst;
  const auto compare = [&](const std::array<std::vector<double>, 4> &axes, bool is_phi) {
    const MeasuredBrdf half = on_nodes(axes);
    for_each_node([&](const BrdfSample &s) {
      // One angle of the pair at a time: the other half of the nodes, along one direction.
      const bool is_left_out = is_phi ? !has(axes[3], s.phi_deg)
                                      : has(axes[1], s.theta_i_deg) != has(axes[2], s.theta_o_deg);
      if (!is_left_out || s.theta_i_deg >= 90 || s.theta_o_deg >= 90)
        return;
      const double between = half(s.wavelength_nm, s.theta_i_deg * pi / 180,
                                  s.theta_o_deg * pi / 180, s.phi_deg * pi / 180)[0];
      const double larger = std::max(between, s.mueller[0]);
      if (!(light(s, larger) > least_share * largest))
        return;
      // Steps half as wide leave a quarter of a smooth difference (second order), but all of it
      // where a lobe lies between two nodes.
      const double off = std::abs(between - s.mueller[0]) / larger;
      if (const double error = off * std::max(0.25, off); error > worst.share)
        worst = {error, s.theta_i_deg, s.theta_o_deg, s.phi_deg, is_phi};
    });
  };
  for (const std::size_t first : {std::size_t{1}, std::size_t{2}}) {
    auto axes = axes_;
    axes[1] = every_second(axes_[1], first);
    // Reciprocity would give a value back that was left out on one side alone.
    std::erase_if(axes[2], [&](double o) { return has(axes_[1], o) && !has(axes[1], o); });
    compare(axes, false);
    axes = axes_;
    axes[2] = every_second(axes_[2], first);
    std::erase_if(axes[1], [&](double i) { return has(axes_[2], i) && !has(axes[2], i); });
    compare(axes, false);
    if (is_in_plane_)
      continue;
    axes = axes_;
    axes[3] = every_second(axes_[3], first);
    compare(axes, true);
  }
  return worst;
}

double MeasuredBrdf::floor_from_deg() const {
  // One value at many directions near grazing, whatever the light does, that is not the rest's.
  std::vector<double> grazing, steep;
  for_each_node([&](const BrdfSample &s) {
    (s.theta_o_deg >= 80 ? grazing : steep).push_back(s.mueller[0]);
  });
  if (grazing.size() < 8 || steep.empty())
    return 90;
  const double low = *std::min_element(grazing.begin(), grazing.end()), usual = median(steep);
  double from = 90;
  std::size_t equal = 0, last = 0;
  for_each_node([&](const BrdfSample &s) {
    if (s.theta_o_deg < 80)
      return;
    const bool is_low = s.mueller[0] <= 1.01 * low;
    equal += is_low ? 1u : 0u;
    last += s.theta_o_deg == axes_[2].back() ? 1u : 0u;
    if (is_low)
      from = std::min(from, s.theta_o_deg);
  });
  const double largest = *std::max_element(steep.begin(), steep.end());
  // (Tails of a lobe are next to nothing in many directions too.)
  if (low > 1e-6 * largest && low < 0.5 * usual && 2 * equal >= last)
    return from;
  // A signal f cos(theta_o) that stays where a surface's falls with the cosine: away from the
  // mirror's side, where nothing else lifts it.
  const auto &nodes = axes_[2];
  for (std::size_t j = 1; j < nodes.size(); ++j) {
    const double fall = std::cos(nodes[j] * pi / 180) / std::cos(nodes[j - 1] * pi / 180);
    if (nodes[j] < 80 || nodes[j] >= 90 || fall > 0.7)
      continue;
    std::vector<double> ratios;
    for (const double nm : axes_[0])
      for (const double i : axes_[1])
        for (const double phi : axes_[3])
          if (const double before = look_up(nm, i, nodes[j - 1], phi)[0];
              i <= 60 && phi <= 90 && before > 0)
            ratios.push_back(look_up(nm, i, nodes[j], phi)[0] / before * fall);
    if (ratios.size() >= 3 && median(ratios) > std::pow(fall, 0.7))
      return nodes[j];
  }
  return 90;
}

void MeasuredBrdf::remark_on_grid(std::vector<std::string> &remarks) const {
  if (const GridError e = grid_error(); e.share > 0.2)
    remarks.push_back(fmt::format(
        "between its nodes the table may be off by {:.0f} % (every second node from the others; "
        "worst near theta_i {:g}, theta_o {:g}, phi {:g} deg, along {}): a lobe is narrower than "
        "the steps there. Take finer steps",
        100 * e.share, e.theta_i_deg, e.theta_o_deg, e.phi_deg, e.is_phi ? "phi" : "theta"));
  const double both = std::min(axes_[1].back(), axes_[2].back());
  const double one = std::max(axes_[1].back(), axes_[2].back());
  if (both < 80)
    remarks.push_back(fmt::format(
        "no value was measured where {} beyond {:g} deg{}: the nearest one is held there, without "
        "what the surface does towards grazing",
        both < one ? "both directions lie" : "a direction lies", both,
        both < one ? fmt::format(", or one of them beyond {:g} deg", one) : ""));
  if (const double from = floor_from_deg(); from < 90)
    remarks.push_back(fmt::format(
        "values from theta_o {:g} deg on do not follow the surface (one value in many directions, "
        "or a signal that does not fall with the cosine): the floor of an instrument, taken as "
        "true. Leave those rows out",
        from));
}

} // namespace umov
