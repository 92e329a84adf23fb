// The library as a service uses it, for as long as one likes: what it holds must not grow.
//
// umov_soak passes SECONDS CATALOGUE   passes of a catalogue over a site, again and again
// umov_soak light SECONDS SCENARIO     one model asked for thousands of poses, models made anew,
//                                      jobs that are cancelled, inputs that are wrong
//
// A line every round: seconds, resident bytes, open descriptors, threads, bytes that were asked for
// and not given back. Where these stay the same, resident memory that grows is the allocator's.

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <malloc.h>
#include <memory>
#include <optional>
#include <string>
#include <umov/jobs/passes.h>
#include <umov/jobs/signature.h>
#include <umov/light/light_model.h>
#include <umov/light/poses.h>
#include <unistd.h>

namespace {

using namespace umov;

std::size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t size = 0, resident = 0;
  file >> size >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

std::size_t used_bytes() {
  const struct mallinfo2 now = ::mallinfo2();
  return now.uordblks + now.hblkhd;
}

std::size_t entries(const char *folder) {
  std::size_t out = 0;
  for ([[maybe_unused]] const auto &entry : std::filesystem::directory_iterator(folder))
    ++out;
  return out;
}

/// Rows that nobody wants.
class Nowhere final : public TableSink {
public:
  Result<void> add(Table &&rows) override {
    rows_ += rows.rows();
    return {};
  }
  Result<void> note(const std::string & /*key*/, const std::string & /*value*/) override {
    return {};
  }
  Result<void> finish() override { return {}; }
  Error stop(const Error &stopped) override { return stopped; }
  [[nodiscard]] std::size_t rows() const { return rows_; }

private:
  std::size_t rows_ = 0;
};

[[noreturn]] void give_up(const Error &error) {
  fmt::print(stderr, "error: {}\n", error.text());
  std::exit(static_cast<int>(error.code));
}

template <class T> T value(Result<T> result) {
  if (!result)
    give_up(result.error());
  return std::move(*result);
}

void passes_round(const std::string &catalogue) {
  jobs::PassesRequest request;
  request.orbit = catalogue;
  request.site = Site{"maui", Angle::degrees(20.7083), Angle::degrees(-156.2578), 3058};
  request.start = value(utc_from_iso("2018-01-21T00:00:00Z"));
  request.stop = value(utc_from_iso("2018-01-21T06:00:00Z"));
  request.keep_going = true;
  request.model.body = jobs::PassModel::Body::Sphere;
  request.model.material = "paper_al";
  jobs::JobOptions options;
  options.allow_old_elements = true;
  Diagnostics diagnostics;
  const auto result = value(jobs::passes(request, options, {}, diagnostics));
  if (result.found.empty() || to_csv(jobs::passes_table(request, result)).empty())
    std::exit(1);
}

/// What clients of a service do, good and bad.
class Service {
public:
  explicit Service(const std::string &file)
      : file_(file), scenario_(value(read_scenario(file, {}))) {
    Diagnostics diagnostics;
    object_ = value(load_object(scenario_, 0, {.allow_old_elements = true}, diagnostics));
    light_ = value(make_light(object_.scene, {}, scenario_.light));
  }
  void round(std::uint64_t number) {
    StokesTable table;
    for (std::uint64_t k = 0; k < 20; ++k) {
      std::vector<Pose> poses;
      for (std::uint64_t i = 0; i < 500; ++i)
        poses.push_back(random_pose(k % 4, i, Angle::degrees(60)));
      if (!light_->evaluate(poses, table) || !(table.i[0] >= 0))
        std::exit(1);
    }
    job(number, false);
    job(number, true);
    if (read_scenario_text("umov = 1\n[[object]]\nname = 3", "wrong.toml", {}))
      std::exit(1);
  }

private:
  void job(std::uint64_t number, bool is_cancelled) {
    const std::atomic<bool> cancel{is_cancelled};
    jobs::Monitor monitor;
    monitor.cancel = &cancel;
    Nowhere rows;
    Diagnostics diagnostics;
    const auto scenario = value(read_scenario(file_, {fmt::format("seed={}", number % 4)}));
    const auto poses = value(jobs::random_poses(200, {60, 120}, number % 4));
    const auto done = jobs::signature(scenario, poses, {}, rows, {}, monitor, diagnostics);
    if (done.has_value() == is_cancelled || (rows.rows() > 0) == is_cancelled)
      std::exit(1);
  }
  std::string file_;
  Scenario scenario_;
  LoadedObject object_;
  std::unique_ptr<LightModel> light_;
};

} // namespace

int main(int argc, char **argv) {
  if (argc != 4)
    return 2;
  using Clock = std::chrono::steady_clock;
  const std::string mode = argv[1], input = argv[3];
  const double seconds = std::atof(argv[2]);
  const auto begin = Clock::now();
  std::optional<Service> service;
  if (mode == "light")
    service.emplace(input);
  std::uint64_t number = 0;
  for (double now = 0; now < seconds;) {
    if (service)
      service->round(number++);
    else
      passes_round(input);
    now = std::chrono::duration<double>(Clock::now() - begin).count();
    fmt::print("{:.2f} {} {} {} {}\n", now, resident_bytes(), entries("/proc/self/fd"),
               entries("/proc/self/task"), used_bytes());
    std::fflush(stdout);
  }
  return 0;
}
