// Stokes parameters of sets of counts as a table.

#include "jobs/columns.h"
#include "jobs/reduced.h"

#include <cmath>
#include <limits>
#include <umov/core/text.h>
#include <umov/reduction/polarization.h>

namespace umov::jobs {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Columns of the result.
class StokesTableWriter {
public:
  StokesTableWriter(const CountsFile &file, std::size_t parameters)
      : file_(file), parameters_(parameters) {
    if (const auto told = file.notes.find("mag_system"); told != file.notes.end())
      magnitudes_ = told->second;
  }

  void add(const Reduced &r) {
    time_.push_back(to_iso_microseconds(r.middle.time));
    name_.push_back(r.middle.name);
    band_.push_back(r.middle.band);
    system_.push_back(magnitudes_);
    flags_.push_back(r.flags);
    set_.push_back(r.middle.set);
    const auto v = numbers(r);
    for (std::size_t k = 0; k < v.size(); ++k)
      columns_[k].push_back(v[k]);
  }

  Table table() && {
    Table out;
    out.add("time_utc", "", "UTC, middle of the set", std::move(time_));
    out.add("set_id", "", "as in the counts", std::move(set_));
    out.add("name", "", "object", std::move(name_));
    out.add("band", "", "band", std::move(band_));
    const std::string unit = magnitude_unit(magnitudes_);
    const char *const names[][3] = {
        {"I", "W / (m2 nm)", "irradiance above the air, from the counts"},
        {"I_err", "W / (m2 nm)", "standard deviation of I"},
        {"mag", unit.c_str(), "of I"},
        {"q", "", "Q/I in the sky frame"},
        {"u", "", "U/I in the sky frame"},
        {"v", "", "V/I"},
        {"cov_qq", "", "variance of q"},
        {"cov_uu", "", "variance of u"},
        {"cov_qu", "", "covariance of q and u"},
        {"cov_vv", "", "variance of v"},
        {"p", "", "degree of linear polarization, biased"},
        {"p_debiased", "", "Plaszczynski et al. 2014"},
        {"p_lo", "", "95 % interval, Feldman & Cousins 1998"},
        {"p_hi", "", "its upper end, a limit where p_lo is 0"},
        {"pa", "deg", "position angle of polarization, [0, 180)"},
        {"pa_err", "deg", "68.27 % half width"},
        {"pa_reach", "deg",
         "half width that holds the true angle in 66 to 70 % at any p where q and u are known "
         "equally well; 90: unknown"},
        {"q_scat", "", "Q/I, + perpendicular to the scattering plane"},
        {"u_scat", "", "U/I in the scattering frame"},
        {"chi2", "", "of the fit"},
        {"dof", "", "degrees of freedom"},
        {"sky_share", "", "sky over object in the apertures"},
        {"phase_angle", "deg", "Sun-object-observer, middle of the set"},
        {"x_axis_pa", "deg", "position angle of the instrument's x axis, middle of the set"},
        {"null_q", "",
         "half of q of the plate's first half turn minus the second's: 0 but for noise"},
        {"null_u", "", "the same of u"},
        {"ra", "deg", "of the object, ICRS axes, middle of the set"},
        {"dec", "deg", "the same"},
        {"range", "km", "of the object"},
        {"I_obs", "W / (m2 nm)", "I behind the air of the site: less k_mag airmass of the counts"},
        {"airmass", "", "of the counts, middle of the set"}};
    for (std::size_t k = 0; k < std::size(names); ++k) {
      out.add(names[k][0], names[k][1], names[k][2], std::move(columns_[k]));
      if (k == 2)
        out.add("mag_system", "", "system of mag", std::move(system_));
    }
    out.add("flags", "", "saturated, incomplete, faint, misfit, above_one", std::move(flags_));
    return out;
  }

private:
  [[nodiscard]] double zero_flux(const std::string &band) const {
    const auto found = file_.notes.find("zero_flux " + band);
    const auto value = found == file_.notes.end() ? std::nullopt : parse_number(found->second);
    return value.value_or(no_number);
  }

  [[nodiscard]] std::array<double, 31> numbers(const Reduced &r) const {
    std::array<double, 31> out;
    out.fill(no_number);
    const bool was_fitted = r.fit.covariance[0][0] > 0;
    if (was_fitted) {
      out[0] = r.fit.stokes[0];
      out[1] = std::sqrt(r.fit.covariance[0][0]);
      out[2] = out[0] > 0 ? -2.5 * std::log10(out[0] / zero_flux(r.middle.band)) : no_number;
      out[29] = out[0] * std::pow(10, -0.4 * r.middle.k_mag * r.middle.airmass);
      out[19] = r.fit.chi2;
      out[20] = r.fit.dof;
    }
    out[21] = r.sky_share;
    out[22] = r.middle.phase_angle_deg;
    out[23] = r.middle.x_axis_pa_deg;
    out[26] = r.middle.ra_deg - 360 * std::floor(r.middle.ra_deg / 360);
    out[27] = r.middle.dec_deg;
    out[28] = r.middle.range_km;
    out[30] = r.middle.airmass > 0 ? r.middle.airmass : no_number;
    if (!r.is_solved)
      return out;
    out[24] = r.null[0];
    out[25] = r.null[1];
    const auto &f = r.fractions;
    const auto &c = f.covariance;
    const double q = f.value[0], u = f.value[1];
    out[3] = q;
    out[4] = u;
    out[6] = c[0][0];
    out[7] = c[1][1];
    out[8] = c[0][1];
    if (parameters_ == 4) {
      out[5] = f.value[2];
      out[9] = c[2][2];
    }
    const auto p = polarization_of(q, u, {{{c[0][0], c[0][1]}, {c[1][0], c[1][1]}}});
    const double sd = interval_sd({{{c[0][0], c[0][1]}, {c[1][0], c[1][1]}}});
    const auto interval = degree_interval(p.p / sd);
    out[10] = p.p;
    out[11] = p.debiased;
    out[12] = interval.low * sd;
    out[13] = interval.high * sd;
    out[14] = p.angle_rad * 180 / pi;
    out[15] = p.angle_sd_rad * 180 / pi;
    out[16] = angle_reach(p.p / p.across) * 180 / pi;
    const double twice = 2 * r.middle.pa_scat_deg * pi / 180;
    out[17] = q * std::cos(twice) + u * std::sin(twice);
    out[18] = u * std::cos(twice) - q * std::sin(twice);
    return out;
  }

  const CountsFile &file_;
  std::size_t parameters_;
  std::string magnitudes_ = "AB";
  std::vector<std::string> time_, name_, band_, system_, flags_;
  std::vector<std::int64_t> set_;
  std::array<std::vector<double>, 31> columns_;
};

} // namespace

Table stokes_table(const CountsFile &file, std::size_t parameters,
                   std::span<const Reduced> reduced) {
  StokesTableWriter writer(file, parameters);
  for (const Reduced &r : reduced)
    writer.add(r);
  return std::move(writer).table();
}

} // namespace umov::jobs
