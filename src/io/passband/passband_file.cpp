#include <umov/io/passband_file.h>

#include "io/passband/curve_text.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <umov/core/constants.h>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov {
namespace {

using passband::Curve;
using passband::unit_nm;

const char *name_of(DetectorKind kind) {
  return kind == DetectorKind::Photon ? "photon" : "energy";
}

/// What the file says and what is said beside it, together.
Result<PassbandForm> agreed(const PassbandForm &in_file, const PassbandForm &beside,
                            const std::string &file) {
  const std::string unit = beside.unit.empty() ? in_file.unit : beside.unit;
  if (unit.empty())
    return fail(ErrorCode::BadInput,
                "the unit of the wavelengths is not said. Add a line \"# unit: nm\" (or um, "
                "Angstrom), or write { file = \"...\", unit = \"nm\" }.",
                {file});
  if (!(unit_nm(unit) > 0))
    return fail(ErrorCode::BadInput,
                fmt::format("wavelengths in \"{}\"; nm, um or Angstrom was expected",
                            printable(unit.substr(0, 40))),
                {file});
  if (!in_file.unit.empty() && unit_nm(in_file.unit) > 0 && unit_nm(unit) != unit_nm(in_file.unit))
    return fail(ErrorCode::BadInput,
                fmt::format("unit = \"{}\", but the file says {}. Leave the one out that is wrong.",
                            unit, printable(in_file.unit)),
                {file});
  if (!beside.detector && !in_file.detector)
    return fail(ErrorCode::BadInput,
                "whether the curve multiplies photons or energy is not said. Add a line "
                "\"# detector: photon\" (filter times quantum efficiency; energy: a curve for "
                "power), or write { file = \"...\", detector = \"photon\" }.",
                {file});
  if (beside.detector && in_file.detector && beside.detector != in_file.detector)
    return fail(ErrorCode::BadInput,
                fmt::format("detector = \"{}\", but the file says {}. Leave the one out that is "
                            "wrong.",
                            name_of(*beside.detector), name_of(*in_file.detector)),
                {file});
  return PassbandForm{unit, beside.detector ? beside.detector : in_file.detector};
}

/// What can be told of one point, with its line.
Result<void> check_points(const Curve &curve, double unit, const std::string &file) {
  const auto &x = curve.wavelength;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Where at{file, curve.line[i]};
    if (i > 0 && !(x[i] > x[i - 1]))
      return fail(ErrorCode::BadInput,
                  fmt::format("wavelength {:g} follows {:g}; increasing ones were expected. Sort "
                              "them and leave repeated ones out.",
                              x[i], x[i - 1]),
                  at);
    if (!(curve.response[i] >= 0 && curve.response[i] <= 1.5))
      return fail(ErrorCode::BadInput,
                  fmt::format("response {:g}; 0 to 1 was expected.{}", curve.response[i],
                              curve.response[i] > 1.5 ? " Is it in per cent? Divide by 100."
                                                      : " Replace the noise of a blocked range "
                                                        "by 0."),
                  at);
  }
  if (x.back() * unit < 100)
    return fail(ErrorCode::BadInput,
                fmt::format("wavelengths {:g} to {:g}, read as {:g} to {:g} nm; {} Say unit = "
                            "\"{}\" there, and in the file.",
                            x.front(), x.back(), x.front() * unit, x.back() * unit,
                            x.back() < 10 ? "are they micrometres?" : "are they nm?",
                            x.back() < 10 ? "um" : "nm"),
                {file});
  return {};
}

} // namespace

Result<Passband> read_passband_text(const std::string &text, const std::string &file,
                                    const PassbandForm &beside) {
  const bool is_xml = trimmed(std::string_view(text).substr(0, 4096)).starts_with('<') ||
                      text.starts_with("\xef\xbb\xbf<");
  UMOV_ASSIGN(curve,
              is_xml ? passband::read_votable(text, file) : passband::read_columns(text, file));
  UMOV_ASSIGN(form, agreed(curve.form, beside, file));
  const double unit = unit_nm(form.unit);
  UMOV_TRY(check_points(curve, unit, file));
  for (double &x : curve.wavelength)
    x *= unit;
  auto out = make_passband("file:" + std::filesystem::path(file).filename().string(),
                           std::move(curve.wavelength), std::move(curve.response), *form.detector);
  if (!out)
    return fail(ErrorCode::BadInput, out.error().message, {file});
  out->source =
      curve.source.empty() ? std::filesystem::path(file).filename().string() : curve.source;
  if (curve.vega_zero_jy > 0) { // per Hz to per nm at the pivot
    const double light_nm_s = constants::speed_of_light_km_s * 1e12, pivot = pivot_nm(*out);
    out->vega_zero = curve.vega_zero_jy * 1e-26 * light_nm_s / (pivot * pivot);
    out->vega_source = "the file";
  }
  return out;
}

namespace {

/// The last `count` names of a path: "b1/my.dat".
std::string end_of(const std::filesystem::path &path, std::size_t count) {
  std::filesystem::path out = path.filename(), folder = path.parent_path();
  for (std::size_t k = 1; k < count && folder.has_filename(); ++k, folder = folder.parent_path())
    out = folder.filename() / out;
  return out.generic_string();
}

/// Files of one name in several folders: as much of their paths as tells them apart. The same file
/// twice stays the same.
void tell_apart(std::vector<Band> &bands, const std::map<std::size_t, std::string> &paths) {
  for (const auto &[k, path] : paths) {
    std::vector<std::filesystem::path> others;
    for (const auto &[j, other] : paths)
      if (j != k && end_of(other, 1) == end_of(path, 1) && other != path)
        others.emplace_back(other);
    std::size_t count = 1;
    const auto is_like = [&count, &own = path](const std::filesystem::path &other) {
      return end_of(other, count) == end_of(own, count);
    };
    constexpr std::size_t deepest = 100;
    while (count < deepest && std::ranges::any_of(others, is_like))
      ++count;
    if (count == 1)
      continue;
    auto curve = std::make_shared<Passband>(*bands[k].curve);
    bands[k].name = curve->name = "file:" + end_of(path, count);
    bands[k].curve = std::move(curve);
  }
}

} // namespace

Result<std::vector<Band>> read_bands(const std::vector<BandEntry> &entries,
                                     const std::filesystem::path &folder,
                                     std::vector<BandFile> *files) {
  std::vector<Band> out;
  std::map<std::size_t, std::string> paths; // of those that are files
  const auto add = [&out](Passband curve) -> Result<void> {
    UMOV_ASSIGN(band, band_of(std::move(curve)));
    out.push_back(std::move(band));
    return {};
  };
  for (const BandEntry &entry : entries) {
    const std::string &name = entry.name;
    if (name.starts_with("file:")) {
      const std::string path = (folder / name.substr(5)).string();
      UMOV_ASSIGN(text, read_file(path, 16u << 20));
      UMOV_ASSIGN(curve, read_passband_text(text, path, entry.form));
      paths[out.size()] = path;
      UMOV_TRY(add(std::move(curve)));
      if (files != nullptr)
        files->push_back({path, std::move(text)});
    } else if (name == "paper_rgb" || name.starts_with("nm:")) {
      UMOV_ASSIGN(wavelengths, bands_from({name}));
      out.insert(out.end(), wavelengths.begin(), wavelengths.end());
    } else {
      auto members = passband_group(name);
      if (members.empty())
        members.push_back(name);
      for (const std::string &one : members) {
        UMOV_ASSIGN(curve, find_passband(one));
        UMOV_TRY(add(std::move(curve)));
      }
    }
  }
  tell_apart(out, paths);
  UMOV_TRY(check_band_set(out));
  return out;
}

Result<std::vector<Band>> bands_named(const std::vector<std::string> &names) {
  std::vector<BandEntry> entries;
  entries.reserve(names.size());
  for (const std::string &name : names)
    entries.push_back({name, {}});
  return read_bands(entries);
}

} // namespace umov
