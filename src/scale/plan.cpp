#include <umov/scale/plan.h>

#include "scale/this_process.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>

namespace umov::scale {
namespace {

/// Rows that are counted and forgotten.
class Counted final : public jobs::RangeSink {
public:
  Result<void> add(std::size_t, Table &&rows) override {
    for (const Column &column : rows.columns()) {
      const auto *texts = std::get_if<std::vector<std::string>>(&column.cells);
      bytes += static_cast<double>(rows.rows()) * (texts != nullptr ? 4 : 8);
      if (texts != nullptr)
        for (const std::string &text : std::set<std::string>(texts->begin(), texts->end()))
          bytes += static_cast<double>(text.size() + 8);
    }
    return {};
  }
  double bytes = 0;
};

/// The k-th of the points of van der Corput (1935) in base 2: however many, they lie evenly.
double spread_point(std::size_t k) {
  double out = 0, half = 0.5;
  for (; k > 0; k /= 2, half /= 2)
    out += half * static_cast<double>(k % 2);
  return out;
}

/// Costs so far of pieces of a job.
struct Sampled {
  double cpu_s = 0, bytes = 0, units = 0;
};

} // namespace

Result<Rate> measure(jobs::RangedJob &job, double setup_cpu_s, const jobs::Monitor &monitor) {
  constexpr double enough_s = 1.5, at_most_s = 20, settled = 0.15;
  const std::size_t total = job.total();
  std::size_t length = std::max<std::size_t>(1, std::min(total, job.grain() / 64)), k = 0;
  Rate out{0, 0, setup_cpu_s};
  double spent = 0, before = 0;
  Diagnostics told_at_the_begin;
  for (std::size_t round = 0;; ++round) {
    Sampled now; // each round has twice the pieces of the one before, or pieces twice as long
    for (std::size_t n = 0; n < 4; ++n) {
      const auto first =
          static_cast<std::size_t>(spread_point(++k) * static_cast<double>(total - length + 1));
      Counted counted;
      const double cpu = cpu_seconds();
      UMOV_TRY(job.rows({first, length}, counted, monitor, told_at_the_begin));
      now.cpu_s += cpu_seconds() - cpu;
      now.bytes += counted.bytes;
      now.units += static_cast<double>(length);
    }
    spent += now.cpu_s;
    out.cpu_s = now.cpu_s / now.units;
    out.bytes = now.bytes / now.units;
    const bool is_settled = std::abs(before - out.cpu_s) < settled * out.cpu_s;
    if ((spent > enough_s && is_settled) || spent > at_most_s || length * 8 > total)
      break;
    before = out.cpu_s;
    length = std::min(total, length * 2);
  }
  // What the first rounds cost above the last is preparation: masks that were traced.
  return out;
}

std::size_t shard_length(const jobs::RangedJob &job, const Rate &rate,
                         const PlanSettings &settings) {
  const std::size_t total = job.total();
  std::size_t length = settings.per_shard;
  if (length == 0) {
    const double cpu_s = std::max(rate.cpu_s, 1e-9);
    const double wall_s = cpu_s * static_cast<double>(total) / static_cast<double>(settings.cores);
    const double shard_s = std::clamp(wall_s / 20, 10.0, 120.0);
    const double by_time = shard_s * static_cast<double>(settings.threads) / cpu_s;
    const double by_size = 1e9 / std::max(rate.bytes, 1.0);
    length = static_cast<std::size_t>(std::max(1.0, std::min({by_time, by_size, 1e15})));
    const std::size_t grain = job.grain();
    length = std::max(grain, length / grain * grain);
  }
  return std::max<std::size_t>(1, std::min(length, total));
}

Plan plan_of(const JobLock &lock, const PlanSettings &settings) {
  const auto total = static_cast<double>(lock.total);
  const double workers =
      std::max(1.0, static_cast<double>(settings.cores) / static_cast<double>(settings.threads));
  const double cpu_s = lock.rate.cpu_s * total + lock.rate.setup_cpu_s * workers;
  Plan out;
  out.total = lock.total;
  out.per_shard = lock.per_shard;
  out.shards = lock.shards();
  out.core_hours = cpu_s / 3600;
  out.gigabytes = lock.rate.bytes * total / 1e9;
  out.shard_s =
      lock.rate.cpu_s * static_cast<double>(lock.per_shard) / static_cast<double>(settings.threads);
  out.wall_s = std::max(out.shard_s, cpu_s / static_cast<double>(settings.cores));
  out.setup_cpu_s = lock.rate.setup_cpu_s;
  return out;
}

std::string describe(const Plan &plan, const std::string &unit) {
  return fmt::format("{} {} in {} shards of {}: {:.2g} core-h, {:.2g} GB, {:.0f} s with these "
                     "workers, {:.1f} s a shard",
                     plan.total, unit, plan.shards, plan.per_shard, plan.core_hours, plan.gigabytes,
                     plan.wall_s, plan.shard_s);
}

std::string to_json(const Plan &plan) {
  const nlohmann::json out{{"total", plan.total},         {"shards", plan.shards},
                           {"per_shard", plan.per_shard}, {"core_hours", plan.core_hours},
                           {"gigabytes", plan.gigabytes}, {"wall_s", plan.wall_s},
                           {"shard_s", plan.shard_s},     {"setup_cpu_s", plan.setup_cpu_s}};
  return out.dump(1) + "\n";
}

} // namespace umov::scale
