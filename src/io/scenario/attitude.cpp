#include "io/scenario/parts.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov::scenario {

Result<Vec3<Body>> read_axis(const Node &node, const char *name, Vec3<Body> fallback) {
  if (!node.has(name))
    return fallback;
  const std::string text = node.text(name, "");
  if (text.size() == 2 && (text[0] == '+' || text[0] == '-') && text[1] >= 'X' && text[1] <= 'Z') {
    const double sign = text[0] == '+' ? 1 : -1;
    return Vec3<Body>{text[1] == 'X' ? sign : 0, text[1] == 'Y' ? sign : 0,
                      text[1] == 'Z' ? sign : 0};
  }
  if (node.get(name)->is_array()) {
    UMOV_ASSIGN(v, node.numbers(name));
    const Vec3<Body> axis{v[0], v.size() > 1 ? v[1] : 0, v.size() > 2 ? v[2] : 0};
    // Already unit to the last bits: left alone, so that a lock is its own lock.
    if (v.size() == 3 && norm(axis) > 0)
      return std::abs(norm(axis) - 1) < 1e-15 ? axis : normalized(axis);
  }
  return fail(ErrorCode::BadInput,
              fmt::format("{}: a body axis was expected, \"+X\" to \"-Z\" or [x, y, z]", name),
              node.where(name));
}

std::string axis_toml(Vec3<Body> v) {
  return fmt::format("[{}, {}, {}]", shortest(v.x), shortest(v.y), shortest(v.z));
}

namespace {

const std::vector<std::string> target_names{"nadir",        "zenith", "velocity",
                                            "orbit_normal", "sun",    "observer"};

Result<Direction> read_place(const Node &node) {
  UMOV_TRY(node.require("lat_deg"));
  UMOV_TRY(node.require("lon_deg"));
  auto site =
      make_site("", node.number("lat_deg", 0), node.number("lon_deg", 0), node.number("alt_m", 0));
  if (!site)
    return fail(ErrorCode::BadInput, site.error().message, node.where("lat_deg"));
  return Direction{GroundTarget{*site}};
}

Result<Direction> read_direction(const Node &node, const char *name, Target fallback) {
  if (!node.has(name))
    return Direction{fallback};
  if (node.get(name)->is_table()) {
    UMOV_ASSIGN(below, node.child(name, "direction"));
    if (below.has("lat_deg") || below.has("lon_deg"))
      return read_place(below);
    UMOV_TRY(below.require("ra_deg"));
    UMOV_TRY(below.require("dec_deg"));
    const double dec = below.number("dec_deg", 0);
    if (std::abs(dec) > 90)
      return fail(ErrorCode::BadInput, fmt::format("dec_deg = {}; -90 to 90 was expected", dec),
                  below.where("dec_deg"));
    return Direction{CelestialDirection{Angle::degrees(below.number("ra_deg", 0)).radians(),
                                        Angle::degrees(dec).radians()}};
  }
  UMOV_ASSIGN(text, node.choice(name, "", target_names));
  for (std::size_t i = 0; i < target_names.size(); ++i)
    if (text == target_names[i])
      return Direction{static_cast<Target>(i)};
  return Direction{fallback};
}

Result<void> forbid(const Node &node, const std::string &mode,
                    std::initializer_list<const char *> names) {
  Problems problems;
  for (const char *name : names)
    if (node.has(name))
      problems.add({ErrorCode::BadInput,
                    fmt::format("{} has no meaning with {}; leave it out", name, mode),
                    node.where(name)});
  return problems.told();
}

Result<TwoAxisLaw> read_two_axis(const Node &node) {
  TwoAxisLaw law;
  const bool is_nadir = node.text("mode", "") == "nadir";
  Problems problems;
  problems.went(forbid(node, is_nadir ? "mode = \"nadir\"" : "two axes (point, at, then, toward)",
                       {"quaternion", "axis", "rate_deg_s", "period_s", "epoch", "start", "inertia",
                        "file", "pieces"}));
  if (is_nadir)
    problems.went(forbid(node, "mode = \"nadir\"", {"point", "at", "then", "toward"}));
  const auto point = problems.taken(read_axis(node, "point", law.point), law.point);
  const auto at = problems.taken(read_direction(node, "at", Target::Nadir), Direction{});
  const auto then = problems.taken(read_axis(node, "then", law.then), law.then);
  const auto toward = problems.taken(read_direction(node, "toward", Target::Velocity), Direction{});
  UMOV_TRY(problems.told());
  const auto radians = [&](const char *name) {
    return Angle::degrees(node.number(name, 0)).radians();
  };
  return TwoAxisLaw{
      point, at, then, toward, {radians("roll_deg"), radians("pitch_deg"), radians("yaw_deg")}};
}

Result<InertialLaw> read_inertial(const Node &node) {
  UMOV_TRY(forbid(node, "mode = \"inertial\"",
                  {"point", "at", "then", "toward", "axis", "rate_deg_s", "period_s", "epoch",
                   "start", "inertia", "file", "pieces", "roll_deg", "pitch_deg", "yaw_deg"}));
  UMOV_ASSIGN(q, node.numbers("quaternion"));
  if (q.size() != 4)
    return fail(ErrorCode::BadInput,
                fmt::format("quaternion has {} numbers; 4 were expected, [w, x, y, z]", q.size()),
                node.where("quaternion"));
  const auto unit = unit_quaternion({q[0], q[1], q[2], q[3]});
  if (!unit)
    return fail(ErrorCode::BadInput, unit.error().message, node.where("quaternion"));
  return InertialLaw{*unit};
}

/// Keys of what a turning law starts from stand in `start`.
Result<StartLaw> read_start(const Node &node) {
  if (!node.has("start"))
    return StartLaw{};
  UMOV_ASSIGN(start, node.child("start", "object.attitude"));
  UMOV_ASSIGN(mode, start.choice("mode", "", {"", "nadir", "inertial"}));
  if (mode == "inertial")
    return read_inertial(start).map([](auto law) { return StartLaw{law}; });
  return read_two_axis(start).map([](auto law) { return StartLaw{law}; });
}

constexpr std::initializer_list<const char *> pointing_keys{
    "point", "at", "then", "toward", "quaternion", "roll_deg", "pitch_deg", "yaw_deg"};

/// When the start holds: as given, else where the scenario begins. A scene has no time: there it is
/// `Epoch{}` (`ScenarioObject::lacks_epoch`), but for a piece, which begins somewhere.
Result<Epoch<Utc>> epoch_of(const Node &node, const AttitudeContext &context) {
  if (node.has("epoch") || (!context.begin && context.is_piece))
    return node.time("epoch");
  return context.begin.value_or(Epoch<Utc>{});
}

/// The key, where there is an epoch at all.
std::string epoch_toml(Epoch<Utc> epoch) {
  return epoch.jd1 == 0 ? std::string() : fmt::format("epoch = {}, ", to_iso_exact(epoch));
}

Result<SpinLaw> read_spin(const Node &node, const AttitudeContext &context) {
  Problems problems;
  problems.went(forbid(node, "mode = \"spin\"", pointing_keys));
  problems.went(forbid(node, "mode = \"spin\"", {"inertia", "file", "pieces"}));
  SpinLaw law;
  law.axis = problems.taken(read_axis(node, "axis", law.axis), law.axis);
  if (node.has("rate_deg_s") == node.has("period_s"))
    problems.add({ErrorCode::BadInput, "mode = \"spin\" needs rate_deg_s or period_s, one of them",
                  node.where("mode")});
  if (node.has("rate_deg_s") && !node.get("rate_deg_s")->is_number())
    problems.add({ErrorCode::BadInput, "rate_deg_s: a number was expected with mode = \"spin\"",
                  node.where("rate_deg_s")});
  const double period = node.number("period_s", 1);
  if (period == 0)
    problems.add(wrong_value(node, "period_s", 0, "another number"));
  law.epoch = problems.taken(epoch_of(node, context), Epoch<Utc>{});
  law.start = problems.taken(read_start(node), StartLaw{});
  UMOV_TRY(problems.told());
  law.rate_rad_s = node.has("rate_deg_s") ? Angle::degrees(node.number("rate_deg_s", 0)).radians()
                                          : 2 * pi / period;
  return law;
}

Result<void> read_inertia(const Node &node, TumbleLaw &law) {
  UMOV_TRY(node.require("inertia"));
  if (node.get("inertia")->is_string()) {
    UMOV_ASSIGN(model, node.choice("inertia", "", {"shell", "solid"}));
    law.from_mesh = model == "shell" ? MassModel::Shell : MassModel::Solid;
    return {};
  }
  UMOV_ASSIGN(v, node.numbers("inertia"));
  if (v.size() != 3 && v.size() != 6)
    return fail(ErrorCode::BadInput,
                fmt::format("inertia has {} numbers; 3 or 6 were expected, [xx, yy, zz] or "
                            "[xx, yy, zz, xy, xz, yz]",
                            v.size()),
                node.where("inertia"));
  v.resize(6, 0);
  law.inertia = {v[0], v[1], v[2], v[3], v[4], v[5]};
  return {};
}

Result<Vec3<Body>> read_rates(const Node &node) {
  UMOV_ASSIGN(rate, node.numbers("rate_deg_s"));
  if (rate.size() != 3)
    return fail(ErrorCode::BadInput,
                fmt::format("rate_deg_s has {} numbers; 3 were expected with mode = \"tumble\", "
                            "[x, y, z] in body axes",
                            rate.size()),
                node.where("rate_deg_s"));
  return Vec3<Body>{rate[0], rate[1], rate[2]} * (pi / 180);
}

Result<TumbleLaw> read_tumble(const Node &node, const AttitudeContext &context) {
  Problems problems;
  problems.went(forbid(node, "mode = \"tumble\"", pointing_keys));
  problems.went(forbid(node, "mode = \"tumble\"", {"axis", "period_s", "file", "pieces"}));
  TumbleLaw law;
  problems.went(read_inertia(node, law));
  law.rate_rad_s = problems.taken(read_rates(node), Vec3<Body>{});
  law.epoch = problems.taken(epoch_of(node, context), Epoch<Utc>{});
  law.start = problems.taken(read_start(node), StartLaw{});
  UMOV_TRY(problems.told());
  return law;
}

Result<TableLaw> read_table(const Node &node, const std::filesystem::path &folder) {
  UMOV_TRY(forbid(node, "mode = \"aem\"", pointing_keys));
  UMOV_TRY(forbid(node, "mode = \"aem\"",
                  {"axis", "rate_deg_s", "period_s", "epoch", "start", "inertia", "pieces"}));
  UMOV_TRY(node.require("file"));
  return TableLaw{tidy_path(folder / node.text("file", "")).string(), nullptr};
}

Result<PiecewiseLaw> read_pieces(const Node &node, const std::filesystem::path &folder,
                                 const AttitudeContext &context) {
  UMOV_TRY(forbid(node, "mode = \"pieces\"", pointing_keys));
  UMOV_TRY(forbid(node, "mode = \"pieces\"",
                  {"axis", "rate_deg_s", "period_s", "epoch", "start", "inertia", "file"}));
  UMOV_TRY(node.require("pieces"));
  PiecewiseLaw law;
  for (const toml::node &item : *node.get("pieces")->as_array()) {
    if (!item.is_table())
      return no_table("pieces", item, "tables such as { from = ..., mode = \"nadir\" }",
                      node.where("pieces"));
    const Node piece(*item.as_table(), "object.attitude", "object.attitude.pieces", node.file());
    UMOV_TRY(piece.check());
    UMOV_ASSIGN(from, piece.time("from"));
    UMOV_ASSIGN(one, read_attitude(piece, folder, {context.seed, context.begin, true}));
    law.pieces.push_back({from, std::make_shared<AttitudeLaw>(one)});
  }
  return law;
}

Result<AttitudeLaw> with_libration(const Node &node, const AttitudeLaw &law, std::uint64_t seed) {
  if (!node.has("libration"))
    return law;
  UMOV_ASSIGN(libration, node.child("libration", "object.attitude.libration"));
  UMOV_TRY(libration.require("rms_deg"));
  return AttitudeLaw{LibrationLaw{std::make_shared<AttitudeLaw>(law),
                                  Angle::degrees(libration.number("rms_deg", 0)).radians(),
                                  libration.number("period_s", 60), seed}};
}

std::string direction_toml(const Direction &d) {
  if (const auto *target = std::get_if<Target>(&d))
    return quoted(target_names[static_cast<std::size_t>(*target)]);
  if (const auto *ground = std::get_if<GroundTarget>(&d))
    return fmt::format("{{ lat_deg = {}, lon_deg = {}, alt_m = {} }}",
                       degrees_text(ground->site.latitude), degrees_text(ground->site.longitude),
                       shortest(ground->site.altitude_m));
  const auto &sky = std::get<CelestialDirection>(d);
  return fmt::format("{{ ra_deg = {}, dec_deg = {} }}",
                     degrees_text(Angle::radians(sky.right_ascension_rad)),
                     degrees_text(Angle::radians(sky.declination_rad)));
}

std::string law_toml(const TwoAxisLaw &law) {
  std::string offset;
  for (const auto &[name, angle] : {std::pair{"roll", law.offset.roll_rad},
                                    {"pitch", law.offset.pitch_rad},
                                    {"yaw", law.offset.yaw_rad}})
    if (angle != 0)
      offset += fmt::format(", {}_deg = {}", name, degrees_text(Angle::radians(angle)));
  return fmt::format("{{ point = {}, at = {}, then = {}, toward = {}{} }}", axis_toml(law.point),
                     direction_toml(law.at), axis_toml(law.then), direction_toml(law.toward),
                     offset);
}

std::string law_toml(const InertialLaw &law) {
  const Quaternion &q = law.body_from_gcrs;
  return fmt::format("{{ mode = \"inertial\", quaternion = [{}, {}, {}, {}] }}", shortest(q.w),
                     shortest(q.x), shortest(q.y), shortest(q.z));
}

std::string law_toml(const SpinLaw &law) {
  const std::string start = std::visit([](const auto &s) { return law_toml(s); }, law.start);
  return fmt::format("{{ mode = \"spin\", axis = {}, rate_deg_s = {}, {}start = {} }}",
                     axis_toml(law.axis), degrees_text(Angle::radians(law.rate_rad_s)),
                     epoch_toml(law.epoch), start);
}

std::string law_toml(const TumbleLaw &law) {
  const std::string start = std::visit([](const auto &s) { return law_toml(s); }, law.start);
  const Inertia &i = law.inertia;
  const std::string inertia =
      law.from_mesh ? (*law.from_mesh == MassModel::Shell ? "\"shell\"" : "\"solid\"")
                    : fmt::format("[{}, {}, {}, {}, {}, {}]", shortest(i.xx), shortest(i.yy),
                                  shortest(i.zz), shortest(i.xy), shortest(i.xz), shortest(i.yz));
  const auto degrees = [](double x) { return degrees_text(Angle::radians(x)); };
  return fmt::format(
      "{{ mode = \"tumble\", inertia = {}, rate_deg_s = [{}, {}, {}], {}start = {} }}", inertia,
      degrees(law.rate_rad_s.x), degrees(law.rate_rad_s.y), degrees(law.rate_rad_s.z),
      epoch_toml(law.epoch), start);
}

std::string law_toml(const TableLaw &law) {
  std::error_code code;
  const auto full = std::filesystem::absolute(law.file, code);
  return fmt::format("{{ mode = \"aem\", file = {} }}",
                     quoted(code ? law.file : tidy_path(full).string()));
}

/// An inline table with one more key at its end.
std::string with_key(std::string table, const std::string &key) {
  table.erase(table.rfind(" }"));
  return table + ", " + key + " }";
}

std::string law_toml(const PiecewiseLaw &law) {
  std::string pieces;
  for (const AttitudePiece &piece : law.pieces)
    pieces += (pieces.empty() ? "" : ", ") +
              with_key(attitude_toml(*piece.law), "from = " + to_iso_exact(piece.from));
  return fmt::format("{{ mode = \"pieces\", pieces = [{}] }}", pieces);
}

std::string law_toml(const LibrationLaw &law) {
  return with_key(attitude_toml(*law.law),
                  fmt::format("libration = {{ rms_deg = {}, period_s = {} }}",
                              degrees_text(Angle::radians(law.rms_rad)), shortest(law.period_s)));
}

} // namespace

Result<AttitudeLaw> read_attitude(const Node &node, const std::filesystem::path &folder,
                                  const AttitudeContext &context) {
  UMOV_ASSIGN(
      mode, node.choice("mode", "", {"", "nadir", "inertial", "spin", "tumble", "aem", "pieces"}));
  const auto as_law = [](auto law) { return AttitudeLaw{law}; };
  const auto read = [&]() -> Result<AttitudeLaw> {
    if (mode == "inertial")
      return read_inertial(node).map(as_law);
    if (mode == "spin")
      return read_spin(node, context).map(as_law);
    if (mode == "tumble")
      return read_tumble(node, context).map(as_law);
    if (mode == "aem")
      return read_table(node, folder).map(as_law);
    if (mode == "pieces")
      return read_pieces(node, folder, context).map(as_law);
    return read_two_axis(node).map(as_law);
  };
  UMOV_ASSIGN(plain, read());
  UMOV_ASSIGN(law, with_libration(node, plain, context.seed));
  if (auto checked = check_attitude(law); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, node.where());
  return law;
}

std::string attitude_toml(const AttitudeLaw &law) {
  return std::visit([](const auto &one) { return law_toml(one); }, law);
}

namespace {

using Motion = decltype(MovingJoint::motion);

Result<Motion> read_motion(const Node &node) {
  if (!node.has("angle_deg")) {
    UMOV_TRY(forbid(node, "toward", {"time"}));
    UMOV_ASSIGN(toward, read_direction(node, "toward", Target::Sun));
    return Motion{toward};
  }
  UMOV_TRY(forbid(node, "angle_deg", {"toward"}));
  UMOV_ASSIGN(angles, node.numbers("angle_deg"));
  if (!node.has("time")) {
    if (angles.size() != 1)
      return fail(ErrorCode::BadInput, "a list of angles needs `time`, a list as long",
                  node.where("angle_deg"));
    return Motion{angles[0] * (pi / 180)};
  }
  AngleTable table;
  for (const toml::node &item : *node.get("time")->as_array()) {
    UMOV_ASSIGN(time, time_of(node, item));
    if (!table.time.empty() && !(seconds_between(time, table.time.back()) > 0))
      return fail(ErrorCode::BadInput, "time: expected times in order", node.where("time"));
    table.time.push_back(time);
  }
  for (const double angle : angles)
    table.angle_rad.push_back(angle * (pi / 180));
  if (table.time.size() != table.angle_rad.size())
    return fail(ErrorCode::BadInput,
                fmt::format("{} times and {} angles; as many of each were expected",
                            table.time.size(), table.angle_rad.size()),
                node.where("time"));
  return Motion{table};
}

} // namespace

Result<MovingJoint> read_part(const Node &node) {
  MovingJoint out;
  out.joint.name = node.text("name", "");
  out.joint.on = node.text("on", "");
  Problems problems;
  if (!node.has("nodes"))
    problems.went(node.require("groups"));
  for (const auto &[key, list] :
       {std::pair{"groups", &out.joint.groups}, {"nodes", &out.joint.nodes}})
    if (node.has(key))
      *list = problems.taken(node.strings(key), std::vector<std::string>{});
  out.joint.axis = problems.taken(read_axis(node, "axis", out.joint.axis), out.joint.axis);
  out.joint.face = problems.taken(read_axis(node, "face", out.joint.face), out.joint.face);
  if (node.has("pivot_m")) {
    auto v = problems.taken(node.numbers("pivot_m"), {0, 0, 0});
    if (v.size() != 3)
      problems.add({ErrorCode::BadInput, "pivot_m: 3 numbers were expected, [x, y, z]",
                    node.where("pivot_m")});
    v.resize(3);
    out.joint.pivot_m = {v[0], v[1], v[2]};
  }
  out.motion = problems.taken(read_motion(node), {});
  UMOV_TRY(problems.told());
  return out;
}

std::string part_toml(const MovingJoint &part) {
  const auto list = [](const std::vector<std::string> &names) {
    std::string out;
    for (const std::string &name : names)
      out += (out.empty() ? "" : ", ") + quoted(name);
    return out;
  };
  std::string out =
      fmt::format("name = {}\ngroups = [{}]\nnodes = [{}]\naxis = {}\npivot_m = {}\nface = {}\n"
                  "on = {}\n",
                  quoted(part.joint.name), list(part.joint.groups), list(part.joint.nodes),
                  axis_toml(part.joint.axis), axis_toml(part.joint.pivot_m),
                  axis_toml(part.joint.face), quoted(part.joint.on));
  if (const auto *direction = std::get_if<Direction>(&part.motion))
    return out + "toward = " + direction_toml(*direction) + "\n";
  if (const auto *angle = std::get_if<double>(&part.motion))
    return out + "angle_deg = " + degrees_text(Angle::radians(*angle)) + "\n";
  const auto &table = std::get<AngleTable>(part.motion);
  std::string times, angles;
  for (std::size_t k = 0; k < table.time.size(); ++k) {
    times += (k > 0 ? ", " : "") + to_iso_exact(table.time[k]);
    angles += (k > 0 ? ", " : "") + degrees_text(Angle::radians(table.angle_rad[k]));
  }
  return out + fmt::format("time = [{}]\nangle_deg = [{}]\n", times, angles);
}

} // namespace umov::scenario
