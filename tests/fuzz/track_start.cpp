// What a tracking begins with (state.json, modes.ecsv): what is accepted can be followed. Behind a
// form feed stand the samples of a search (samples.ecsv).

#include "jobs/track_start.h"
#include "fuzz/target.h"

#include <cmath>

namespace {

using namespace umov;

/// Of an answer that says its body, that body.
jobs::TrackFrame frame_of(std::string_view text) {
  jobs::TrackFrame frame;
  frame.bands = {"nm:550"};
  frame.parts = {{"white", 0.1, 0}};
  if (text.find("object_mesh") != std::string_view::npos)
    frame.body = {"12 facets", "bus=white 1a2b"};
  return frame;
}

jobs::TrackStartFile file_of(std::string_view text) {
  const std::size_t end = text.find('\f');
  jobs::TrackStartFile out{"input", std::string(text.substr(0, end))};
  if (end != std::string_view::npos) {
    out.samples_path = "samples";
    out.samples = text.substr(end + 1);
  }
  return out;
}

void check_modes(const std::vector<TrackMode> &modes) {
  fuzz::require(!modes.empty(), "there is a mode");
  double sum = 0;
  for (const TrackMode &mode : modes) {
    const std::size_t n = 6 + mode.nuisances.size();
    fuzz::require(mode.covariance.size() == n * n && mode.scale > 0, "a covariance and a scale");
    for (std::size_t k = 0; k < n; ++k)
      fuzz::require(mode.covariance[k * n + k] > 0, "variances above 0");
    const Quaternion q = mode.turning.attitude;
    fuzz::require(std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-5, "a length");
    sum += std::exp(mode.log_weight);
  }
  fuzz::require(std::abs(sum - 1) < 1e-5, "weights that add up to 1");
}

/// A tracking that goes on is read as it was; one that was lost or explains nothing is refused.
void check_states(const jobs::TrackStart &state, const jobs::TrackFrame &frame) {
  using jobs::Verdict;
  Diagnostics diagnostics;
  const auto written = [&](const jobs::TrackStart &one, TrackLoss loss, Verdict verdict) {
    return jobs::TrackStartFile{"input", jobs::state_json(one, frame, loss, verdict)};
  };
  const auto own = written(state, TrackLoss::None, Verdict::Determined);
  const auto again =
      fuzz::must(jobs::read_track_start(own, frame, 0.1, diagnostics), "what is written is read");
  fuzz::require(written(again, TrackLoss::None, Verdict::Determined).text == own.text,
                "a state comes back as it was");
  for (const auto &[loss, verdict] : {std::pair{TrackLoss::Misfit, Verdict::Determined},
                                      {TrackLoss::Open, Verdict::Undetermined},
                                      {TrackLoss::None, Verdict::NoFit}})
    fuzz::require(!fuzz::is_read(jobs::read_track_start(written(state, loss, verdict), frame, 0.1,
                                                        diagnostics)),
                  "nothing is followed that was lost or is not explained");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  const jobs::TrackFrame frame = frame_of(text);
  const jobs::TrackStartFile file = file_of(text);
  Diagnostics diagnostics;
  const auto read = jobs::read_track_start(file, frame, 0.1, diagnostics);
  if (!fuzz::is_read(read))
    return 0;
  check_modes(read->modes);
  const auto as_bright = [&]() -> Result<jobs::LightRange> {
    return jobs::LightRange{read->median_i, read->median_i};
  };
  for (const double times : {0.5, 2000.})
    (void)fuzz::is_read(
        jobs::check_brightness(file, frame, read->median_i, times * read->median_i, as_bright));
  if (file.text.starts_with('{'))
    check_states(*read, frame);
  return 0;
}
