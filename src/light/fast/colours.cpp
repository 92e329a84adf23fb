#include "light/fast/colours.h"

#include <algorithm>
#include <cmath>

namespace umov {

void BandLight::reset(std::size_t bands, bool has_u_or_v) {
  if (has_u_or_v || bands != size())
    for (auto *column : {&u, &v, &var_u, &var_v})
      column->assign(bands, 0);
  for (auto *column : {&i, &q, &var_i, &var_q, &bias})
    column->assign(bands, 0);
}

void BandLight::add(const BandLight &other) {
  const auto one = [&](std::vector<double> BandLight::*column) {
    for (std::size_t b = 0; b < size(); ++b)
      (this->*column)[b] += (other.*column)[b];
  };
  for (auto column : {&BandLight::i, &BandLight::q, &BandLight::u, &BandLight::v, &BandLight::var_i,
                      &BandLight::var_q, &BandLight::var_u, &BandLight::var_v, &BandLight::bias})
    one(column);
}

void BandLight::add_scaled(const BandLight &other, double scale) {
  const auto one = [&](std::vector<double> BandLight::*column, double by) {
    for (std::size_t b = 0; b < size(); ++b)
      (this->*column)[b] += (other.*column)[b] * by;
  };
  for (auto column : {&BandLight::i, &BandLight::q, &BandLight::u, &BandLight::v, &BandLight::bias})
    one(column, scale);
  for (auto column : {&BandLight::var_i, &BandLight::var_q, &BandLight::var_u, &BandLight::var_v})
    one(column, scale * scale);
}

Colours::Colours(std::vector<const Surface *> surfaces,
                 std::vector<std::optional<SurfaceLight>> light,
                 const std::vector<backend::SlotTerms> &terms, bool is_intensity_only)
    : is_intensity_only_(is_intensity_only) {
  std::vector<const Surface *> distinct; // equal ones share their columns
  bands_ = surfaces.empty() ? 0 : surfaces.front()->band_count();
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    Slot slot;
    slot.surface = surfaces[s];
    const auto same = std::find_if(distinct.begin(), distinct.end(), [&](const Surface *other) {
      return other->is_same(*surfaces[s]);
    });
    slot.column = static_cast<std::size_t>(same - distinct.begin()) * bands_;
    if (same == distinct.end())
      distinct.push_back(surfaces[s]);
    if (light[s]) {
      slot.has_lobe = terms[s].lobe_count > 0;
      slot.lobe = light[s]->lobe;
      slot.product_count = terms[s].product_count;
      slot.diffuse_error = light[s]->diffuse_error;
      for (std::size_t p = 0; p < slot.product_count; ++p)
        for (std::size_t b = 0; b < bands_; ++b) {
          const ProductLight &by = light[s]->products[b][p];
          slot.single_bounce.push_back(by.single_bounce);
          slot.whole.push_back(by.unpolarized + by.single_bounce);
          slot.q.push_back(by.q);
          slot.u.push_back(by.u);
          slot.has_single_bounce = slot.has_single_bounce || by.single_bounce != 0;
          slot.has_emission = slot.has_emission || by.q != 0;
        }
    }
    const bool is_grey =
        std::all_of(slot.lobe.begin(), slot.lobe.end(), [](auto lobe) { return lobe == 0; });
    slot.is_plain =
        is_grey && slot.product_count <= 1 && !slot.has_single_bounce && !slot.has_emission;
    slots_.push_back(std::move(slot));
  }
  fresnel_ = FresnelTable(std::move(distinct));
}

bool Colours::has_u() const {
  return std::any_of(slots_.begin(), slots_.end(), [](const Slot &s) { return s.has_emission; });
}

void Colours::prepare(double cos_phase, bool has_plane, PhaseFactors &out) const {
  const std::size_t columns = fresnel_.columns();
  out.a.resize(columns);
  out.b.resize(columns);
  for (auto *room : {&out.ratio, &out.dev_i, &out.dev_q, &out.dev_u})
    room->resize(bands_);
  fresnel_.at(cos_phase, out.a.data(), out.b.data());
  if (!has_plane)
    std::fill(out.b.begin(), out.b.end(), 0);
}

/// The common case in one loop: one lobe for all bands and at most one product.
void Colours::add_plain(const Slot &slot, const SlotSums &sums, const double *__restrict a,
                        const double *__restrict b, BandLight &out) const {
  const double s = slot.has_lobe ? sums.specular[0] : 0,
               d = slot.has_lobe ? sums.specular_deviation[0] : 0,
               e = slot.has_lobe ? sums.specular_bias[0] : 0;
  const double *__restrict whole = slot.product_count > 0 ? slot.whole.data() : a;
  const double s_p = slot.product_count > 0 ? sums.product[0] : 0,
               d_p = slot.product_count > 0 ? sums.product_deviation[0] : 0;
  const double e_p = slot.diffuse_error;
  double *__restrict i = out.i.data(), *__restrict q = out.q.data(),
                     *__restrict var_i = out.var_i.data(), *__restrict var_q = out.var_q.data(),
                     *__restrict bias = out.bias.data();
  for (std::size_t k = 0; k < bands_; ++k) {
    const double diffuse = whole[k] * s_p;
    i[k] += a[k] * s + diffuse;
    bias[k] += a[k] * e + e_p * diffuse;
  }
  for (std::size_t k = 0; !is_intensity_only_ && k < bands_; ++k)
    q[k] += b[k] * s;
  if (!sums.varies)
    return;
  for (std::size_t k = 0; k < bands_; ++k) {
    const double dev_i = a[k] * d + std::abs(whole[k]) * d_p;
    var_i[k] += dev_i * dev_i;
  }
  for (std::size_t k = 0; !is_intensity_only_ && k < bands_; ++k)
    var_q[k] += (b[k] * d) * (b[k] * d);
}

/// Deviations of a slot are added before they are squared: its lobes and products share facets.
void Colours::add_variances(const Slot &slot, const SlotSums &sums, PhaseFactors &at,
                            BandLight &out) const {
  const std::size_t n = bands_;
  const double *a = at.a.data() + slot.column, *b = at.b.data() + slot.column,
               *ratio = at.ratio.data();
  double *__restrict dev_i = at.dev_i.data(), *__restrict dev_q = at.dev_q.data(),
                     *__restrict dev_u = at.dev_u.data();
  for (std::size_t k = 0; k < n; ++k) {
    const double d = slot.has_lobe ? sums.specular_deviation[slot.lobe[k]] : 0;
    dev_i[k] = a[k] * d;
    dev_q[k] = std::abs(b[k]) * d;
    dev_u[k] = 0;
  }
  for (std::size_t p = 0; p < slot.product_count; ++p) {
    const double d = sums.product_deviation[p];
    const double *whole = slot.whole.data() + p * n, *bounced = slot.single_bounce.data() + p * n;
    for (std::size_t k = 0; k < n; ++k)
      dev_i[k] += std::abs(whole[k]) * d;
    for (std::size_t k = 0; slot.has_single_bounce && k < n; ++k)
      dev_q[k] += std::abs(ratio[k] * bounced[k]) * d;
    for (std::size_t k = 0; slot.has_emission && k < n; ++k) {
      dev_q[k] += std::abs(slot.q[p * n + k]) * d;
      dev_u[k] += std::abs(slot.u[p * n + k]) * d;
    }
  }
  for (std::size_t k = 0; k < n; ++k)
    out.var_i[k] += dev_i[k] * dev_i[k];
  for (std::size_t k = 0; !is_intensity_only_ && k < n; ++k)
    out.var_q[k] += dev_q[k] * dev_q[k];
  for (std::size_t k = 0; !is_intensity_only_ && slot.has_emission && k < n; ++k)
    out.var_u[k] += dev_u[k] * dev_u[k];
}

void Colours::add_slot(std::size_t index, const SlotSums &sums, PhaseFactors &at,
                       BandLight &out) const {
  const Slot &slot = slots_[index];
  const std::size_t n = bands_;
  const double *__restrict a = at.a.data() + slot.column, *__restrict b = at.b.data() + slot.column;
  if (slot.is_plain)
    return add_plain(slot, sums, a, b, out);
  double *__restrict i = out.i.data(), *__restrict q = out.q.data(),
                     *__restrict bias = out.bias.data();
  double *__restrict ratio = at.ratio.data();
  const bool has_q = !is_intensity_only_;
  for (std::size_t k = 0; slot.has_single_bounce && k < n; ++k)
    ratio[k] = a[k] > 0 ? b[k] / a[k] : 0;
  for (std::size_t k = 0; slot.has_lobe && k < n; ++k) {
    const std::uint32_t lobe = slot.lobe[k];
    i[k] += a[k] * sums.specular[lobe];
    bias[k] += a[k] * sums.specular_bias[lobe];
    q[k] += has_q ? b[k] * sums.specular[lobe] : 0;
  }
  for (std::size_t p = 0; p < slot.product_count; ++p) {
    const double s = sums.product[p], e = slot.diffuse_error;
    const double *__restrict whole = slot.whole.data() + p * n;
    for (std::size_t k = 0; k < n; ++k) {
      i[k] += whole[k] * s;
      bias[k] += e * (whole[k] * s);
    }
    const double *__restrict bounced = slot.single_bounce.data() + p * n;
    for (std::size_t k = 0; has_q && slot.has_single_bounce && k < n; ++k)
      q[k] += ratio[k] * bounced[k] * s;
    for (std::size_t k = 0; has_q && slot.has_emission && k < n; ++k) {
      q[k] += slot.q[p * n + k] * s;
      out.u[k] += slot.u[p * n + k] * s;
    }
  }
  if (sums.varies)
    add_variances(slot, sums, at, out);
}

} // namespace umov
