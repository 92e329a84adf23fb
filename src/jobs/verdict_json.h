#pragma once
// Private: what verdict.json files of several questions have in common.

#include "jobs/invert_tables.h"

#include <nlohmann/json.hpp>

namespace umov::jobs {

/// `u_null_test`.
inline void put_null_test(const NullTest &u, nlohmann::ordered_json &out) {
  out["u_null_test"] = {{"chi2_gain", u.chi2_gain}, {"q0", u.q0},
                        {"q0_sd", u.q0_sd},         {"u0", u.u0},
                        {"u0_sd", u.u0_sd},         {"flagged", u.is_flagged()}};
}

/// What those of an attitude end with: `symmetries`, as texts, and `u_null_test`.
inline void put_symmetries_and_null_test(const std::vector<BodySymmetry> &symmetries,
                                         const NullTest &u, nlohmann::ordered_json &out) {
  auto turns = nlohmann::ordered_json::array();
  for (const BodySymmetry &s : symmetries)
    turns.push_back(s.text);
  out["symmetries"] = turns;
  put_null_test(u, out);
}

} // namespace umov::jobs
