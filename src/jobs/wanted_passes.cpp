#include "jobs/wanted_passes.h"

#include <algorithm>
#include <fmt/format.h>

namespace umov::jobs {

Result<LightCurveOutcome> compute_wanted(const ObjectRun &one, const LightModels &models,
                                         const Progress &progress, const std::atomic<bool> &cancel,
                                         KeptBlocks blocks) {
  const LightModel *many = models.many_directions.get();
  if (!one.passes)
    return compute_light_curve(one.request, *models.light, many, progress, cancel, blocks);
  return compute_cut(
      one.request,
      cut_passes(*one.kept, one.passes->first, one.passes->count, *models.light, one.request),
      *models.light, many, progress, cancel, blocks);
}

IndexRange overlap(IndexRange range, std::size_t first, std::size_t count) {
  const std::size_t begin = std::clamp(range.first, first, first + count);
  const std::size_t end = std::clamp(range.end(), first, first + count);
  return {begin - first, end - begin};
}

Result<void> take_part(std::vector<ObjectRun> &objects, const JobPart &part,
                       const std::atomic<bool> &cancel) {
  std::size_t total = 0;
  for (ObjectRun &one : objects) {
    UMOV_ASSIGN(kept, kept_epochs(one.request, cancel));
    one.kept = std::make_shared<const KeptEpochs>(std::move(kept));
    total += one.kept->passes.size();
  }
  UMOV_ASSIGN(range, part.of(total, "passes"));
  std::size_t first = 0;
  for (ObjectRun &one : objects) {
    one.passes = overlap(range, first, one.kept->passes.size());
    first += one.kept->passes.size();
  }
  std::erase_if(objects, [](const ObjectRun &one) { return one.passes->count == 0; });
  if (objects.empty())
    return fail(ErrorCode::Nothing,
                fmt::format("part {} of {} passes has none of them", part.text(), total));
  return {};
}

} // namespace umov::jobs
