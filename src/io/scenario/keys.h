#pragma once
// Private: the table of keys. The reader, the messages and the schema all come from it.

#include <string>
#include <string_view>
#include <vector>

namespace umov::scenario {

enum class Kind { String, Number, Integer, Boolean, Time, List, Table, Any };

struct Key {
  const char *table; ///< "" top level, "time.only", "material", ...
  const char *name;
  Kind kind;
  std::string fallback; ///< as TOML; "" = required or absent
  const char *text;     ///< meaning with unit
};

const std::vector<Key> &keys();
/// Names of the keys of a table.
std::vector<std::string> names_in(std::string_view table);
const Key *find_key(std::string_view table, std::string_view name);
const char *to_text(Kind kind);

} // namespace umov::scenario
