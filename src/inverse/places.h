#pragma once
// Private: attitudes that are worth a fit, and what lies beside them.

#include "inverse/turning_fit.h"

#include <umov/inverse/pose_search.h>

namespace umov::inverse {

/// Places of fits under errors that shrink, of attitudes in order of their likelihood: many at
/// first, by few epochs, and few of those that stay apart. A basin of one glint is a long valley,
/// and there is one for each flat that could have mirrored the Sun; how they compare shows where a
/// quarter of I is no longer forgiven. Of a model that is wrong by more than that it does not: each
/// round has places of its own, and so have the unknowns of its parts, if it has any, without which
/// the truth can look hopeless. `times`: as many as usual. Empty if it was stopped.
std::vector<Turning> cooled_places(const SearchModels &models, const std::vector<Turning> &sorted,
                                   std::size_t times, const SearchOptions &options);

/// The first steps of a fit of each place, best first. A model whose parts are not quite known is
/// asked around the best half of `most` places too: narrow lobes make dents of a part of a degree,
/// which stand beside each other where parts can make up for a turn, and no fit leaves its own.
/// Empty if it was stopped.
std::vector<TurningFit> first_fits(const CurveModel &model, const CurveLikelihood &likelihood,
                                   const std::vector<Turning> &places, std::size_t most,
                                   unsigned threads);

/// The best `count` turnings that are apart, then half as many of the best beside them: dents of
/// one place are modes of their own, but must not crowd out other places.
std::vector<Turning> apart_first(const std::vector<Turning> &sorted, std::size_t count);

/// Ten modes and more in different places explain the data nearly as well as the best: others were
/// passed by then.
bool are_many(const std::vector<TurningFit> &fits, double span_s);

} // namespace umov::inverse
