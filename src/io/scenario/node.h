#pragma once
// Private: a TOML table whose keys have been checked, with messages that name the place.

#include <optional>
#include <string>
#include <toml++/toml.h>
#include <umov/core/result.h>
#include <umov/time/epoch.h>
#include <vector>

namespace umov::scenario {

/// What is wrong with a file in places that do not follow from each other, to be told at once.
class Problems {
public:
  /// Whether that went well; else keeps why.
  bool went(const Result<void> &result);
  void add(Error problem); ///< once, however often it is met
  /// The first problem, with the others in lines of their own.
  [[nodiscard]] Result<void> told() const;

private:
  std::vector<Error> found_;
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
  /// The same for all tables below too, as far as they have a list of keys.
  [[nodiscard]] Result<void> check_with_all_below() const;

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
  void add_problems(Problems &problems) const;
  void add_problems_below(Problems &problems) const;
  const toml::table *table_;
  std::string schema_, label_, file_;
};

/// A time that stands in a list of `node`.
Result<Epoch<Utc>> time_of(const Node &node, const toml::node &item);

/// The error of a file, with the place that names the file.
Error named(Error error, const Where &at);

/// Place of a node or key; values of --set carry their own source name.
Where place_of(const toml::source_region &source, const std::string &file);
/// Place of a value; of its key where that is all one knows.
Where place_of(const toml::key &key, const toml::node &value, const std::string &file);

} // namespace umov::scenario
