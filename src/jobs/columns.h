#pragma once
// Private: columns of numbers from rows.

#include <string>
#include <umov/io/table.h>
#include <vector>

namespace umov::jobs {

/// One column of numbers taken from each row.
template <class Rows, class Take>
void add_numbers(Table &table, const Rows &rows, const char *name, const char *unit,
                 const char *description, Take take) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const auto &row : rows)
    values.push_back(take(row));
  table.add(name, unit, description, std::move(values));
}

/// As readers of ECSV know it: Vega's is none for them.
inline std::string magnitude_unit(const std::string &system) {
  return system == "Vega" ? "mag" : "mag(" + system + ")";
}

} // namespace umov::jobs
