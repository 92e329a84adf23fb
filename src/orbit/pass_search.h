#pragma once
// The search behind all functions on passes, in seconds after its start.

#include <atomic>
#include <functional>
#include <umov/orbit/passes.h>

namespace umov::passes {

/// Times of a pass.
struct Stretch {
  double rise_s = 0, top_s = 0, set_s = 0;
  bool is_rise_cut = false, is_set_cut = false;
};

/// What stands above, and where the orbit ends if it does.
struct Found {
  std::vector<Stretch> stretches;
  std::vector<OrbitGap> gaps;
  std::optional<OrbitEnd> end;
};

/// The whole search; what was found until then where `cancel` comes true.
Found search(const Trajectory &orbit, const Site &site, Epoch<Utc> start, Epoch<Utc> stop,
             Angle altitude_min, const std::atomic<bool> *cancel = nullptr);

/// Where f changes sign between a and b, by bisection to 1 ms.
double crossing(const std::function<double(double)> &f, double a, double b);

} // namespace umov::passes
