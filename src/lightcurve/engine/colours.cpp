#include "lightcurve/engine/colours.h"

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
      slot.is_grey = std::all_of(slot.lobe.begin(), slot.lobe.end(), [](auto l) { return l == 0; });
      slot.product_count = terms[s].product_count;
      slot.diffuse_error = light[s]->diffuse_error;
      for (std::size_t p = 0; p < slot.product_count; ++p)
        for (std::size_t b = 0; b < bands_; ++b) {
          const ProductLight &by = light[s]->products[b][p];
          slot.unpolarized.push_back(by.unpolarized);
          slot.single_bounce.push_back(by.single_bounce);
          slot.whole.push_back(by.unpolarized + by.single_bounce);
          slot.has_single_bounce = slot.has_single_bounce || by.single_bounce != 0;
        }
    }
    slot.is_plain = slot.is_grey && slot.product_count <= 1 && !slot.has_single_bounce;
    slots_.push_back(std::move(slot));
  }
  fresnel_ = FresnelTable(std::move(distinct));
}

void Colours::prepare(double cos_phase, bool has_plane, PhaseFactors &out) const {
  const std::size_t columns = fresnel_.columns();
  out.a.resize(columns);
  out.b.resize(columns);
  out.ratio.assign(columns, 0);
  for (auto *room : {&out.i, &out.q, &out.dev_i, &out.dev_q, &out.bias})
    room->resize(bands_);
  fresnel_.at(cos_phase, out.a.data(), out.b.data());
  if (!has_plane)
    std::fill(out.b.begin(), out.b.end(), 0);
  for (std::size_t c = 0; c < columns; ++c)
    out.ratio[c] = out.a[c] > 0 ? out.b[c] / out.a[c] : 0;
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
    const double diffuse = whole[k] * s_p, dev_i = a[k] * d + std::abs(whole[k]) * d_p;
    i[k] += a[k] * s + diffuse;
    var_i[k] += dev_i * dev_i;
    bias[k] += a[k] * e + e_p * diffuse;
  }
  for (std::size_t k = 0; !is_intensity_only_ && k < bands_; ++k) {
    q[k] += b[k] * s;
    var_q[k] += (b[k] * d) * (b[k] * d);
  }
}

void Colours::add_slot(std::size_t index, const SlotSums &sums, PhaseFactors &at,
                       BandLight &out) const {
  const Slot &slot = slots_[index];
  const std::size_t n = bands_;
  const double *__restrict a = at.a.data() + slot.column, *__restrict b = at.b.data() + slot.column,
                           *__restrict ratio = at.ratio.data() + slot.column;
  if (slot.is_plain)
    return add_plain(slot, sums, a, b, out);
  double *__restrict i = at.i.data(), *__restrict q = at.q.data(),
                     *__restrict dev_i = at.dev_i.data(), *__restrict dev_q = at.dev_q.data(),
                     *__restrict bias = at.bias.data();
  const bool has_q = !is_intensity_only_;
  if (!slot.has_lobe) {
    for (auto *column : {i, q, dev_i, dev_q, bias})
      std::fill_n(column, n, 0.0);
  } else if (slot.is_grey) {
    const double s = sums.specular[0], d = sums.specular_deviation[0], e = sums.specular_bias[0];
    for (std::size_t k = 0; k < n; ++k) {
      i[k] = a[k] * s;
      dev_i[k] = a[k] * d;
      bias[k] = a[k] * e;
    }
    for (std::size_t k = 0; has_q && k < n; ++k) {
      q[k] = b[k] * s;
      dev_q[k] = std::abs(b[k]) * d;
    }
  } else {
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint32_t lobe = slot.lobe[k];
      i[k] = a[k] * sums.specular[lobe];
      q[k] = b[k] * sums.specular[lobe];
      dev_i[k] = a[k] * sums.specular_deviation[lobe];
      dev_q[k] = std::abs(b[k]) * sums.specular_deviation[lobe];
      bias[k] = a[k] * sums.specular_bias[lobe];
    }
  }
  for (std::size_t p = 0; p < slot.product_count; ++p) {
    const double s = sums.product[p], d = sums.product_deviation[p], e = slot.diffuse_error;
    const double *__restrict whole = slot.whole.data() + p * n;
    for (std::size_t k = 0; k < n; ++k) {
      const double value = whole[k] * s;
      i[k] += value;
      bias[k] += e * value;
      dev_i[k] += std::abs(whole[k]) * d;
    }
    const double *__restrict bounced = slot.single_bounce.data() + p * n;
    for (std::size_t k = 0; has_q && slot.has_single_bounce && k < n; ++k) {
      q[k] += ratio[k] * bounced[k] * s;
      dev_q[k] += std::abs(ratio[k] * bounced[k]) * d;
    }
  }
  double *__restrict to_i = out.i.data(), *__restrict to_q = out.q.data(),
                     *__restrict var_i = out.var_i.data(), *__restrict var_q = out.var_q.data(),
                     *__restrict to_bias = out.bias.data();
  for (std::size_t k = 0; k < n; ++k) {
    to_i[k] += i[k];
    var_i[k] += dev_i[k] * dev_i[k];
    to_bias[k] += bias[k];
  }
  for (std::size_t k = 0; has_q && k < n; ++k) {
    to_q[k] += q[k];
    var_q[k] += dev_q[k] * dev_q[k];
  }
}

} // namespace umov
