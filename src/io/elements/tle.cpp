// TLE and 3LE texts: lines into sets.

#include "io/elements/tle_line.h"

#include <optional>
#include <utility>

namespace umov {

namespace tle {

namespace {

constexpr std::size_t name_limit = 256;        // bytes; longer lines are no names
constexpr std::size_t warnings_per_kind = 100; // then one line tells how many more there were

/// Warnings of one kind: the first hundred in full, then their number.
class Tally {
public:
  explicit Tally(std::string what) : what_(std::move(what)) {}
  void add(Diagnostics &diagnostics, std::string message, Where where) {
    if (++count_ <= warnings_per_kind)
      diagnostics.warn(std::move(message), std::move(where));
  }
  void close(Diagnostics &diagnostics, const std::string &file) const {
    if (count_ > warnings_per_kind)
      diagnostics.warn(std::to_string(count_ - warnings_per_kind) + " more " + what_ + ".",
                       {file, 0, 0});
  }

private:
  std::string what_;
  std::size_t count_ = 0;
};

/// Hands out lines ended by LF, CRLF or CR, without trailing blanks.
class LineReader {
public:
  explicit LineReader(std::string_view text) : rest_(text) {
    if (rest_.starts_with("\xEF\xBB\xBF")) // byte order mark
      rest_.remove_prefix(3);
  }
  std::optional<Line> next() {
    if (rest_.empty())
      return std::nullopt;
    const std::size_t end = rest_.find_first_of("\r\n");
    std::string_view text = rest_.substr(0, end);
    if (end == std::string_view::npos)
      rest_ = {};
    else
      rest_.remove_prefix(end + (rest_.substr(end).starts_with("\r\n") ? 2 : 1));
    text = text.substr(0, text.find_last_not_of(" \t") + 1);
    return Line{text, ++number_};
  }

private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// Collects lines into sets: an optional name, line 1, line 2.
class Reader {
public:
  Reader(const std::string &file, const TleOptions &options, Diagnostics &diagnostics)
      : file_(file), options_(options), diagnostics_(diagnostics) {}

  Result<void> take(const Line &line) {
    const Kind kind = kind_of(line.text);
    if (kind == Kind::Blank || kind == Kind::Comment)
      return {};
    if (skip_second_) { // belongs to the set that was given up
      skip_second_ = false;
      if (kind == Kind::Second)
        return {};
    }
    if (first_)
      return kind == Kind::Second ? end_set(line) : break_set(line, kind);
    switch (kind) {
    case Kind::First:
      return begin_set(line);
    case Kind::Second:
      return give_up(wrong_order(line, "line 1", "line 2 stands without a line 1 before it"));
    case Kind::OtherNumber:
      skip_second_ = true;
      return give_up(wrong_number(line, '1'));
    default:
      return take_name(line);
    }
  }

  Result<std::vector<ElementSet>> finish() {
    if (first_)
      UMOV_TRY(give_up(fail(ErrorCode::BadInput,
                            "the text ends after line 1 of a set, expected its line 2. The file "
                            "may be truncated; fetch it again.",
                            {file_, first_->line, 1})));
    else if (name_)
      UMOV_TRY(give_up(after_name("the text ends")));
    bad_sets_.close(diagnostics_, file_);
    no_checksum_.close(diagnostics_, file_);
    bad_checksum_.close(diagnostics_, file_);
    other_.close(diagnostics_, file_);
    if (sets_.empty())
      return fail(ErrorCode::BadInput,
                  "holds no complete element set; expected lines that begin with \"1 \" and "
                  "\"2 \", 69 columns each. Is it a TLE file?",
                  {file_, 0, 0});
    return std::move(sets_);
  }

private:
  using Failure = tl::unexpected<Error>;

  Failure wrong_order(const Line &line, const std::string &expected,
                      const std::string &found) const {
    return fail(ErrorCode::BadInput,
                found + ", expected " + expected +
                    ". The two lines may be swapped, or one is missing; fetch the set again.",
                {file_, line.number, 1});
  }
  Failure wrong_number(const Line &line, char expected) const {
    return fail(ErrorCode::BadInput,
                std::string("the line number is ") + line.text[0] + ", expected " + expected +
                    "; element lines are numbered 1 and 2. Correct it or fetch the set again.",
                {file_, line.number, 1});
  }
  Failure after_name(const std::string &found) const {
    return fail(ErrorCode::BadInput,
                found + " after what reads as the name \"" + name_->substr(0, 40) +
                    "\", expected line 1 of a set (\"1 NNNNN...\"). Remove the line, or mark it "
                    "as a comment with '#'.",
                {file_, name_line_, 1});
  }

  /// Ends the reading, or with keep_going warns and drops the set.
  Result<void> give_up(Failure failure) {
    name_.reset();
    first_.reset();
    if (!options_.keep_going)
      return failure;
    bad_sets_.add(diagnostics_, failure.value().message + " This set is skipped.",
                  failure.value().where);
    return {};
  }

  Result<void> take_name(const Line &line) {
    if (line.text.size() > name_limit)
      return give_up(fail(ErrorCode::BadInput,
                          "the line has " + std::to_string(line.text.size()) +
                              " bytes, expected a name or an element line of 69 columns. Is it "
                              "a TLE file?",
                          {file_, line.number, name_limit + 1}));
    Result<void> before{};
    if (name_)
      before = give_up(after_name("another line follows"));
    bool is_changed = false;
    name_ = clean_name(line.text, is_changed);
    name_line_ = line.number;
    if (is_changed)
      other_.add(diagnostics_,
                 "the name holds bytes that are not printable UTF-8; they are replaced by '?'.",
                 {file_, line.number, 1});
    return before;
  }

  void note(const Line &line, const LineNotes &notes) {
    if (notes.lacks_checksum)
      no_checksum_.add(diagnostics_,
                       "the line has 68 columns: its checksum is missing, so a changed character "
                       "would go unseen.",
                       {file_, line.number, 69});
    if (!notes.bad_checksum.empty())
      bad_checksum_.add(diagnostics_, notes.bad_checksum + " The set is used as it stands.",
                        {file_, line.number, 69});
    if (!notes.odd_epoch.empty())
      other_.add(diagnostics_, notes.odd_epoch, {file_, line.number, 21});
  }

  Result<void> begin_set(const Line &line) {
    ElementSet set;
    auto notes = check_line(line, Kind::First, file_, options_);
    if (notes)
      if (auto fields = read_first(line, file_, set, *notes); !fields)
        notes = Failure(std::move(fields).error());
    if (!notes) {
      skip_second_ = true;
      return give_up(Failure(std::move(notes).error()));
    }
    set.name = name_.value_or("");
    name_.reset();
    first_ = std::move(set);
    first_text_ = line;
    first_notes_ = *notes;
    return {};
  }

  Result<void> end_set(const Line &line) {
    auto notes = check_line(line, Kind::Second, file_, options_);
    if (notes)
      if (auto fields = read_second(line, file_, *first_); !fields)
        notes = Failure(std::move(fields).error());
    if (!notes)
      return give_up(Failure(std::move(notes).error()));
    note(first_text_, first_notes_);
    note(line, *notes);
    first_->epoch = utc_from_year_day(first_->epoch_year, first_->epoch_day_of_year);
    sets_.push_back(std::move(*first_));
    first_.reset();
    return {};
  }

  /// Line 2 was due, but something else came: the set is dropped and the line taken anew.
  Result<void> break_set(const Line &line, Kind kind) {
    if (kind == Kind::OtherNumber)
      return give_up(wrong_number(line, '2'));
    UMOV_TRY(give_up(wrong_order(
        line, "line 2 of the set that begins in line " + std::to_string(first_->line),
        kind == Kind::First ? "found another line 1" : "found a line that is no element line")));
    return take(line);
  }

  const std::string &file_;
  const TleOptions &options_;
  Diagnostics &diagnostics_;
  std::vector<ElementSet> sets_;
  std::optional<std::string> name_;
  std::size_t name_line_ = 0;
  std::optional<ElementSet> first_;
  Line first_text_{};
  LineNotes first_notes_{};
  bool skip_second_ = false;
  Tally bad_sets_{"sets are skipped"}, no_checksum_{"lines have no checksum"},
      bad_checksum_{"lines have a wrong checksum"}, other_{"remarks on names and epochs"};
};

} // namespace

} // namespace tle

Result<std::vector<ElementSet>> read_tle(std::string_view text, const std::string &file,
                                         const TleOptions &options, Diagnostics &diagnostics) {
  if (text.size() > options.limit_bytes)
    return fail(ErrorCode::BadInput,
                "the text has " + std::to_string(text.size()) + " bytes, expected at most " +
                    std::to_string(options.limit_bytes) + ". Split the file or raise the limit.",
                {file, 0, 0});
  tle::LineReader lines(text);
  tle::Reader reader(file, options, diagnostics);
  while (const auto line = lines.next())
    UMOV_TRY(reader.take(*line));
  return reader.finish();
}

} // namespace umov
