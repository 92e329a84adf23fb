#pragma once
// Private: one question to one curve, made ready once for many of them.

#include "jobs/invert_light.h"

#include <functional>
#include <umov/jobs/identify.h>

namespace umov::jobs {

/// What is asked of every curve.
struct CurveQuestion {
  std::vector<std::string> curves; ///< files
  std::vector<NamedTable> tables;  ///< of an answer, without rows
  std::vector<InputFile> inputs;   ///< besides the curves
  std::string asked;               ///< all that answers depend on besides
  std::function<Result<Inversion>(const std::string &curve, const Monitor &, Diagnostics &)> ask;
  std::function<void()> keep; ///< masks for the next process
};

/// The answer of invert_pose to a curve whose object is ready to be lit.
Result<Inversion> pose_answer(const Scenario &scenario, const InvertRequest &request,
                              const JobOptions &options, const ObservedLightCurve &observed,
                              const SearchedLight &ready, const Monitor &monitor,
                              Diagnostics &diagnostics);

/// The answer of identify_object, of whose objects those that were asked for before are ready.
class ReadyObjects;
Result<Inversion> identity_answer(const Scenario &scenario, const IdentifyRequest &request,
                                  const JobOptions &options, ReadyObjects &ready,
                                  const Monitor &monitor, Diagnostics &diagnostics);

/// The tables of invert_pose and of identify_object, without rows.
std::vector<NamedTable> no_pose_tables();
std::vector<NamedTable> no_identity_tables();

/// What the objects of a library were made from, as text; BadInput as identify_object.
Result<std::string> library_text(const std::string &folder);

/// Errors and grid of a request, as text.
std::string text_of(const InvertRequest &request);

} // namespace umov::jobs
