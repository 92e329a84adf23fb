// What a tracking begins with (state.json, modes.ecsv): what is accepted can be followed.

#include "jobs/track_start.h"
#include "fuzz/target.h"

#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  jobs::TrackFrame frame;
  frame.bands = {"nm:550"};
  frame.parts = {{"white", 0.1, 0}};
  const std::string text(fuzz::text_of(data, size));
  Diagnostics diagnostics;
  const auto read = jobs::read_track_start({"input", text}, frame, 0.1, diagnostics);
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(!read->modes.empty(), "there is a mode");
  double sum = 0;
  for (const TrackMode &mode : read->modes) {
    const std::size_t n = 6 + mode.nuisances.size();
    fuzz::require(mode.covariance.size() == n * n && mode.scale > 0, "a covariance and a scale");
    for (std::size_t k = 0; k < n; ++k)
      fuzz::require(mode.covariance[k * n + k] > 0, "variances above 0");
    const Quaternion q = mode.turning.attitude;
    fuzz::require(std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-5, "a length");
    sum += std::exp(mode.log_weight);
  }
  fuzz::require(std::abs(sum - 1) < 1e-5, "weights that add up to 1");
  if (!text.starts_with('{'))
    return 0;
  const std::string written =
      jobs::state_json(*read, frame, TrackLoss::None, jobs::Verdict::Determined);
  const auto again = fuzz::must(jobs::read_track_start({"input", written}, frame, 0.1, diagnostics),
                                "what is written is read");
  fuzz::require(jobs::state_json(again, frame, TrackLoss::None, jobs::Verdict::Determined) ==
                    written,
                "a state comes back as it was");
  return 0;
}
