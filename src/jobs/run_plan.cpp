#include <umov/jobs/run_plan.h>

#include "jobs/wanted_passes.h"

#include <nlohmann/json.hpp>
#include <umov/core/stop.h>

namespace umov::jobs {
namespace {

using Json = nlohmann::ordered_json;

/// An object, the epochs of it that are lit, and how many of the span are looked at for them.
struct Planned {
  Json object;
  std::size_t searched = 0, lit = 0;
};

Result<Planned> plan_of(const ObjectRun &one, const Monitor &monitor) {
  UMOV_ASSIGN(searched, epoch_count(one.request.span));
  KeptEpochs own;
  if (!one.kept) {
    UMOV_ASSIGN(kept, kept_epochs(one.request, monitor.cancel_flag()));
    own = std::move(kept);
  }
  const KeptEpochs &kept = one.kept ? *one.kept : own;
  const IndexRange wanted = one.passes.value_or(IndexRange{0, kept.passes.size()});
  Planned out{{}, searched, 0};
  Json passes = Json::array();
  for (std::size_t k = wanted.first; k < wanted.end(); ++k) {
    const Pass &pass = kept.passes[k];
    passes.push_back({{"pass_id", pass.id},
                      {"alt_max", pass.culmination_altitude.degrees()},
                      {"epochs", pass.rows}});
    out.lit += pass.rows;
  }
  out.object = {{"name", one.request.object},
                {"norad_cat_id", one.request.track.orbit.norad_cat_id()},
                {"triangles", one.object.scene.mesh.triangles.size()},
                {"epochs", out.lit},
                {"passes", std::move(passes)},
                {"stops", kept.stopped ? Json(kept.stopped->text()) : Json(nullptr)}};
  return out;
}

} // namespace

Result<std::string> run_plan_json(std::vector<ObjectRun> objects, const Scenario &scenario,
                                  const JobOptions &options, const Monitor &monitor) {
  return without_failures([&]() -> Result<std::string> {
    if (!options.part.is_whole())
      UMOV_TRY(take_part(objects, options.part, monitor.cancel_flag()));
    Json bands = Json::array(), list = Json::array();
    for (const Band &band : scenario.bands)
      bands.push_back(band.name);
    std::size_t searched = 0, lit = 0;
    for (const ObjectRun &one : objects) {
      UMOV_ASSIGN(planned, plan_of(one, monitor));
      list.push_back(std::move(planned.object));
      searched += planned.searched;
      lit += planned.lit;
    }
    const Json out{{"scenario", scenario.file},
                   {"folder", scenario.output_dir.string()},
                   {"method", name_of(scenario.light.method)},
                   {"accuracy", scenario.light.accuracy},
                   {"bounces", scenario.light.bounces},
                   {"bands", std::move(bands)},
                   {"objects", std::move(list)},
                   {"cost",
                    {{"epochs_searched", searched},
                     {"epochs_lit", lit},
                     {"rows", lit * scenario.bands.size()}}}};
    return out.dump(2, ' ', false, Json::error_handler_t::replace);
  });
}

} // namespace umov::jobs
