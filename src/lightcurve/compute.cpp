#include <umov/lightcurve/compute.h>

#include "lightcurve/row.h"

#include "lightcurve/row_bytes.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/parallel.h>
#include <umov/frames/sky.h>
#include <umov/light/blocks.h>
#include <umov/photometry/radiometry.h>

namespace umov {
namespace {

/// Of the one that has left its cards, else of `light`.
std::string device_of(const LightModel &light, const LightModel *many_directions) {
  std::string out = light.device();
  if (many_directions != nullptr && !out.starts_with("cpu"))
    if (std::string many = many_directions->device(); many.starts_with("cpu"))
      return many;
  return out;
}

/// Fills the rows of a curve, block by block.
class RowMaker {
public:
  RowMaker(const LightCurveRequest &request, const LightModel &light,
           const LightModel *many_directions, const Track &track, const KeptEpochs &kept,
           std::vector<PhotometricBand> colours, LightCurve &curve, const std::atomic<bool> &cancel,
           KeptBlocks blocks)
      : request_(request), light_(light), many_directions_(many_directions), track_(track),
        kept_(kept), colours_(std::move(colours)), curve_(curve), cancel_(cancel), blocks_(blocks) {
  }

  /// Every finished block stays after a stop; returns the rows kept.
  std::size_t fill(const Progress &progress, std::optional<Error> &stopped);

private:
  std::size_t fill_block(Journal::Block block, std::size_t begin, std::size_t count,
                         std::optional<Error> &stopped);
  bool light_block(const std::vector<TrackPoint> &points, std::size_t begin, StokesTable &table);
  bool find(Journal::Block block, std::size_t begin, std::size_t count, StokesTable &table);
  std::size_t place(std::size_t begin, std::size_t count, std::vector<TrackPoint> &points,
                    std::optional<Error> &stopped);
  void put(const StokesTable &table, std::size_t k, std::size_t row);
  void add_second_lights(const TrackPoint &point, std::size_t row);
  [[nodiscard]] std::vector<std::vector<BandResult>>
  light_from(const std::vector<Pose> &poses, const std::vector<double> &joint_angles_rad) const;

  const LightCurveRequest &request_;
  const LightModel &light_;
  const LightModel *many_directions_;
  const Track &track_;
  const KeptEpochs &kept_;
  std::vector<PhotometricBand> colours_;
  LightCurve &curve_;
  const std::atomic<bool> &cancel_;
  KeptBlocks blocks_;
};

/// Many directions at one epoch.
std::vector<std::vector<BandResult>>
RowMaker::light_from(const std::vector<Pose> &poses,
                     const std::vector<double> &joint_angles_rad) const {
  StokesTable table;
  std::vector<double> angles;
  for (std::size_t k = 0; k < poses.size(); ++k)
    angles.insert(angles.end(), joint_angles_rad.begin(), joint_angles_rad.end());
  LightTask task;
  task.threads = 1; // epochs are side by side
  (void)many_directions_->evaluate(poses, angles, table, task);
  std::vector<std::vector<BandResult>> out(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (std::size_t b = 0; b < table.bands; ++b)
      out[k].push_back(table.at(k, b));
  return out;
}

void RowMaker::add_second_lights(const TrackPoint &point, std::size_t row) {
  const ObservingGeometry &geometry = point.geometry;
  const Rotation<Body, Gcrs> &body_from_gcrs = point.body_from_gcrs;
  const LightCurveRequest &request = request_;
  LightCurve &curve = curve_;
  const std::size_t bands = curve.bands.size();
  const auto light = [&](const std::vector<Pose> &poses) {
    return light_from(poses, point.joint_angles_rad);
  };
  const Vec3<Gcrs> north = request.frame == PolarizationFrame::Equatorial ? Vec3<Gcrs>{0, 0, 1}
                           : request.frame == PolarizationFrame::AltAz
                               ? geometry.zenith
                               : scattering_normal(geometry.to_observer, geometry.to_sun);
  EarthshineOptions earth = request.earthshine.value_or(EarthshineOptions{});
  earth.narrowest_lobe = narrowest_lobe(light_.scene());
  for (SecondLight &second : curve.second_lights) {
    const auto sum = second.source == SecondSource::Moon
                         ? moon_light(geometry, body_from_gcrs, north, bands, light)
                         : earth_light(geometry, body_from_gcrs, north, earth, bands, light);
    for (std::size_t b = 0; b < bands; ++b) {
      second.intensity[row * bands + b] = sum.stokes[b];
      second.half_width[row * bands + b] = sum.half_width[b];
      second.irradiance[row * bands + b] = irradiance_at_observer(
          sum.stokes[b].i, colours_[b].solar, geometry.sun_distance_km, 1, geometry.range_km);
    }
  }
}

/// Where the object is, how it is turned and how it is lit and seen; how many rows before the first
/// that cannot be placed (`stopped` says why).
std::size_t RowMaker::place(std::size_t begin, std::size_t count, std::vector<TrackPoint> &points,
                            std::optional<Error> &stopped) {
  std::vector<std::optional<Result<TrackPoint>>> placed(count);
  parallel_for(count, request_.threads,
               [&](std::size_t k) { placed[k] = track_.place(kept_.geometry[begin + k]); });
  for (std::size_t k = 0; k < count; ++k) {
    if (!*placed[k]) {
      stopped = placed[k]->error();
      return k;
    }
    points.push_back(std::move(**placed[k]));
    const TrackPoint &point = points.back();
    LightCurveEpoch &epoch = curve_.epochs[begin + k];
    epoch.geometry = point.geometry;
    epoch.body_from_gcrs = quaternion_from(point.body_from_gcrs);
    epoch.pose = point.pose;
    epoch.joint_angles_rad = point.joint_angles_rad;
    epoch.airmass = airmass(point.geometry.altitude);
    epoch.pass_id = kept_.passes[kept_.pass[begin + k]].id;
    epoch.elset_age_days = request_.track.orbit.element_age_days(point.geometry.time);
  }
  return count;
}

void RowMaker::put(const StokesTable &table, std::size_t k, std::size_t row) {
  LightCurveEpoch &epoch = curve_.epochs[row];
  epoch.is_dark = table.is_dark[k] != 0;
  epoch.has_glint = table.glint_share[k] > 0.5;
  epoch.method = table.method[k];
  const std::size_t bands = table.bands, parts = curve_.materials.size() * bands;
  for (std::size_t b = 0; b < bands; ++b) {
    const BandResult result = table.at(k, b);
    LightCurveSample &sample = curve_.samples[row * bands + b];
    sample = sample_from(result, colours_[b], epoch.geometry, request_, epoch.is_dark);
    if (!table.band_err.empty())
      sample.band_err = table.band_err[k * bands + b];
    if (!table.indirect.empty() && result.stokes.i > 0)
      sample.indirect = table.indirect[k * bands + b] * (1 / result.stokes.i);
  }
  std::copy_n(table.material_i.begin() + static_cast<std::ptrdiff_t>(k * parts), parts,
              curve_.material_i.begin() + static_cast<std::ptrdiff_t>(row * parts));
}

/// Lights placed rows; false if it was cancelled.
bool RowMaker::light_block(const std::vector<TrackPoint> &points, std::size_t begin,
                           StokesTable &table) {
  std::vector<Pose> poses;
  std::vector<double> angles;
  for (const TrackPoint &point : points) {
    poses.push_back(point.pose);
    angles.insert(angles.end(), point.joint_angles_rad.begin(), point.joint_angles_rad.end());
  }
  const LightTask task{true, true, request_.threads, &cancel_};
  if (!light_.evaluate(poses, angles, table, task))
    return false;
  if (!curve_.second_lights.empty())
    parallel_for(points.size(), request_.threads, [&](std::size_t k) {
      if (!cancel_) // light of the Earth takes its time
        add_second_lights(points[k], begin + k);
    });
  return !cancel_;
}

/// A block that an earlier run of the same job has lit.
bool RowMaker::find(Journal::Block block, std::size_t begin, std::size_t count,
                    StokesTable &table) {
  const auto bytes = blocks_.journal != nullptr ? blocks_.journal->find(block) : std::nullopt;
  return bytes && take_row_bytes(*bytes, begin, count, table, curve_);
}

/// How many rows of a block are complete: none if it was cancelled.
std::size_t RowMaker::fill_block(Journal::Block block, std::size_t begin, std::size_t count,
                                 std::optional<Error> &stopped) {
  std::vector<TrackPoint> points;
  const std::size_t placed = place(begin, count, points, stopped);
  StokesTable table;
  const bool is_found = find(block, begin, placed, table);
  if (cancel_ || (!is_found && !light_block(points, begin, table))) {
    stopped = Error{ErrorCode::Interrupted, "", {}};
    return 0;
  }
  if (!is_found && blocks_.journal != nullptr) {
    blocks_.journal->remark(blocks_.part, device_of(light_, many_directions_));
    blocks_.journal->keep(block, row_bytes(table, begin, placed, curve_));
  }
  parallel_for(placed, request_.threads, [&](std::size_t k) { put(table, k, begin + k); });
  return placed;
}

std::size_t RowMaker::fill(const Progress &progress, std::optional<Error> &stopped) {
  const std::size_t rows = kept_.geometry.size();
  const std::size_t grain = series_block(light_, request_.light);
  for (std::size_t begin = 0; begin < rows; begin += grain) {
    const std::size_t count = std::min(grain, rows - begin);
    std::optional<Error> here; // the selection may have stopped before, at a later row
    const std::size_t done = begin + fill_block({blocks_.part, begin / grain}, begin, count, here);
    if (here) {
      stopped = here;
      if (stopped->code == ErrorCode::Interrupted)
        stopped->message =
            done == 0 ? "stopped before the first row"
                      : fmt::format("stopped by the user after {} of {} epochs", done, rows);
      return done;
    }
    if (progress)
      progress(begin + count, rows);
  }
  return rows;
}

LightCurve empty_curve(const LightCurveRequest &request, const LightModel &light,
                       std::size_t rows) {
  LightCurve curve;
  curve.object = request.object;
  curve.bounces = request.light.bounces;
  curve.method = request.light.method;
  curve.norad_cat_id = request.track.orbit.norad_cat_id();
  curve.bands = light.scene().bands;
  curve.magnitudes = request.magnitudes;
  curve.materials = light.materials();
  curve.epochs.resize(rows);
  curve.samples.resize(rows * curve.bands.size());
  curve.material_i.resize(curve.samples.size() * curve.materials.size());
  if (request.earthshine)
    curve.second_lights.push_back({SecondSource::Earth, {}, {}, {}});
  if (request.has_moonlight)
    curve.second_lights.push_back({SecondSource::Moon, {}, {}, {}});
  for (SecondLight &second : curve.second_lights) {
    second.intensity.resize(curve.samples.size());
    second.half_width.resize(curve.samples.size());
    second.irradiance.resize(curve.samples.size());
  }
  return curve;
}

void truncate(LightCurve &curve, std::size_t rows) {
  const std::size_t samples = rows * curve.bands.size();
  curve.samples.resize(samples);
  curve.material_i.resize(samples * curve.materials.size());
  for (SecondLight &second : curve.second_lights) {
    second.intensity.resize(samples);
    second.half_width.resize(samples);
    second.irradiance.resize(samples);
  }
  curve.epochs.resize(rows);
}

/// Leaves out what was lit only because its block was.
void drop_front(LightCurve &curve, std::size_t rows) {
  rows = std::min(rows, curve.epochs.size());
  const auto drop = [](auto &values, std::size_t count) {
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
  };
  const std::size_t samples = rows * curve.bands.size();
  drop(curve.epochs, rows);
  drop(curve.samples, samples);
  drop(curve.material_i, samples * curve.materials.size());
  for (SecondLight &second : curve.second_lights) {
    drop(second.intensity, samples);
    drop(second.half_width, samples);
    drop(second.irradiance, samples);
  }
}

/// After a stop some passes have fewer rows, or none and are not told of.
void count_rows(LightCurveOutcome &out) {
  for (Pass &pass : out.passes)
    pass.rows = static_cast<std::size_t>(
        std::count_if(out.curve.epochs.begin(), out.curve.epochs.end(),
                      [&](const LightCurveEpoch &e) { return e.pass_id == pass.id; }));
  std::erase_if(out.passes, [](const Pass &pass) { return pass.rows == 0; });
}

} // namespace

Result<void> LightModels::keep_masks() const {
  UMOV_TRY(light->keep_masks());
  return many_directions ? many_directions->keep_masks() : Result<void>();
}

std::string LightModels::device() const { return device_of(*light, many_directions.get()); }

Result<LightModels> make_light_models(const LightCurveRequest &request, const Scene &scene,
                                      const std::atomic<bool> *cancel) {
  LightOptions options = request.light;
  options.threads = request.threads;
  const std::vector<Joint> joints = joints_of(request.track.joints);
  LightModels out;
  UMOV_ASSIGN(light, make_light(scene, joints, options, cancel));
  out.light = std::move(light);
  if (request.earthshine || request.has_moonlight) {
    UMOV_ASSIGN(many, make_light_for_many(scene, joints, options, cancel));
    out.many_directions = std::move(many);
  }
  return out;
}

PassCut cut_passes(const KeptEpochs &all, std::size_t first, std::size_t count,
                   const LightModel &light, const LightCurveRequest &request) {
  std::size_t begin = 0, rows = 0;
  for (std::size_t p = 0; p < first + count; ++p)
    (p < first ? begin : rows) += all.passes[p].rows;
  std::size_t from = begin, behind = begin + rows;
  if (request.light.bounces > 1) { // a block shares its paths: it is lit as a whole
    const std::size_t grain = series_block(light, request.light);
    from = begin / grain * grain;
    behind = std::min(all.geometry.size(), (behind + grain - 1) / grain * grain);
  }
  const auto at = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
  PassCut out{all, begin - from, rows};
  out.kept.geometry.assign(all.geometry.begin() + at(from), all.geometry.begin() + at(behind));
  out.kept.pass.assign(all.pass.begin() + at(from), all.pass.begin() + at(behind));
  return out;
}

Result<KeptEpochs> kept_epochs(const LightCurveRequest &request, const std::atomic<bool> &cancel) {
  if (const ElementSet *set = request.track.orbit.elements())
    UMOV_TRY(request.track.orbit.at(set->epoch)); // elements that cannot even start
  UMOV_ASSIGN(track, Track::make(request.track));
  return keep_epochs(track, request.span, request.only, request.threads, cancel);
}

Result<LightCurveOutcome> compute_cut(const LightCurveRequest &request, PassCut cut,
                                      const LightModel &light, const LightModel *many_directions,
                                      const Progress &progress, const std::atomic<bool> &cancel,
                                      KeptBlocks blocks) {
  UMOV_ASSIGN(colours, photometric_bands(light.scene().bands, request.magnitudes));
  UMOV_ASSIGN(track, Track::make(request.track));
  const KeptEpochs &kept = cut.kept;
  LightCurveOutcome out;
  out.curve = empty_curve(request, light, kept.geometry.size());
  out.passes = kept.passes;
  out.passes_seen = kept.passes_seen;
  out.epochs_in_gaps = kept.epochs_in_gaps;
  out.stopped = kept.stopped;
  RowMaker maker(request, light, many_directions, track, kept, std::move(colours), out.curve,
                 cancel, blocks);
  truncate(out.curve, std::min(maker.fill(progress, out.stopped), cut.before + cut.rows));
  drop_front(out.curve, cut.before);
  count_rows(out);
  if (request.air)
    for (const LightCurveEpoch &epoch : out.curve.epochs)
      for (std::size_t b = 0; b < out.curve.bands.size(); ++b)
        out.curve.transmission.push_back(
            band_transmission(light.scene().grid, b, *request.air, epoch.geometry.altitude));
  return out;
}

Result<LightCurveOutcome> compute_light_curve(const LightCurveRequest &request,
                                              const LightModel &light,
                                              const LightModel *many_directions,
                                              const Progress &progress,
                                              const std::atomic<bool> &cancel, KeptBlocks blocks) {
  UMOV_ASSIGN(kept, kept_epochs(request, cancel));
  const std::size_t rows = kept.geometry.size();
  return compute_cut(request, {std::move(kept), 0, rows}, light, many_directions, progress, cancel,
                     blocks);
}

Result<LightCurveOutcome> compute_light_curve(const LightCurveRequest &request, const Scene &scene,
                                              const Progress &progress,
                                              const std::atomic<bool> &cancel) {
  UMOV_ASSIGN(models, make_light_models(request, scene, &cancel));
  auto out =
      compute_light_curve(request, *models.light, models.many_directions.get(), progress, cancel);
  UMOV_TRY(models.keep_masks());
  return out;
}

} // namespace umov
