#include "jobs/invert_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <span>
#include <umov/inverse/attitude_grid.h>
#include <umov/inverse/likelihood.h>
#include <umov/inverse/sample_errors.h>

namespace umov::jobs {
namespace {

constexpr double degree = pi / 180;
using Numbers = std::vector<double>;

Quaternion upper(Quaternion q) { return q.w < 0 ? Quaternion{-q.w, -q.x, -q.y, -q.z} : q; }

/// Columns qw to qz of attitudes.
template <class Rows, class Take> void add_attitudes(Table &table, const Rows &rows, Take take) {
  std::vector<Quaternion> attitudes;
  attitudes.reserve(rows.size());
  for (const auto &row : rows)
    attitudes.push_back(take(row));
  add_attitude_columns(
      table, attitudes,
      "body_from_gcrs at the first epoch (of a tracking: at the last), scalar first");
}

template <class Rows> void add_rates(Table &table, const Rows &rows) {
  std::array<Numbers, 3> c;
  for (const auto &row : rows) {
    const Vec3<Body> w = row.turning.rate_rad_s * (1 / degree);
    c[0].push_back(w.x);
    c[1].push_back(w.y);
    c[2].push_back(w.z);
  }
  const char *const names[] = {"rate_x", "rate_y", "rate_z"};
  for (std::size_t k = 0; k < 3; ++k)
    table.add(names[k], "deg / s", "angular velocity, body axes", std::move(c[k]));
}

void note(Table &table) {
  note_conventions(table);
  table.note("attitude", "qw qx qy qz: body_from_gcrs, scalar first: v_body = conj(q) v_gcrs q");
}

} // namespace

void add_attitude_columns(Table &table, const std::vector<Quaternion> &attitudes,
                          const char *description) {
  std::array<Numbers, 4> c;
  for (const Quaternion &one : attitudes) {
    const Quaternion q = upper(one);
    c[0].push_back(q.w);
    c[1].push_back(q.x);
    c[2].push_back(q.y);
    c[3].push_back(q.z);
  }
  const char *const names[] = {"qw", "qx", "qy", "qz"};
  for (std::size_t k = 0; k < 4; ++k)
    table.add(names[k], "", description, std::move(c[k]));
}

void note_start(Table &modes, const BodyWords &body, const ObservedLightCurve &observed,
                const PoseAnswer &answer, const Judgement &judgement) {
  modes.note(mesh_note, body.mesh);
  modes.note(materials_note, body.materials);
  modes.note(unit_note, unit_of_light(observed.curve.is_absolute));
  modes.note(epoch_note, to_iso_exact(observed.geometry.front().time));
  modes.note(until_note, to_iso_exact(observed.geometry.back().time));
  modes.note(median_note, fmt::format("{}", inverse::median_of_i(observed.curve)));
  modes.note(floor_note, fmt::format("{}", answer.errors.floor));
  modes.note(verdict_note, name_of(judgement.verdict));
  if (is_wide_alone(answer, observed.curve, judgement))
    modes.note(doubt_note, width_alone);
}

Table modes_table(const PoseAnswer &answer, bool has_rates) {
  Table out;
  std::vector<std::int64_t> number;
  Numbers weight, sd, chi2, scale;
  for (const PoseMode &mode : answer.modes) {
    number.push_back(static_cast<std::int64_t>(number.size()) + 1);
    weight.push_back(mode.weight);
    sd.push_back(mode.sd_rad() / degree);
    chi2.push_back(mode.chi2);
    scale.push_back(mode.scale);
  }
  out.add("mode", "", "heaviest first", std::move(number));
  out.add("weight", "", "share of the posterior", std::move(weight));
  add_attitudes(out, answer.modes, [](const PoseMode &m) { return m.turning.attitude; });
  if (has_rates)
    add_rates(out, answer.modes);
  out.add("sd", "deg", "root of the largest variance of the attitude", std::move(sd));
  out.add("chi2", "", "of the fit", std::move(chi2));
  out.add("scale", "", "observed over model", std::move(scale));
  const std::size_t n = has_rates ? 6 : 3;
  const char *const axes[] = {"x", "y", "z", "wx", "wy", "wz"};
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = r; c < n; ++c) {
      Numbers cells;
      for (const PoseMode &mode : answer.modes)
        cells.push_back(mode.covariance[r * n + c]);
      const bool is_attitude = c < 3, is_rate = r >= 3;
      out.add(fmt::format("cov_{}{}", axes[r], axes[c]),
              is_attitude ? "rad2"
              : is_rate   ? "rad2 / s2"
                          : "rad2 / s",
              "of the rotation vector in body axes", std::move(cells));
    }
  note(out);
  return out;
}

Table set_table(const PoseAnswer &answer) {
  Table out;
  add_attitudes(out, answer.set95, [](const AttitudeBall &b) { return b.attitude; });
  Numbers radius;
  for (const AttitudeBall &ball : answer.set95)
    radius.push_back(ball.radius_rad / degree);
  out.add("radius_deg", "deg", "the 95 % set is the union of these balls", std::move(radius));
  note(out);
  out.note("share_of_so3", fmt::format("{:.3g}", answer.share_of_so3));
  return out;
}

Table samples_table(const PoseAnswer &answer, bool has_rates) {
  Table out;
  Numbers weight, minus_2_log, scale;
  for (const PoseSample &s : answer.samples) {
    weight.push_back(s.weight);
    minus_2_log.push_back(s.minus_2_log);
    scale.push_back(s.scale);
  }
  out.add("weight", "", "they add up to 1", std::move(weight));
  add_attitudes(out, answer.samples, [](const PoseSample &s) { return s.turning.attitude; });
  if (has_rates)
    add_rates(out, answer.samples);
  out.add("minus_2_log", "", "-2 ln likelihood, without constants of the data",
          std::move(minus_2_log));
  out.add("scale", "", "observed over model", std::move(scale));
  note(out);
  return out;
}

Table twins_table(const PoseAnswer &answer, const std::vector<BodySymmetry> &symmetries) {
  Table out;
  std::vector<std::int64_t> of;
  std::vector<std::string> why;
  std::vector<Quaternion> attitudes;
  Numbers angle;
  if (!answer.modes.empty()) {
    const Quaternion best = answer.modes.front().turning.attitude;
    for (const BodySymmetry &s : symmetries) {
      of.push_back(1);
      why.push_back("the body: " + s.text);
      attitudes.push_back(twin_of(best, s, s.angle_rad));
      angle.push_back(s.angle_rad / degree);
    }
    for (std::size_t k = 1; k < answer.modes.size(); ++k) {
      of.push_back(1);
      why.push_back(fmt::format("the data: mode {}", k + 1));
      attitudes.push_back(answer.modes[k].turning.attitude);
      angle.push_back(angle_between(best, answer.modes[k].turning.attitude) / degree);
    }
  }
  out.add("mode", "", "whose twin this is", std::move(of));
  out.add("why", "", "what cannot tell them apart", std::move(why));
  add_attitudes(out, attitudes, [](Quaternion q) { return q; });
  out.add("apart", "deg", "between the two", std::move(angle));
  note(out);
  return out;
}

namespace {

Table table_of(const ObservedLightCurve &observed, const EndMember &model,
               std::span<const double> half_width, const CurveErrors &errors) {
  const ObservedCurve &curve = observed.curve;
  const std::size_t bands = curve.bands.size();
  std::vector<double> i = model.i, q = model.q, u = model.u;
  const double scale =
      i.empty() ? 1 : CurveLikelihood(curve, errors).compare({i, q, u, half_width}).scale;
  i.resize(curve.epochs.size() * bands, std::nan(""));
  q.resize(i.size(), std::nan(""));
  u.resize(i.size(), std::nan(""));
  std::vector<std::string> time, band;
  std::array<Numbers, 9> c;
  for (const ObservedSample &s : curve.samples) {
    const std::size_t at = s.epoch * bands + s.band;
    time.push_back(to_iso(observed.geometry[s.epoch].time));
    band.push_back(curve.bands[s.band]);
    const double row[] = {observed.geometry[s.epoch].phase_angle.degrees(),
                          std::isnan(s.i) ? s.i : s.i / scale,
                          std::isnan(s.i) ? s.i : s.i_sd / scale,
                          i[at],
                          s.q,
                          i[at] > 0 ? q[at] / i[at] : std::nan(""),
                          s.u,
                          i[at] > 0 ? u[at] / i[at] : std::nan(""),
                          std::isnan(s.q) ? s.q : std::sqrt(s.cov_qq)};
    for (std::size_t k = 0; k < c.size(); ++k)
      c[k].push_back(row[k]);
  }
  Table out;
  out.add("time_utc", "", "UTC", std::move(time));
  out.add("band", "", "band", std::move(band));
  const char *const names[][3] = {{"phase_angle", "deg", "Sun-object-observer"},
                                  {"intensity", "m2 / sr", "measured, over the scale"},
                                  {"intensity_err", "m2 / sr", "its standard deviation"},
                                  {"intensity_model", "m2 / sr", "of the best fit"},
                                  {"q_scat", "", "measured"},
                                  {"q_scat_model", "", "of the best fit"},
                                  {"u_scat", "", "measured"},
                                  {"u_scat_model", "", "of the best fit"},
                                  {"q_err", "", "standard deviation of q_scat"}};
  for (std::size_t k = 0; k < c.size(); ++k)
    out.add(names[k][0], names[k][1], names[k][2], std::move(c[k]));
  note(out);
  return out;
}

} // namespace

Table fit_table(const ObservedLightCurve &observed, const EndMember &model,
                const CurveErrors &errors) {
  return table_of(observed, model, {}, errors);
}

BestLight best_light(const CurveModel &model, const PoseAnswer &answer) {
  BestLight out;
  if (answer.modes.empty())
    return out;
  const CurveLikelihood likelihood(model.curve(), answer.errors);
  const Turning best[] = {answer.modes.front().turning};
  (void)model.for_each(best, {}, 1, [&](std::size_t, const ModelLight &lit) {
    auto fitted = likelihood.fit_parts(lit);
    out.light.i = std::move(fitted.i);
    out.light.q = std::move(fitted.q);
    out.light.u = std::move(fitted.u);
    out.parts = std::move(fitted.off);
    out.half_width.assign(lit.i_half_width.begin(), lit.i_half_width.end());
  });
  return out;
}

Table fit_table(const ObservedLightCurve &observed, const CurveModel &model,
                const PoseAnswer &answer) {
  const BestLight best = best_light(model, answer);
  return table_of(observed, best.light, best.half_width, answer.errors);
}

std::array<double, 3> axis_spread_deg(const PoseAnswer &answer) {
  std::array<double, 3> out{};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3<Gcrs> mean{};
    for (const PoseSample &s : answer.samples)
      mean = mean + rotation_from<Body, Gcrs>(s.turning.attitude).row(axis) * s.weight;
    const double length = std::sqrt(dot(mean, mean));
    double square = 0;
    for (const PoseSample &s : answer.samples) {
      const Vec3<Gcrs> a = rotation_from<Body, Gcrs>(s.turning.attitude).row(axis);
      const double off =
          length > 1e-9 ? std::acos(std::clamp(dot(a, mean) / length, -1.0, 1.0)) : pi / 2;
      square += s.weight * off * off;
    }
    out[static_cast<std::size_t>(axis)] = std::sqrt(square) / degree;
  }
  return out;
}

namespace {

/// Angle between two attitudes, up to the body's own turns.
double twin_distance(Quaternion a, Quaternion b, const std::vector<BodySymmetry> &symmetries) {
  double out = angle_between(a, b);
  constexpr int turns = 360; // of a figure of revolution
  for (const BodySymmetry &s : symmetries)
    for (int k = 0; k < (s.angle_rad > 0 ? 1 : turns); ++k) {
      const double angle = s.angle_rad > 0 ? s.angle_rad : k * 2 * pi / turns;
      out = std::min(out, angle_between(twin_of(a, s, angle), b));
    }
  return out;
}

} // namespace

Families families_of(const PoseAnswer &answer, const std::vector<BodySymmetry> &symmetries) {
  std::vector<std::size_t> leaders;
  Numbers weight;
  const auto is_twin = [&](const PoseMode &a, const PoseMode &b) {
    const double near = std::max(2 * degree, 3 * std::max(a.sd_rad(), b.sd_rad()));
    return twin_distance(a.turning.attitude, b.turning.attitude, symmetries) < near;
  };
  for (std::size_t k = 0; k < answer.modes.size(); ++k) {
    const auto leader = std::ranges::find_if(
        leaders, [&](std::size_t other) { return is_twin(answer.modes[other], answer.modes[k]); });
    if (leader == leaders.end()) {
      leaders.push_back(k);
      weight.push_back(answer.modes[k].weight);
    } else {
      weight[static_cast<std::size_t>(leader - leaders.begin())] += answer.modes[k].weight;
    }
  }
  Families out;
  constexpr double least = 0.005; // lighter ones are no alternative
  out.count =
      static_cast<std::size_t>(std::ranges::count_if(weight, [](double w) { return w > least; }));
  out.heaviest = weight.empty() ? 0 : *std::ranges::max_element(weight);
  double square = 0;
  if (!answer.modes.empty())
    for (const PoseSample &s : answer.samples)
      square += s.weight * std::pow(twin_distance(answer.modes.front().turning.attitude,
                                                  s.turning.attitude, symmetries),
                                    2);
  out.spread_deg = std::sqrt(square) / degree;
  return out;
}

} // namespace umov::jobs
