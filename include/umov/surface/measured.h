#pragma once
// Surfaces known from measurements.

#include <array>
#include <string>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// One measured geometry: angles from the normal, azimuth between the directions (0 = source and
/// observer on the same side), and the Mueller BRDF [1/sr] in the scattering plane; a plain BRDF
/// has m00 alone.
struct BrdfSample {
  double wavelength_nm = 0, theta_i_deg = 0, theta_o_deg = 0, phi_deg = 0;
  std::array<double, 16> mueller{};
};

/// A table of samples on a full grid of wavelength, theta_i, theta_o and phi, interpolated so that
/// reciprocity holds exactly: each value is the mean of the table's at (i, o) and, transposed, at
/// (o, i), with multilinear weights. Outside the grid: no light below the horizon, the nearest
/// angle where neither way was measured (the one known of them alone otherwise), and no wavelength
/// beyond the ends.
class MeasuredBrdf {
public:
  /// A plain table with the azimuths 0 and 180 only (in plane) is read in the coordinates in which
  /// lobes keep their shape, tilt of the half vector and incidence on it (Rusinkiewicz 1998), and
  /// taken to be isotropic about the normal: the same tilt to any side gives the same. BadInput if
  /// the grid has holes; if a table is not reciprocal within 5 % of its largest value, or any
  /// gives more than it gets, and `accept` is false, with the numbers. `remarks` says where the
  /// grid is too coarse, ends too early or holds the floor of an instrument, and
  /// where of many wavelengths and incidences the brightest alone were asked whether they give more
  /// than they get.
  static Result<MeasuredBrdf> from(std::vector<BrdfSample> samples, bool has_polarization,
                                   bool accept, std::vector<std::string> &remarks);

  /// f M [1/sr], 4 x 4 by rows.
  [[nodiscard]] std::array<double, 16> operator()(double wavelength_nm, double theta_i_rad,
                                                  double theta_o_rad, double phi_rad) const;
  /// Directional albedo at an incidence.
  [[nodiscard]] double albedo(double wavelength_nm, double theta_i_rad) const;
  /// How far off values between the nodes may be, estimated from half the nodes against the others,
  /// in parts of the larger value; where, and whether along phi.
  struct GridError {
    double share = 0, theta_i_deg = 0, theta_o_deg = 0, phi_deg = 0;
    bool is_phi = false;
  };
  /// The worst place of the table by that estimate.
  [[nodiscard]] GridError grid_error() const;
  /// First theta_o whose values look like the floor of an instrument; 90 if none do.
  [[nodiscard]] double floor_from_deg() const;
  /// Largest difference of f(i, o) and f(o, i) in the table, in parts of its largest value.
  [[nodiscard]] double worst_asymmetry() const { return asymmetry_; }
  /// The table has whole Mueller matrices.
  [[nodiscard]] bool has_polarization() const { return has_polarization_; }
  /// First wavelength of the table.
  [[nodiscard]] double first_nm() const { return axes_[0].front(); }
  /// Last wavelength of the table.
  [[nodiscard]] double last_nm() const { return axes_[0].back(); }

private:
  template <class Take> void for_each_node(Take take) const;
  /// The same table with some of its nodes only.
  [[nodiscard]] MeasuredBrdf on_nodes(const std::array<std::vector<double>, 4> &axes) const;
  void remark_on_grid(std::vector<std::string> &remarks) const;
  /// Directional albedo at a wavelength and an incidence of the table.
  struct Albedo {
    double value = 0, wavelength_nm = 0, theta_i_deg = 0;
  };
  /// What the nodes at (theta_o, phi) count in the albedo at an incidence, by their own values
  /// alone: what `operator()` makes of the way back, or in the plane of other incidences, is left
  /// aside.
  [[nodiscard]] std::vector<double> node_weights(double theta_i_deg) const;
  /// Estimates by these weights, of all wavelengths at all incidences below 90 deg.
  [[nodiscard]] std::vector<Albedo> albedos_by_nodes() const;
  /// The largest albedo at the nodes: of many, of those with the largest estimates, with a remark.
  [[nodiscard]] Albedo largest_albedo(std::vector<std::string> &remarks) const;
  /// The table can say what the way back of a sample gives.
  [[nodiscard]] bool is_partner_known(const BrdfSample &sample) const;
  [[nodiscard]] double in_plane(double nm, double tilt_rad, double incidence_rad) const;
  /// m00 of `operator()` alone [deg], which the way back has too: an albedo takes many.
  [[nodiscard]] double m00(double nm, double i, double o, double phi) const;
  [[nodiscard]] std::array<double, 16> look_up(double nm, double i, double o, double phi) const;
  std::array<std::vector<double>, 4> axes_; ///< nm, theta_i, theta_o, phi [deg]
  std::vector<std::array<double, 16>> values_;
  double asymmetry_ = 0;
  bool has_polarization_ = false, is_in_plane_ = false;
};

} // namespace umov
