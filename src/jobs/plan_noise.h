#pragma once
// Private: what errors an observer of an alternative would have.

#include <optional>
#include <span>
#include <umov/inverse/design.h>
#include <umov/jobs/plan.h>
#include <umov/orbit/ephemeris.h>

namespace umov::jobs {

/// The light of all alternatives where it would be observed, band by band.
struct PlannedLight {
  std::span<const ObservingGeometry> geometry;
  std::span<const Alternative> alternatives; ///< without errors yet
  std::size_t bands = 0;
};

/// Errors of every alternative, in their order, and in words what they stand for.
struct PlannedErrors {
  std::vector<ExpectedErrors> of;
  std::string text;
  std::size_t saturated = 0; ///< rows of all alternatives that a full pixel leaves out
};
/// As the request says, or of the scenario's instrument. BadInput where a set of exposures takes
/// longer than the time between two rows.
Result<PlannedErrors> planned_errors(const Scenario &scenario, const PlanRequest &request,
                                     const PlannedLight &light);

} // namespace umov::jobs
