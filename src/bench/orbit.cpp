#include <umov/bench/bench.h>

#include "bench/machine.h"

#include <algorithm>
#include <limits>
#include <umov/core/files.h>
#include <umov/io/elements_file.h>
#include <umov/light/instruction_set.h>
#include <umov/orbit/sgp4.h>

namespace umov::bench {
namespace {

constexpr std::size_t steps = 1440;

struct Catalogue {
  std::vector<Sgp4> objects;
  std::vector<double> minutes; ///< of one day
};

/// Best rate [states/s] of a call that computes `count` states.
template <class Work> double best_rate(std::size_t count, Work work) {
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < repetitions; ++k) {
    const double begin = now_s();
    work();
    best = std::min(best, now_s() - begin);
  }
  return static_cast<double>(count) / best;
}

double rate_over_times(const Catalogue &c) {
  std::vector<TemeState> states(steps);
  std::vector<Sgp4Code> codes(steps);
  return best_rate(c.objects.size() * steps, [&] {
    for (const Sgp4 &object : c.objects)
      object.propagate(c.minutes, states, codes);
  });
}

double rate_over_objects(const Catalogue &c) {
  std::vector<TemeState> states(c.objects.size());
  std::vector<Sgp4Code> codes(c.objects.size());
  const std::size_t rounds = 100; // epochs
  return best_rate(c.objects.size() * rounds, [&] {
    for (std::size_t k = 0; k < rounds; ++k)
      propagate_objects(c.objects, std::vector<double>(c.objects.size(), c.minutes[14 * k]), states,
                        codes);
  });
}

double rate_one_by_one(const Catalogue &c) {
  TemeState state;
  return best_rate(c.objects.size() * steps, [&] {
    for (const Sgp4 &object : c.objects)
      for (const double t : c.minutes)
        object.propagate(t, state);
  });
}

/// Largest difference of position [km] between lanes and one by one; infinity if codes differ.
double largest_difference(const Catalogue &c) {
  std::vector<TemeState> states(steps);
  std::vector<Sgp4Code> codes(steps);
  double worst = 0;
  for (const Sgp4 &object : c.objects) {
    object.propagate(c.minutes, states, codes);
    for (std::size_t k = 0; k < steps; k += 7) {
      TemeState one;
      if (object.propagate(c.minutes[k], one) != codes[k])
        return std::numeric_limits<double>::infinity();
      worst = std::max(worst, norm(one.position_km - states[k].position_km));
    }
  }
  return worst;
}

} // namespace

Result<Table> orbit(const std::string &file, Diagnostics &diagnostics) {
  const std::string load_before = load_average();
  UMOV_ASSIGN(text, read_file(file));
  TleOptions options;
  options.keep_going = true;
  UMOV_ASSIGN(sets, read_elements(text, file, options, diagnostics));
  Catalogue c;
  std::size_t deep = 0;
  for (const ElementSet &set : sets) {
    c.objects.emplace_back(set);
    deep += c.objects.back().is_deep_space() ? 1u : 0u;
  }
  for (std::size_t k = 0; k < steps; ++k)
    c.minutes.push_back(static_cast<double>(k));
  std::vector<std::string> name, set;
  std::vector<double> rate, difference;
  const auto add = [&](const char *what, double states_per_s) {
    name.emplace_back(what);
    set.emplace_back(engine_instruction_set());
    rate.push_back(states_per_s);
    difference.push_back(largest_difference(c));
  };
  add("one by one", rate_one_by_one(c));
  for (const char *which : {"avx512", "avx2", "sse4", "baseline"}) {
    if (!restrict_engine(which))
      continue;
    add("lanes over times", rate_over_times(c));
    add("lanes over objects", rate_over_objects(c));
  }
  restrict_engine("best");
  Table out;
  out.add("case", "", "what was run, on one core", std::move(name));
  out.add("instruction_set", "", "as Highway names it", std::move(set));
  out.add("states_per_s", "1 / s", "best of five", std::move(rate));
  out.add("difference", "km", "largest against one by one", std::move(difference));
  out.note("catalogue", std::to_string(sets.size()) + " objects, " + std::to_string(deep) +
                            " of them deep space, one day in 1440 steps");
  add_machine(out, load_before);
  return out;
}

} // namespace umov::bench
