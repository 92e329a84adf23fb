#pragma once
// Private: which object it was, as a table and in words.

#include <umov/inverse/identify.h>
#include <umov/jobs/invert.h>

namespace umov::jobs {

/// Everything that identity.ecsv, the summary and verdict.json say.
struct IdentityWords {
  std::vector<std::string> names;   ///< of the candidates, as they were given
  std::vector<double> table_errors; ///< of their signatures
  const IdentityAnswer *answer = nullptr;
  Verdict verdict = Verdict::Undetermined;
  std::vector<std::string> notes;
  /// `share_between` of the best in its own light, if it was asked, and whether its fit had that.
  std::optional<double> light_between = {};
  bool is_between_fitted = false;
};

/// The name of the row that stands for none of the library.
inline constexpr const char *none_of_these = "none of these";

/// The most probable of the candidates that were searched: it has attitudes and a chi-square.
std::size_t best_searched(const IdentityAnswer &answer);
/// identity.ecsv: most probable first, none of these among them.
Table identity_table(const IdentityWords &words);
/// Determined: one object holds over 95 % in its own light; NoFit: none of these does. What a
/// table, a steady curve or one epoch says of a name is never more than Ambiguous.
Verdict verdict_of(const IdentityAnswer &answer, const ObservedCurve &curve,
                   const CurveErrors &errors);
/// What the answer rests on, and what it cannot tell.
std::vector<std::string> notes_of(const IdentityWords &words, const ObservedCurve &curve,
                                  const CurveErrors &errors);
std::string summary_of(const IdentityWords &words);
/// A line of each of the most probable rows of the table, for the page.
std::string odds_of(const IdentityWords &words);
/// `library`: SHA-256 of what its objects were made from.
std::string json_of(const IdentityWords &words, const std::string &library);

} // namespace umov::jobs
