// [bands] of a scenario.

#include "io/scenario/parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov::scenario {
namespace {

namespace fs = std::filesystem;

/// { file = "x.csv", unit = "nm", detector = "photon" }
Result<BandEntry> read_file_entry(const Node &node) {
  UMOV_TRY(node.check());
  UMOV_TRY(node.require("file"));
  BandEntry out{"file:" + node.text("file", ""), {}};
  if (node.has("unit")) {
    UMOV_ASSIGN(unit, node.choice("unit", "nm", {"nm", "um", "Angstrom"}));
    out.form.unit = unit;
  }
  if (node.has("detector")) {
    UMOV_ASSIGN(kind, node.choice("detector", "photon", {"photon", "energy"}));
    out.form.detector = kind == "photon" ? DetectorKind::Photon : DetectorKind::Energy;
  }
  return out;
}

/// One item of the set, or the set where it is none.
Result<BandEntry> read_entry(const Node &bands, const toml::node &item) {
  if (const toml::table *table = item.as_table())
    return read_file_entry(Node(*table, "bands.set", "bands.set", bands.file()));
  if (const auto number = item.value<double>(); number && !item.is_string())
    return fail(ErrorCode::BadInput,
                fmt::format("set holds the number {0:g}; bands are names, a wavelength among them "
                            "is written \"nm:{0:g}\"",
                            *number),
                bands.where("set"));
  if (!item.is_string())
    return fail(ErrorCode::BadInput,
                "set: a name, a table { file = \"x.csv\" }, or a list of both was expected",
                bands.where("set"));
  return BandEntry{item.value_or(std::string()), {}};
}

Result<std::vector<BandEntry>> read_set(const Node &bands, const fs::path &folder) {
  std::vector<BandEntry> out;
  const toml::node &set = *bands.get("set");
  if (const toml::array *list = set.as_array()) {
    for (const toml::node &item : *list) {
      UMOV_ASSIGN(entry, read_entry(bands, item));
      out.push_back(std::move(entry));
    }
  } else {
    UMOV_ASSIGN(entry, read_entry(bands, set));
    out.push_back(std::move(entry));
  }
  for (BandEntry &entry : out)
    if (entry.name.starts_with("file:"))
      entry.name = "file:" + tidy_path(folder / entry.name.substr(5)).string();
  return out;
}

Result<MagnitudeSystem> read_system(const Node &bands) {
  UMOV_ASSIGN(name, bands.choice("mag_system", "AB", {"AB", "ST", "Vega"}));
  return name == "ST"     ? MagnitudeSystem::ST
         : name == "Vega" ? MagnitudeSystem::Vega
                          : MagnitudeSystem::AB;
}

} // namespace

Result<void> read_bands(const Node &top, const fs::path &folder, Scenario &out) {
  Where set_at = top.where("bands"), system_at = set_at;
  if (top.has("bands")) {
    UMOV_ASSIGN(node, top.child("bands"));
    if (node.has("set")) {
      UMOV_ASSIGN(set, read_set(node, folder));
      out.band_set = std::move(set);
      set_at = node.where("set");
    }
    UMOV_ASSIGN(system, read_system(node));
    out.magnitudes = system;
    if (node.has("mag_system"))
      system_at = node.where("mag_system");
  }
  std::vector<BandFile> files;
  auto bands = umov::read_bands(out.band_set, {}, &files);
  if (!bands && !bands.error().where.file.empty())
    return tl::unexpected(named(bands.error(), set_at));
  if (!bands)
    return fail(bands.error().code, bands.error().message, set_at);
  out.bands = std::move(*bands);
  for (const BandFile &file : files)
    out.band_files.push_back({file.path, sha256_hex(file.bytes)});
  // Bands of an [observation] stand for these: umov observe asks those, umov run these.
  const toml::table *observation = top.table().get_as<toml::table>("observation");
  if (observation != nullptr && observation->contains("bands"))
    return {};
  for (const Band &band : out.bands)
    if (const auto zero = zero_irradiance(band, out.magnitudes); !zero)
      return fail(ErrorCode::BadInput, zero.error().message, system_at);
  return {};
}

std::string bands_toml(const Scenario &of) {
  std::vector<std::string> items;
  for (const BandEntry &entry : of.band_set) {
    const bool is_file = entry.name.starts_with("file:");
    std::string name = entry.name;
    if (is_file) {
      std::error_code code;
      const auto full = fs::absolute(entry.name.substr(5), code);
      name = code ? entry.name.substr(5) : tidy_path(full).string();
    }
    std::string more;
    if (!entry.form.unit.empty())
      more += fmt::format(", unit = \"{}\"", entry.form.unit);
    if (entry.form.detector)
      more += fmt::format(", detector = \"{}\"",
                          *entry.form.detector == DetectorKind::Photon ? "photon" : "energy");
    const std::string text = scenario::quoted(name);
    items.push_back(is_file ? fmt::format("{{ file = {}{} }}", text, more) : text);
  }
  return fmt::format("\n[bands]\nset = [{}]\nmag_system = \"{}\"\n", fmt::join(items, ", "),
                     name_of(of.magnitudes));
}

} // namespace umov::scenario

namespace umov {

Result<void> check_magnitudes(const Scenario &scenario) {
  for (const Band &band : scenario.bands)
    if (const auto zero = zero_irradiance(band, scenario.magnitudes); !zero)
      return fail(ErrorCode::BadInput,
                  zero.error().message + ", or bands that have one in [bands] set: those of "
                                         "observation.bands are for umov observe alone",
                  scenario.place("bands.mag_system"));
  return {};
}

} // namespace umov
