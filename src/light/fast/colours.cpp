#include "light/fast/colours.h"

#include <algorithm>
#include <span>

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
                 const std::vector<backend::SlotTerms> &terms, bool is_intensity_only) {
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
    backend::SlotColour<double> &colour = slot.colour;
    colour.bands = static_cast<std::uint32_t>(bands_);
    colour.column = static_cast<std::uint32_t>(slot.column);
    colour.is_intensity_only = is_intensity_only;
    if (light[s]) {
      colour.has_lobe = terms[s].lobe_count > 0;
      slot.lobe = light[s]->lobe;
      colour.product_count = terms[s].product_count;
      colour.diffuse_error = light[s]->diffuse_error;
      for (std::size_t p = 0; p < colour.product_count; ++p)
        for (std::size_t b = 0; b < bands_; ++b) {
          const ProductLight &by = light[s]->products[b][p];
          slot.single_bounce.push_back(by.single_bounce);
          slot.whole.push_back(by.unpolarized + by.single_bounce);
          slot.q.push_back(by.q);
          slot.u.push_back(by.u);
          colour.has_single_bounce = colour.has_single_bounce || by.single_bounce != 0;
          colour.has_emission = colour.has_emission || by.q != 0;
        }
    }
    const bool is_grey =
        std::all_of(slot.lobe.begin(), slot.lobe.end(), [](auto lobe) { return lobe == 0; });
    colour.is_plain =
        is_grey && colour.product_count <= 1 && !colour.has_single_bounce && !colour.has_emission;
    slot.look_at_own();
    slots_.push_back(std::move(slot));
  }
  fresnel_ = FresnelTable(std::move(distinct));
}

bool Colours::has_u() const {
  return std::any_of(slots_.begin(), slots_.end(),
                     [](const Slot &s) { return s.colour.has_emission; });
}

void Colours::Slot::look_at_own() {
  colour.lobe = lobe;
  colour.single_bounce = single_bounce;
  colour.whole = whole;
  colour.q = q;
  colour.u = u;
}

void Colours::prepare(double cos_phase, bool has_plane, PhaseFactors &out) const {
  const std::size_t columns = fresnel_.columns();
  out.a.resize(columns);
  out.b.resize(columns);
  for (auto *room : {&out.ratio, &out.dev_i, &out.dev_q, &out.dev_u})
    room->resize(bands_);
  fresnel_.at(cos_phase, out.a.data(), out.b.data(), out.recent);
  if (!has_plane)
    std::fill(out.b.begin(), out.b.end(), 0);
}

void Colours::add_slot(std::size_t index, const SlotSums &sums, PhaseFactors &at,
                       BandLight &out) const {
  backend::add_slot<double>(slots_[index].colour, sums,
                            {at.a.data(), at.b.data(), at.ratio.data(), at.dev_i.data(),
                             at.dev_q.data(), at.dev_u.data()},
                            out.columns());
}

RoundedColours Colours::rounded() const {
  const auto in_single = [](std::span<const double> from) {
    std::vector<float> out;
    out.reserve(from.size());
    for (const double x : from)
      out.push_back(static_cast<float>(x));
    return out;
  };
  RoundedColours out;
  out.slots.reserve(slots_.size());
  for (const Slot &from : slots_) {
    const backend::SlotColour<double> &c = from.colour;
    out.slots.push_back({from.lobe,
                         in_single(from.single_bounce),
                         in_single(from.whole),
                         in_single(from.q),
                         in_single(from.u),
                         {c.bands,
                          c.column,
                          c.product_count,
                          c.has_lobe,
                          c.has_single_bounce,
                          c.has_emission,
                          c.is_plain,
                          c.is_intensity_only,
                          {},
                          {},
                          {},
                          {},
                          {},
                          static_cast<float>(c.diffuse_error)}});
  }
  const auto table = fresnel_.view();
  out.reflection = in_single(std::span(table.values.data(), table.values.size()));
  out.columns = table.columns;
  out.steps = table.steps;
  return out;
}

} // namespace umov
