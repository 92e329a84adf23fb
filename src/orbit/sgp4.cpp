// SGP4: one state, or many at once. The theory itself: kernel/sgp4.inl.h.

#include "kernel/sgp4.inl.h"
#include "orbit/sgp4_model.h"

#include <algorithm>
#include <cmath>

namespace umov {

namespace sgp4 {

Sgp4Code state_at(const Constants &c, double minutes, TemeState &state) {
  const auto s = kernel::sgp4_state(c.kind, c.numbers, resonance_node(c, minutes), minutes);
  const auto code = static_cast<Sgp4Code>(static_cast<int>(s.code));
  state = {};
  if (code == Sgp4Code::Ok)
    state = {{s.x, s.y, s.z}, {s.vx, s.vy, s.vz}};
  return code;
}

} // namespace sgp4

struct Sgp4::Model {
  sgp4::Constants constants;
};

const char *to_text(Sgp4Code code) {
  switch (code) {
  case Sgp4Code::Ok:
    return "no error";
  case Sgp4Code::Eccentricity:
    return "the mean eccentricity left the range 0 to 1";
  case Sgp4Code::MeanMotion:
    return "the mean motion is not positive";
  case Sgp4Code::PerturbedEccentricity:
    return "the eccentricity perturbed by Sun and Moon left the range 0 to 1";
  case Sgp4Code::SemiLatusRectum:
    return "the semi-latus rectum is negative";
  case Sgp4Code::SubOrbital:
    return "the elements are sub-orbital";
  case Sgp4Code::Decayed:
    return "the object has decayed: it would be below the Earth's surface";
  case Sgp4Code::OutOfRange:
    return "the time is not a number or more than 190 years from the epoch";
  }
  return "unknown code";
}

Sgp4::Sgp4(const ElementSet &elements) {
  auto model = std::make_shared<Model>();
  model->constants = sgp4::initialise(elements);
  model_ = std::move(model);
}

Sgp4Code Sgp4::init_code() const { return model_->constants.code; }

bool Sgp4::is_deep_space() const { return model_->constants.kind.is_deep; }

namespace {

/// Ok where the theory can be evaluated at all.
Sgp4Code code_before(const sgp4::Constants &c, double minutes) {
  if (!c.is_usable)
    return c.code;
  return std::abs(minutes) <= sgp4::limit_minutes ? Sgp4Code::Ok : Sgp4Code::OutOfRange;
}

} // namespace

Sgp4Code Sgp4::propagate(double minutes, TemeState &state) const {
  state = {};
  const Sgp4Code code = code_before(model_->constants, minutes);
  return code == Sgp4Code::Ok ? sgp4::state_at(model_->constants, minutes, state) : code;
}

void Sgp4::propagate(std::span<const double> minutes, std::span<TemeState> states,
                     std::span<Sgp4Code> codes) const {
  const sgp4::Constants &c = model_->constants;
  const bool is_plain = std::all_of(minutes.begin(), minutes.end(),
                                    [&](double t) { return code_before(c, t) == Sgp4Code::Ok; });
  if (is_plain) {
    sgp4::states_over_times(c, minutes.data(), minutes.size(), states.data(), codes.data());
    return;
  }
  for (std::size_t k = 0; k < minutes.size(); ++k)
    codes[k] = propagate(minutes[k], states[k]);
}

void propagate_objects(std::span<const Sgp4> objects, std::span<const double> minutes,
                       std::span<TemeState> states, std::span<Sgp4Code> codes) {
  // Lanes share the way through the theory: objects are taken kind by kind.
  struct Group {
    kernel::Sgp4Kind kind;
    std::vector<const sgp4::Constants *> constants;
    std::vector<double> minutes;
    std::vector<TemeState *> states;
    std::vector<Sgp4Code *> codes;
  };
  std::vector<Group> groups;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const sgp4::Constants &c = objects[k].model_->constants;
    states[k] = {};
    codes[k] = code_before(c, minutes[k]);
    if (codes[k] != Sgp4Code::Ok)
      continue;
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const Group &g) { return g.kind == c.kind; });
    if (group == groups.end())
      group = groups.insert(group, Group{c.kind, {}, {}, {}, {}});
    group->constants.push_back(&c);
    group->minutes.push_back(minutes[k]);
    group->states.push_back(&states[k]);
    group->codes.push_back(&codes[k]);
  }
  for (const Group &g : groups)
    sgp4::states_over_objects(g.constants.data(), g.minutes.data(), g.minutes.size(),
                              g.states.data(), g.codes.data());
}

} // namespace umov
