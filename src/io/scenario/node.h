#pragma once
// Private: a TOML table whose keys have been checked, with messages that name the place.

#include <fmt/format.h>
#include <optional>
#include <set>
#include <string>
#include <toml++/toml.h>
#include <umov/core/result.h>
#include <umov/time/epoch.h>
#include <utility>
#include <vector>

namespace umov::scenario {

/// What is wrong with a file in places that do not follow from each other, to be told at once.
class Problems {
public:
  /// Whether that went well; else keeps why.
  template <class T> bool went(const Result<T> &result) {
    if (!result)
      add(result.error());
    return result.has_value();
  }
  /// What was read; `instead` where it was not, and why is kept.
  template <class T> T taken(const Result<T> &result, T instead) {
    return went(result) ? *result : std::move(instead);
  }
  void add(const Error &problem);    ///< once, however often it is met
  void leave_out(const Error &told); ///< it is told in other words
  /// The first problem, with the others in lines of their own.
  [[nodiscard]] Result<void> told() const;
  [[nodiscard]] bool has_some() const { return !found_.empty(); }

private:
  std::vector<Error> found_;
  std::set<std::string> known_; ///< texts of those that are found, or left out
};

/// What a reader needs to know besides the node: the file for messages.
class Node {
public:
  /// `schema`: name of the table in the list of keys; `label`: how messages call it.
  Node(const toml::table &table, std::string schema, std::string label, std::string file)
      : table_(&table), schema_(std::move(schema)), label_(std::move(label)),
        file_(std::move(file)) {}

  /// BadInput at the first key that is unknown or of the wrong type; the message has the others.
  [[nodiscard]] Result<void> check() const;
  /// The same, one by one.
  void add_problems(Problems &problems) const;

  [[nodiscard]] bool has(const char *name) const { return table_->contains(name); }
  [[nodiscard]] Where where(const char *name) const;
  [[nodiscard]] Where where() const;
  [[nodiscard]] const toml::node *get(const char *name) const { return table_->get(name); }
  [[nodiscard]] const toml::table &table() const { return *table_; }
  [[nodiscard]] const std::string &file() const { return file_; }
  [[nodiscard]] const std::string &label() const { return label_; }

  [[nodiscard]] std::string text(const char *name, std::string fallback) const;
  [[nodiscard]] double number(const char *name, double fallback) const;
  [[nodiscard]] std::int64_t integer(const char *name, std::int64_t fallback) const;
  [[nodiscard]] bool boolean(const char *name, bool fallback) const;
  [[nodiscard]] Result<Epoch<Utc>> time(const char *name) const;
  /// Numbers of a list or a single one. BadInput if something else is in it.
  [[nodiscard]] Result<std::vector<double>> numbers(const char *name) const;
  [[nodiscard]] Result<std::vector<std::string>> strings(const char *name) const;
  /// A table below, checked. `schema` overrides the name of its key list.
  [[nodiscard]] Result<Node> child(const char *name, const char *schema = nullptr) const;
  /// BadInput if `name` is missing.
  [[nodiscard]] Result<void> require(const char *name) const;
  /// BadInput unless the text is one of `known`; values of `later` are "not built yet".
  [[nodiscard]] Result<std::string> choice(const char *name, const std::string &fallback,
                                           const std::vector<std::string> &known,
                                           const std::vector<std::string> &later = {}) const;

private:
  [[nodiscard]] std::optional<Error> problem_of(const toml::key &key,
                                                const toml::node &value) const;
  const toml::table *table_;
  std::string schema_, label_, file_;
};

/// Tells what is wrong with the keys of a document and of all tables below that have a list of
/// keys, and leaves what can be read of it: an unknown key near to a known one is taken for that,
/// so that its value is looked at too; others, and what is no table where one was expected, are
/// taken away.
void settle_keys(toml::table &document, const std::string &file, Problems &problems);

/// A value that its key does not take: "step_s = -5; a positive number was expected".
template <class T>
Error wrong_value(const Node &node, const char *name, const T &value, const char *expected) {
  return {ErrorCode::BadInput, fmt::format("{} = {}; {} was expected", name, value, expected),
          node.where(name)};
}

/// A time that stands in a list of `node`.
Result<Epoch<Utc>> time_of(const Node &node, const toml::node &item);

/// The error of a file, with the place that names the file.
Error named(Error error, const Where &at);
/// What was read of a file; what is wrong with it, with the place that names it.
template <class T> Result<T> named_in(Result<T> read, const Where &at) {
  return read ? std::move(read) : tl::unexpected(named(read.error(), at));
}

/// What stands there, as messages say it: "a number, 4".
std::string described(const toml::node &value);
/// BadInput: an item of a list that is no table.
tl::unexpected<Error> no_table(const char *list, const toml::node &item, const char *expected,
                               Where where);

/// Place of a node or key; values of --set carry their own source name.
Where place_of(const toml::source_region &source, const std::string &file);
/// Place of a value; of its key where that is all one knows.
Where place_of(const toml::key &key, const toml::node &value, const std::string &file);

} // namespace umov::scenario
