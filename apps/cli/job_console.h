#pragma once
// Jobs on a terminal: their progress, their log, and where their tables go.

#include "console.h"
#include "progress_bar.h"

#include <memory>
#include <optional>
#include <umov/io/run_folder.h>
#include <umov/io/table_sink.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/requests.h>

namespace umov::cli {

/// Why the first rows of a shape take longest.
inline constexpr const char *tracing_masks = "the first run of a shape traces what hides what";

/// Draws the progress of a job; lives as long as the job runs.
class JobConsole {
public:
  /// `wait`: what takes the time before the first piece is done, if anybody can say.
  explicit JobConsole(const Common &common, std::string wait = {})
      : common_(common), wait_(std::move(wait)) {}
  /// `with_remarks`: lines of the job's log are shown too.
  jobs::Monitor monitor(bool with_remarks);

private:
  const Common &common_;
  std::string wait_, what_;
  std::optional<ProgressBar> bar_;
};

/// Threads and cache as the command line asks for them.
jobs::JobOptions job_options(const Common &common);

/// Where a table goes: a file by the suffix of `path`, or stdout as text or JSON.
std::unique_ptr<TableSink> sink_for(const std::string &path, const Common &common);

/// For a table that is there when its job stops: TableSink::stop of what `sink_for` gives. No row,
/// no file.
Error stop_table(const std::string &path, Table rows, const Common &common, const Error &stopped);

/// What every manifest says of the command: its line, threads and begin.
ManifestInput manifest_of_command(const Common &common,
                                  std::chrono::system_clock::time_point started);

} // namespace umov::cli
