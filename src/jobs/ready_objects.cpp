#include "jobs/ready_objects.h"

namespace umov::jobs {

Result<const Scenario *> ReadyObjects::scenario(const std::string &path) {
  auto at = all_.find(path);
  if (at == all_.end()) {
    UMOV_ASSIGN(read, read_scenario(path, {}));
    at = all_.emplace(path, One{std::move(read), {}, {}}).first;
  }
  return &at->second.scenario;
}

Result<const SearchedLight *> ReadyObjects::light(const std::string &path,
                                                  const InvertRequest &request,
                                                  const JobOptions &options,
                                                  Diagnostics &diagnostics,
                                                  const std::atomic<bool> *cancel) {
  One &one = all_.at(path);
  auto made = Result<void>();
  if (!one.light) {
    Diagnostics told;
    auto light = prepare_light(one.scenario, request, options, told, cancel);
    one.told = std::move(told);
    if (light)
      made = take_coarse(*light, one.scenario, request, options, cancel);
    else
      made = tl::unexpected(light.error());
    if (made)
      one.light = std::move(*light);
  }
  for (const Warning &warning : one.told.warnings())
    diagnostics.warn(warning.message, warning.where);
  UMOV_TRY(made);
  return &*one.light;
}

void ReadyObjects::keep() const {
  for (const auto &[path, one] : all_)
    if (one.light)
      keep_masks(*one.light);
}

} // namespace umov::jobs
