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
    return fail(
        ErrorCode::BadInput,
        fmt::format("set holds {}; a name, a table {{ file = \"x.csv\" }}, or a list of both "
                    "was expected",
                    described(item)),
        bands.where("set"));
  return BandEntry{item.value_or(std::string()), {}};
}

Result<std::vector<BandEntry>> read_set(const Node &bands, const fs::path &folder) {
  std::vector<BandEntry> out;
  Problems problems;
  const toml::node &set = *bands.get("set");
  if (const toml::array *list = set.as_array())
    for (const toml::node &item : *list)
      out.push_back(problems.taken(read_entry(bands, item), BandEntry{}));
  else
    out.push_back(problems.taken(read_entry(bands, set), BandEntry{}));
  UMOV_TRY(problems.told());
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

/// What is wrong with each band by itself; `of_all`, where nothing is.
void add_band_problems(const std::vector<BandEntry> &set, const Error &of_all, const Where &set_at,
                       Problems &problems) {
  const auto add = [&](const Error &error) {
    problems.add(error.where.file.empty() ? Error{error.code, error.message, set_at}
                                          : named(error, set_at));
  };
  bool has_one = false;
  for (const BandEntry &entry : set)
    if (const auto one = umov::read_bands({entry}, {}, nullptr); !one) {
      add(one.error());
      has_one = true;
    }
  if (!has_one)
    add(of_all);
}

} // namespace

Result<void> read_bands(const Node &top, const fs::path &folder, Scenario &out) {
  Where set_at = top.where("bands"), system_at = set_at;
  Problems problems;
  if (top.has("bands")) {
    UMOV_ASSIGN(node, top.child("bands"));
    if (node.has("set")) {
      out.band_set = problems.taken(read_set(node, folder), std::move(out.band_set));
      set_at = node.where("set");
    }
    out.magnitudes = problems.taken(read_system(node), out.magnitudes);
    if (node.has("mag_system"))
      system_at = node.where("mag_system");
  }
  std::vector<BandFile> files;
  auto bands = umov::read_bands(out.band_set, {}, &files);
  if (!bands)
    add_band_problems(out.band_set, bands.error(), set_at, problems);
  UMOV_TRY(problems.told());
  out.bands = std::move(*bands);
  for (const BandFile &file : files)
    out.band_files.push_back({file.path, sha256_hex(file.bytes)});
  // Bands of an [observation] stand for these: umov observe asks those, umov run these.
  const toml::table *observation = top.table().get_as<toml::table>("observation");
  if (observation != nullptr && observation->contains("bands"))
    return {};
  for (const Band &band : out.bands)
    if (const auto zero = zero_irradiance(band, out.magnitudes); !zero)
      problems.add({ErrorCode::BadInput, zero.error().message, system_at});
  return problems.told();
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
