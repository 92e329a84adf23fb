#include <umov/inverse/joined_epochs.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace umov {
namespace {

constexpr double alike = 2;                ///< errors and exposures within this factor
constexpr double same_angle = 0.1;         ///< of the unit vector of an analyser (cos 2a, sin 2a)
constexpr std::size_t open_stretches = 16; ///< so many sites may take turns

Vec3<Gcrs> halfway(const ObservedEpoch &epoch) {
  return normalized(epoch.to_sun + epoch.to_observer);
}

bool are_close(const ObservedEpoch &a, const ObservedEpoch &b, const JoinLimits &limits) {
  const auto within = [](const Vec3<Gcrs> &x, const Vec3<Gcrs> &y, double angle) {
    const Vec3<Gcrs> off = x - y;
    return dot(off, off) <= angle * angle;
  };
  return within(halfway(a), halfway(b), limits.halfway_rad) &&
         within(a.to_sun, b.to_sun, limits.directions_rad) &&
         within(a.to_observer, b.to_observer, limits.directions_rad);
}

/// The stretch of each epoch, stretches in order of their first epochs.
std::vector<std::size_t> stretches_of(const std::vector<ObservedEpoch> &epochs,
                                      const JoinLimits &limits) {
  std::vector<std::size_t> out, first;
  for (std::size_t e = 0; e < epochs.size(); ++e) {
    std::size_t found = first.size();
    for (std::size_t k = first.size(); k > 0 && k + open_stretches > first.size(); --k)
      if (are_close(epochs[first[k - 1]], epochs[e], limits)) {
        found = k - 1;
        break;
      }
    if (found == first.size())
      first.push_back(e);
    out.push_back(found);
  }
  return out;
}

bool is_within_factor(double a, double b, double factor) {
  return (a == 0 && b == 0) || (a <= factor * b && b <= factor * a);
}

bool are_like(const ObservedSample &a, const ObservedSample &b) {
  return a.band == b.band && std::isnan(a.i) == std::isnan(b.i) &&
         std::isnan(a.q) == std::isnan(b.q) && is_within_factor(a.i_sd, b.i_sd, alike) &&
         is_within_factor(a.cov_qq, b.cov_qq, alike * alike) &&
         is_within_factor(a.cov_uu, b.cov_uu, alike * alike);
}

bool are_like(const ObservedCount &a, const ObservedCount &b) {
  return a.band == b.band && a.excess2 == b.excess2 && a.has_own_pupil == b.has_own_pupil &&
         is_within_factor(a.by_i, b.by_i, alike) &&
         std::hypot(a.by_q / a.by_i - b.by_q / b.by_i, a.by_u / a.by_i - b.by_u / b.by_i) <
             same_angle;
}

/// Rows that are alike, in one stretch, none of them at the epoch of another.
template <class Row> struct Heap {
  std::size_t channels = 0; ///< of each of their exposures: of less, one was saturated
  std::vector<const Row *> rows;
};

/// Rows of the epoch and band of each.
template <class Row> std::vector<std::size_t> channels_of(const std::vector<Row> &rows) {
  std::vector<std::size_t> out(rows.size());
  const auto are_together = [&](std::size_t a, std::size_t b) {
    return rows[a].epoch == rows[b].epoch && rows[a].band == rows[b].band;
  };
  for (std::size_t k = 0, end = 0; k < rows.size(); k = end) {
    for (end = k + 1; end < rows.size() && are_together(k, end);)
      ++end;
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(k),
              out.begin() + static_cast<std::ptrdiff_t>(end), end - k);
  }
  return out;
}

template <class Row>
std::vector<Heap<Row>> heaps_of(const std::vector<Row> &rows,
                                const std::vector<std::size_t> &stretch_of) {
  std::vector<Heap<Row>> out;
  std::vector<std::vector<std::size_t>> in_stretch; // heaps
  const auto channels = channels_of(rows);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Row &row = rows[r];
    const std::size_t stretch = stretch_of[row.epoch];
    in_stretch.resize(std::max(in_stretch.size(), stretch + 1));
    const auto found = std::ranges::find_if(in_stretch[stretch], [&](std::size_t k) {
      return out[k].channels == channels[r] && out[k].rows.back()->epoch != row.epoch &&
             are_like(*out[k].rows.front(), row);
    });
    if (found != in_stretch[stretch].end()) {
      out[*found].rows.push_back(&row);
      continue;
    }
    in_stretch[stretch].push_back(out.size());
    out.push_back({channels[r], {&row}});
  }
  return out;
}

ObservedSample joined(const std::vector<const ObservedSample *> &rows) {
  ObservedSample out = *rows.front();
  out.i = out.i_sd = out.q = out.u = out.cov_qq = out.cov_uu = out.cov_qu = 0;
  for (const ObservedSample *row : rows) {
    out.i += row->i; // NaN stays NaN
    out.i_sd += row->i_sd * row->i_sd;
    out.q += row->q;
    out.u += row->u;
    out.cov_qq += row->cov_qq;
    out.cov_uu += row->cov_uu;
    out.cov_qu += row->cov_qu;
  }
  const auto n = static_cast<double>(rows.size());
  out.i /= n;
  out.i_sd = std::sqrt(out.i_sd) / n;
  out.q /= n;
  out.u /= n;
  for (double *cov : {&out.cov_qq, &out.cov_uu, &out.cov_qu})
    *cov /= n * n;
  out.set = no_set;
  return out;
}

ObservedCount joined(const std::vector<const ObservedCount *> &rows) {
  ObservedCount out = *rows.front();
  out.net = out.sky = out.fixed_variance = out.by_i = out.by_q = out.by_u = 0;
  double flicker = 0;
  for (const ObservedCount *row : rows) {
    out.net += row->net;
    out.sky += row->sky;
    out.fixed_variance += row->fixed_variance;
    out.by_i += row->by_i;
    out.by_q += row->by_q;
    out.by_u += row->by_u;
    flicker += std::pow(row->by_i * row->scintillation, 2);
  }
  out.scintillation = out.by_i != 0 ? std::sqrt(flicker) / out.by_i : 0;
  out.set = no_set;
  return out;
}

/// Of the epochs of some rows.
template <class Row>
ObservedEpoch mean_epoch(const std::vector<ObservedEpoch> &epochs,
                         const std::vector<const Row *> &rows) {
  ObservedEpoch out = epochs[rows.front()->epoch];
  if (rows.size() == 1)
    return out;
  out = {};
  double cos_twice = 0, sin_twice = 0;
  out.flux_per_intensity = 0;
  const double part = 1 / static_cast<double>(rows.size());
  for (const Row *row : rows) {
    const ObservedEpoch &e = epochs[row->epoch];
    out.seconds += part * e.seconds;
    out.to_sun = out.to_sun + e.to_sun;
    out.to_observer = out.to_observer + e.to_observer;
    out.sun_radius_rad += part * e.sun_radius_rad;
    out.flux_per_intensity += part * e.flux_per_intensity;
    cos_twice += std::cos(2 * e.scattering_axis_rad);
    sin_twice += std::sin(2 * e.scattering_axis_rad);
  }
  out.to_sun = normalized(out.to_sun);
  out.to_observer = normalized(out.to_observer);
  out.scattering_axis_rad = std::atan2(sin_twice, cos_twice) / 2;
  return out;
}

/// The epochs of a joined curve. Rows of the same epochs stand at one, so that channels of one
/// exposure share its transparency and the model's error; of other epochs they do not.
class Places {
public:
  template <class Row>
  std::size_t find_or_add(const std::vector<ObservedEpoch> &epochs,
                          const std::vector<const Row *> &rows) {
    std::vector<std::size_t> of;
    of.reserve(rows.size());
    for (const Row *row : rows)
      of.push_back(row->epoch);
    const auto [at, is_new] = place_.try_emplace(std::move(of), all.size());
    if (is_new)
      all.push_back(mean_epoch(epochs, rows));
    return at->second;
  }
  std::vector<ObservedEpoch> all;

private:
  std::map<std::vector<std::size_t>, std::size_t> place_;
};

template <class Row>
std::vector<Row> joined_rows(const std::vector<Row> &rows, const std::vector<ObservedEpoch> &epochs,
                             const std::vector<std::size_t> &stretch_of, Places &places) {
  std::vector<Row> out;
  for (const Heap<Row> &heap : heaps_of(rows, stretch_of)) {
    out.push_back(joined(heap.rows));
    out.back().epoch = places.find_or_add(epochs, heap.rows);
  }
  return out;
}

/// Epochs in order of time, and rows in theirs.
void sort_by_time(ObservedCurve &curve) {
  std::vector<std::size_t> order(curve.epochs.size()), place(curve.epochs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return curve.epochs[k].seconds; });
  std::vector<ObservedEpoch> sorted;
  for (const std::size_t k : order) {
    place[k] = sorted.size();
    sorted.push_back(curve.epochs[k]);
  }
  curve.epochs = std::move(sorted);
  const auto sort = [&](auto &rows) {
    for (auto &row : rows)
      row.epoch = place[row.epoch];
    std::ranges::stable_sort(rows, {},
                             [](const auto &row) { return std::pair(row.epoch, row.band); });
  };
  sort(curve.samples);
  sort(curve.counts);
}

} // namespace

ObservedCurve joined_epochs(const ObservedCurve &curve, const JoinLimits &limits) {
  const auto stretch_of = stretches_of(curve.epochs, limits);
  const std::size_t stretches =
      stretch_of.empty() ? 0 : std::ranges::max(stretch_of) + 1; // none skipped
  if (stretches == curve.epochs.size())
    return curve;
  ObservedCurve out = curve;
  Places places;
  out.counts = joined_rows(curve.counts, curve.epochs, stretch_of, places);
  out.samples = joined_rows(curve.samples, curve.epochs, stretch_of, places);
  out.epochs = std::move(places.all);
  sort_by_time(out);
  return out;
}

} // namespace umov
