#include <umov/jobs/index_range.h>

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

namespace umov::jobs {
namespace {

/// Two counts with a sign between them, and nothing else.
std::optional<std::pair<std::size_t, std::size_t>> two_counts(const std::string &text, char sign) {
  const char *const end = text.data() + text.size();
  std::size_t a = 0, b = 0;
  const auto first = std::from_chars(text.data(), end, a);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != sign)
    return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, b);
  if (second.ec != std::errc() || second.ptr != end)
    return std::nullopt;
  return std::pair(a, b);
}

} // namespace

IndexRange share_of(std::size_t total, std::size_t part, std::size_t of) {
  const std::size_t each = total / of, more = total % of;
  return {part * each + std::min(part, more), each + (part < more ? 1 : 0)};
}

Result<JobPart> JobPart::shard(const std::string &text) {
  const auto read = two_counts(text, '/');
  if (!read || read->first >= read->second)
    return fail(
        ErrorCode::Usage,
        fmt::format("--shard {}: K/N with K from 0 to N - 1 was expected, such as 0/8", text));
  JobPart out;
  out.shard_ = Share{read->first, read->second};
  out.text_ = text;
  return out;
}

Result<JobPart> JobPart::range(const std::string &text) {
  const auto read = two_counts(text, ':');
  if (!read || read->second == 0)
    return fail(ErrorCode::Usage,
                fmt::format("--range {}: FIRST:COUNT was expected, such as 1000:500", text));
  JobPart out;
  out.range_ = IndexRange{read->first, read->second};
  out.text_ = text;
  return out;
}

Result<IndexRange> JobPart::of(std::size_t total, const std::string &unit) const {
  if (shard_) {
    const IndexRange share = share_of(total, shard_->part, shard_->of);
    if (share.count == 0 && total > 0)
      return fail(ErrorCode::Nothing,
                  fmt::format("--shard {}: the job has {} {}, of which this part has none. Take no "
                              "more than {} parts.",
                              text_, total, unit, total));
    return share;
  }
  if (!range_)
    return IndexRange{0, total};
  if (range_->first > total || range_->count > total - range_->first)
    return fail(ErrorCode::Usage,
                fmt::format("--range {}: the job has {} {}, counted from 0", text_, total, unit));
  return *range_;
}

} // namespace umov::jobs
