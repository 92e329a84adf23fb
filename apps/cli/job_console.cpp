#include "job_console.h"

#include "cache_folder.h"
#include "device_options.h"

#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <umov/core/parallel.h>

namespace umov::cli {

jobs::Monitor JobConsole::monitor(bool with_remarks) {
  jobs::Monitor out;
  out.cancel = &interrupted();
  out.progress = [this](const std::string &what, std::size_t done, std::size_t total) {
    if (!bar_ || what != what_) {
      what_ = what;
      bar_.emplace(what, wait_, common_.quiet);
    }
    bar_->update(done, total);
  };
  out.left = [this](double seconds) {
    if (bar_)
      bar_->expect(seconds);
  };
  if (with_remarks)
    out.remark = [this](const std::string &text) { note(common_, text); };
  return out;
}

jobs::JobOptions job_options(const Common &common) {
  jobs::JobOptions out;
  out.threads = static_cast<unsigned>(common.threads);
  if (!common.no_cache)
    out.mask_cache = cache_folder();
  out.device = device_options(common);
  return out;
}

namespace {

/// Rows that are printed when all are there.
class Printed final : public TableSink {
public:
  explicit Printed(const Common &common) : common_(common) {}
  Result<void> add(Table &&rows) override {
    table_.append(std::move(rows));
    return {};
  }
  Result<void> note(const std::string &key, const std::string &value) override {
    table_.note(key, value);
    return {};
  }
  Result<void> finish() override {
    return put("", common_.json ? to_json(table_) : to_text(table_));
  }
  Error stop(const Error &stopped) override {
    Error out = stopped;
    if (table_.rows() == 0)
      return out;
    table_.note("status", "stopped early: " + stopped.message);
    if (const auto done = finish(); !done)
      return done.error();
    out.message += sentence_end(out.message) + " The finished rows were printed; they are not all.";
    return out;
  }

private:
  const Common &common_;
  Table table_;
};

} // namespace

std::unique_ptr<TableSink> sink_for(const std::string &path, const Common &common) {
  if (path.empty() || path == "-")
    return std::make_unique<Printed>(common);
  return make_file_sink(path, static_cast<unsigned>(common.threads));
}

Error stop_table(const std::string &path, Table rows, const Common &common, const Error &stopped) {
  const auto sink = sink_for(path, common);
  if (rows.rows() > 0)
    if (const auto added = sink->add(std::move(rows)); !added)
      return added.error();
  return sink->stop(stopped);
}

ManifestInput manifest_of_command(const Common &common,
                                  std::chrono::system_clock::time_point started) {
  using namespace std::chrono;
  ManifestInput out;
  out.threads = resolve_threads(static_cast<unsigned>(common.threads));
  out.command_line = command_line();
  out.started_utc =
      fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(system_clock::to_time_t(started)));
  out.started = started;
  return out;
}

} // namespace umov::cli
