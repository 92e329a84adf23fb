// OFF before Assimp reads it: its reader takes counts at their word, and for an index that names no
// vertex silently another one (assimp 5.2, OFFLoader.cpp).

#include "io/mesh/off_check.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <optional>
#include <umov/core/stop.h>
#include <umov/core/text.h>
#include <vector>

namespace umov::mesh_io {
namespace {

/// Lines with words in them, without comments.
class OffLines {
public:
  OffLines(std::string_view text, const std::atomic<bool> *cancel) : text_(text), cancel_(cancel) {}

  bool next() {
    words.clear();
    while (words.empty() && !text_.empty()) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      const std::string_view one = text_.substr(0, end);
      split(one.substr(0, one.find('#')));
      text_.remove_prefix(std::min(end + 1, text_.size()));
      leave_if_stopped(cancel_, ++line);
    }
    return !words.empty();
  }
  std::vector<std::string_view> words;
  std::size_t line = 0;

private:
  void split(std::string_view one) {
    constexpr std::string_view blanks = " \t\r";
    constexpr std::size_t most = 1'000'000;
    while (words.size() < most) {
      const std::size_t begin = one.find_first_not_of(blanks);
      if (begin == std::string_view::npos)
        return;
      const std::size_t end = std::min(one.find_first_of(blanks, begin), one.size());
      words.push_back(one.substr(begin, end - begin));
      one.remove_prefix(end);
    }
  }
  std::string_view text_;
  const std::atomic<bool> *cancel_;
};

std::optional<std::size_t> whole(std::string_view word) {
  const auto value = parse_number(word);
  constexpr double most = 4294967295.0;
  if (!value || !(*value >= 0 && *value <= most) ||
      *value != static_cast<double>(static_cast<std::uint64_t>(*value)))
    return std::nullopt;
  return static_cast<std::size_t>(*value);
}

class OffCheck {
public:
  OffCheck(std::string_view bytes, const std::string &file, const std::atomic<bool> *cancel)
      : bytes_(bytes), file_(file), lines_(bytes, cancel) {}

  Result<void> check() {
    UMOV_TRY(counts());
    for (std::size_t v = 0; v < vertices_; ++v)
      if (!lines_.next() || lines_.words.size() < 3)
        return bad(fmt::format("vertex {} of {} has {} numbers; 3 were expected", v + 1, vertices_,
                               lines_.words.size()));
    for (std::size_t f = 0; f < faces_; ++f)
      UMOV_TRY(face(f));
    return {};
  }

private:
  [[nodiscard]] tl::unexpected<Error> bad(const std::string &what) const {
    return fail(ErrorCode::BadInput, what + ". Export or fetch the file again.",
                {file_, lines_.line});
  }
  /// "OFF" (or COFF, STNOFF ...), and behind it or in the next line the counts.
  Result<void> counts() {
    constexpr std::string_view mark = "OFF";
    if (!lines_.next() || !lines_.words[0].ends_with(mark))
      return bad("no \"OFF\" at the beginning, which was expected");
    std::size_t at = 1;
    if (lines_.words.size() == 1) {
      lines_.next();
      at = 0;
    }
    const auto v = lines_.words.size() > at + 1 ? whole(lines_.words[at]) : std::nullopt;
    const auto f = lines_.words.size() > at + 1 ? whole(lines_.words[at + 1]) : std::nullopt;
    if (!v || !f)
      return bad("no counts of vertices and faces behind \"OFF\"; two or three whole numbers were "
                 "expected");
    // A vertex takes six bytes or more ("0 0 0" and an end of line), a face two.
    if (*v > bytes_.size() / 6 || *f > bytes_.size() / 2)
      return bad(fmt::format("the header counts {} vertices and {} faces, which {} bytes cannot "
                             "hold",
                             *v, *f, bytes_.size()));
    vertices_ = *v;
    faces_ = *f;
    return {};
  }
  Result<void> face(std::size_t index) {
    const bool is_there = lines_.next();
    const auto corners = is_there ? whole(lines_.words[0]) : std::nullopt;
    if (!corners || *corners > lines_.words.size() - 1)
      return bad(fmt::format("face {} of {} {}; the number of its corners and as many vertices "
                             "were expected",
                             index + 1, faces_, is_there ? "is cut off" : "is missing"));
    for (std::size_t k = 1; k <= *corners; ++k)
      if (const auto vertex = whole(lines_.words[k]); !vertex || *vertex >= vertices_)
        return bad(fmt::format("face {} of {} names vertex {}; there are {}, counted from 0",
                               index + 1, faces_, printable(lines_.words[k].substr(0, 40)),
                               vertices_));
    return {};
  }

  std::string_view bytes_;
  const std::string &file_;
  OffLines lines_;
  std::size_t vertices_ = 0, faces_ = 0;
};

} // namespace

Result<void> check_off(std::string_view bytes, const std::string &file,
                       const std::atomic<bool> *cancel) {
  if (const auto why = why_no_text(bytes))
    return fail(ErrorCode::BadInput, *why, {file});
  return OffCheck(bytes, file, cancel).check();
}

} // namespace umov::mesh_io
