#pragma once
// Which object of a library made a light curve.

#include <umov/inverse/identify.h>
#include <umov/jobs/invert.h>

namespace umov::jobs {

/// Where to look, and how.
struct IdentifyRequest {
  InvertRequest observed; ///< observations, errors, grid of the searches
  std::string library;    ///< folder of umov library build
  /// Scenarios that objects of the library were made from: the best ones are judged by their own
  /// light too. A file belongs to the object of its name.
  std::vector<std::string> objects;
  double none_prior = 0.05; ///< chance, before any data, that it is none of them
};

/// Which object of a library made the observations, in an unknown attitude and of unknown size:
/// identity (a row for each object and one for none of them), attitudes and fit of the most
/// probable one. The scenario gives orbit, site and bands; its own shape is not read. BadInput for
/// a library without objects or without the curve's bands; Usage for a scenario of `objects` that
/// the library does not have. Warns of one that is not what the library was made from.
Result<Inversion> identify_object(const Scenario &scenario, const IdentifyRequest &request,
                                  const JobOptions &options, const Monitor &monitor,
                                  Diagnostics &diagnostics);

} // namespace umov::jobs
