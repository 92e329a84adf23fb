#pragma once
// Which part of a job is wanted, where a job is a list of things by their index.

#include <cstddef>
#include <optional>
#include <string>
#include <umov/core/result.h>

namespace umov::jobs {

/// `count` things from `first` on.
struct IndexRange {
  std::size_t first = 0, count = 0;
  /// The index behind the last.
  [[nodiscard]] std::size_t end() const { return first + count; }
};

/// One of `of` parts that are as equal as they can be: the first ones have one more.
IndexRange share_of(std::size_t total, std::size_t part, std::size_t of);

/// The part that a person asks for; by default the whole. What it comes to is known when the job
/// knows how many things it has.
class JobPart {
public:
  JobPart() = default;
  /// "K/N": part K of N, counted from 0. Usage for anything else.
  static Result<JobPart> shard(const std::string &text);
  /// "FIRST:COUNT". Usage for anything else.
  static Result<JobPart> range(const std::string &text);

  /// Nothing less was asked for.
  [[nodiscard]] bool is_whole() const { return !shard_ && !range_; }
  /// The indices; Usage where a range reaches beyond `total` (`unit`: what is counted).
  [[nodiscard]] Result<IndexRange> of(std::size_t total, const std::string &unit) const;
  /// As it was asked for: "3/8", "100:50" or "".
  [[nodiscard]] const std::string &text() const { return text_; }

private:
  struct Share {
    std::size_t part = 0, of = 1;
  };
  std::optional<Share> shard_;
  std::optional<IndexRange> range_;
  std::string text_;
};

} // namespace umov::jobs
