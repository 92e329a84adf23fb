#pragma once
// What every verb shares: messages on stderr, data on stdout or in a file, progress, Ctrl-C.

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <vector>

namespace umov::cli {

/// Options that all verbs take.
struct Common {
  bool quiet = false;
  bool verbose = false;
  bool json = false;
  int threads = 0; ///< 0: all cores
  bool force = false;
  bool no_cache = false;      ///< masks are neither read from nor kept in the cache folder
  std::string device = "cpu"; ///< who adds up the light of the facets
};

/// Adds -q and, where the verb prints a table, --json.
void add_common(CLI::App &verb, Common &common, bool prints_table);
void add_threads(CLI::App &verb, Common &common);
/// --no-cache, for verbs that light an object.
void add_cache(CLI::App &verb, Common &common);

/// "error: ..." on stderr; returns the exit code.
int report(const Error &error);
/// That there is no memory, said without asking for any; its exit code.
int report_out_of_memory();
void report(const Diagnostics &diagnostics, const Common &common);
/// A line of the log, unless -q.
void note(const Common &common, const std::string &text);

/// Writes to `path` atomically, or to stdout if it is empty or "-". An existing file is replaced
/// only if `may_replace`.
Result<void> put(const std::string &path, const std::string &bytes);
/// What was printed has arrived. Device if not: the disk is full, or nobody reads.
Result<void> flush_output();

/// Set by the first Ctrl-C or termination signal; a second one ends the program at once.
const std::atomic<bool> &interrupted();
void watch_interrupts();

/// "." unless the text ends with one.
inline std::string sentence_end(const std::string &text) { return text.ends_with('.') ? "" : "."; }

/// The command line as it was given, for manifests.
std::vector<std::string> &command_line();

/// True if stdout or stderr may be coloured (a terminal, NO_COLOR unset).
bool may_colour(std::FILE *stream);

} // namespace umov::cli
