#include "jobs/u_null_test.h"

#include "jobs/counts_in_sequence.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <umov/reduction/stokes_fit.h>

namespace umov::jobs {
namespace {

/// U/I of the scattering plane of `sample` that a reduction makes of the fitted light of a set's
/// exposures, which is not that of one moment where the light, the distance or the plane change
/// between them; none where it tells none.
std::optional<double> reduced_u(const std::vector<const ObservedCount *> &set,
                                const EndMember &fitted, const ObservedCurve &curve,
                                const ObservedSample &sample) {
  double net = 0, light = 0;
  std::vector<ChannelDatum> data;
  for (const ObservedCount *count : set) {
    const std::size_t at = count->epoch * curve.bands.size() + count->band;
    const double seen =
        count->by_i * fitted.i[at] + count->by_q * fitted.q[at] + count->by_u * fitted.u[at];
    net += count->net;
    light += seen;
    // As the instrument has it, whose reduction knows neither the distance nor the plane.
    const ObservedEpoch &epoch = curve.epochs[count->epoch];
    const double c = std::cos(2 * epoch.scattering_axis_rad) / epoch.flux_per_intensity;
    const double s = std::sin(2 * epoch.scattering_axis_rad) / epoch.flux_per_intensity;
    data.push_back({seen,
                    count->sky,
                    count->fixed_variance,
                    count->excess2,
                    {count->by_i / epoch.flux_per_intensity, count->by_q * c - count->by_u * s,
                     count->by_q * s + count->by_u * c, 0}});
  }
  if (!(net > 0 && light > 0))
    return {};
  for (ChannelDatum &one : data)
    one.counts = one.sky + net / light * one.counts;
  const auto fit = fit_stokes(data, 3);
  if (!fit || !(fit->stokes[0] > 0))
    return {};
  const double twice = 2 * curve.epochs[sample.epoch].scattering_axis_rad;
  return (fit->stokes[2] * std::cos(twice) - fit->stokes[1] * std::sin(twice)) / fit->stokes[0];
}

} // namespace

NullTest null_test_of(const ObservedCurve &curve, const EndMember &fitted) {
  if (fitted.i.empty())
    return null_test(curve, std::vector<double>(curve.samples.size(), 0));
  const auto sets = counts_in_sequence(curve);
  ObservedCurve seen = curve;
  std::vector<double> model(curve.samples.size(), 0);
  for (std::size_t k = 0; k < model.size(); ++k) {
    ObservedSample &sample = seen.samples[k];
    const std::size_t at = sample.epoch * curve.bands.size() + sample.band;
    model[k] = fitted.i[at] > 0 ? fitted.u[at] / fitted.i[at] : 0;
    const auto set = sets.find(sample.set);
    if (set == sets.end())
      continue;
    const auto reduced = reduced_u(set->second, fitted, curve, sample);
    if (!reduced) {
      sample.u = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    // A model is as right about the change within a set as about anything: where that makes most
    // of U, what is left of it says little of the instrument.
    const double by_change = *reduced - model[k];
    sample.cov_uu += by_change * by_change;
    model[k] = *reduced;
  }
  return null_test(seen, model);
}

void note_null_test(const NullTest &u, std::vector<std::string> &notes, const std::string &whose) {
  if (u.is_flagged())
    notes.push_back(fmt::format(
        "{}U of the scattering plane is not what the best fit has: polarization of the instrument "
        "of ({:.4f} +- {:.4f}, {:.4f} +- {:.4f}) would explain it; calibrate, or suspect light "
        "between surfaces",
        whose, u.q0, u.q0_sd, u.u0, u.u0_sd));
}

} // namespace umov::jobs
