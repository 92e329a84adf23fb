#pragma once
// How likely measured I, q and u are if the object gives a certain light: docs/theory/inverse.md,
// section 2.

#include <array>
#include <memory>
#include <span>
#include <umov/inverse/observed_curve.h>
#include <umov/inverse/parameter.h>
#include <vector>

namespace umov {

namespace inverse {
class CountLikelihood;
class PartFit;
struct Gains;
struct Weighed;
struct GainSums;
} // namespace inverse

/// What is not known beside the light itself.
struct CurveErrors {
  double floor = 0.02; ///< error of the model, in parts of I; half of it for q and u
  double floor_q = -1; ///< of q and u, if it is not that half; below 0: it is
  /// More of it, in parts of the median I; below 0: 1 %, or half of `floor` where that is less.
  double floor_median = -1;
  double median_i = 0;         ///< that median; 0: of the curve's own samples
  double zero_point_sd = 0.02; ///< of each band's zero point, relative
  double scale_sd = 0;         ///< of the common scale, relative; 0: any scale
  bool has_clouds = false;     ///< transparency free at every epoch, common to its bands
  double outlier_share = 0;    ///< of measurements whose error is `outlier_factor` times as large
  double outlier_factor = 10;
  bool has_polarization = true; ///< q and u are used where they are measured
  /// Error of the model in q and u.
  [[nodiscard]] double of_q() const { return floor_q < 0 ? floor / 2 : floor_q; }
  /// More of it, in parts of the median I: a model that is right is right about faint light too.
  [[nodiscard]] double of_median() const {
    constexpr double usual = 0.01;
    return floor_median >= 0 ? floor_median : floor < 2 * usual ? floor / 2 : usual;
  }
};

/// No measurement is taken for better than this part of I, whatever its errors say: what is left of
/// an error of 0 would not be finite.
inline constexpr double best_relative = 1e-4;

/// Chance that a chi-square of so many degrees of freedom is at least so large (Wilson & Hilferty
/// 1931).
double chi2_probability(double chi2, double dof);

/// A part of a body's light whose amount is not quite known, nor how rough the surface is, nor how
/// it is aligned to the body.
struct PartKind {
  std::string name;
  double sd = 0;       ///< of ln of its amount
  double slope_sd = 0; ///< of ln of the slopes of its lobe; 0: it has none, or they are known
  /// Of its turn about each body axis, the same for all parts that have one; 0: it is aligned as
  /// the mesh says.
  double tilt_sd_rad = 0;
  bool tilts_with_last = false; ///< it is turned as the part before it, of the same surfaces
  /// Of a PoseLighting: its light, and that of smaller and of larger slopes.
  [[nodiscard]] std::size_t blocks() const { return slope_sd > 0 ? 3 : 1; }
  /// Numbers that are not known.
  [[nodiscard]] std::size_t unknowns() const {
    return (sd > 0 ? 1u : 0u) + (slope_sd > 0 ? 1u : 0u) +
           (tilt_sd_rad > 0 && !tilts_with_last ? 3u : 0u);
  }
};
/// Of a standard deviation: short, for light bends within a turn that a glint is wide.
inline constexpr double tilt_step = 0.25;

/// Light of one part as the model has it: [epoch * bands + band].
struct PartLight {
  std::span<const double> i, q, u;
  /// `i` with slopes one standard deviation smaller and larger; empty: they are known.
  std::span<const double> smooth, rough = {};
  double sd = 0; ///< of ln of its amount
  /// `i` turned by `tilt_step` standard deviations about each body axis; empty: it is aligned as it
  /// is.
  std::array<std::span<const double>, 3> tilted = {};
  bool tilts_with_last = false; ///< as PartKind has it
};

/// Light of a model at all epochs and bands: [epoch * bands + band], scattering plane.
struct ModelLight {
  std::span<const double> i, q, u;
  /// Numerical 95 % half-width of `i`, which is an error of its own in each row; may be empty.
  std::span<const double> i_half_width = {};
  std::span<const PartLight> parts = {}; ///< of which it may have more or less
};

/// A model held against a curve.
struct Comparison {
  /// -2 ln of the likelihood over scale and zero points, without constants of the data alone.
  double minus_2_log = 0;
  double chi2 = 0;  ///< of the best scale and zero points
  double scale = 1; ///< observed over model
  /// Whitened: chi2 is the sum of their squares where there are no outliers.
  std::vector<double> residuals;
  /// Of the parts of the model, as `CurveLikelihood::FittedLight` has them; empty: it has none, or
  /// their fit did not come to rest.
  std::vector<double> off;
};

/// Measured I, q and u with their errors, or the counts that they were reduced from, ready to be
/// compared with many models. Thread safe.
class CurveLikelihood {
public:
  /// Of the samples of `epochs`, which rise, alone, if there are any.
  CurveLikelihood(const ObservedCurve &curve, const CurveErrors &errors,
                  std::span<const std::size_t> epochs = {});

  /// Holds a model against the curve; its parts are fitted under their priors, and integrated over
  /// by Laplace's rule. `near`: parts of a model that is next to this one; they then change to
  /// first order in what is between the two, as derivatives ask for. Empty, or numbers may be wrong
  /// (`outlier_share`): they are fitted from the parts as they are.
  [[nodiscard]] Comparison compare(const ModelLight &model,
                                   std::span<const double> near = {}) const;
  /// Holds a model, whose parts are as they are, against the curve with the gain of each group
  /// (band; epoch in clouds) said: nothing is fitted or integrated over, residuals are those of the
  /// data alone, and none is trusted less than another. `scale` is the mean of the gains.
  [[nodiscard]] Comparison compare_at(const ModelLight &model, std::span<const double> gains) const;
  /// So many gains.
  [[nodiscard]] std::size_t groups() const { return groups_; }
  /// How far measurements are trusted where some may be wrong (`outlier_share`).
  struct Trust {
    std::vector<double> root; ///< of each residual: what least squares multiply it by
    double minus_2_log = 0;   ///< of the mixture; without outliers the sum of the squares
  };
  /// Of residuals as `compare_at` has them.
  [[nodiscard]] Trust trust(std::span<const double> residuals) const;
  /// The light of a model with its parts as they fit best.
  struct FittedLight {
    std::vector<double> i, q, u;
    std::vector<double> off; ///< of each part its amount, then its slope [standard deviations]
    double log_det = 0;      ///< of what the data add to the priors of `off`
    bool is_at_rest = true;
  };
  /// The light with its parts as they fit best, under their priors (docs/theory/inverse.md, 4b).
  /// `near` as in `compare`.
  [[nodiscard]] FittedLight fit_parts(const ModelLight &model,
                                      std::span<const double> near = {}) const;
  /// Residuals that are wrong together: of one epoch and band.
  struct Place {
    std::size_t epoch = 0, band = 0;
    std::size_t begin = 0, size = 0; ///< among those of `compare`; those of I
  };
  /// All of them, in the order of `compare`.
  [[nodiscard]] std::vector<Place> places() const;
  /// What a residual of `compare` is of.
  enum class Measured { Nothing, Intensity, Polarization, Electrons };
  /// One of those residuals.
  struct Number {
    Measured what = Measured::Nothing; ///< a prior, or what was not measured
    std::size_t band = 0;
  };
  /// Of all of them, in order; those that stand behind these are priors.
  [[nodiscard]] std::vector<Number> numbers() const;
  /// Numbers that were measured.
  [[nodiscard]] std::size_t measurements() const { return measurements_; }
  /// What data and model may be off by.
  [[nodiscard]] const CurveErrors &errors() const { return errors_; }
  /// Unknowns that `compare` integrates over.
  [[nodiscard]] std::vector<Parameter> nuisances() const;
  /// Median of the measured I; 0 if there is none.
  [[nodiscard]] double median_i() const { return median_i_; }
  /// ln of all variances, which `compare` leaves out: to be added to -2 ln of the likelihood where
  /// models of different errors are compared.
  [[nodiscard]] double log_variance() const { return log_variance_; }

private:
  struct Row {
    std::size_t at = 0, group = 0; ///< in the model's light; of the gain: band, or epoch in clouds
    double i = 0, weight = 0;      ///< 0: not measured
    double q = 0, u = 0;
    /// Rows of the inverse square root of the covariance of q, u; all 0: not measured.
    double l_qq = 0, l_uq = 0, l_uu = 0;
  };
  friend class inverse::PartFit;
  /// Whitened residuals: measurements, and what the priors of zero points add.
  [[nodiscard]] std::size_t residual_count() const;
  using Gains = inverse::Gains;
  using Weighed = inverse::Weighed;
  using GainSums = inverse::GainSums;
  [[nodiscard]] GainSums sums_of(const ModelLight &model, const Weighed &data) const;
  [[nodiscard]] Weighed weigh(const ModelLight &model) const;
  [[nodiscard]] Weighed weigh_at(const ModelLight &model, double scale) const;
  [[nodiscard]] Gains gains_of(const GainSums &sums) const;
  [[nodiscard]] Comparison compare_as_it_is(const ModelLight &model) const;
  double fill(const ModelLight &model, const Gains &gains, const Weighed &data,
              std::vector<double> &residuals) const;

  /// Numbers of one row that are wrong together, if they are: where among the residuals.
  struct Block {
    std::size_t begin = 0, size = 0;
    double measurements = 0;
  };
  [[nodiscard]] std::vector<Block> blocks() const;
  /// A block as a mixture of good and wrong ones: what it is trusted, and its part of -2 ln.
  struct Mixed {
    double trust = 1, minus_2_log = 0;
  };
  [[nodiscard]] Mixed mixture(const Block &block, std::span<const double> residuals) const;

  std::vector<Row> rows_;
  std::shared_ptr<const inverse::CountLikelihood> counts_; ///< in place of rows; may be none
  std::vector<std::string> bands_;
  CurveErrors errors_;
  bool is_absolute_ = false;
  std::size_t groups_ = 0, measurements_ = 0;
  double median_i_ = 0, log_variance_ = 0;
};

} // namespace umov
