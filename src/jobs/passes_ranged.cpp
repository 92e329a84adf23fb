// A search for passes, object by object.

#include "jobs/job_journal.h"
#include "jobs/pass_searcher.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/jobs/ranged_job.h>

namespace umov::jobs {
namespace {

constexpr const char *order_column = "_order";

/// All that the rows depend on. The files of a scene stand in the locked scenario with their own
/// contents.
Result<std::string> identity_of(const PassesRequest &r, const JobOptions &options,
                                const Monitor &monitor) {
  UMOV_ASSIGN(orbits, read_file(r.orbit));
  std::vector<InputFile> inputs{{r.orbit, sha256_hex(orbits)}};
  const Scenario scene = r.model.scene.value_or(Scenario{});
  for (std::size_t k = 0; r.model.scene && k < scene.objects.size(); ++k) {
    Diagnostics heard_before;
    Scenario timeless = scene;
    timeless.time.reset();
    UMOV_ASSIGN(object,
                load_object(timeless, k, {.allow_old_elements = true, .cancel = monitor.cancel},
                            heard_before));
    inputs.insert(inputs.end(), object.inputs.begin(), object.inputs.end());
  }
  if (!r.model.material.empty() && file_exists(r.model.material)) {
    UMOV_ASSIGN(material, read_file(r.model.material));
    inputs.push_back({r.model.material, sha256_hex(material)});
  }
  return job_text(
      scene, inputs,
      fmt::format("passes of {}; site {} {:.17g} {:.17g} {:.17g}; {} to {}; above "
                  "{:.17g}, dark below {:.17g}, "
                  "shadow {}; {} {} {:.17g} {}; model {} {:.17g} {} {}; scene {}; old {} bad {}",
                  fmt::join(r.norad, ","), r.site.name, r.site.latitude.degrees(),
                  r.site.longitude.degrees(), r.site.altitude_m, to_iso_exact(r.start),
                  to_iso_exact(r.stop), r.altitude_min.degrees(), r.sun_altitude_max.degrees(),
                  static_cast<int>(r.shadow), r.is_visible_only, r.keep_going,
                  r.magnitude_max.value_or(1e9), static_cast<int>(r.order),
                  static_cast<int>(r.model.body), r.model.size_m, r.model.material, r.model.band,
                  r.model.scene.has_value(), options.allow_old_elements,
                  options.allow_bad_checksum));
}

class RangedPasses final : public RangedJob {
public:
  RangedPasses(PassSearcher searcher, std::string identity)
      : searcher_(std::move(searcher)), identity_(std::move(identity)) {}

  [[nodiscard]] std::string unit() const override { return "objects"; }
  [[nodiscard]] std::size_t total() const override { return searcher_.objects(); }
  [[nodiscard]] std::string identity() const override { return identity_; }
  [[nodiscard]] std::vector<std::string> tables() const override { return {"passes"}; }
  [[nodiscard]] std::string order() const override { return order_column; }
  [[nodiscard]] std::string nothing() const override { return no_pass(searcher_.request()); }
  [[nodiscard]] Result<void> keep() override { return searcher_.keep_masks(); }
  Result<void> rows(IndexRange range, RangeSink &sink, const Monitor &monitor,
                    Diagnostics &diagnostics) override {
    const FoundPasses found = searcher_.search(range, monitor, diagnostics);
    if (found.result.stopped)
      return tl::unexpected(*found.result.stopped);
    Table table = passes_table(searcher_.request(), found.result);
    std::vector<double> order;
    for (const ObjectPass &one : found.result.found)
      order.push_back(order_of(searcher_.request(), one));
    table.add(order_column, "", "what rows are put in order by", std::move(order));
    return sink.add(0, std::move(table));
  }

private:
  PassSearcher searcher_;
  std::string identity_;
};

} // namespace

Result<std::unique_ptr<RangedJob>> ranged_passes(const PassesRequest &request,
                                                 const JobOptions &options, const Monitor &monitor,
                                                 Diagnostics &diagnostics) {
  UMOV_ASSIGN(identity, identity_of(request, options, monitor));
  UMOV_ASSIGN(searcher, PassSearcher::make(request, options, diagnostics, monitor.cancel));
  return std::make_unique<RangedPasses>(std::move(searcher), std::move(identity));
}

} // namespace umov::jobs
