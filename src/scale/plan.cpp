#include <umov/scale/plan.h>

#include "scale/this_process.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <umov/core/text.h>
#include <utility>
#include <vector>

namespace umov::scale {
namespace {

/// Rows that are counted and forgotten, at the cost that keeping them has for the processor: they
/// are copied and hashed.
class Counted final : public jobs::RangeSink {
public:
  Result<void> add(std::size_t, Table &&rows) override {
    for (const Column &column : rows.columns()) {
      const auto *texts = std::get_if<std::vector<std::string>>(&column.cells);
      if (const auto *numbers = std::get_if<std::vector<double>>(&column.cells))
        held_.append(reinterpret_cast<const char *>(numbers->data()),
                     numbers->size() * sizeof(double));
      bytes += static_cast<double>(rows.rows()) * (texts != nullptr ? 4 : 8);
      if (texts != nullptr)
        for (const std::string &text : std::set<std::string>(texts->begin(), texts->end()))
          bytes += static_cast<double>(text.size() + 8);
    }
    if (held_.size() > most_held)
      hash();
    return {};
  }
  void hash() {
    (void)sha256_hex(held_);
    held_.clear();
  }
  double bytes = 0;

private:
  static constexpr std::size_t most_held = 64'000'000;
  std::string held_;
};

/// The k-th of the points of van der Corput (1935) in base 2: however many, they lie evenly.
double spread_point(std::size_t k) {
  double out = 0, half = 0.5;
  for (; k > 0; k /= 2, half /= 2)
    out += half * static_cast<double>(k % 2);
  return out;
}

/// What pieces of a job cost.
struct Sampled {
  double cpu_s = 0, bytes = 0, units = 0;
};

/// How much of a job was asked for, and what of its cost was for what is learnt once.
struct Learnt {
  double units = 0, cpu_s = 0;
};

/// What is learnt once grows with what is asked for, as directions that poses look from, towards an
/// end: C (1 - exp(-n/s)) through two moments of the trial; a line where no end is in sight.
double learnt_of_all(const std::vector<Learnt> &trial, double total) {
  const Learnt last = trial.back();
  if (last.cpu_s <= 0 || total <= last.units)
    return last.cpu_s;
  const auto from =
      std::ranges::find_if(trial, [&](const Learnt &one) { return one.units >= last.units / 2; });
  if (from->cpu_s >= last.cpu_s) // nothing new in the second half
    return last.cpu_s;
  const auto part = [](double units, double s) { return -std::expm1(-units / s); };
  double low = from->units / 40, high = last.units * 1e6;
  if (from->cpu_s * last.units <= last.cpu_s * from->units)
    return last.cpu_s * total / last.units;
  for (int k = 0; k < 100; ++k) {
    const double s = std::sqrt(low * high);
    const bool is_slower = part(last.units, s) * from->cpu_s > last.cpu_s * part(from->units, s);
    (is_slower ? high : low) = s;
  }
  return last.cpu_s * part(total, low) / part(last.units, low);
}

/// CPU seconds of a trial that tell the cost of most jobs.
constexpr double enough_s = 1.25;

/// Asks a job for pieces of it.
class Trial {
public:
  Trial(jobs::RangedJob &job, const jobs::Monitor &monitor) : job_(job), monitor_(monitor) {}

  /// Four pieces of that length, or fewer where they are much of the job, and each of them again at
  /// once as long as that is cheaper: what the first time costs more is learnt, masks for the most
  /// part, and is not paid for every row.
  Result<Sampled> round(std::size_t length) {
    const auto places = static_cast<double>(job_.total() - length + 1);
    Sampled first, again;
    bool is_any_twice = false;
    for (std::size_t n = 0; n < 4 && (n == 0 || may_go_on()); ++n) {
      const jobs::IndexRange piece{static_cast<std::size_t>(spread_point(++pieces_) * places),
                                   length};
      UMOV_ASSIGN(once, ask(piece));
      add(once, first);
      add(once, raw_);
      double more = 0;
      if (learns_ && once.cpu_s < dear_s && may_go_on()) {
        is_any_twice = true;
        UMOV_ASSIGN(twice, ask(piece));
        more = std::max(0.0, once.cpu_s - twice.cpu_s);
        once.cpu_s = std::min(once.cpu_s, twice.cpu_s);
      }
      add(once, again);
      learnt_.push_back({learnt_.back().units + once.units, learnt_.back().cpu_s + more});
    }
    learns_ = learns_ && (!is_any_twice || again.cpu_s < 0.95 * first.cpu_s);
    return again;
  }
  /// The first time still costs more.
  [[nodiscard]] bool learns() const { return learns_; }
  /// The trial is below a quarter of the job, at what its rows have cost so far with all that they
  /// learnt: a few curves shall not be answered twice before the first counts.
  [[nodiscard]] bool may_go_on() const {
    const double whole_s = raw_.cpu_s / raw_.units * static_cast<double>(job_.total());
    return spent_ < std::max(enough_s, whole_s / 4);
  }
  /// CPU seconds so far.
  [[nodiscard]] double spent() const { return spent_; }
  [[nodiscard]] double learnt() const {
    return learnt_of_all(learnt_, static_cast<double>(job_.total()));
  }

private:
  static constexpr double dear_s = 20; ///< a piece that is not asked for twice

  static void add(const Sampled &one, Sampled &all) {
    all.cpu_s += one.cpu_s;
    all.bytes += one.bytes;
    all.units += one.units;
  }
  Result<Sampled> ask(jobs::IndexRange piece) {
    Counted counted;
    const double cpu = cpu_seconds();
    UMOV_TRY(job_.rows(piece, counted, monitor_, told_at_the_begin_));
    counted.hash();
    const double taken = cpu_seconds() - cpu;
    spent_ += taken;
    return Sampled{taken, counted.bytes, static_cast<double>(piece.count)};
  }
  jobs::RangedJob &job_;
  const jobs::Monitor &monitor_;
  Diagnostics told_at_the_begin_;
  std::vector<Learnt> learnt_{{}};
  Sampled raw_; ///< all pieces, each when it was first asked for
  std::size_t pieces_ = 0;
  double spent_ = 0;
  bool learns_ = true;
};

} // namespace

Result<Rate> measure(jobs::RangedJob &job, double setup_cpu_s, const jobs::Monitor &monitor) {
  constexpr double too_long_s = 1.5, at_most_s = 20, settled = 0.15;
  const std::size_t total = job.total();
  std::size_t length = std::max<std::size_t>(1, std::min(total / 8, job.grain() / 128));
  Rate out;
  out.setup_cpu_s = setup_cpu_s;
  Trial trial(job, monitor);
  for (double before = 0, spent = 0;; before = out.cpu_s, spent = trial.spent()) {
    UMOV_ASSIGN(now, trial.round(length)); // each with pieces twice as long as the one before
    out.cpu_s = now.cpu_s / now.units;
    out.bytes = now.bytes / now.units;
    const bool is_settled = std::abs(before - out.cpu_s) < settled * out.cpu_s;
    const double with_next_s = trial.spent() + 2 * (trial.spent() - spent);
    const bool is_enough =
        trial.spent() > enough_s || (!trial.learns() && with_next_s > too_long_s);
    if ((is_enough && is_settled) || trial.spent() > at_most_s || !trial.may_go_on() ||
        length * 8 > total)
      break;
    length = std::min(total, length * 2);
  }
  out.once_cpu_s = trial.learnt();
  if (job.is_reduced())
    out.shard_bytes = std::exchange(out.bytes, 0) * static_cast<double>(length);
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
  const double cpu_s =
      lock.rate.cpu_s * total + lock.rate.setup_cpu_s * workers + lock.rate.once_cpu_s;
  Plan out;
  out.total = lock.total;
  out.per_shard = lock.per_shard;
  out.shards = lock.shards();
  out.core_hours = cpu_s / 3600;
  out.gigabytes =
      (lock.rate.bytes * total + lock.rate.shard_bytes * static_cast<double>(out.shards)) / 1e9;
  out.shard_s =
      lock.rate.cpu_s * static_cast<double>(lock.per_shard) / static_cast<double>(settings.threads);
  out.wall_s = std::max(out.shard_s, cpu_s / static_cast<double>(settings.cores));
  out.setup_cpu_s = lock.rate.setup_cpu_s;
  out.once_cpu_s = lock.rate.once_cpu_s;
  return out;
}

std::string describe(const Plan &plan, const std::string &unit) {
  return fmt::format("{} {} in {} shards of {}: {:.2g} core-h, {:.2g} GB, {:.0f} s with these "
                     "workers, {:.1f} s a shard",
                     plan.total, unit, plan.shards, plan.per_shard, plan.core_hours, plan.gigabytes,
                     plan.wall_s, plan.shard_s);
}

std::string to_json(const Plan &plan) {
  const nlohmann::json out{{"total", plan.total},          {"shards", plan.shards},
                           {"per_shard", plan.per_shard},  {"core_hours", plan.core_hours},
                           {"gigabytes", plan.gigabytes},  {"wall_s", plan.wall_s},
                           {"shard_s", plan.shard_s},      {"setup_cpu_s", plan.setup_cpu_s},
                           {"once_cpu_s", plan.once_cpu_s}};
  return out.dump(1) + "\n";
}

} // namespace umov::scale
