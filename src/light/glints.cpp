#include <umov/light/glints.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <optional>
#include <umov/core/golden_section.h>
#include <umov/core/quantity.h>
#include <umov/core/stop.h>
#include <unordered_map>

namespace umov {
namespace {

/// Stretches shorter than this are one glint with the next [s].
constexpr double time_step_min = 1e-4;
constexpr std::size_t evaluations_max = 20'000'000;

/// Angle between a flat's normal and the half vector against time, with its errors passed on.
class Miss {
public:
  Miss(const GlintFlat &flat, const GlintPath &path, std::size_t &count)
      : flat_(flat), path_(path), count_(count) {}

  double operator()(double seconds) {
    if (failure_)
      return pi;
    ++count_;
    const auto view = path_(seconds);
    if (!view) {
      failure_ = view.error();
      return pi;
    }
    const Vec3<Body> half = view->sun + view->observer;
    return norm(half) > 1e-12 ? angle_between(flat_.normal, half) : pi;
  }
  [[nodiscard]] const std::optional<Error> &failure() const { return failure_; }

private:
  const GlintFlat &flat_;
  const GlintPath &path_;
  std::size_t &count_;
  std::optional<Error> failure_;
};

struct Sample {
  double seconds, miss;
};

/// Samples of the stretches where the angle may be below the limit, close enough to see each one;
/// `gap` marks where a stretch is left out.
class Search {
public:
  Search(Miss &miss, double limit, double rate) : miss_(miss), limit_(limit), rate_(rate) {}

  void run(double first, double last) {
    const Sample a{first, miss_(first)}, b{last, miss_(last)};
    divide(a, b);
    close();
  }
  [[nodiscard]] const std::vector<std::vector<Sample>> &stretches() const { return stretches_; }

private:
  // The angle cannot change faster than the half vector moves (Piyavskii 1972).
  void divide(const Sample &a, const Sample &b) { // NOLINT(misc-no-recursion): depth is log2
    const double length = b.seconds - a.seconds;
    if (miss_.failure() || 0.5 * (a.miss + b.miss - rate_ * length) > limit_) {
      close();
      return;
    }
    // Fine enough to see every minimum below the limit.
    if (rate_ * length < 0.25 * limit_ || length < time_step_min) {
      if (open_.empty())
        open_.push_back(a);
      open_.push_back(b);
      return;
    }
    const double middle = 0.5 * (a.seconds + b.seconds);
    const Sample m{middle, miss_(middle)};
    divide(a, m);
    divide(m, b);
  }
  void close() {
    if (!open_.empty())
      stretches_.push_back(std::exchange(open_, {}));
  }

  Miss &miss_;
  double limit_, rate_;
  std::vector<Sample> open_;
  std::vector<std::vector<Sample>> stretches_;
};

/// The smallest angle between two times, by golden section on its square, which is smooth.
Sample minimum(Miss &miss, double a, double b) {
  const double at = golden_minimum(miss, a, b, 0.1 * time_step_min);
  return {at, miss(at)};
}

double crossing(Miss &miss, double inside, double outside, double limit) {
  while (std::abs(outside - inside) > 0.1 * time_step_min) {
    const double middle = 0.5 * (inside + outside);
    (miss(middle) < limit ? inside : outside) = middle;
  }
  return 0.5 * (inside + outside);
}

/// Glints of one fine stretch: runs of samples around a minimum below the limit.
void collect(Miss &miss, const std::vector<Sample> &samples, double limit, std::size_t flat,
             std::vector<Glint> &out) {
  const std::size_t n = samples.size();
  std::vector<Sample> tops; // minima below the limit
  for (std::size_t k = 0; k < n; ++k) {
    const bool is_low = (k == 0 || samples[k].miss <= samples[k - 1].miss) &&
                        (k + 1 == n || samples[k].miss < samples[k + 1].miss);
    if (!is_low)
      continue;
    Sample best =
        minimum(miss, samples[k > 0 ? k - 1 : k].seconds, samples[k + 1 < n ? k + 1 : k].seconds);
    if (samples[k].miss < best.miss)
      best = samples[k];
    if (best.miss < limit)
      tops.push_back(best);
  }
  for (std::size_t k = 0; k < tops.size(); ++k) {
    // From the minimum outwards to the first sample beyond the limit.
    double from = samples.front().seconds, to = samples.back().seconds;
    for (const Sample &s : samples) {
      if (s.miss >= limit && s.seconds < tops[k].seconds)
        from = crossing(miss, tops[k].seconds, s.seconds, limit);
      if (s.miss >= limit && s.seconds > tops[k].seconds) {
        to = crossing(miss, tops[k].seconds, s.seconds, limit);
        break;
      }
    }
    // Several minima within one stretch below the limit are one glint: the nearest counts.
    if (!out.empty() && out.back().flat == flat && k > 0 && tops[k - 1].seconds >= from) {
      if (tops[k].miss < out.back().miss_rad) {
        out.back().seconds = tops[k].seconds;
        out.back().miss_rad = tops[k].miss;
      }
      continue;
    }
    out.push_back({tops[k].seconds, tops[k].miss, to - from, flat});
  }
}

} // namespace

std::vector<GlintFlat> glint_flats(const Scene &scene, double least_share, double widest_rad,
                                   const std::atomic<bool> *cancel) {
  const std::vector<VisibleSides> sides = visible_sides(scene.mesh, cancel);
  // Normals alike to 1e-5 are one flat.
  std::map<std::array<long, 5>, GlintFlat> found;
  const auto add = [&](Vec3<Body> normal, double area, std::uint32_t group, const Surface &surface,
                       bool is_back) {
    if (!(surface.half_width_rad() <= widest_rad))
      return;
    const auto cell = [](double x) { return std::lround(x * 1e5); };
    GlintFlat &flat = found[{cell(normal.x), cell(normal.y), cell(normal.z),
                             static_cast<long>(group), is_back ? 1L : 0L}];
    flat.normal = normal;
    flat.half_width_rad = surface.half_width_rad();
    flat.area_m2 += area;
    flat.group = group;
  };
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    leave_if_stopped(cancel, t);
    const Triangle &triangle = scene.mesh.triangles[t];
    const Vec3<Body> doubled = area_vector_doubled(scene.mesh, triangle);
    const double area = 0.5 * norm(doubled);
    const auto bends = [&] { // smooth normals that differ make it a curved facet
      if (scene.normals != NormalMode::Smooth)
        return false;
      for (const std::uint32_t normal : triangle.normal)
        if (normal != no_index && angle_between(scene.mesh.normals[normal], doubled) > 1e-4)
          return true;
      return false;
    };
    if (!(area > 0) || bends())
      continue;
    const Vec3<Body> normal = normalized(doubled);
    if (sides[t].front)
      add(normal, area, triangle.front, scene.front[triangle.front], false);
    if (sides[t].back)
      add(-normal, area, triangle.back, surface_of_side(scene, triangle, false), true);
  }
  std::vector<GlintFlat> out;
  double largest = 0;
  for (const auto &[key, flat] : found)
    largest = std::max(largest, flat.area_m2);
  for (const auto &[key, flat] : found)
    if (flat.area_m2 >= least_share * largest)
      out.push_back(flat);
  std::stable_sort(out.begin(), out.end(),
                   [](const GlintFlat &a, const GlintFlat &b) { return a.area_m2 > b.area_m2; });
  return out;
}

namespace {

/// Flats are searched at the same halved times: an orbit and an attitude cost more than a look-up.
GlintPath remembering(const GlintPath &path) {
  constexpr std::size_t views_max = 1'000'000;
  return [path, known = std::make_shared<std::unordered_map<double, GlintView>>()](
             double seconds) -> Result<GlintView> {
    if (const auto found = known->find(seconds); found != known->end())
      return found->second;
    auto view = path(seconds);
    if (view && known->size() < views_max)
      known->emplace(seconds, *view);
    return view;
  };
}

} // namespace

Result<std::vector<Glint>> find_glints(const std::vector<GlintFlat> &flats,
                                       const GlintPath &plain_path, double first_s, double last_s,
                                       double rate_rad_s, double half_disk_rad) {
  const GlintPath path = remembering(plain_path);
  std::vector<Glint> out;
  std::size_t count = 0;
  for (std::size_t k = 0; k < flats.size(); ++k) {
    const double limit = flats[k].half_width_rad + half_disk_rad;
    Miss miss(flats[k], path, count);
    Search search(miss, limit, std::max(rate_rad_s, 1e-12));
    search.run(first_s, last_s);
    for (const std::vector<Sample> &stretch : search.stretches())
      collect(miss, stretch, limit, k, out);
    if (miss.failure())
      return tl::unexpected(*miss.failure());
    if (count > evaluations_max)
      return fail(
          ErrorCode::Physics,
          fmt::format("glints of a body that turns by {:.3g} rad/s over {:.0f} s are too many "
                      "to be told one by one; shorten the span",
                      rate_rad_s, last_s - first_s));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Glint &a, const Glint &b) { return a.seconds < b.seconds; });
  return out;
}

} // namespace umov
