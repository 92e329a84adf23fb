#include "jobs/signature_rows.h"

#include <array>
#include <limits>
#include <umov/core/parallel.h>
#include <umov/io/light_curve_table.h>

namespace umov::jobs {

void SignatureRows::reserve(std::size_t rows) {
  pose_.reserve(rows);
  band_.reserve(rows);
  for (auto &column : numbers_)
    column.reserve(rows);
}

void SignatureRows::put(std::size_t row, std::int64_t number, const Pose &at,
                        const std::string &band, const BandResult &result, bool is_dark) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto &s = result.stokes;
  const auto &e = result.half_width;
  const double scale = is_dark || !(s.i > 0) ? nan : 1 / s.i;
  const std::array<double, number_columns> values{angle_between(at.sun, at.observer) * 180 / pi,
                                                  s.i,
                                                  s.q,
                                                  s.u,
                                                  s.v,
                                                  s.q * scale,
                                                  s.u * scale,
                                                  s.v * scale,
                                                  e.i,
                                                  e.q,
                                                  e.u,
                                                  e.v,
                                                  at.sun.x,
                                                  at.sun.y,
                                                  at.sun.z,
                                                  at.observer.x,
                                                  at.observer.y,
                                                  at.observer.z};
  pose_[row] = number;
  band_[row] = band;
  for (std::size_t i = 0; i < values.size(); ++i)
    numbers_[i][row] = values[i];
}

void SignatureRows::add(std::int64_t number, const Pose &pose, const std::string &band,
                        const BandResult &result, bool is_dark) {
  pose_.emplace_back();
  band_.emplace_back();
  for (auto &column : numbers_)
    column.emplace_back();
  put(pose_.size() - 1, number, pose, band, result, is_dark);
}

SignatureRows SignatureRows::of(const std::vector<std::int64_t> &numbers,
                                const std::vector<Pose> &poses, const std::vector<Band> &bands,
                                const StokesTable &results, unsigned threads) {
  SignatureRows out;
  const std::size_t rows = poses.size() * bands.size();
  out.pose_.resize(rows);
  out.band_.resize(rows);
  for (auto &column : out.numbers_)
    column.resize(rows);
  out.band_err_ = results.band_err;
  out.bands_ = bands;
  constexpr std::size_t poses_per_task = 2048;
  parallel_for((poses.size() + poses_per_task - 1) / poses_per_task, threads,
               [&](std::size_t task) {
                 const std::size_t end = std::min(poses.size(), (task + 1) * poses_per_task);
                 for (std::size_t i = task * poses_per_task; i < end; ++i)
                   for (std::size_t b = 0; b < bands.size(); ++b) {
                     const std::size_t row = i * bands.size() + b;
                     out.put(row, numbers[i], poses[i], bands[b].name, results.at(i, b),
                             results.is_dark[i] != 0);
                   }
               });
  return out;
}

Table SignatureRows::table(bool is_emitted) && {
  struct Head {
    const char *name, *unit, *text;
  };
  const char *unit = is_emitted ? "W / (nm sr)" : "m2 / sr";
  const std::array<Head, 18> heads{
      {{"phase_angle", "deg", "Sun-object-observer, 0 = full"},
       {"intensity", unit, is_emitted ? "emitted" : "per unit solar irradiance"},
       {"stokes_q", unit, "scattering frame"},
       {"stokes_u", unit, "scattering frame"},
       {"stokes_v", unit, "scattering frame"},
       {"q_scat", "", "Q/I, scattering frame"},
       {"u_scat", "", "U/I, scattering frame"},
       {"v", "", "V/I"},
       {"intensity_err", unit, "numerical 95 % half-width"},
       {"stokes_q_err", unit, "numerical 95 % half-width"},
       {"stokes_u_err", unit, "numerical 95 % half-width"},
       {"stokes_v_err", unit, "numerical 95 % half-width"},
       {"sun_x", "", "direction of the Sun, body frame"},
       {"sun_y", "", "direction of the Sun, body frame"},
       {"sun_z", "", "direction of the Sun, body frame"},
       {"obs_x", "", "direction of the observer, body frame"},
       {"obs_y", "", "direction of the observer, body frame"},
       {"obs_z", "", "direction of the observer, body frame"}}};
  Table out;
  out.add("pose", "", "number of the pose", std::move(pose_));
  out.add("band", "", "band as in the scene", std::move(band_));
  for (std::size_t i = 0; i < heads.size(); ++i)
    out.add(heads[i].name, heads[i].unit, heads[i].text, std::move(numbers_[i]));
  if (!band_err_.empty()) {
    const auto add = [&](const char *name, double Stokes<ScatteringPlane>::*part) {
      std::vector<double> values;
      for (const Stokes<ScatteringPlane> &error : band_err_)
        values.push_back(error.*part);
      out.add(name, unit,
              "error of the band's sum of wavelengths (change if every other is left out)",
              std::move(values));
    };
    add("band_err_i", &Stokes<ScatteringPlane>::i);
    add("band_err_q", &Stokes<ScatteringPlane>::q);
    add("band_err_u", &Stokes<ScatteringPlane>::u);
    add("band_err_v", &Stokes<ScatteringPlane>::v);
  }
  note_conventions(out);
  note_curves(bands_, out);
  return out;
}

} // namespace umov::jobs
