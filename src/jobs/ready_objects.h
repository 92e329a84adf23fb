#pragma once
// Private: objects of scenarios, lit ready once for all curves that are held against them.

#include "jobs/invert_light.h"

#include <map>

namespace umov::jobs {

/// Scenarios with their light, each read and made ready when it is first asked for, and then kept.
/// What was warned of meanwhile is told every time: an answer does not depend on those before it.
/// For one thread at a time.
class ReadyObjects {
public:
  /// The scenario of a file.
  Result<const Scenario *> scenario(const std::string &path);
  /// The light of an object whose scenario was asked for, under one request and options.
  Result<const SearchedLight *> light(const std::string &path, const InvertRequest &request,
                                      const JobOptions &options, Diagnostics &diagnostics,
                                      const std::atomic<bool> *cancel);
  /// Masks of all lights, for later jobs.
  void keep() const;

private:
  struct One {
    Scenario scenario;
    std::optional<SearchedLight> light;
    Diagnostics told;
  };
  std::map<std::string, One> all_;
};

} // namespace umov::jobs
