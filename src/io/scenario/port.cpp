// telescope.port: a focus by name, or a train of mirrors.

#include "io/scenario/instrument.h"
#include "io/scenario/parts.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/text.h>
#include <umov/io/index_file.h>

namespace umov::scenario {

Result<void> read_metal(const Node &node, const char *key, std::string &out) {
  if (!node.has(key))
    return {};
  out = node.text(key, "");
  if (auto found = find_index(out); !found)
    return fail(ErrorCode::BadInput, found.error().message, node.where(key));
  return {};
}

namespace {

constexpr const char *port_names[] = {"cassegrain", "nasmyth_left", "nasmyth_right"};
constexpr std::array direction_names{"up",   "down",  "left", "right", "forward",
                                     "back", "north", "east", "south", "west"};

std::string name_of(BeamDirection which) {
  return direction_names[static_cast<std::size_t>(which)];
}
bool is_vertical(BeamDirection d) { return d == BeamDirection::Up || d == BeamDirection::Down; }
bool is_of_ground(BeamDirection d) { return d >= BeamDirection::North; }

Result<BeamDirection> direction_named(const std::string &name, const Where &at) {
  const auto found = std::ranges::find(direction_names, name);
  if (found == direction_names.end())
    return fail(ErrorCode::BadInput,
                fmt::format("a beam that goes \"{}\"; {} was expected: left, right, forward and "
                            "back of who looks towards the azimuth",
                            printable(name), fmt::join(direction_names, ", ")),
                at);
  return static_cast<BeamDirection>(found - direction_names.begin());
}

/// Directions of one number lie on one line.
int line_of(BeamDirection d) {
  switch (d) {
  case BeamDirection::Up:
  case BeamDirection::Down:
    return 0;
  case BeamDirection::Left:
  case BeamDirection::Right:
    return 1;
  case BeamDirection::Forward:
  case BeamDirection::Back:
    return 2;
  case BeamDirection::North:
  case BeamDirection::South:
    return 3;
  case BeamDirection::East:
  case BeamDirection::West:
    return 4;
  }
  return 0;
}

/// Why no flat mirror sends the light of these on in that direction, wherever the mount looks;
/// empty if one does.
std::string why_not(const std::vector<TrainMirror> &before, BeamDirection after) {
  if (before.empty())
    return line_of(after) == 1 ? "" : "left or right was expected, along the altitude axis";
  const BeamDirection last = before.back().to;
  if (line_of(last) == line_of(after))
    return "the beam is on that line already; another one was expected";
  const auto is_level_in_fork = [](BeamDirection d) { return !is_vertical(d) && !is_of_ground(d); };
  if (is_of_ground(after) && is_level_in_fork(last))
    return "light leaves the fork along the azimuth axis: up or down was expected between";
  const bool is_down = std::ranges::any_of(
      before, [](const TrainMirror &mirror) { return is_of_ground(mirror.to); });
  if (is_down && is_level_in_fork(after))
    return "the light has left the fork: north, east, south, west, up or down was expected";
  return "";
}

Result<void> read_train(const Node &node, MirrorTrain &out) {
  UMOV_TRY(node.require("mirrors"));
  for (const toml::node &item : *node.get("mirrors")->as_array()) {
    TrainMirror mirror;
    std::string to;
    if (const toml::table *table = item.as_table()) {
      const Node one(*table, "telescope.port.mirrors", node.label() + ".mirrors", node.file());
      UMOV_TRY(one.check());
      UMOV_TRY(one.require("to"));
      UMOV_TRY(read_metal(one, "mirror", mirror.index));
      to = one.text("to", "");
    } else if (const auto *text = item.as_string()) {
      to = text->get();
    } else {
      return fail(ErrorCode::BadInput,
                  "a mirror that is neither a text nor a table; where it sends the light was "
                  "expected, \"left\" or { to = \"left\", mirror = \"NAME\" }",
                  node.where("mirrors"));
    }
    UMOV_ASSIGN(direction, direction_named(to, node.where("mirrors")));
    mirror.to = direction;
    if (const std::string why = why_not(out.mirrors, direction); !why.empty())
      return fail(ErrorCode::BadInput,
                  fmt::format("mirror {} sends the light {}: {}", out.mirrors.size() + 1, to, why),
                  node.where("mirrors"));
    out.mirrors.push_back(std::move(mirror));
  }
  if (out.mirrors.empty())
    return fail(ErrorCode::BadInput,
                "a train without mirrors; such as [\"right\", \"down\", \"east\"] was expected, or "
                "port = \"cassegrain\"",
                node.where("mirrors"));
  return {};
}

/// Where the instrument's x axis is counted from: across the last beam, and standing as still as
/// it.
Result<void> read_x_from(const Node &node, MirrorTrain &out) {
  const BeamDirection last = out.mirrors.back().to;
  out.x_from = is_vertical(last) ? BeamDirection::Forward : BeamDirection::Up;
  if (!node.has("x_from"))
    return {};
  UMOV_ASSIGN(x, direction_named(node.text("x_from", ""), node.where("x_from")));
  out.x_from = x;
  if (is_vertical(last) == is_vertical(x))
    return fail(ErrorCode::BadInput,
                fmt::format("x_from = \"{}\" of a beam that goes {}: {} was expected", name_of(x),
                            name_of(last),
                            is_vertical(last) ? "a horizontal direction" : "up or down"),
                node.where("x_from"));
  return {};
}

} // namespace

Result<void> read_port(const Node &node, Telescope &out) {
  if (!node.has("port"))
    return {};
  const toml::node &value = *node.get("port");
  if (const toml::table *table = value.as_table()) {
    const Node below(*table, "telescope.port", node.label() + ".port", node.file());
    UMOV_TRY(below.check());
    out.port = TelescopePort::Train;
    out.train = {};
    UMOV_TRY(read_train(below, out.train));
    return read_x_from(below, out.train);
  }
  if (!value.is_string())
    return fail(ErrorCode::BadInput,
                fmt::format("port is {}; a name, or {{ mirrors = [\"right\", \"down\"] }}, was "
                            "expected",
                            described(value)),
                node.where("port"));
  UMOV_ASSIGN(port,
              node.choice("port", port_names[0], {port_names[0], port_names[1], port_names[2]}));
  out.port = static_cast<TelescopePort>(std::find(port_names, port_names + 3, port) - port_names);
  out.train = {};
  return {};
}

std::string port_toml(const Telescope &t) {
  if (t.port != TelescopePort::Train)
    return quoted(port_names[static_cast<int>(t.port)]);
  std::string mirrors;
  for (const TrainMirror &one : t.train.mirrors)
    mirrors +=
        fmt::format("{}{}", mirrors.empty() ? "" : ", ",
                    one.index.empty() ? quoted(name_of(one.to))
                                      : fmt::format("{{ to = {}, mirror = {} }}",
                                                    quoted(name_of(one.to)), quoted(one.index)));
  return fmt::format("{{ mirrors = [{}], x_from = {} }}", mirrors, quoted(name_of(t.train.x_from)));
}

} // namespace umov::scenario
