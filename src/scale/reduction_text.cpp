#include "scale/reduction_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <set>
#include <umov/core/text.h>
#include <umov/scale/reduction.h>
#include <utility>

namespace umov::scale {
namespace {

constexpr std::size_t most_bins = 1'000'000, most_rows = 1'000'000;
constexpr std::array<const char *, 5> kind_names{"histogram", "log-histogram", "most", "least",
                                                 "likelihood"};

std::vector<std::string> split(const std::string &text, char at) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(at, begin);
    out.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return out;
}

bool are_edges(const std::vector<double> &edges) {
  return std::ranges::all_of(edges, [](double edge) { return std::isfinite(edge); }) &&
         std::ranges::adjacent_find(edges, std::greater_equal()) == edges.end();
}

} // namespace

std::vector<double> edges_of(const Wanted &wanted) {
  const auto bins = static_cast<double>(wanted.count);
  std::vector<double> out;
  for (std::size_t k = 0; k <= wanted.count; ++k) {
    const double part = static_cast<double>(k) / bins;
    out.push_back(wanted.kind == Kind::LogHistogram
                      ? wanted.low * std::pow(wanted.high / wanted.low, part)
                      : wanted.low + (wanted.high - wanted.low) * part);
  }
  out.back() = wanted.high;
  return out;
}

namespace {

using Words = std::vector<std::string>;

/// At each + but that of an exponent.
Words split_numbers(const std::string &text) {
  Words out;
  for (std::string &word : split(text, '+'))
    if (!out.empty() && (out.back().ends_with('e') || out.back().ends_with('E')))
      out.back() += '+' + word;
    else
      out.push_back(std::move(word));
  return out;
}

/// Nothing where all is well, else what is wrong.
std::string read_bins(const Words &words, Wanted &out) {
  const auto low = parse_number(words[2]), high = parse_number(words[3]);
  const bool is_log = out.kind == Kind::LogHistogram;
  if (!low || !high || !(*low < *high) || (is_log && !(*low > 0)))
    return is_log ? "0 < LOW < HIGH" : "LOW < HIGH";
  out.low = *low, out.high = *high;
  return are_edges(edges_of(out))
             ? ""
             : "LOW and HIGH are too far apart, or too near for so many bins: the edges between "
               "them are no rising numbers";
}

std::string read_count(const std::string &word, std::size_t most, Wanted &out) {
  const auto end = word.data() + word.size();
  if (std::from_chars(word.data(), end, out.count).ptr != end || out.count == 0 || out.count > most)
    return "\"" + printable(word) + "\" is no number from 1 to a million";
  return "";
}

std::string read_measured(const Words &words, Wanted &out) {
  const Words columns = split(words[1], '+'), values = split_numbers(words[2]),
              errors = split_numbers(words[3]);
  if (values.size() != columns.size() || errors.size() != columns.size())
    return "a value and an error of each column";
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto value = parse_number(values[k]), error = parse_number(errors[k]);
    if (!value || !error || !(*error > 0))
      return "a VALUE, and an ERROR above 0";
    out.measured.push_back({columns[k], *value, *error});
  }
  return "";
}

} // namespace

Result<Wanted> read_wanted(const std::string &text) {
  const auto refuse = [&text](const std::string &why) {
    return fail(ErrorCode::Usage,
                fmt::format("--reduce {}: {}. Expected: histogram:COLUMN:LOW:HIGH:BINS, the same "
                            "with log-histogram, most:COLUMN:COUNT, least:COLUMN:COUNT, "
                            "likelihood:COLUMN:VALUE:ERROR or, of several in one row, "
                            "likelihood:COLUMN+COLUMN:VALUE+VALUE:ERROR+ERROR, and :COLUMN behind "
                            "it for one of each "
                            "of its values; such as log-histogram:intensity:1e-6:100:80",
                            printable(text), why));
  };
  const Words words = split(text, ':');
  const auto name = std::ranges::find(kind_names, words.front());
  if (name == kind_names.end())
    return refuse("no such reduction");
  Wanted out;
  out.kind = static_cast<Kind>(name - kind_names.begin());
  const bool is_histogram = out.kind == Kind::Histogram || out.kind == Kind::LogHistogram;
  const bool is_likelihood = out.kind == Kind::Likelihood;
  const std::size_t least = is_histogram ? 5 : is_likelihood ? 4 : 3;
  if (words.size() < least || words.size() > least + 1 ||
      std::ranges::any_of(words, [](const std::string &word) { return word.empty(); }))
    return refuse(is_histogram    ? "a column, two numbers and a number of bins"
                  : is_likelihood ? "a column, a value and its error"
                                  : "a column and a number of rows");
  out.column = words[1];
  std::string problem =
      is_likelihood ? read_measured(words, out)
                    : read_count(words[least - 1], is_histogram ? most_bins : most_rows, out);
  if (problem.empty() && is_histogram)
    problem = read_bins(words, out);
  if (!problem.empty())
    return refuse(problem);
  if (words.size() > least)
    out.by = split(words[least], '+');
  return out;
}

std::string reduced_name(const std::string &text) {
  const std::size_t kind = text.find(':'), column = text.find(':', kind + 1);
  std::string out = text.substr(0, column);
  std::ranges::replace_if(
      out, [](char c) { return c == ':' || c == '-' || c == '+'; }, '_');
  return out;
}

Result<void> check_reductions(const std::vector<std::string> &texts) {
  std::set<std::string> names;
  for (const std::string &text : texts) {
    UMOV_TRY(read_wanted(text));
    if (!names.insert(reduced_name(text)).second)
      return fail(ErrorCode::Usage, fmt::format("--reduce {}: there is one of that kind and column "
                                                "already; another job takes the other",
                                                printable(text)));
  }
  return {};
}

} // namespace umov::scale
