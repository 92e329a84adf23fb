#include "io/scenario/parts.h"

#include <cmath>
#include <fmt/format.h>
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
    if (v.size() == 3 && norm(axis) > 0)
      return normalized(axis);
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

Result<Direction> read_direction(const Node &node, const char *name, Target fallback) {
  if (!node.has(name))
    return Direction{fallback};
  if (node.get(name)->is_table()) {
    UMOV_ASSIGN(below, node.child(name, "direction"));
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
  for (const char *name : names)
    if (node.has(name))
      return fail(ErrorCode::BadInput,
                  fmt::format("{} has no meaning with {}; leave it out", name, mode),
                  node.where(name));
  return {};
}

Result<TwoAxisLaw> read_two_axis(const Node &node) {
  TwoAxisLaw law;
  const bool is_nadir = node.text("mode", "") == "nadir";
  UMOV_TRY(forbid(node, is_nadir ? "mode = \"nadir\"" : "two axes (point, at, then, toward)",
                  {"quaternion", "axis", "rate_deg_s", "period_s", "epoch", "start"}));
  if (is_nadir)
    UMOV_TRY(forbid(node, "mode = \"nadir\"", {"point", "at", "then", "toward"}));
  UMOV_ASSIGN(point, read_axis(node, "point", law.point));
  UMOV_ASSIGN(at, read_direction(node, "at", Target::Nadir));
  UMOV_ASSIGN(then, read_axis(node, "then", law.then));
  UMOV_ASSIGN(toward, read_direction(node, "toward", Target::Velocity));
  return TwoAxisLaw{point, at, then, toward};
}

Result<InertialLaw> read_inertial(const Node &node) {
  UMOV_TRY(forbid(
      node, "mode = \"inertial\"",
      {"point", "at", "then", "toward", "axis", "rate_deg_s", "period_s", "epoch", "start"}));
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

Result<SpinLaw> read_spin(const Node &node) {
  UMOV_TRY(forbid(node, "mode = \"spin\"", {"point", "at", "then", "toward", "quaternion"}));
  SpinLaw law;
  UMOV_ASSIGN(axis, read_axis(node, "axis", law.axis));
  law.axis = axis;
  if (node.has("rate_deg_s") == node.has("period_s"))
    return fail(ErrorCode::BadInput, "mode = \"spin\" needs rate_deg_s or period_s, one of them",
                node.where("mode"));
  const double period = node.number("period_s", 1);
  if (period == 0)
    return fail(ErrorCode::BadInput, "period_s = 0; another number was expected",
                node.where("period_s"));
  law.rate_rad_s = node.has("rate_deg_s") ? Angle::degrees(node.number("rate_deg_s", 0)).radians()
                                          : 2 * pi / period;
  UMOV_ASSIGN(epoch, node.time("epoch"));
  law.epoch = epoch;
  if (!node.has("start"))
    return law;
  UMOV_ASSIGN(start, node.child("start", "object.attitude"));
  UMOV_ASSIGN(mode, start.choice("mode", "nadir", {"nadir", "inertial"}));
  if (mode == "inertial") {
    UMOV_ASSIGN(inertial, read_inertial(start));
    law.start = inertial;
  } else {
    UMOV_ASSIGN(two_axis, read_two_axis(start));
    law.start = two_axis;
  }
  return law;
}

std::string direction_toml(const Direction &d) {
  if (const auto *target = std::get_if<Target>(&d))
    return quoted(target_names[static_cast<std::size_t>(*target)]);
  const auto &sky = std::get<CelestialDirection>(d);
  return fmt::format("{{ ra_deg = {}, dec_deg = {} }}",
                     degrees_text(Angle::radians(sky.right_ascension_rad)),
                     degrees_text(Angle::radians(sky.declination_rad)));
}

std::string law_toml(const TwoAxisLaw &law) {
  return fmt::format("{{ point = {}, at = {}, then = {}, toward = {} }}", axis_toml(law.point),
                     direction_toml(law.at), axis_toml(law.then), direction_toml(law.toward));
}

std::string law_toml(const InertialLaw &law) {
  const Quaternion &q = law.body_from_gcrs;
  return fmt::format("{{ mode = \"inertial\", quaternion = [{}, {}, {}, {}] }}", shortest(q.w),
                     shortest(q.x), shortest(q.y), shortest(q.z));
}

std::string law_toml(const SpinLaw &law) {
  const std::string start = std::visit([](const auto &s) { return law_toml(s); }, law.start);
  return fmt::format("{{ mode = \"spin\", axis = {}, rate_deg_s = {}, epoch = {}, start = {} }}",
                     axis_toml(law.axis), degrees_text(Angle::radians(law.rate_rad_s)),
                     to_iso_exact(law.epoch), start);
}

} // namespace

Result<AttitudeLaw> read_attitude(const Node &node) {
  UMOV_ASSIGN(mode, node.choice("mode", "", {"", "nadir", "inertial", "spin"}, {"tumble", "aem"}));
  const auto read = [&]() -> Result<AttitudeLaw> {
    if (mode == "inertial")
      return read_inertial(node).map([](auto law) { return AttitudeLaw{law}; });
    if (mode == "spin")
      return read_spin(node).map([](auto law) { return AttitudeLaw{law}; });
    return read_two_axis(node).map([](auto law) { return AttitudeLaw{law}; });
  };
  UMOV_ASSIGN(law, read());
  if (auto checked = umov::check(law); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, node.where());
  return law;
}

std::string attitude_toml(const AttitudeLaw &law) {
  return std::visit([](const auto &one) { return law_toml(one); }, law);
}

} // namespace umov::scenario
