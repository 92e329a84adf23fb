#pragma once
// Private: readers of instruments and observations.

#include "io/scenario/node.h"
#include <filesystem>
#include <umov/io/scenario.h>

namespace umov::scenario {

/// Where a number of an instrument or an observation lies; `what` ends "a number ... was expected".
struct Bounds {
  double low, high;
  const char *what;
};
/// A key's number within bounds, if it is there; `out` stays where it is not good.
Result<void> read_number(const Node &node, const char *name, const Bounds &bounds, double &out);

/// [telescope], [detector] and [polarimeter] of a document; what they leave out is that of `out`.
Result<void> read_instrument_tables(const Node &top, Instrument &out);
/// A key that names an index of refraction, if it is there.
Result<void> read_metal(const Node &node, const char *key, std::string &out);
/// telescope.port, if it is there: a name, or { mirrors = [...], x_from = ... }.
Result<void> read_port(const Node &node, Telescope &out);
/// What it says, as TOML.
std::string port_toml(const Telescope &telescope);
/// [atmosphere] and [observation] behind the air of the site, with the instrument that the document
/// names; absent without [observation].
Result<std::optional<ScenarioObservation>>
read_observation(const Node &top, const std::optional<SiteAir> &air, const std::string &folder);
/// What [observer] says of the air, or [atmosphere]; where neither does, clear air beside
/// [observation] and none without. BadInput where both do. `folder`: of relative paths; `files`
/// gets a table that was read.
Result<std::optional<SiteAir>> read_site_air(const Node &top, const std::filesystem::path &folder,
                                             std::vector<InputFile> &files);
/// `atmosphere` of [observer] as TOML.
std::string clear_air_toml(const SiteAir &air);
/// The tables as TOML, those of the instrument included; [atmosphere] where there is air.
std::string observation_toml(const ScenarioObservation &observation, bool has_air);
/// [telescope], [detector] and [polarimeter].
std::string instrument_tables_toml(const Instrument &instrument);

} // namespace umov::scenario
