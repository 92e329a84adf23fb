#include "light/fast/abundance_state.h"
#include "light/fast/state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <umov/core/parallel.h>

namespace umov {

void begin_abundances(const CompiledScene &scene, const Mesh &mesh, std::span<const Pose> poses,
                      AbundanceTable &out) {
  out.columns.clear();
  for (std::size_t s = 0; s < scene.slots.size(); ++s) {
    const backend::SlotTerms &terms = scene.data.slots[s];
    AbundanceColumn column;
    for (const std::uint32_t slot : scene.slots[s])
      column.sides.push_back({mesh.groups[group_of_slot(slot)], slot % 2 != 0});
    for (std::size_t l = 0; l < terms.lobe_count; ++l) {
      column.shape = scene.data.lobes[terms.lobe_first + l].shape;
      out.columns.push_back(column);
    }
    column.kind = AbundanceColumn::Kind::Diffuse;
    column.shape = 0;
    out.columns.insert(out.columns.end(), terms.product_count, column);
  }
  const std::size_t cells = poses.size() * out.columns.size();
  out.sum.assign(cells, 0);
  out.half_width.assign(cells, 0);
  out.bias.assign(cells, 0);
  out.is_dark.assign(poses.size(), 1);
  out.cos_phase.clear();
  out.has_plane.clear();
  for (const Pose &pose : poses) {
    out.cos_phase.push_back(cos_phase(pose));
    out.has_plane.push_back(has_scattering_plane(pose) ? 1 : 0);
  }
}

namespace {

/// `lobe` and `product` give a sum, its standard deviation and its bias by number.
template <class Lobe, class Product>
void put_terms(const CompiledScene &scene, std::size_t row, AbundanceTable &out, const Lobe &lobe,
               const Product &product) {
  std::size_t k = row * out.columns.size();
  const auto put = [&](const std::array<double, 3> &term) {
    out.sum[k] = term[0] * scene.area_m2;
    out.half_width[k] = normal_95 * term[1] * scene.area_m2;
    out.bias[k] = term[2] * scene.area_m2;
    ++k;
  };
  for (const backend::SlotTerms &terms : scene.data.slots) {
    for (std::size_t l = terms.lobe_first; l < terms.lobe_first + terms.lobe_count; ++l)
      put(lobe(l));
    for (std::size_t p = terms.product_first; p < terms.product_first + terms.product_count; ++p)
      put(product(p));
  }
}

} // namespace

void put_abundances(const CompiledScene &scene, const backend::PoseSums &sums, std::size_t row,
                    AbundanceTable &out) {
  using Term = std::array<double, 3>;
  put_terms(
      scene, row, out,
      [&](std::size_t l) {
        return Term{sums.specular[l], std::sqrt(sums.specular_variance[l]), sums.specular_bias[l]};
      },
      [&](std::size_t p) {
        return Term{sums.product[p], std::sqrt(sums.product_variance[p]), 0};
      });
}

void put_abundances(const CompiledScene &scene, const backend::Weighed<const float> &sums,
                    std::size_t row, AbundanceTable &out) {
  using Term = std::array<double, 3>;
  put_terms(
      scene, row, out,
      [&](std::size_t l) {
        return Term{sums.specular[l], sums.specular_deviation[l], sums.specular_bias[l]};
      },
      [&](std::size_t p) {
        return Term{sums.product[p], sums.product_deviation[p], 0};
      });
}

struct MaterialTables::State {
  Scene scene; ///< the colours point into its surfaces
  Colours colours;
  std::vector<backend::SlotTerms> slots;
  double diffuse_error = 0;
};

Result<MaterialTables> make_material_tables(const Scene &materials, const CompiledScene &sums,
                                            const Mesh &mesh, bool is_intensity_only) {
  if (materials.mesh.groups != mesh.groups)
    return fail(ErrorCode::BadInput, "these materials are for a mesh with other groups than the "
                                     "one that the sums are of");
  auto state = std::make_shared<MaterialTables::State>();
  state->scene = materials;
  UMOV_ASSIGN(colours, colours_of(state->scene, sums, is_intensity_only, state->diffuse_error));
  state->colours = std::move(colours);
  state->slots = sums.data.slots;
  return MaterialTables(std::move(state));
}

std::size_t MaterialTables::band_count() const { return state_->colours.band_count(); }
double MaterialTables::diffuse_error() const { return state_->diffuse_error; }

void MaterialTables::apply(const AbundanceTable &from, StokesTable &out, unsigned threads,
                           const std::atomic<bool> *cancel) const {
  const State &s = *state_;
  out.resize(from.poses(), band_count());
  const std::size_t columns = from.columns.size();
  constexpr std::size_t poses_per_task = 1024;
  parallel_for(
      (from.poses() + poses_per_task - 1) / poses_per_task, threads, [&](std::size_t task) {
        PhaseFactors factors;
        BandLight light;
        std::vector<double> deviation(columns);
        const std::size_t end = std::min(from.poses(), (task + 1) * poses_per_task);
        for (std::size_t row = task * poses_per_task; row < end && !is_stopped(cancel); ++row) {
          if (from.is_dark[row] != 0) {
            put_darkness(row, out);
            continue;
          }
          const double *sum = from.sum.data() + row * columns;
          const double *bias = from.bias.data() + row * columns;
          for (std::size_t k = 0; k < columns; ++k)
            deviation[k] = from.half_width[row * columns + k] / normal_95;
          s.colours.prepare(from.cos_phase[row], from.has_plane[row] != 0, factors);
          light.reset(band_count(), s.colours.has_u());
          std::size_t k = 0;
          for (std::size_t slot = 0; slot < s.slots.size(); ++slot) {
            const std::size_t p = k + s.slots[slot].lobe_count;
            s.colours.add_slot(
                slot, {sum + k, deviation.data() + k, bias + k, sum + p, deviation.data() + p},
                factors, light);
            k = p + s.slots[slot].product_count;
          }
          put_light(light, 1, from.has_plane[row] != 0, s.colours.has_u(), row, out);
        }
      });
}

} // namespace umov
