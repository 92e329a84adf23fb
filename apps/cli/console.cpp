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

/// A standard error that takes nothing more is no reason to end: fmt::print would throw.
template <class... T> void say(fmt::format_string<T...> format, T &&...values) {
  const std::string text = fmt::format(format, std::forward<T>(values)...);
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

ProgressBar::ProgressBar(std::string what, const Common &common)
    : what_(std::move(what)), is_terminal_(::isatty(STDERR_FILENO) != 0), is_on_(!common.quiet),
      begin_(std::chrono::steady_clock::now()), last_(begin_) {}

ProgressBar::~ProgressBar() {
  if (is_terminal_ && has_drawn_)
    say("\r\033[K");
}

/// Time left at the rate of the last 20 s; nothing is promised in the first seconds, when caches
/// fill and rates say little.
std::string ProgressBar::left(std::size_t done, std::size_t total) const {
  using namespace std::chrono;
  const auto &[from, first] = lately_.front();
  const auto &[to, last] = lately_.back();
  const double spent = duration<double>(to - from).count();
  if (duration<double>(to - begin_).count() < 3 || last <= first || !(spent > 1))
    return "time left not known yet";
  const double rest = static_cast<double>(total - done) * spent / static_cast<double>(last - first);
  return rest < 100 ? fmt::format("{:.0f} s left", rest)
                    : fmt::format("{:.0f} min left", rest / 60);
}

void ProgressBar::update(std::size_t done, std::size_t total) {
  using namespace std::chrono;
  const auto now = steady_clock::now();
  const auto pause = is_terminal_ ? milliseconds(100) : milliseconds(5000);
  if (!is_on_ || total == 0 || now - last_ < pause)
    return;
  last_ = now;
  has_drawn_ = true;
  const double share = static_cast<double>(done) / static_cast<double>(total);
  lately_.emplace_back(now, done);
  while (lately_.size() > 2 && now - lately_.front().first > seconds(20))
    lately_.pop_front();
  if (!is_terminal_) {
    say("{}: {} of {}, {}\n", what_, done, total, left(done, total));
    return;
  }
  constexpr int width = 30;
  const int full = static_cast<int>(share * width);
  say("\r\033[K{} [{:=<{}}{:<{}}] {:3.0f} %  {}", what_, "", full, "", width - full, 100 * share,
      left(done, total));
  std::fflush(stderr);
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

const std::vector<std::string> &device_names() {
  static const std::vector<std::string> names{"cpu"};
  return names;
}

bool may_colour(std::FILE *stream) {
  const char *no_colour = std::getenv("NO_COLOR");
  return (no_colour == nullptr || *no_colour == '\0') && ::isatty(fileno(stream)) != 0;
}

} // namespace umov::cli
