#pragma once
// Private: one run of particles from all attitudes to the posterior.

#include "inverse/particle_steps.h"
#include "inverse/posterior.h"

namespace umov::inverse {

/// How many a run follows.
struct Crowd {
  std::size_t first = 0;    ///< attitudes that it begins with
  std::size_t followed = 0; ///< particles
  double wanted = 0;        ///< of them, that are effective after a step
};

/// A density on the way from where particles begin to the posterior: powers of the density there,
/// of the likelihood by quick light, and of that by the light of the last steps.
struct Density {
  double start = 0, quick = 0, last = 0; ///< the powers
  [[nodiscard]] double minus_2_log(const Particle &p) const {
    // Light that was not asked for has no part.
    return start * p.start + (quick > 0 ? quick * p.quick.minus_2_log : 0) +
           (last > 0 ? last * p.last.minus_2_log : 0);
  }
  /// ln of how much denser it is at one than at another.
  [[nodiscard]] double log_ratio(const Particle &at, const Particle &than) const {
    return (minus_2_log(than) - minus_2_log(at)) / 2;
  }
};

/// Sequential Monte Carlo (Del Moral, Doucet & Jasra 2006).
class ParticleRun {
public:
  ParticleRun(const CurveModel &quick, const CurveModel &last, const CurveLikelihood &likelihood,
              const std::vector<PoseMode> &modes, const SearchOptions &options,
              std::uint32_t number, Crowd crowd)
      : quick_(quick), last_(last), likelihood_(likelihood), around_(modes, crowd.followed),
        options_(options), of_run_(number << 24u), crowd_(crowd) {}

  /// Empty if it was stopped.
  Samples samples();

private:
  [[nodiscard]] bool has_last_light() const { return &quick_ != &last_; }
  /// A grid turned by a rotation of the run's own, and draws around what is known.
  bool begin();
  /// Through powers of the likelihood, to 1.
  bool follow();
  /// To the light of the last steps, in which a mask's sliver of light is gone or has come: where
  /// few of the particles would hold all of the weight, through powers too. What is left are
  /// weights that half of them, or more, share.
  bool take_last_light();
  /// Resamples by `more` of what has these values of -2 ln, and moves under the density that this
  /// leads to.
  bool go_on(const std::vector<double> &values, double more, std::size_t count,
             const Density &density);
  /// Metropolis steps of all particles, until nearly all have moved. False if it was stopped.
  bool move(const Density &density);
  bool take_step(const Density &density, const Round &round, std::uint32_t step);
  /// Steps of the shape of what lies around, among those particles that stand still meanwhile.
  bool try_local(const Density &density, const Round &round);
  /// Tries a step for each of every `stride`-th particle; false if it was stopped.
  template <class Propose>
  bool try_steps(const Density &density, const Round &round, std::size_t first, std::size_t stride,
                 Propose propose);
  /// Of steps that `asked`, a density of quick light, has taken, those that are taken by `density`
  /// too: delayed acceptance (Christen & Fox 2005, J. Comput. Graph. Stat. 14, 795), after which
  /// particles have this one, and light of the last steps is asked of the few that may be taken.
  bool keep_by_last_light(const Density &density, const Density &asked, const Round &round,
                          std::size_t first, std::size_t stride, std::vector<Particle> &tried,
                          std::vector<std::size_t> &taken) const;
  /// Particles with the light that a density asks for; false if it was stopped.
  bool light(const Density &density, std::span<const Turning> turnings,
             std::vector<Particle> &out) const;

  const CurveModel &quick_;
  const CurveModel &last_;
  const CurveLikelihood &likelihood_;
  const AroundModes around_;
  double of_modes_ = 0; ///< part of them, of those that a run begins with
  const SearchOptions &options_;
  std::uint32_t of_run_, level_ = 0, stream_ = 0;
  double width_ = 1;            ///< of local steps, beside what lies around
  std::vector<char> has_moved_; ///< of each, in this level
  std::size_t accepted_ = 0;
  Crowd crowd_;
  std::vector<Particle> draws_;
  std::vector<double> left_; ///< -2 ln of the weights of the draws
  double log_evidence_ = 0;
};

} // namespace umov::inverse
