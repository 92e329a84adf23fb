#include "progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

namespace umov::cli {
namespace {

void draw(const std::string &line) {
  const std::string text = "\r\033[K" + line;
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string time_left(double seconds) {
  return seconds < 100 ? fmt::format("{:.0f} s left", seconds)
                       : fmt::format("{:.0f} min left", seconds / 60);
}

double seconds_of(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

} // namespace

ProgressBar::ProgressBar(std::string what, std::string wait, bool is_quiet)
    : what_(std::move(what)), wait_(std::move(wait)) {
  if (!is_quiet && ::isatty(STDERR_FILENO) != 0)
    drawer_ = std::jthread([this](const std::stop_token &stop) { keep_drawing(stop); });
}

ProgressBar::~ProgressBar() {
  if (!drawer_.joinable())
    return;
  drawer_.request_stop();
  drawer_.join();
  if (has_drawn_)
    draw("");
}

void ProgressBar::update(std::size_t done, std::size_t total) {
  const std::lock_guard guard(mutex_);
  done_ = done;
  total_ = total;
  lately_.emplace_back(Clock::now(), done);
  while (lately_.size() > 2 && Clock::now() - lately_.front().first > std::chrono::seconds(20))
    lately_.pop_front();
  if (has_drawn_ && done >= total) {
    draw("");
    has_drawn_ = false;
  }
}

void ProgressBar::expect(double seconds) {
  const std::lock_guard guard(mutex_);
  expected_ = {Clock::now(), seconds};
}

void ProgressBar::keep_drawing(const std::stop_token &stop) {
  std::unique_lock lock(mutex_);
  // Short jobs are over before the first line.
  while (!stopped_.wait_for(lock, stop, std::chrono::milliseconds(250), [] { return false; }) &&
         !stop.stop_requested()) {
    if (total_ == 0 || done_ >= total_)
      continue;
    draw(line());
    has_drawn_ = true;
  }
}

std::string ProgressBar::line() const {
  const double share = static_cast<double>(done_) / static_cast<double>(total_);
  constexpr int width = 24;
  const int full = static_cast<int>(share * width);
  return fmt::format("{} [{:=<{}}{:<{}}] {:3.0f} %  {}", what_, "", full, "", width - full,
                     100 * share, left());
}

/// Time left at the rate of the last 20 s; nothing is promised in the first seconds, when caches
/// fill and rates say little.
std::string ProgressBar::left() const {
  if (expected_)
    return time_left(
        std::max(0.0, expected_->second - seconds_of(Clock::now() - expected_->first)));
  const double spent = seconds_of(Clock::now() - begin_);
  if (done_ == 0)
    return fmt::format("{:.0f} s{}{}", spent, wait_.empty() ? "" : ", ", wait_);
  const auto &[from, first] = lately_.front();
  const auto &[to, last] = lately_.back();
  const double between = seconds_of(to - from);
  if (seconds_of(to - begin_) < 3 || last <= first || !(between > 1))
    return "time left not known yet";
  return time_left(static_cast<double>(total_ - done_) * between /
                   static_cast<double>(last - first));
}

} // namespace umov::cli
