#pragma once
// Reads element lines by column alone, without any check: the reference's verification file has
// wrong checksums and further text after column 69, which the real reader refuses.

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>
#include <umov/orbit/elements.h>
#include <vector>

namespace umov::test {

inline double columns(const std::string &line, std::size_t first, std::size_t last) {
  return std::strtod(line.substr(first - 1, last - first + 1).c_str(), nullptr);
}

/// " 12345-3" as 0.12345e-3.
inline double implied_decimal(const std::string &line, std::size_t first) {
  const double mantissa = columns(line, first, first + 5) * 1e-5;
  return mantissa * std::pow(10, columns(line, first + 6, first + 7));
}

inline ElementSet by_columns(const std::string &one, const std::string &two) {
  constexpr double degree = std::numbers::pi / 180;
  ElementSet e;
  e.norad_cat_id = static_cast<int>(columns(one, 3, 7));
  const int year = static_cast<int>(columns(one, 19, 20));
  e.epoch_year = year + (year < 57 ? 2000 : 1900);
  e.epoch_day_of_year = columns(one, 21, 32);
  e.bstar = implied_decimal(one, 54);
  e.inclination = columns(two, 9, 16) * degree;
  e.raan = columns(two, 18, 25) * degree;
  e.eccentricity = columns(two, 27, 33) * 1e-7;
  e.argument_of_perigee = columns(two, 35, 42) * degree;
  e.mean_anomaly = columns(two, 44, 51) * degree;
  e.mean_motion = columns(two, 53, 63) * 2 * std::numbers::pi / 1440;
  return e;
}

inline std::vector<ElementSet> load_by_columns(const std::string &path) {
  std::vector<ElementSet> sets;
  std::ifstream in(path);
  std::string line, one;
  while (std::getline(in, line)) {
    if (line.starts_with("1 "))
      one = line;
    else if (line.starts_with("2 "))
      sets.push_back(by_columns(one, line));
  }
  return sets;
}

} // namespace umov::test
