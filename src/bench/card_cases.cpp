// Cards beside the processor they stand with: the same engine, lit by one core, by all, and by the
// cards with so many poses at a time.

#include "bench/cases.h"

#include <fmt/format.h>

namespace umov::bench {
namespace {

constexpr MaskQuality without_rays(MaskQuality quality) {
  quality.refine_above = 0;
  return quality;
}

BenchCase box_wing() {
  BenchCase out;
  out.name = "box-wing";
  return out;
}

BenchCase telescope() {
  BenchCase out;
  out.name = "hst";
  out.mesh = "hst";
  return out;
}

/// A million facets, joined into as many classes as their normals need.
BenchCase crumpled_foil() {
  BenchCase out;
  out.name = "crumpled, 1,000,000 triangles";
  out.mesh = "foil";
  out.facets = 1'000'000;
  out.cluster_rad = 0.01;
  out.masks = {60'000, 48, 48, 0};
  return out;
}

} // namespace

std::vector<BenchCase> card_cases(const std::vector<std::string> &meshes,
                                  const std::vector<std::size_t> &batches) {
  std::vector<BenchCase> objects;
  for (const std::string &file : meshes) {
    objects.emplace_back();
    objects.back().name = objects.back().mesh = file;
  }
  if (objects.empty())
    objects = {box_wing(), telescope(), crumpled_foil()};
  std::vector<BenchCase> out;
  for (const BenchCase &object : objects)
    for (const std::size_t bands : {1U, 3U, 16U}) {
      BenchCase one = object;
      one.masks = without_rays(one.masks);
      one.bands = bands;
      one.has_errors = false;
      one.name += fmt::format(", {} band{}", bands, bands == 1 ? "" : "s");
      const auto add = [&](const std::string &by) -> BenchCase & {
        out.push_back(one);
        out.back().name += ", " + by;
        return out.back();
      };
      add("one core").threads = 1;
      add("all cores").threads = 0;
      for (const std::size_t batch : batches) {
        BenchCase &on = add(fmt::format("cards, {} at a time", batch));
        on.threads = 0;
        on.is_on_card = true;
        on.batch = batch;
      }
    }
  return out;
}

} // namespace umov::bench
