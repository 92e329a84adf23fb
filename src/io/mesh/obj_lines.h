#pragma once
// Private: the lines of an OBJ or MTL text as words with columns.

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <vector>

namespace umov::obj {

struct Word {
  std::string_view text;
  std::size_t line = 0, column = 0; ///< from 1
};

/// Words of one line that are kept: twice what the largest polygon has, so that a longer one is
/// seen to be too long, and a line of millions of words takes no memory.
inline constexpr std::size_t words_max = 20'000;

/// Walks a text line by line: LF, CR LF or CR ends; a byte order mark, comments and a backslash at
/// the end of a line (continuation) are understood.
class Lines {
public:
  Lines(std::string_view text, std::string file, const std::atomic<bool> *cancel = nullptr);
  /// Words of the next line that has any; false at the end. Throws Failure (Interrupted) once
  /// `cancel` became true.
  bool next(std::vector<Word> &words);
  [[nodiscard]] Where where(const Word &word) const { return {file_, word.line, word.column}; }
  [[nodiscard]] const std::string &file() const { return file_; }
  /// The first line that has more words than were kept; 0 if there is none.
  [[nodiscard]] std::size_t cut_line() const { return cut_line_; }

private:
  std::string_view rest_;
  std::string file_;
  const std::atomic<bool> *cancel_;
  std::size_t line_ = 0, cut_line_ = 0;
};

/// A finite number; the message tells of commas, hexadecimal digits, NaN and overflow.
Result<double> number(const Lines &lines, const Word &word);

/// The rest of a line from word `first` on, as one name (names may hold blanks).
std::string name_from(const std::vector<Word> &words, std::size_t first);

} // namespace umov::obj
