#pragma once
// Private: columns of numbers from rows.

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

} // namespace umov::jobs
