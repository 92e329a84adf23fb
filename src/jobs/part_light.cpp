#include "jobs/part_light.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/parallel.h>
#include <umov/core/quantity.h>

namespace umov::jobs {
namespace {

/// The material with all slopes multiplied; as it is where its distribution has no such number.
Material with_slopes(Material material, double factor) {
  for (auto &[name, value] : material.distribution.parameters)
    if (name == "alpha")
      value *= factor;
    else if (name == "m" || name == "nu" || name == "nv") // slopes go with its root
      value /= factor * factor;
  return material;
}

/// The scene in which no two groups share a material.
Result<Scene> apart_by_group(const Scene &scene) {
  return with_materials(scene, [](Material material, const std::string &group) {
    material.name += " of " + group;
    return material;
  });
}

const Material &material_of(const Scene &scene, const AbundanceColumn &column) {
  const AbundanceColumn::Side &side = column.sides.front();
  const auto at = static_cast<std::size_t>(std::ranges::find(scene.mesh.groups, side.group) -
                                           scene.mesh.groups.begin());
  return (side.is_back_surface ? scene.back : scene.front)[at].material();
}

} // namespace

std::unique_ptr<LightByPart> LightByPart::make(const LightModel &elder,
                                               const MaterialErrors &errors,
                                               const JobOptions &options,
                                               const std::atomic<bool> *cancel) {
  if (!errors.is_any() || !elder.joints().empty())
    return nullptr;
  std::unique_ptr<LightByPart> out(new LightByPart);
  auto scene = errors.is_by_group ? apart_by_group(elder.scene()) : elder.scene();
  if (!scene)
    return nullptr;
  out->scenes_.push_back(std::move(*scene));
  for (const double sign : {-1.0, 1.0}) {
    if (!(errors.slope > 0))
      break;
    auto other =
        with_materials(out->scenes_.front(), [&](const Material &material, const std::string &) {
          return with_slopes(material, std::exp(sign * errors.slope));
        });
    if (!other)
      return nullptr;
    out->scenes_.push_back(std::move(*other));
  }
  SumsOptions how;
  how.hypotheses.assign(out->scenes_.begin() + 1, out->scenes_.end());
  how.mask_cache = options.mask_cache;
  how.threads = options.threads;
  how.device = options.device;
  // Of dim light less need be known, and poses of a search lie far apart.
  how.accuracy_floor = default_accuracy_floor(LightMethod::Auto);
  how.is_for_many_poses = true;
  for (auto *one : {&out->sums_, &out->quick_}) {
    auto sums = make_sums(out->scenes_.front(), how, cancel);
    if (!sums)
      return nullptr;
    *one = std::move(*sums);
    (*one)->take_masks_of(elder);
    how.accuracy = 0.02; // masks of the same kind, and no rays
  }
  for (const Scene &scene : out->scenes_) {
    auto tables = out->sums_->tables_for(scene);
    if (!tables)
      return nullptr;
    out->tables_.push_back(std::move(*tables));
  }
  AbundanceTable first;
  const Pose any[] = {{{0, 0, 1}, {1, 0, 0}, 0}};
  if (!out->sums_->evaluate(any, first, 1, cancel) || !out->name_parts(first, errors))
    return nullptr;
  return out;
}

bool LightByPart::name_parts(const AbundanceTable &sums, const MaterialErrors &errors) {
  std::map<std::string, std::pair<Columns, Columns>> found; // by material: its lobe, and the rest
  const Scene &scene = scenes_.front();
  for (std::size_t k = 0; k < sums.columns.size(); ++k) {
    auto &[lobe, rest] = found[material_of(scene, sums.columns[k]).name];
    (sums.columns[k].kind == AbundanceColumn::Kind::Specular ? lobe : rest).push_back(k);
  }
  const auto add = [&](const std::string &name, Columns columns, PartKind kind) {
    kind.name = name;
    if (columns.empty() || (kind.unknowns() == 0 && !(kind.tilt_sd_rad > 0)))
      return;
    kinds_.push_back(std::move(kind));
    columns_.push_back(std::move(columns));
    blocks_ += kinds_.back().blocks();
  };
  const double tilt = errors.tilt_deg * pi / 180;
  const PartKind of_lobe{"", errors.reflectance, errors.slope, tilt};
  // What a surface scatters is turned with its lobe.
  const auto beside = [&](const Columns &lobe, double sd) {
    return PartKind{"", sd, 0, tilt, !lobe.empty()};
  };
  for (const auto *side : {&scene.front, &scene.back})
    for (const Surface &surface : *side)
      if (const auto one = found.extract(surface.material().name); !one.empty()) {
        const bool has_body = surface.material().body.has_value();
        add("lobe of " + one.key(), one.mapped().first, of_lobe);
        add((has_body ? "body of " : "haze of ") + one.key(), one.mapped().second,
            beside(one.mapped().first, has_body ? errors.reflectance : errors.haze));
      }
  return !kinds_.empty();
}

std::shared_ptr<const LightByPart::Colours>
LightByPart::colours_at(double cos_phase, bool has_plane, const AbundanceTable &like) const {
  // The same for all whose cosine is the same to its ninth digit, whoever asks first.
  constexpr double digits = 1e9;
  const auto key = std::pair(std::llround(cos_phase * digits), has_plane);
  const std::scoped_lock hold(lock_);
  auto &kept = colours_[key];
  if (kept)
    return kept;
  const std::size_t columns = like.columns.size();
  AbundanceTable units;
  units.columns = like.columns;
  units.sum.assign(columns * columns, 0);
  for (std::size_t k = 0; k < columns; ++k)
    units.sum[k * columns + k] = 1;
  units.half_width.assign(columns * columns, 0);
  units.bias.assign(columns * columns, 0);
  units.cos_phase.assign(columns, static_cast<double>(key.first) / digits);
  units.has_plane.assign(columns, has_plane ? 1 : 0);
  units.is_dark.assign(columns, 0);
  const Scene &scene = scenes_.front();
  Colours out;
  StokesTable nodes;
  for (const MaterialTables &tables : tables_) {
    tables.apply(units, nodes, 1);
    for (std::size_t k = 0; k < columns; ++k)
      for (const auto &terms : scene.grid.terms()) { // wavelengths become bands
        double light[3]{};
        for (const BandTerm &term : terms) {
          const std::size_t from = k * nodes.bands + term.node;
          light[0] += term.weight * nodes.i[from];
          light[1] += term.weight * nodes.q[from];
          light[2] += term.weight * nodes.u[from];
        }
        out.insert(out.end(), std::begin(light), std::end(light));
      }
  }
  return kept = std::make_shared<const Colours>(std::move(out));
}

void LightByPart::keep_masks() const {
  quick_->keep_masks();
  sums_->keep_masks();
}

bool LightByPart::evaluate(std::span<const Pose> poses, StokesTable &out, unsigned threads,
                           bool is_quick, const std::atomic<bool> *cancel) const {
  AbundanceTable sums;
  if (!(is_quick ? quick_ : sums_)->evaluate(poses, sums, threads, cancel))
    return false;
  out.resize(poses.size(), blocks_ * scenes_.front().bands.size());
  std::vector<std::shared_ptr<const Colours>> colours;
  colours.reserve(poses.size());
  for (std::size_t row = 0; row < poses.size(); ++row)
    colours.push_back(colours_at(sums.cos_phase[row], sums.has_plane[row] != 0, sums));
  constexpr std::size_t chunk = 256;
  parallel_for((poses.size() + chunk - 1) / chunk, threads, [&](std::size_t c) {
    for (std::size_t row = c * chunk; row < std::min(poses.size(), (c + 1) * chunk); ++row)
      put(sums, row, *colours[row], out);
  });
  if (is_quick)
    out.i_err.clear();
  return true;
}

/// All blocks of one pose.
void LightByPart::put(const AbundanceTable &sums, std::size_t row, const Colours &colours,
                      StokesTable &out) const {
  const std::size_t columns = sums.columns.size(), bands = scenes_.front().bands.size();
  const auto at = [&](std::size_t block, std::size_t band) {
    return row * out.bands + block * bands + band;
  };
  const auto first = static_cast<std::ptrdiff_t>(row * out.bands);
  for (auto *column : {&out.i, &out.q, &out.u, &out.i_err})
    std::fill_n(column->begin() + first, out.bands, 0.0);
  out.is_dark[row] = sums.is_dark[row];
  if (sums.is_dark[row] != 0)
    return;
  const auto add = [&](std::size_t level, std::size_t k, std::size_t block) {
    const double sum = sums.sum[row * columns + k];
    for (std::size_t b = 0; b < bands; ++b) {
      const double *const light = &colours[((level * columns + k) * bands + b) * 3];
      out.i[at(block, b)] += sum * light[0];
      out.q[at(block, b)] += sum * light[1];
      out.u[at(block, b)] += sum * light[2];
    }
  };
  for (std::size_t k = 0; k < columns; ++k) {
    add(0, k, 0);
    for (std::size_t b = 0; b < bands; ++b) // what each sum may be off by adds up at worst
      out.i_err[at(0, b)] += colours[(k * bands + b) * 3] * sums.half_width[row * columns + k];
  }
  std::size_t block = 1;
  for (std::size_t p = 0; p < kinds_.size(); ++p)
    for (std::size_t level = 0; level < kinds_[p].blocks(); ++level, ++block)
      for (const std::size_t k : columns_[p])
        add(level, k, block);
}

} // namespace umov::jobs
