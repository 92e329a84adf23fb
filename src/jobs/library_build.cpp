#include <umov/jobs/library.h>

#include "jobs/job_journal.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <umov/core/files.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/io/signature_file.h>
#include <umov/jobs/pose_light.h>
#include <umov/light/light_sums.h>

namespace umov::jobs {
namespace {

namespace fs = std::filesystem;

/// A signature on its way to its file.
struct Making {
  SignatureText text;
  PackedLight light;
  double error = 0;
  std::vector<float> sums;
  const char *state = "made";
  std::string no_sums; ///< why there is light alone; empty: there are sums
  std::string device;  ///< as LightModel::device; who lit it in the end is in `text`
};

/// Light by sums before any colour: for objects without parts that turn, in single wavelengths.
class SummedLight {
public:
  static Result<SummedLight> of(const Scene &scene, const JobOptions &options, double accuracy,
                                const std::atomic<bool> *cancel) {
    UMOV_ASSIGN(sums, make_sums(scene, sums_options(options, accuracy), cancel));
    return SummedLight(std::move(sums), scene, options);
  }

  /// False where this scene has no sums, or it was stopped.
  bool make(std::size_t cells, const Monitor &monitor, Making &out, StokesTable &light) const;
  /// Light of sums that a file holds; false where they do not serve these materials.
  bool colour(const SignatureView &kept, StokesTable &light) const;
  [[nodiscard]] std::string device() const { return sums_->device(); }
  [[nodiscard]] std::string lit_by() const { return sums_->lit_by(); }

private:
  SummedLight(std::unique_ptr<LightSums> sums, const Scene &scene, const JobOptions &options)
      : sums_(std::move(sums)), scene_(scene), options_(options) {}
  static SumsOptions sums_options(const JobOptions &options, double accuracy) {
    SumsOptions out;
    out.accuracy = accuracy;
    out.mask_cache = options.mask_cache;
    out.threads = options.threads;
    out.device = options.device;
    return out;
  }
  [[nodiscard]] static std::vector<std::string> words_of(const AbundanceTable &sums);
  std::unique_ptr<LightSums> sums_;
  const Scene &scene_;
  const JobOptions &options_;
};

std::vector<std::string> SummedLight::words_of(const AbundanceTable &sums) {
  std::vector<std::string> out;
  for (const AbundanceColumn &column : sums.columns) {
    std::string text = column.kind == AbundanceColumn::Kind::Specular
                           ? fmt::format("lobe {:.9g}", column.shape)
                           : std::string("body");
    for (const AbundanceColumn::Side &side : column.sides)
      text += fmt::format(" {}{}", side.is_back_surface ? "back of " : "", side.group);
    out.push_back(std::move(text));
  }
  return out;
}

void append(const StokesTable &part, StokesTable &all) {
  all.bands = part.bands;
  all.i.insert(all.i.end(), part.i.begin(), part.i.end());
  all.q.insert(all.q.end(), part.q.begin(), part.q.end());
}

constexpr std::size_t block = 1u << 14; // poses whose sums are held at a time

bool SummedLight::make(std::size_t cells, const Monitor &monitor, Making &out,
                       StokesTable &light) const {
  const auto tables = sums_->tables_for(scene_);
  if (!tables) {
    out.no_sums = tables.error().message;
    return false;
  }
  const std::size_t pairs = signature_pairs(cells);
  AbundanceTable sums;
  StokesTable part;
  for (std::size_t begin = 0; begin < pairs && !monitor.is_cancelled(); begin += block) {
    const std::size_t end = std::min(begin + block, pairs);
    const auto poses = signature_poses(cells, begin, end, out.text.sun_radius_rad);
    if (const auto added = sums_->evaluate(poses, sums, options_.threads, monitor.cancel); !added) {
      if (!monitor.is_cancelled())
        out.no_sums = added.error().message;
      return false;
    }
    tables->apply(sums, part, options_.threads, monitor.cancel);
    append(part, light);
    for (const double sum : sums.sum)
      out.sums.push_back(static_cast<float>(sum));
  }
  out.text.columns = words_of(sums);
  sums_->keep_masks();
  return !monitor.is_cancelled();
}

bool SummedLight::colour(const SignatureView &kept, StokesTable &light) const {
  const auto tables = sums_->tables_for(scene_);
  const std::size_t cells = kept.signature.cells;
  AbundanceTable sums;
  const Pose one = signature_poses(cells, 1, 2, kept.text.sun_radius_rad).front();
  if (!tables || kept.text.columns.empty() || !sums_->evaluate({&one, 1}, sums, 1) ||
      words_of(sums) != kept.text.columns)
    return false;
  const std::size_t pairs = signature_pairs(cells), columns = kept.text.columns.size();
  StokesTable part;
  for (std::size_t begin = 0; begin < pairs; begin += block) {
    const std::size_t end = std::min(begin + block, pairs);
    const auto poses = signature_poses(cells, begin, end, kept.text.sun_radius_rad);
    const auto from = kept.abundances.subspan(begin * columns, poses.size() * columns);
    sums.sum.assign(from.begin(), from.end());
    sums.half_width.assign(sums.sum.size(), 0);
    sums.bias.assign(sums.sum.size(), 0);
    sums.cos_phase.clear();
    sums.has_plane.clear();
    sums.is_dark.clear();
    for (std::size_t k = 0; k < poses.size(); ++k) {
      sums.cos_phase.push_back(cos_phase(poses[k]));
      sums.has_plane.push_back(has_scattering_plane(poses[k]) ? 1 : 0);
      const auto row = from.subspan(k * columns, columns);
      sums.is_dark.push_back(std::ranges::all_of(row, [](float s) { return s == 0; }) ? 1 : 0);
    }
    tables->apply(sums, part, options_.threads);
    append(part, light);
  }
  return true;
}

/// Light of whatever has no sums.
bool light_pairs(const PoseLight &from, std::size_t cells, const JobOptions &options,
                 const Monitor &monitor, StokesTable &light) {
  LightTask task;
  task.threads = options.threads;
  task.cancel = monitor.cancel;
  StokesTable part;
  const std::size_t pairs = signature_pairs(cells);
  for (std::size_t begin = 0; begin < pairs; begin += block) {
    const auto poses =
        signature_poses(cells, begin, std::min(begin + block, pairs), from.sun_radius_rad());
    if (monitor.is_cancelled() || !from.evaluate(poses, part, task))
      return false;
    append(part, light);
  }
  return true;
}

/// What sums over the facets depend on of a material: its lobe. Profiles of body light and haze are
/// fitted to the material itself, so that those sums are of one `job` alone.
std::string lobe_of(const Material &material, const std::string &job) {
  const bool has_profiles = material.body || material.haze || material.apparent_roughness ||
                            material.measured || material.interreflection != Interreflection::None;
  const DistributionChoice &lobe = material.distribution;
  std::string out = fmt::format("{} {} {} {}\n", has_profiles ? job : "", lobe.model,
                                fmt::join(lobe.angle_deg, ","), fmt::join(lobe.density, ","));
  for (const auto &[name, value] : lobe.parameters)
    out += fmt::format("{} {} ", name, value);
  const Vec3<Body> along = material.direction.value_or(Vec3<Body>{});
  return out + fmt::format("{} {} {} {} {}\n", static_cast<int>(material.shadowing),
                           material.direction.has_value(), along.x, along.y, along.z);
}

/// What abundances depend on apart from the optical constants: places, facets, normals, lobes, how
/// hiding is decided, who added up, and the program that made them.
std::string shape_of(const PoseLight &light, const std::string &job, const std::string &device) {
  const Scene &scene = light.model().scene();
  const Mesh &mesh = scene.mesh;
  std::string bytes = fmt::format("umov {} {} {} {}\n", version, source_revision,
                                  static_cast<int>(scene.normals), light.options().accuracy) +
                      device;
  for (const auto *side : {&scene.front, &scene.back})
    for (const Surface &surface : *side)
      bytes += lobe_of(surface.material(), job);
  const auto add = [&](const auto &list) {
    bytes.append(reinterpret_cast<const char *>(list.data()), list.size() * sizeof(list[0]));
  };
  add(mesh.positions);
  add(mesh.normals);
  for (const Triangle &triangle : mesh.triangles) {
    add(triangle.vertex);
    add(triangle.normal);
    bytes += fmt::format("{} {} ", triangle.front, triangle.back);
  }
  for (const std::string &group : mesh.groups)
    bytes += group + '\n';
  return sha256_hex(bytes);
}

/// Who lit what two models lit; an empty text is the processor.
std::string lit_by_both(const std::string &one, const std::string &other) {
  if (one == other)
    return one;
  constexpr std::string_view too = " and the processor";
  const auto cards_of = [&](std::string_view text) {
    return text.ends_with(too) ? text.substr(0, text.size() - too.size()) : text;
  };
  const bool is_processor_too =
      one.empty() || other.empty() || one.ends_with(too) || other.ends_with(too);
  std::string out(cards_of(one));
  if (const std::string_view more = cards_of(other); more != out)
    (out += out.empty() || more.empty() ? "" : " and ") += more;
  return out + std::string(is_processor_too ? too : "");
}

/// One object of a library.
class SignatureMaker {
public:
  SignatureMaker(const LibraryRequest &request, const JobOptions &options, const Monitor &monitor,
                 Diagnostics &diagnostics)
      : request_(request), options_(options), monitor_(monitor), diagnostics_(diagnostics) {}

  Result<void> make(const std::string &path, const std::string &name);
  [[nodiscard]] Table table() const;

private:
  /// What a file is made from if `device` lit it.
  using JobBy = std::function<std::string(const std::string &device)>;
  Result<Making> light(const Scenario &scenario, const PoseLight &own, const std::string &name,
                       const JobBy &job_by, const fs::path &file) const;
  Result<bool> colour(const SummedLight &sums, const PoseLight &own, const JobBy &job_by,
                      const fs::path &file, Making &out, StokesTable &light) const;
  [[nodiscard]] Result<bool> may_stay(const std::string &device) const;
  void tell_of_quality(const Making &made) const;
  void tell(const Making &made);

  const LibraryRequest &request_;
  const JobOptions &options_;
  const Monitor &monitor_;
  Diagnostics &diagnostics_;
  std::string told_; ///< device of the object before
  std::vector<std::string> name_, state_;
  std::vector<std::int64_t> poses_, columns_;
  std::vector<double> error_;
};

Result<void> SignatureMaker::make(const std::string &path, const std::string &name) {
  UMOV_ASSIGN(scenario, read_scenario(path, {}));
  if (const auto fits = check_signature_size(request_.cells, scenario.bands.size()); !fits)
    return fail(ErrorCode::Usage, fits.error().message, {path});
  SignatureRequest asked;
  asked.method = LightMethod::Masks;
  UMOV_ASSIGN(own, PoseLight::make(scenario, asked, options_, diagnostics_, monitor_.cancel));
  const JobBy job_by = [&](const std::string &device) {
    return signature_job(scenario, own.inputs(), request_.cells, device);
  };
  const fs::path file = fs::path(request_.folder) / (name + ".umovsig");
  if (file_exists(file))
    if (const auto kept = SignatureFile::open(file, true)) {
      const SignatureText &text = kept->view().text;
      UMOV_ASSIGN(stays, may_stay(text.device));
      if (stays && text.job == job_by(text.device)) {
        Making there;
        there.text = text;
        there.error = kept->view().signature.error;
        there.state = "was there";
        tell(there);
        return {};
      }
    }
  UMOV_ASSIGN(made, light(scenario, own, name, job_by, file));
  UMOV_ASSIGN(bytes, signature_bytes(made.text, request_.cells, made.light, made.error, made.sums));
  UMOV_TRY(write_file_atomically(file, bytes));
  tell_of_quality(made);
  (void)own.model().keep_masks(); // a cache that cannot be written costs time alone
  const std::string own_device = own.model().device();
  const std::string &device = made.device.starts_with("cpu") ? made.device : own_device;
  if (device != told_) // once for many objects
    tell_of_device(device, diagnostics_);
  told_ = device;
  tell(made);
  return {};
}

/// What was lit by `device` is what is asked for: with Auto whoever lit.
Result<bool> SignatureMaker::may_stay(const std::string &device) const {
  if (options_.device.choice == DeviceChoice::Auto)
    return true;
  UMOV_ASSIGN(cards, cards_for(options_.device));
  return device == cards;
}

/// Light of the sums that a file holds; false where they are not those of this object, or not of
/// who is asked for.
Result<bool> SignatureMaker::colour(const SummedLight &sums, const PoseLight &own,
                                    const JobBy &job_by, const fs::path &file, Making &out,
                                    StokesTable &light) const {
  if (!file_exists(file))
    return false;
  const auto kept = SignatureFile::open(file, true);
  if (!kept || kept->view().signature.cells != request_.cells)
    return false;
  const SignatureText &text = kept->view().text;
  UMOV_ASSIGN(stays, may_stay(text.device));
  if (!stays || text.sun_radius_rad != out.text.sun_radius_rad ||
      text.shape != shape_of(own, job_by(text.device), text.device) ||
      !sums.colour(kept->view(), light))
    return false;
  out.state = "recoloured";
  out.text.device = text.device;
  out.text.columns = text.columns;
  out.sums.assign(kept->view().abundances.begin(), kept->view().abundances.end());
  return true;
}

Result<Making> SignatureMaker::light(const Scenario &scenario, const PoseLight &own,
                                     const std::string &name, const JobBy &job_by,
                                     const fs::path &file) const {
  Making out;
  out.text.name = name;
  out.text.sun_radius_rad = own.sun_radius_rad();
  for (const Band &band : scenario.bands)
    out.text.bands.push_back(band.name);
  StokesTable light;
  bool is_lit = false;
  out.no_sums = !own.model().joints().empty()          ? "parts that turn have no sums"
                : !own.model().scene().grid.is_plain() ? "bands with a curve have no sums"
                : own.options().bounces > 1            ? "light between surfaces has no sums"
                                                       : "";
  if (out.no_sums.empty()) {
    UMOV_ASSIGN(sums, SummedLight::of(own.model().scene(), options_, own.options().accuracy,
                                      monitor_.cancel));
    UMOV_ASSIGN(recoloured, colour(sums, own, job_by, file, out, light));
    is_lit = recoloured;
    if (!recoloured) {
      light = {};
      is_lit = sums.make(request_.cells, monitor_, out, light);
      out.text.device = sums.lit_by();
    }
    if (is_lit)
      out.device = sums.device();
  }
  if (!is_lit) {
    light = {};
    out.sums.clear();
    out.text.columns.clear();
    if (!light_pairs(own, request_.cells, options_, monitor_, light))
      return fail(ErrorCode::Interrupted,
                  "stopped by the user; finished objects stay, and the same command goes on");
    out.text.device = own.model().lit_by();
  }
  out.light = pack_light(light);
  const Signature signature{
      name, request_.cells, light.bands, out.light.ln_least, out.light.ln_step, 0, out.light.code};
  out.error = interpolation_error(
      signature,
      [&](std::span<const Pose> poses, StokesTable &to) {
        LightTask task;
        task.threads = options_.threads;
        return own.evaluate(poses, to, task);
      },
      scenario.seed);
  // Now that all is lit it is known by whom.
  out.text.device = lit_by_both(out.text.device, own.model().lit_by());
  out.text.job = job_by(out.text.device);
  out.text.shape = shape_of(own, out.text.job, out.text.device);
  return out;
}

/// Beyond this part of I a signature says nothing of the light between its nodes.
constexpr double useless_error = 1;

void SignatureMaker::tell_of_quality(const Making &made) const {
  if (!made.no_sums.empty())
    diagnostics_.warn(fmt::format("{}: {}: the file holds light without abundances, and other "
                                  "materials need it to be made anew",
                                  printable(made.text.name), made.no_sums));
  if (made.error <= useless_error)
    return;
  diagnostics_.warn(fmt::format(
      "{}: between its nodes the light is off by {:.2g} of itself: glints are narrower than the "
      "grid of {} cells, and a search by it finds nothing. Take more --cells or rougher materials",
      printable(made.text.name), made.error, request_.cells));
}

void SignatureMaker::tell(const Making &made) {
  name_.push_back(made.text.name);
  state_.emplace_back(made.state);
  poses_.push_back(static_cast<std::int64_t>(signature_pairs(request_.cells)));
  columns_.push_back(static_cast<std::int64_t>(made.text.columns.size()));
  error_.push_back(made.error);
}

Table SignatureMaker::table() const {
  Table out;
  out.add("name", "", "of the object", name_);
  out.add("poses", "", "pairs of Sun and observer", poses_);
  out.add("abundances", "", "sums kept for each, so that materials can be changed; 0: light alone",
          columns_);
  out.add("error", "", "of I between the nodes, in parts of it: two of three poses are better",
          error_);
  out.add("state", "", "made, recoloured from its abundances, or was there", state_);
  return out;
}

} // namespace

Result<LibraryBuilt> build_library(const LibraryRequest &request, const JobOptions &options,
                                   const Monitor &monitor, Diagnostics &diagnostics) {
  std::vector<std::string> names;
  for (const std::string &path : request.scenarios) {
    names.push_back(fs::path(path).stem().string());
    if (std::ranges::count(names, names.back()) > 1)
      return fail(
          ErrorCode::Usage,
          fmt::format("two scenarios are named {}: the objects of a library are named after "
                      "their files; rename one",
                      printable(names.back())));
  }
  std::error_code problem;
  const bool is_new = fs::create_directories(request.folder, problem);
  if (problem)
    return fail(ErrorCode::Device,
                "cannot make the folder: " + problem.message() + ". Choose another folder.",
                {request.folder});
  SignatureMaker maker(request, options, monitor, diagnostics);
  const std::size_t first = std::min(request.first, names.size());
  const std::size_t end = first + std::min(request.count, names.size() - first);
  for (std::size_t k = first; k < end; ++k) {
    monitor.advance("objects", k - first, end - first);
    Result<void> made;
    const auto done = without_failures([&]() -> Result<void> {
      made = maker.make(request.scenarios[k], names[k]);
      return {};
    });
    if (!done) { // a card
      made = done;
      made.error().message += ". Finished objects stay, and the same command goes on";
    }
    if (made)
      continue;
    if (is_new) // a folder that holds nothing goes with the refusal; another stays
      fs::remove(request.folder, problem);
    return tl::unexpected(made.error());
  }
  return LibraryBuilt{maker.table()};
}

} // namespace umov::jobs
