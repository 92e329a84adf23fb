#include <umov/lightcurve/earth_light.h>

#include "kernel/facet_constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <umov/core/constants.h>
#include <umov/frames/sky.h>
#include <umov/orbit/moon.h>
#include <umov/scene/pose.h>

namespace umov {
namespace {

/// Of the Moon, for mirrors: as the Sun's.
constexpr double moon_radius_rad = sun_radius_at_1au_rad;

/// A source of light: a part of the Earth's disk as the object sees it, or the Moon.
struct Patch {
  Vec3<Gcrs> direction;  ///< unit, from the object
  double irradiance = 0; ///< per unit solar irradiance
  double radius_rad = 0; ///< of a disk that stands for it
};

struct Contribution {
  Stokes<SkyNorth> stokes, half_width;
};

/// Lattice points in a circle of four steps' radius are 50.3 with a deviation of 0.7 times the root
/// of the radius over many centres (Kendall 1948): 95 % of them lie within this share.
constexpr double disk_scatter = 0.055;

/// What asks for the light of many sources at once.
struct Asker {
  const ObservingGeometry &geometry;
  const Rotation<Body, Gcrs> &body_from_gcrs;
  Vec3<Gcrs> sky_north;
  std::size_t bands;
  const LightOfPoses &light;

  /// [patch * bands + band], each turned into the sky's axes from its own scattering plane.
  [[nodiscard]] std::vector<Contribution> operator()(const std::vector<Patch> &patches) const {
    std::vector<Contribution> out(patches.size() * bands);
    if (patches.empty())
      return out;
    std::vector<Pose> poses;
    for (const Patch &patch : patches)
      poses.push_back({normalized(body_from_gcrs * patch.direction),
                       normalized(body_from_gcrs * geometry.to_observer), patch.radius_rad});
    const auto results = light(poses);
    for (std::size_t k = 0; k < patches.size(); ++k) {
      const Angle axis =
          position_angle(scattering_normal(geometry.to_observer, patches[k].direction), sky_north,
                         geometry.to_observer);
      for (std::size_t b = 0; b < bands; ++b) {
        const BandResult &one = results[k][b];
        Contribution &to = out[k * bands + b];
        to.stokes = rotate_to<SkyNorth>(one.stokes, Angle::radians(-axis.radians())) *
                    patches[k].irradiance;
        const double across = std::hypot(one.half_width.q, one.half_width.u); // in any axes
        to.half_width = Stokes<SkyNorth>{one.half_width.i, across, across, one.half_width.v} *
                        patches[k].irradiance;
      }
    }
    return out;
  }
};

/// The part of the sky that the Earth fills, as a square: azimuthal equal area (Lambert 1772) from
/// the cap to the disk, and the concentric map (Shirley & Chiu 1997) from the disk to the square.
/// Equal areas in the square are equal solid angles, and small squares stay nearly square.
class Cap {
public:
  Cap(const ObservingGeometry &g, double albedo)
      : g_(g), albedo_(albedo), distance_(norm(g.gcrs_km)), down_(-1 * g.gcrs_km / distance_),
        e1_(any_perpendicular(down_)), e2_(cross(down_, e1_)), sun_(normalized(g.sun_gcrs_km)) {
    const double sine = constants::wgs84_a_km / distance_;
    height_ = sine < 1 ? 1 - std::sqrt(1 - sine * sine) : 0;
  }
  /// The object is outside the Earth.
  [[nodiscard]] bool is_seen() const { return height_ > 0; }

  [[nodiscard]] double solid_angle() const { return 2 * pi * height_; }

  /// What shines from a square of the unit square: its lit part, which the terminator may cut, as
  /// a disk about its centre of light with the same second moments.
  [[nodiscard]] Patch patch(double x, double y, double side) const {
    constexpr int across = 4; // points along a side
    std::array<Vec3<Gcrs>, across * across> to;
    std::array<double, across * across> lit{};
    Vec3<Gcrs> sum{};
    double light = 0;
    for (int k = 0; k < across * across; ++k) {
      const auto at = static_cast<std::size_t>(k);
      to[at] =
          direction(x + side * (k % across + 0.5) / across, y + side * (k / across + 0.5) / across);
      lit[at] = sunlight(to[at]);
      light += lit[at];
      sum += to[at] * lit[at];
    }
    if (!(light > 0))
      return {};
    const Vec3<Gcrs> middle = normalized(sum);
    const double solid = 2 * pi * height_ * side * side, points = across * across;
    double variance = solid / points / 6; // of a square: side^2/12 along each axis
    for (std::size_t k = 0; k < to.size(); ++k)
      variance += lit[k] / light * dot(to[k] - middle, to[k] - middle);
    // Of a uniform disk: radius^2/4 along each axis.
    return {middle, albedo_ / pi * light / points * solid, std::sqrt(2 * variance)};
  }

private:
  [[nodiscard]] Vec3<Gcrs> direction(double x, double y) const {
    const double a = 2 * x - 1, b = 2 * y - 1;
    const bool is_a = std::abs(a) > std::abs(b);
    const double r = is_a ? a : b;
    const double azimuth = r == 0 ? 0 : is_a ? pi / 4 * b / a : pi / 2 - pi / 4 * a / b;
    const double c = 1 - height_ * r * r, s = std::copysign(std::sqrt(1 - c * c), r);
    return down_ * c + e1_ * (s * std::cos(azimuth)) + e2_ * (s * std::sin(azimuth));
  }
  /// Cosine of the Sun's zenith distance where a line from the object meets the Earth first.
  [[nodiscard]] double sunlight(Vec3<Gcrs> to) const {
    const double c = dot(to, down_) * distance_, radius = constants::wgs84_a_km;
    const double along =
        c - std::sqrt(std::max(0.0, c * c - distance_ * distance_ + radius * radius));
    return std::max(0.0, dot(normalized(g_.gcrs_km + to * along), sun_));
  }

  const ObservingGeometry &g_;
  double albedo_, distance_;
  Vec3<Gcrs> down_, e1_, e2_, sun_;
  double height_ = 0; ///< 1 minus the cosine of the cap's half angle
};

/// Sums the light of the cap over squares that are cut into four where that changes the sum.
class CapSum {
public:
  CapSum(const Cap &cap, const Asker &ask, const EarthshineOptions &options)
      : cap_(cap), ask_(ask), options_(options), total_(ask.bands), error_(ask.bands) {}

  SourceLight run() {
    // A quarter of the patches first, then all, so that there is a difference from the start. A
    // lobe of slope w spreads the source by 2 w to either side: steps of 3 w cannot miss it.
    const double most_at_first = static_cast<double>(patches_bound * options_.patches) / 4;
    const double step =
        options_.narrowest_lobe > 0 ? 3 * options_.narrowest_lobe : mirror_source() / 4;
    const double wanted = std::max(static_cast<double>(options_.patches),
                                   std::min(most_at_first, cap_.solid_angle() / (step * step)));
    const auto across = static_cast<std::size_t>(std::ceil(std::sqrt(wanted / 4)));
    const double side = 1 / static_cast<double>(across);
    std::vector<Square> first;
    for (std::size_t i = 0; i < across * across; ++i)
      first.push_back(
          {side * static_cast<double>(i % across), side * static_cast<double>(i / across), side});
    cut(first, values_of(first));
    const std::size_t most = patches_bound * options_.patches;
    for (int generation = 0; generation < 20 && asked_ < most; ++generation) {
      sum_up();
      if (worst(error_) <= options_.accuracy || !refine(most - asked_))
        break;
    }
    sum_up();
    SourceLight out;
    out.sources = asked_;
    for (std::size_t b = 0; b < ask_.bands; ++b) {
      out.stokes.push_back(total_[b].stokes);
      out.half_width.push_back(error_[b] + total_[b].half_width);
      if (!(options_.narrowest_lobe > 0)) // how many squares lie in a disk is not even
        out.half_width.back() += Stokes<SkyNorth>{1, 1, 1, 1} * (disk_scatter * out.stokes[b].i);
    }
    return out;
  }

private:
  struct Square {
    double x, y, side;
  };
  /// Four squares and what they give together beyond the one that they came from.
  struct Group {
    std::array<Square, 4> part;
    std::vector<Contribution> value; ///< [part * bands + band]
    std::vector<Stokes<SkyNorth>> error;
  };

  std::vector<Contribution> values_of(const std::vector<Square> &squares) {
    std::vector<Patch> lit;
    std::vector<std::size_t> place;
    for (std::size_t k = 0; k < squares.size(); ++k) {
      const Square &s = squares[k];
      Patch patch = cap_.patch(s.x, s.y, s.side);
      if (patch.irradiance > 0) {
        patch.radius_rad = options_.narrowest_lobe > 0
                               ? std::min(patch.radius_rad, widest_source(patch.direction))
                               : mirror_source();
        lit.push_back(patch);
        place.push_back(k);
      }
    }
    asked_ += lit.size();
    const auto found = ask_(lit);
    std::vector<Contribution> out(squares.size() * ask_.bands);
    for (std::size_t k = 0; k < lit.size(); ++k)
      for (std::size_t b = 0; b < ask_.bands; ++b)
        out[place[k] * ask_.bands + b] = found[k * ask_.bands + b];
    return out;
  }

  /// Of every source before a mirror, however small the square that it stands for: the image of the
  /// Earth is blurred by 7 deg or less. About 50 of the first squares lie in it.
  [[nodiscard]] double mirror_source() const {
    return std::min(0.12, 0.2 * std::sqrt(cap_.solid_angle() / pi));
  }

  /// A source for which the kernels need no closer look at the lobes: what they leave to the exact
  /// image of a disk costs a hundred times as much.
  [[nodiscard]] double widest_source(Vec3<Gcrs> direction) const {

    const double half_cosine =
        std::sqrt(std::max(0.0, (1 + dot(direction, ask_.geometry.to_observer)) / 2));
    const double least = 1e-4, variance = 0.8 * kernel::nodes_max; // in those of the lobe
    return std::max(least, 4 * std::sqrt(variance) * options_.narrowest_lobe * half_cosine);
  }

  /// Makes a group of each square, whose values are known.
  void cut(const std::vector<Square> &squares, const std::vector<Contribution> &values) {
    std::vector<Square> parts;
    for (const Square &s : squares)
      for (int k = 0; k < 4; ++k)
        parts.push_back({s.x + (k % 2) * s.side / 2, s.y + (k / 2) * s.side / 2, s.side / 2});
    const auto fine = values_of(parts);
    const std::size_t bands = ask_.bands;
    for (std::size_t g = 0; g < squares.size(); ++g) {
      Group group{{parts[4 * g], parts[4 * g + 1], parts[4 * g + 2], parts[4 * g + 3]}, {}, {}};
      const auto from = fine.begin() + static_cast<std::ptrdiff_t>(4 * g * bands);
      group.value.assign(from, from + static_cast<std::ptrdiff_t>(4 * bands));
      for (std::size_t b = 0; b < bands; ++b) {
        Stokes<SkyNorth> change = values[g * bands + b].stokes * -1;
        for (std::size_t k = 0; k < 4; ++k)
          change += group.value[k * bands + b].stokes;
        // Second order: the next cut would change a third of that; half, for what is not smooth.
        group.error.push_back(Stokes<SkyNorth>{std::abs(change.i), std::abs(change.q),
                                               std::abs(change.u), std::abs(change.v)} *
                              0.5);
      }
      groups_.push_back(std::move(group));
    }
  }

  void sum_up() {
    std::fill(total_.begin(), total_.end(), Contribution{});
    std::fill(error_.begin(), error_.end(), Stokes<SkyNorth>{});
    for (const Group &group : groups_)
      for (std::size_t b = 0; b < ask_.bands; ++b) {
        for (std::size_t k = 0; k < 4; ++k) {
          total_[b].stokes += group.value[k * ask_.bands + b].stokes;
          total_[b].half_width += group.value[k * ask_.bands + b].half_width;
        }
        error_[b] += group.error[b];
      }
  }

  /// The largest part of its band's I that an error is.
  [[nodiscard]] double worst(const std::vector<Stokes<SkyNorth>> &error) const {
    double out = 0;
    for (std::size_t b = 0; b < ask_.bands; ++b)
      if (total_[b].stokes.i > 0)
        out = std::max(out, std::max({error[b].i, error[b].q, error[b].u}) / total_[b].stokes.i);
    return out;
  }

  /// Cuts the groups that make up most of the error (bulk marking, Doerfler 1996), each of their
  /// squares into four, with at most `room` new sources; false if that is too few for any.
  bool refine(std::size_t room) {
    std::vector<std::pair<double, std::size_t>> order;
    double sum = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      order.emplace_back(worst(groups_[g].error), g);
      sum += order.back().first;
    }
    std::sort(order.begin(), order.end(), [](const auto &a, const auto &b) {
      return a.first > b.first || (a.first == b.first && a.second < b.second);
    });
    // What is left of the error may be half of what is asked for, or a fifth of what there is.
    const double leave = std::max(0.5 * options_.accuracy, 0.2 * sum);
    std::vector<bool> is_chosen(groups_.size(), false);
    std::size_t chosen = 0;
    for (const auto &[error, g] : order) {
      if (sum <= leave || 16 * (chosen + 1) > room)
        break;
      is_chosen[g] = true;
      ++chosen;
      sum -= error;
    }
    if (chosen == 0)
      return false;
    std::vector<Square> squares;
    std::vector<Contribution> values;
    std::vector<Group> kept;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!is_chosen[g]) {
        kept.push_back(std::move(groups_[g]));
        continue;
      }
      squares.insert(squares.end(), groups_[g].part.begin(), groups_[g].part.end());
      values.insert(values.end(), groups_[g].value.begin(), groups_[g].value.end());
    }
    groups_ = std::move(kept);
    cut(squares, values);
    return true;
  }

  const Cap &cap_;
  const Asker &ask_;
  const EarthshineOptions &options_;
  std::vector<Group> groups_;
  std::vector<Contribution> total_;
  std::vector<Stokes<SkyNorth>> error_;
  std::size_t asked_ = 0;
};

SourceLight darkness(std::size_t bands) {
  return {std::vector<Stokes<SkyNorth>>(bands), std::vector<Stokes<SkyNorth>>(bands), 0};
}

} // namespace

double narrowest_lobe(const Scene &scene) {
  double out = 1;
  for (const auto *side : {&scene.front, &scene.back})
    for (const Surface &surface : *side)
      out = std::min(out, surface.width());
  return out;
}

SourceLight earth_light(const ObservingGeometry &g, const Rotation<Body, Gcrs> &body_from_gcrs,
                        Vec3<Gcrs> sky_north, const EarthshineOptions &options, std::size_t bands,
                        const LightOfPoses &light) {
  const Cap cap(g, options.albedo);
  const Asker ask{g, body_from_gcrs, sky_north, bands, light};
  return cap.is_seen() ? CapSum(cap, ask, options).run() : darkness(bands);
}

double moon_irradiance(const ObservingGeometry &g, Vec3<Gcrs> moon) {
  const Vec3<Gcrs> to_moon = moon - g.gcrs_km, down = -1 * g.gcrs_km;
  const double limb = std::asin(std::min(1.0, constants::wgs84_a_km / norm(down)));
  if (angle_between(to_moon, down) < limb)
    return 0;
  const double phase =
      angle_between(g.sun_gcrs_km - moon, g.gcrs_km - moon) * 180 / pi; // at the Moon
  if (phase > 160)
    return 0;
  constexpr double sun_magnitude = -26.74, mean_distance_km = 384400;
  const double magnitude = -12.73 + 0.026 * phase + 4e-9 * std::pow(phase, 4);
  return std::pow(10, -0.4 * (magnitude - sun_magnitude)) *
         std::pow(mean_distance_km / norm(to_moon), 2);
}

SourceLight moon_light(const ObservingGeometry &g, const Rotation<Body, Gcrs> &body_from_gcrs,
                       Vec3<Gcrs> sky_north, std::size_t bands, const LightOfPoses &light) {
  const Vec3<Gcrs> moon = moon_km(g.time);
  SourceLight out = darkness(bands);
  const double irradiance = moon_irradiance(g, moon);
  if (!(irradiance > 0))
    return out;
  const Asker ask{g, body_from_gcrs, sky_north, bands, light};
  const auto found = ask({{normalized(moon - g.gcrs_km), irradiance, moon_radius_rad}});
  for (std::size_t b = 0; b < bands; ++b) {
    out.stokes[b] = found[b].stokes;
    out.half_width[b] = found[b].half_width;
  }
  out.sources = 1;
  return out;
}

} // namespace umov
