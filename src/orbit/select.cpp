#include <umov/orbit/select.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <umov/core/text.h>
#include <vector>

namespace umov {
namespace {

std::string list_objects(const std::vector<ElementSet> &sets) {
  if (sets.empty())
    return "other objects";
  std::map<int, std::string> objects;
  for (const ElementSet &set : sets)
    objects.emplace(set.norad_cat_id, set.name);
  std::vector<std::string> names;
  names.reserve(objects.size());
  for (const auto &[norad, name] : objects)
    names.push_back(name.empty() ? fmt::format("{}", norad) : fmt::format("{} {}", norad, name));
  return listed(names, 8);
}

} // namespace

Result<ElementSet> choose_elements(const std::vector<ElementSet> &sets, int norad, Epoch<Utc> start,
                                   const std::string &file) {
  const ElementSet *best = nullptr;
  for (const ElementSet &set : sets) {
    if (norad == 0 && set.norad_cat_id != sets.front().norad_cat_id)
      return fail(ErrorCode::BadInput,
                  "holds several objects; say which one with its catalogue number (norad = ...): " +
                      list_objects(sets),
                  {file});
    if (norad != 0 && set.norad_cat_id != norad)
      continue;
    const double age = clock_days_between(start, set.epoch);
    const double best_age = best != nullptr ? clock_days_between(start, best->epoch) : 0;
    const bool is_better = best == nullptr || (age >= 0 && (best_age < 0 || age < best_age)) ||
                           (age < 0 && best_age < 0 && age > best_age);
    if (is_better)
      best = &set;
  }
  if (best == nullptr)
    return fail(ErrorCode::BadInput,
                fmt::format("has no elements of {}. It holds {}", norad, list_objects(sets)),
                {file});
  return *best;
}

Result<void> check_element_age(const ElementSet &set, Epoch<Utc> start, Epoch<Utc> stop,
                               bool allow_old, const std::string &file, Diagnostics &diagnostics) {
  const double age = std::max(std::abs(clock_days_between(start, set.epoch)),
                              std::abs(clock_days_between(stop, set.epoch)));
  const Where where{file, set.line};
  if (age > 30 && !allow_old)
    return fail(ErrorCode::BadInput,
                fmt::format("{}: the elements are of {}, {:.1f} d from the span asked for; 30 d is "
                            "the limit. Give newer elements or pass --allow-old-elements (in "
                            "Python allow_old_elements=True).",
                            set.norad_cat_id, to_iso(set.epoch), age),
                where);
  if (age > 7)
    diagnostics.warn(fmt::format("{}: the elements are of {}, {:.1f} d from the span; expect "
                                 "kilometres of error along the track",
                                 set.norad_cat_id, to_iso(set.epoch), age),
                     where);
  return {};
}

} // namespace umov
