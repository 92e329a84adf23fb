#include "console.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <unistd.h>

namespace umov::cli {
namespace {

std::atomic<bool> interrupt_flag{false};

extern "C" void on_interrupt(int) {
  if (interrupt_flag.exchange(true))
    _exit(static_cast<int>(ErrorCode::Interrupted));
}

} // namespace

void add_common(CLI::App &verb, Common &common, bool prints_table) {
  verb.add_flag("-q,--quiet", common.quiet, "No log and no progress, only errors");
  if (prints_table)
    verb.add_flag("--json", common.json, "Print the table as JSON");
}

void add_threads(CLI::App &verb, Common &common) {
  verb.add_option("--threads", common.threads, "Threads to use; 0 = all cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

void add_cache(CLI::App &verb, Common &common) {
  verb.add_flag("--no-cache", common.no_cache,
                "Neither read masks from the cache folder nor keep them there; see umov doctor");
}

namespace {

/// Messages quote files, which may hold what a terminal obeys. Line breaks are the messages' own.
std::string safe(const std::string &text) {
  std::string out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    out += printable(text.substr(begin, end - begin));
    if (end < text.size())
      out += '\n';
    begin = end + 1;
  }
  return out;
}

/// A standard error that takes nothing more is no reason to end: fmt::print would throw. What a bar
/// has drawn on this line goes.
template <class... T> void say(fmt::format_string<T...> format, T &&...values) {
  static const bool is_terminal = ::isatty(STDERR_FILENO) != 0;
  const std::string text =
      (is_terminal ? "\r\033[K" : "") + fmt::format(format, std::forward<T>(values)...);
  std::fwrite(text.data(), 1, text.size(), stderr);
}

} // namespace

int report(const Error &error) {
  const bool nothing = error.code == ErrorCode::Nothing;
  const bool colour = may_colour(stderr);
  const std::string word = nothing ? "no result" : "error";
  say("{}{}:{} {}\n", colour ? (nothing ? "\033[33m" : "\033[31m") : "", word,
      colour ? "\033[0m" : "", safe(error.text()));
  return static_cast<int>(error.code);
}

int report_out_of_memory() {
  constexpr std::string_view text = "error: out of memory; ask for less at once\n",
                             erase_bar = "\r\033[K";
  const bool is_terminal = ::isatty(STDERR_FILENO) != 0;
  for (const std::string_view part : {is_terminal ? erase_bar : std::string_view(), text})
    [[maybe_unused]] const ssize_t said = ::write(STDERR_FILENO, part.data(), part.size());
  return static_cast<int>(ErrorCode::Device);
}

void report(const Diagnostics &diagnostics, const Common &common) {
  if (common.quiet)
    return;
  const bool colour = may_colour(stderr);
  for (const Warning &warning : diagnostics.warnings())
    say("{}warning:{} {}\n", colour ? "\033[33m" : "", colour ? "\033[0m" : "",
        safe(warning.text()));
}

void note(const Common &common, const std::string &text) {
  if (!common.quiet)
    say("{}\n", text);
}

namespace {

tl::unexpected<Error> standard_output_lost() {
  return fail(ErrorCode::Device, std::string("standard output cannot be written: ") +
                                     std::strerror(errno) +
                                     ". Give it a file with room, or -o to write to one.");
}

} // namespace

Result<void> put(const std::string &path, const std::string &bytes) {
  if (!path.empty() && path != "-")
    return write_file_atomically(path, bytes);
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size())
    return standard_output_lost();
  return flush_output();
}

Result<void> flush_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    return standard_output_lost();
  return {};
}

const std::atomic<bool> &interrupted() { return interrupt_flag; }

void watch_interrupts() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

std::vector<std::string> &command_line() {
  static std::vector<std::string> words;
  return words;
}

bool may_colour(std::FILE *stream) {
  const char *no_colour = std::getenv("NO_COLOR");
  return (no_colour == nullptr || *no_colour == '\0') && ::isatty(fileno(stream)) != 0;
}

} // namespace umov::cli
