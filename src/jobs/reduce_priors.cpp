#include <umov/jobs/reduce.h>

#include <array>
#include <umov/core/quantity.h>

namespace umov::jobs {
namespace {

constexpr double degree = pi / 180;

} // namespace

std::span<const ReducePrior> reduce_priors() {
  using O = ReduceOptions;
  static constexpr std::array all{
      ReducePrior{"q0_sd", "How well the instrument's own q and u are known", 1,
                  [](O &o) -> double & { return o.priors.instrumental; }},
      ReducePrior{"gain_sd", "How well the gain of each channel is known", 1,
                  [](O &o) -> double & { return o.priors.gain; }},
      ReducePrior{"angle_sd_deg", "How well the instrument's angle is known [deg]", degree,
                  [](O &o) -> double & { return o.priors.angle_rad; }},
      ReducePrior{"efficiency_sd", "How well the efficiency is known", 1,
                  [](O &o) -> double & { return o.priors.efficiency; }},
      ReducePrior{"plate_sd_deg", "How well the zero of a plate's angle is known [deg]", degree,
                  [](O &o) -> double & { return o.priors.plate_rad; }},
      ReducePrior{"retardance_sd_deg", "How well the retardance of a plate is known [deg]", degree,
                  [](O &o) -> double & { return o.priors.retardance_rad; }},
      ReducePrior{"crosstalk_sd",
                  "How much of Q and U mirrors may turn into V, and back: parts of them", 1,
                  [](O &o) -> double & { return o.priors.crosstalk; }},
      ReducePrior{"sky_sd", "How well the whole sky is known, relative", 1,
                  [](O &o) -> double & { return o.priors.sky; }},
      ReducePrior{"sky_p_sd",
                  "How well the sky's polarization along the normal of the scattering plane is "
                  "known",
                  1, [](O &o) -> double & { return o.priors.sky_p; }},
      ReducePrior{"transparency_sd",
                  "How much the air lets through changes from exposure to exposure, relative: thin "
                  "cloud",
                  1, [](O &o) -> double & { return o.transparency_sd; }},
      ReducePrior{"transparency_time_s",
                  "Time in which such cloud changes [s]: exposures that are closer share it; 0: "
                  "the header's cloud_time_s, else each has its own",
                  1, [](O &o) -> double & { return o.transparency_time_s; }},
      ReducePrior{"aperture_sd",
                  "How well the share of the light in the apertures of an exposure is known, "
                  "relative",
                  1, [](O &o) -> double & { return o.aperture_sd; }},
      ReducePrior{"zero_sd_mag", "How well the zero point is known [mag]", 1,
                  [](O &o) -> double & { return o.zero_sd_mag; }},
      ReducePrior{"time_sd_s", "How well the clock is known [s]: axes turn meanwhile in the sky", 1,
                  [](O &o) -> double & { return o.priors.time_s; }}};
  return all;
}

} // namespace umov::jobs
