#include <umov/jobs/pose_light.h>

#include "jobs/part_angles.h"
#include "jobs/temperatures.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <umov/light/blocks.h>

namespace umov::jobs {
namespace {

using Source = SignatureRequest::Source;

/// Stokes vector of the source per unit irradiance.
Result<Stokes<ScatteringPlane>> source_of(const SignatureRequest &request) {
  const Stokes<ScatteringPlane> &s = request.state;
  const double polarized = std::sqrt(s.q * s.q + s.u * s.u + s.v * s.v);
  if (request.source != Source::Laser && polarized > 0)
    return fail(ErrorCode::Usage, "--state goes with --source laser");
  if (!(s.i > 0) || !(polarized <= s.i * (1 + 1e-12)))
    return fail(ErrorCode::Usage,
                fmt::format("--state {} {} {} {}: I > 0 and sqrt(Q2 + U2 + V2) <= I were expected",
                            s.i, s.q, s.u, s.v));
  return Stokes<ScatteringPlane>{1, s.q / s.i, s.u / s.i, s.v / s.i}; // 1 / i may be infinite
}

/// What the options say against each other.
Result<void> check_request(const Scenario &scenario, const SignatureRequest &request) {
  if (scenario.objects.size() > 1)
    return fail(ErrorCode::BadInput,
                fmt::format("holds {} objects; a signature is of one. Keep one [[object]].",
                            scenario.objects.size()),
                {scenario.file});
  const bool has_masks = request.method == LightMethod::Masks || !request.mask_file.empty();
  if (request.source != Source::Sun && has_masks)
    return fail(ErrorCode::Usage, "masks are for sunlight; a laser takes rays, own heat paths");
  if (request.source != Source::Sun && has_curve(scenario.bands))
    return fail(ErrorCode::BadInput,
                fmt::format("band \"{}\" is a mean over sunlight; {} takes wavelengths, such as "
                            "bands.set = \"nm:550\"",
                            std::find_if(scenario.bands.begin(), scenario.bands.end(),
                                         [](const Band &band) { return band.curve; })
                                ->name,
                            request.source == Source::Laser ? "a laser" : "own heat"),
                {scenario.file});
  if ((request.source == Source::Thermal) != !request.temperatures.empty())
    return fail(ErrorCode::Usage, "--source thermal and --temperature go together");
  const LightMethod method = request.method.value_or(scenario.light.method);
  if (!request.mask_file.empty() && method == LightMethod::Rays)
    return fail(ErrorCode::Usage, "--masks goes with --visibility masks or auto");
  return {};
}

Result<std::unique_ptr<LightModel>> light_of(const Scene &scene, const std::vector<Joint> &joints,
                                             const SignatureRequest &request,
                                             const LightOptions &options,
                                             const std::atomic<bool> *cancel) {
  if (request.source != Source::Thermal)
    return make_light(scene, joints, options, cancel);
  if (options.device.choice == DeviceChoice::Cuda)
    return fail(ErrorCode::Usage, "own heat is lit by the processor: take --device cpu");
  UMOV_ASSIGN(kelvin, temperatures_of(request.temperatures, scene.mesh));
  return make_thermal_light(scene, joints, kelvin, options, cancel);
}

/// What the request says goes over what the scenario says.
LightOptions light_asked_for(const Scenario &scenario, const SignatureRequest &request,
                             const Stokes<ScatteringPlane> &source, const JobOptions &options) {
  LightOptions out = light_options(scenario, options);
  out.method = request.method.value_or(out.method);
  if (request.accuracy)
    out.accuracy = *request.accuracy;
  else if (request.source == Source::Sun && !scenario.places.contains("render.accuracy"))
    out = for_many_poses(out);
  out.between = request.between.value_or(out.between);
  out.seed = request.seed.value_or(scenario.seed);
  out.source = source;
  out.mask_file = request.mask_file;
  out.has_half_widths = request.has_half_widths;
  out.is_for_search = request.is_for_search;
  return out;
}

} // namespace

struct PoseLight::State {
  LightOptions options;
  std::vector<InputFile> inputs;
  double sun_radius_rad = 0;
  std::optional<PartAngles> parts;
  std::unique_ptr<LightModel> model;
};

PoseLight::PoseLight(std::unique_ptr<State> state) : state_(std::move(state)) {}
PoseLight::PoseLight(PoseLight &&) noexcept = default;
PoseLight &PoseLight::operator=(PoseLight &&) noexcept = default;
PoseLight::~PoseLight() = default;

Result<void> PoseLight::check(const Scenario &scenario, const SignatureRequest &request) {
  UMOV_TRY(source_of(request));
  return check_request(scenario, request);
}

Result<PoseLight> PoseLight::make(const Scenario &scenario, const SignatureRequest &request,
                                  const JobOptions &options, Diagnostics &diagnostics,
                                  const std::atomic<bool> *cancel, std::size_t poses_in_all) {
  UMOV_ASSIGN(source, source_of(request));
  UMOV_TRY(check_request(scenario, request));
  const bool is_sun = request.source == Source::Sun;
  UMOV_ASSIGN(object, load_object(scenario, 0,
                                  {.allow_old_elements = true,
                                   .source_is_sun = is_sun,
                                   .turns_in_time = false,
                                   .cancel = cancel},
                                  diagnostics));
  LightOptions light = light_asked_for(scenario, request, source, options);
  light.poses_in_all = poses_in_all;
  return of(object.scene, std::move(object.inputs), scenario, request, std::move(light),
            diagnostics, cancel);
}

Result<PoseLight> PoseLight::again(const PoseLight &read, const Scenario &scenario,
                                   const SignatureRequest &request, const JobOptions &options,
                                   const std::atomic<bool> *cancel) {
  UMOV_ASSIGN(source, source_of(request));
  UMOV_TRY(check_request(scenario, request));
  Diagnostics twice; // what there is to be told was told when it was read
  return of(read.model().scene(), read.inputs(), scenario, request,
            light_asked_for(scenario, request, source, options), twice, cancel);
}

Result<PoseLight> PoseLight::of(const Scene &scene, std::vector<InputFile> inputs,
                                const Scenario &scenario, const SignatureRequest &request,
                                LightOptions light, Diagnostics &diagnostics,
                                const std::atomic<bool> *cancel) {
  const bool is_sun = request.source == Source::Sun;
  auto state = std::make_unique<State>();
  state->options = std::move(light);
  state->inputs = std::move(inputs);
  state->sun_radius_rad = is_sun && scenario.has_solar_disk ? sun_radius_at_1au_rad : 0;
  state->parts.emplace(scenario.objects.front().parts, is_sun, scenario.file, diagnostics);
  // A body that is another one at every pose shares nothing, and a pose by itself is not worth it.
  if (!state->parts->joints().empty() || state->options.between == BetweenMethod::Auto)
    state->options.between = BetweenMethod::Paths;
  UMOV_ASSIGN(model, light_of(scene, state->parts->joints(), request, state->options, cancel));
  state->model = std::move(model);
  return PoseLight(std::move(state));
}

bool PoseLight::evaluate(std::span<const Pose> poses, StokesTable &out,
                         const LightTask &task) const {
  return state_->model->evaluate(poses, state_->parts->of(poses), out, task);
}

std::size_t PoseLight::block() const { return list_block(*state_->model, state_->options); }

double PoseLight::sun_radius_rad() const { return state_->sun_radius_rad; }
const LightModel &PoseLight::model() const { return *state_->model; }
const LightOptions &PoseLight::options() const { return state_->options; }
const std::vector<InputFile> &PoseLight::inputs() const { return state_->inputs; }

} // namespace umov::jobs
