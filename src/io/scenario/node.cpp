#include "io/scenario/node.h"

#include "io/scenario/keys.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sstream>
#include <umov/core/text.h>
#include <umov/time/typed.h>

namespace umov::scenario {
namespace {

bool is_of(const toml::node &node, Kind kind) {
  switch (kind) {
  case Kind::String:
    return node.is_string();
  case Kind::Number:
    return node.is_number();
  case Kind::Integer:
    return node.is_integer();
  case Kind::Boolean:
    return node.is_boolean();
  case Kind::Time:
    return node.is_date() || node.is_date_time() || node.is_string();
  case Kind::List:
    return node.is_array();
  case Kind::Table:
    return node.is_table();
  case Kind::Any:
    break;
  }
  return true;
}

const char *name_of(const toml::node &node) {
  switch (node.type()) {
  case toml::node_type::string:
    return "a string";
  case toml::node_type::integer:
  case toml::node_type::floating_point:
    return "a number";
  case toml::node_type::boolean:
    return "true or false";
  case toml::node_type::array:
    return "a list";
  case toml::node_type::table:
    return "a table";
  default:
    return "a date or time";
  }
}

/// What a value is, where it is one word.
std::string shown(const toml::node &node) {
  if (const auto text = node.value_exact<std::string>())
    return fmt::format(", \"{}\"", printable(text->substr(0, 40)));
  if (const auto number = node.value_exact<double>())
    return fmt::format(", {}", *number);
  if (const auto number = node.value_exact<std::int64_t>())
    return fmt::format(", {}", *number);
  return {};
}

} // namespace

std::string described(const toml::node &value) { return name_of(value) + shown(value); }

tl::unexpected<Error> no_table(const char *list, const toml::node &item, const char *expected,
                               Where where) {
  return fail(ErrorCode::BadInput,
              fmt::format("{} holds {}; {} were expected", list, described(item), expected),
              std::move(where));
}

namespace {

/// How a word that stands in place of a table is written in one: the file or the mode that it
/// names.
std::string in_a_table(const std::string &below, const std::string &name, const toml::node &value) {
  if (value.is_string())
    for (const char *key : {"mode", "file"})
      if (find_key(below, key) != nullptr)
        return fmt::format(", as in {} = {{ {} = {} }}", name, key, shown(value).substr(2));
  return {};
}

/// A TOML date-time as ISO text; without an offset if it has none.
std::string iso_of(const toml::date_time &t) {
  std::string out = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", t.date.year, t.date.month,
                                t.date.day, t.time.hour, t.time.minute, t.time.second);
  if (t.time.nanosecond > 0)
    out += fmt::format(".{:09}", t.time.nanosecond);
  if (!t.offset)
    return out;
  const int minutes = t.offset->minutes;
  return out + (minutes == 0 ? std::string("Z")
                             : fmt::format("{}{:02}:{:02}", minutes < 0 ? '-' : '+',
                                           std::abs(minutes) / 60, std::abs(minutes) % 60));
}

} // namespace

Error named(Error error, const Where &at) {
  const std::string place = to_text(at); // ends with ": "
  error.message += fmt::format(" (named in {})", place.substr(0, place.size() - 2));
  return error;
}

Where place_of(const toml::source_region &source, const std::string &file) {
  const bool is_other = source.path && *source.path != file;
  if (is_other)
    return {*source.path};
  return {file, source.begin.line, source.begin.column};
}

Where place_of(const toml::key &key, const toml::node &value, const std::string &file) {
  const bool has_place = value.source().path != nullptr; // lost where a --set put the value
  return place_of(has_place ? value.source() : key.source(), file);
}

std::optional<Error> Node::problem_of(const toml::key &key, const toml::node &value) const {
  const std::string name(key.str());
  const auto problem = [](const std::string &text, const Where &where) {
    return Error{ErrorCode::BadInput, text, where};
  };
  const Key *spec = find_key(schema_, name);
  if (spec == nullptr) {
    const auto known = names_in(schema_);
    const auto near = nearest_name(name, known);
    return problem(fmt::format("unknown key \"{}\"{}. {}", name,
                               label_.empty() ? "" : " in [" + label_ + "]",
                               near ? fmt::format("Did you mean \"{}\"?", *near)
                                    : fmt::format("Known: {}", fmt::join(known, ", "))),
                   place_of(key.source(), file_));
  }
  if (!is_of(value, spec->kind))
    return problem(
        fmt::format("{} is {}; {} was expected ({}){}", name, described(value), to_text(spec->kind),
                    spec->text,
                    spec->kind == Kind::Table
                        ? in_a_table(schema_.empty() ? name : schema_ + "." + name, name, value)
                        : std::string()),
        place_of(key, value, file_));
  if (const auto number = value.value<double>();
      number && spec->kind == Kind::Number && !std::isfinite(*number))
    return problem(fmt::format("{} is {}; a finite number was expected", name, *number),
                   place_of(key, value, file_));
  return {};
}

void Node::add_problems(Problems &problems) const {
  for (const auto &[key, value] : *table_)
    if (const auto problem = problem_of(key, value))
      problems.add(*problem);
}

namespace {

/// Takes the value of a key to another key, in whose place it stands from now on.
void rename(toml::table &table, const std::string &from, const std::string &to) {
  const auto at = table.find(from);
  toml::key key(to, toml::source_region(at->first.source()));
  at->second.visit([&](auto &value) { table.insert(std::move(key), std::move(value)); });
  table.erase(from);
}

/// Unknown keys: read as the known ones that they are near to, or taken away.
void settle_unknown(toml::table &table, const std::string &schema) {
  const std::vector<std::string> known = names_in(schema);
  std::vector<std::string> unknown;
  for (const auto &[key, value] : table)
    if (find_key(schema, key.str()) == nullptr)
      unknown.emplace_back(key.str());
  for (const std::string &name : unknown) {
    const auto near = nearest_name(name, known);
    if (near && !table.contains(*near) && is_of(*table.get(name), find_key(schema, *near)->kind))
      rename(table, name, *near);
    else
      table.erase(name);
  }
}

/// What stands in place of a table or a list: without it the rest can be read.
void take_away_mistyped(toml::table &table, const std::string &schema) {
  std::vector<std::string> wrong;
  for (const auto &[key, value] : table)
    if (const Key *spec = find_key(schema, key.str());
        (spec->kind == Kind::Table || spec->kind == Kind::List) && !is_of(value, spec->kind))
      wrong.emplace_back(key.str());
  for (const std::string &name : wrong)
    table.erase(name);
}

void settle(toml::table &table, const std::string &schema, const std::string &label,
            const std::string &file, Problems &problems) {
  if (names_in(schema).empty())
    return;
  const Node node(table, schema, label, file);
  node.add_problems(problems);
  settle_unknown(table, schema);
  if (schema.empty() || schema == "object")
    take_away_mistyped(table, schema);
  else if (const auto left = node.check(); !left) // and so says whoever reads the table
    problems.leave_out(left.error());
  for (auto &&[key, value] : table) {
    const std::string name(key.str()),
        below = schema.empty() ? name : fmt::format("{}.{}", schema, name);
    if (toml::table *one = value.as_table(); one != nullptr && below != "material")
      settle(*one, below, below, file, problems);
    else if (one != nullptr)
      for (auto &&[own, material] : *one)
        if (toml::table *keys = material.as_table())
          settle(*keys, below, below + "." + std::string(own.str()), file, problems);
    if (toml::array *list = value.as_array())
      for (toml::node &item : *list)
        if (toml::table *one = item.as_table())
          settle(*one, below, below, file, problems);
  }
}

} // namespace

void settle_keys(toml::table &document, const std::string &file, Problems &problems) {
  settle(document, "", "", file, problems);
}

namespace {

/// Between problems of one message.
constexpr std::string_view next_problem = "\n  and ";

/// The problems that a message tells, one by one; the first has the place.
std::vector<Error> one_by_one(const Error &told) {
  std::vector<Error> out;
  for (std::string_view rest = told.message;;) {
    const std::size_t end = std::min(rest.find(next_problem), rest.size());
    out.push_back(
        {told.code, std::string(rest.substr(0, end)), out.empty() ? told.where : Where{}});
    if (end == rest.size())
      return out;
    rest.remove_prefix(end + next_problem.size());
  }
}

} // namespace

void Problems::add(const Error &problem) {
  for (Error &one : one_by_one(problem))
    if (known_.insert(one.text()).second) // front and back of a face have one material
      found_.push_back(std::move(one));
}

void Problems::leave_out(const Error &told) {
  for (const Error &one : one_by_one(told))
    known_.insert(one.text());
}

Result<void> Problems::told() const {
  if (found_.empty())
    return {};
  Error out = found_.front();
  constexpr std::size_t most = 40;
  for (std::size_t i = 1; i < std::min(found_.size(), most); ++i)
    out.message += std::string(next_problem) + found_[i].text();
  if (found_.size() > most)
    out.message += fmt::format("{}{} more", next_problem, found_.size() - most);
  return tl::unexpected(out);
}

Result<void> Node::check() const {
  Problems problems;
  add_problems(problems);
  return problems.told();
}

Where Node::where(const char *name) const {
  const auto found = table_->find(name);
  return found == table_->end() ? where() : place_of(found->first.source(), file_);
}

Where Node::where() const { return place_of(table_->source(), file_); }

std::string Node::text(const char *name, std::string fallback) const {
  return (*table_)[name].value_or(std::move(fallback));
}
double Node::number(const char *name, double fallback) const {
  return (*table_)[name].value_or(fallback);
}
std::int64_t Node::integer(const char *name, std::int64_t fallback) const {
  return (*table_)[name].value_or(fallback);
}
bool Node::boolean(const char *name, bool fallback) const {
  return (*table_)[name].value_or(fallback);
}

namespace {

Result<Epoch<Utc>> time_from(const toml::node &node) {
  if (const auto day = node.value<toml::date>())
    return utc_from_iso_or_day(fmt::format("{:04}-{:02}-{:02}", day->year, day->month, day->day));
  if (const auto stamp = node.value<toml::date_time>())
    return utc_from_iso_or_day(iso_of(*stamp));
  if (node.is_string())
    return utc_from_iso_or_day(node.value_or(std::string()));
  std::ostringstream told;
  node.visit([&told](const auto &value) { told << value; });
  return fail(ErrorCode::BadInput, told.str() + " is not a time; one like 2018-01-21T05:00:00Z was "
                                                "expected");
}

} // namespace

Result<Epoch<Utc>> time_of(const Node &node, const toml::node &item) {
  auto time = time_from(item);
  if (!time)
    return fail(ErrorCode::BadInput, time.error().message, place_of(item.source(), node.file()));
  return *time;
}

Result<Epoch<Utc>> Node::time(const char *name) const {
  UMOV_TRY(require(name));
  auto time = time_from(*table_->get(name));
  if (!time)
    return fail(ErrorCode::BadInput, fmt::format("{} = {}", name, time.error().message),
                where(name));
  return *time;
}

Result<std::vector<double>> Node::numbers(const char *name) const {
  UMOV_TRY(require(name));
  const toml::node &node = *table_->get(name);
  std::vector<double> out;
  const auto take = [&](const toml::node &item) {
    const auto number = item.value<double>();
    if (number && std::isfinite(*number) && item.is_number())
      out.push_back(*number);
    return number && std::isfinite(*number) && item.is_number();
  };
  const auto refuse = [&](const std::string &found) {
    return fail(ErrorCode::BadInput,
                fmt::format("{}; a finite number or a list of them was expected", found),
                where(name));
  };
  if (const toml::array *list = node.as_array()) {
    for (const toml::node &item : *list)
      if (!take(item))
        return refuse(fmt::format("{} holds {}", name, described(item)));
  } else if (!take(node)) {
    return refuse(fmt::format("{} is {}", name, described(node)));
  }
  if (out.empty())
    return refuse(fmt::format("{} is an empty list", name));
  return out;
}

Result<std::vector<std::string>> Node::strings(const char *name) const {
  UMOV_TRY(require(name));
  const toml::node &node = *table_->get(name);
  std::vector<std::string> out;
  const auto refuse = [&](const char *verb, const toml::node &found) {
    return fail(ErrorCode::BadInput,
                fmt::format("{} {} {}; a string or a list of strings was expected", name, verb,
                            described(found)),
                where(name));
  };
  if (const toml::array *list = node.as_array()) {
    for (const toml::node &item : *list) {
      if (!item.is_string())
        return refuse("holds", item);
      out.push_back(item.value_or(std::string()));
    }
  } else if (!node.is_string()) {
    return refuse("is", node);
  } else {
    out.push_back(node.value_or(std::string()));
  }
  return out;
}

Result<Node> Node::child(const char *name, const char *schema) const {
  UMOV_TRY(require(name));
  const toml::table *below = table_->get_as<toml::table>(name);
  if (below == nullptr)
    return fail(ErrorCode::BadInput,
                fmt::format("{} is {}; a table was expected", name, described(*table_->get(name))),
                where(name));
  Node out(*below, schema != nullptr ? schema : schema_ + (schema_.empty() ? "" : ".") + name,
           label_ + (label_.empty() ? "" : ".") + name, file_);
  UMOV_TRY(out.check());
  return out;
}

Result<void> Node::require(const char *name) const {
  if (has(name))
    return {};
  const Key *spec = find_key(schema_, name);
  return fail(ErrorCode::BadInput,
              fmt::format("{} has no \"{}\"{}. Add it.",
                          label_.empty() ? "the file" : "[" + label_ + "]", name,
                          spec != nullptr ? fmt::format(" ({})", spec->text) : ""),
              where());
}

/// "a, b or c".
static std::string one_of(const std::vector<std::string> &words) {
  if (words.size() < 2)
    return fmt::format("{}", fmt::join(words, ""));
  const auto last = words.end() - 1;
  return fmt::format("{} or {}", fmt::join(words.begin(), last, ", "), *last);
}

Result<std::string> Node::choice(const char *name, const std::string &fallback,
                                 const std::vector<std::string> &known,
                                 const std::vector<std::string> &later) const {
  const std::string given = text(name, fallback);
  std::vector<std::string> shown; // "" stands for an absent key
  std::copy_if(known.begin(), known.end(), std::back_inserter(shown),
               [](const std::string &one) { return !one.empty(); });
  if (std::find(known.begin(), known.end(), given) != known.end())
    return given;
  if (std::find(later.begin(), later.end(), given) != later.end())
    return fail(ErrorCode::BadInput,
                fmt::format("{} = \"{}\" is not built yet; this version knows {}", name, given,
                            fmt::join(shown, ", ")),
                where(name));
  const auto near = nearest_name(given, shown);
  return fail(ErrorCode::BadInput,
              fmt::format("{} = \"{}\" is unknown; {} was expected.{}", name, given, one_of(shown),
                          near ? fmt::format(" Did you mean \"{}\"?", *near) : ""),
              where(name));
}

} // namespace umov::scenario
