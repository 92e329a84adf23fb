#include "io/scenario/instrument.h"
#include "io/scenario/parse_toml.h"

#include "io/scenario/parts.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/embedded.h>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov {

const std::vector<EmbeddedFile> &instrument_files();

namespace scenario {

Result<void> read_number(const Node &node, const char *name, const Bounds &bounds, double &out) {
  if (!node.has(name))
    return {};
  const double value = node.number(name, out);
  if (!(value >= bounds.low && value <= bounds.high))
    return tl::unexpected(wrong_value(node, name, value, bounds.what));
  out = value;
  return {};
}

namespace {

constexpr Bounds positive{1e-12, 1e12, "a number above 0"};

/// A number, or { wavelength_nm = [...], value = [...] }.
Result<void> read_curve(const Node &node, const char *name, const Bounds &bounds, Tabulated &out) {
  if (!node.has(name))
    return {};
  const toml::node &value = *node.get(name);
  Tabulated found;
  if (const toml::table *table = value.as_table()) {
    const Node below(*table, "curve", node.label() + "." + name, node.file());
    UMOV_TRY(below.check());
    UMOV_TRY(below.require("wavelength_nm"));
    UMOV_TRY(below.require("value"));
    UMOV_ASSIGN(nm, below.numbers("wavelength_nm"));
    UMOV_ASSIGN(values, below.numbers("value"));
    found = {nm, values};
    if (auto fine = check_tabulated(found, name); !fine)
      return fail(ErrorCode::BadInput, fine.error().message, node.where(name));
  } else if (value.is_number()) {
    found = {{}, {node.number(name, 0)}};
  } else {
    return fail(ErrorCode::BadInput,
                fmt::format("{}: a number or {{ wavelength_nm = [...], value = [...] }} was "
                            "expected",
                            name),
                node.where(name));
  }
  for (const double one : found.value)
    if (!(one >= bounds.low && one <= bounds.high))
      return fail(ErrorCode::BadInput,
                  fmt::format("{} holds {}; {} was expected", name, one, bounds.what),
                  node.where(name));
  out = std::move(found);
  return {};
}

/// Lengths that are of another unit: no focal ratio is under a quarter or in the hundreds.
Result<void> check_focal_ratio(const Node &node, const Telescope &t) {
  if (!(t.aperture_m > 0 && t.focal_length_m > 0))
    return {};
  const double ratio = t.focal_length_m / t.aperture_m;
  if (ratio >= 0.25 && ratio <= 300)
    return {};
  return fail(
      ErrorCode::BadInput,
      fmt::format("focal_length_m = {} with aperture_m = {} is f/{:.3g}; both are in metres: "
                  "is one of them in mm?",
                  t.focal_length_m, t.aperture_m, ratio),
      node.where(node.has("focal_length_m") ? "focal_length_m" : "aperture_m"));
}

constexpr const char *tracking_names[] = {"satellite", "sidereal", "fixed"};

Result<void> read_tracking(const Node &node, Telescope &out) {
  const auto &names = tracking_names;
  UMOV_ASSIGN(tracking, node.choice("tracking", names[static_cast<int>(out.tracking)],
                                    {names[0], names[1], names[2]}));
  out.tracking = static_cast<Tracking>(std::find(names, names + 3, tracking) - names);
  return read_number(node, "tracking_error_arcsec", {0, 1e5, "0 to 100000 seconds of arc"},
                     out.tracking_error_arcsec);
}

Result<void> read_throughput(const Node &node, Telescope &out) {
  UMOV_TRY(read_curve(node, "throughput", {0, 1, "0 to 1"}, out.throughput));
  if (std::ranges::max(out.throughput.value) > 0)
    return {};
  return fail(ErrorCode::BadInput,
              "throughput is 0: no light comes through; a share above 0, up to 1, was expected",
              node.where("throughput"));
}

/// What turns with what.
Result<void> read_mount(const Node &node, Telescope &out) {
  UMOV_ASSIGN(mount, node.choice("mount", out.mount == Mount::AltAz ? "altaz" : "equatorial",
                                 {"altaz", "equatorial"}));
  out.mount = mount == "altaz" ? Mount::AltAz : Mount::Equatorial;
  out.has_derotator = node.boolean("derotator", out.has_derotator);
  Problems problems;
  if (out.mount == Mount::Equatorial && out.has_derotator)
    problems.add({ErrorCode::BadInput,
                  "derotator = true on an equatorial mount, on which no field turns: leave it out, "
                  "or give mount = \"altaz\"",
                  node.where(node.has("derotator") ? "derotator" : "mount")});
  if (out.mount == Mount::Equatorial && out.port != TelescopePort::Cassegrain)
    problems.add({ErrorCode::BadInput,
                  fmt::format("port = {} on an equatorial mount: a Nasmyth port lies on the "
                              "altitude axis of an altaz one, and so do the mirrors of a train",
                              port_toml(out)),
                  node.where(node.has("port") ? "port" : "mount")});
  return problems.told();
}

Result<void> read_telescope(const Node &node, Telescope &out) {
  Problems problems;
  const bool has_sizes =
      problems.went(read_number(node, "aperture_m",
                                {1e-12, 60, "a number above 0, up to 60 m (is it in mm?)"},
                                out.aperture_m)) &
      problems.went(read_number(node, "focal_length_m",
                                {1e-12, 1000, "a number above 0, up to 1000 m (is it in mm?)"},
                                out.focal_length_m));
  if (has_sizes)
    problems.went(check_focal_ratio(node, out));
  problems.went(read_number(node, "obstruction", {0, .999999, "0 to below 1"}, out.obstruction));
  problems.went(read_throughput(node, out));
  problems.went(read_port(node, out));
  problems.went(read_metal(node, "mirror", out.mirror));
  problems.went(read_mount(node, out));
  problems.went(read_tracking(node, out));
  return problems.told();
}

Result<void> read_shutter(const Node &node, Detector &out) {
  UMOV_ASSIGN(shutter, node.choice("shutter", out.has_rolling_shutter ? "rolling" : "global",
                                   {"global", "rolling"}));
  out.has_rolling_shutter = shutter == "rolling";
  UMOV_TRY(read_number(node, "line_time_s", positive, out.line_time_s));
  if (out.has_rolling_shutter && !(out.line_time_s > 0))
    return fail(ErrorCode::BadInput,
                "shutter = \"rolling\" without line_time_s; add the time from row to row",
                node.where("shutter"));
  if (node.has("line_time_s") && !out.has_rolling_shutter)
    return fail(ErrorCode::BadInput,
                fmt::format("line_time_s = {} with shutter = \"global\": all rows begin at once; "
                            "leave it out, or give shutter = \"rolling\"",
                            out.line_time_s),
                node.where("line_time_s"));
  return {};
}

/// Keys of one model alone.
void check_model(const Node &node, const Detector &d, Problems &problems) {
  const auto add = [&](const std::string &text, const char *name) {
    problems.add({ErrorCode::BadInput, text, node.where(name)});
  };
  if (d.model == DetectorModel::Emccd && !(d.em_gain > 1))
    add("an emccd needs em_gain above 1, that of its register; without one it is a ccd",
        node.has("em_gain") ? "em_gain" : "model");
  if (node.has("em_gain") && d.model != DetectorModel::Emccd && d.em_gain != 1)
    add(fmt::format("em_gain = {} with model = \"{}\"; only an emccd multiplies", d.em_gain,
                    name_of(d.model)),
        "em_gain");
  if (node.has("dead_time_s") && d.model != DetectorModel::Counter && d.dead_time_s != 0)
    add(fmt::format("dead_time_s = {} with model = \"{}\"; only a counter is dead after a photon",
                    d.dead_time_s, name_of(d.model)),
        "dead_time_s");
  if (d.is_paralyzable && !(d.dead_time_s > 0))
    add("paralyzable = true without a dead time; a counter with dead_time_s was expected",
        "paralyzable");
  if (const double last = std::exp2(d.bits) - 1; has_converter(d) && d.bias_adu >= last)
    add(fmt::format("bias_adu = {} with bits = {}: the largest number is {:g}, which leaves "
                    "nothing for light",
                    d.bias_adu, d.bits, last),
        node.has("bias_adu") ? "bias_adu"
        : node.has("bits")   ? "bits"
                             : "model");
}

Result<void> read_size(const Node &node, Detector &out) {
  if (!node.has("size_px"))
    return {};
  UMOV_ASSIGN(size, node.numbers("size_px"));
  const auto fits = [](double x) { return x >= 1 && x <= 1e5 && x == std::floor(x); };
  if (size.size() != 2 || !fits(size[0]) || !fits(size[1]))
    return fail(ErrorCode::BadInput,
                fmt::format("size_px = {}; [columns, rows], two whole numbers of 1 to 100000, was "
                            "expected",
                            list_toml(size)),
                node.where("size_px"));
  out.size_px = {static_cast<int>(size[0]), static_cast<int>(size[1])};
  return {};
}

Result<void> read_detector(const Node &node, Detector &out) {
  Problems problems;
  const auto &names = detector_names();
  const auto model = problems.taken(node.choice("model", name_of(out.model), names), std::string());
  const auto known = std::find(names.begin(), names.end(), model);
  if (known != names.end())
    out.model = static_cast<DetectorModel>(known - names.begin());
  const auto number = [&](const char *name, const Bounds &bounds, double &value) {
    problems.went(read_number(node, name, bounds, value));
  };
  number("pixel_um", {0.1, 1e4, "0.1 to 10000 um (is it in mm or m?)"}, out.pixel_um);
  number("read_e", {0, 1e4, "0 to 10000 electrons of a pixel (cameras have 1 to 100)"}, out.read_e);
  number("dark_e_s", {0, 1e7, "0 to 10000000 electrons a second"}, out.dark_e_s);
  number("gain_e_adu", {1e-12, 1e6, "a number above 0, up to 1000000"}, out.gain_e_adu);
  number("bias_adu", {0, 1e9, "0 to 1000000000"}, out.bias_adu);
  number("well_e", {0, 1e12, "0 or more"}, out.well_e);
  number("nonlinearity", {0, .25, "0 to 0.25"}, out.nonlinearity);
  number("em_gain", {1, 1e5, "1 to 100000"}, out.em_gain);
  number("dead_time_s", {0, 1, "0 to 1"}, out.dead_time_s);
  out.is_paralyzable = node.boolean("paralyzable", out.is_paralyzable);
  const auto bits = node.integer("bits", out.bits);
  if (bits < 1 || bits > 32)
    problems.add(wrong_value(node, "bits", bits, "1 to 32"));
  else
    out.bits = static_cast<int>(bits);
  if (!problems.has_some()) // of values that are good each by itself
    check_model(node, out, problems);
  problems.went(read_size(node, out));
  problems.went(read_shutter(node, out));
  return problems.told();
}

Result<void> read_layout(const Node &node, Polarimeter &out) {
  if (node.has("angles_deg")) {
    UMOV_ASSIGN(angles, node.numbers("angles_deg"));
    out.angles_deg = angles;
  }
  if (!node.has("layout"))
    return {};
  std::vector<double> angles;
  const toml::array &rows = *node.get("layout")->as_array();
  bool is_square = rows.size() == 2;
  for (const toml::node &row : rows) {
    const toml::array *cells = row.as_array();
    is_square = is_square && cells != nullptr && cells->size() == 2;
    if (cells != nullptr)
      for (const toml::node &cell : *cells)
        if (const auto angle = cell.value<double>())
          angles.push_back(*angle);
  }
  std::vector<double> sorted = angles;
  for (double &angle : sorted)
    angle = std::fmod(std::fmod(angle, 180) + 180, 180);
  std::sort(sorted.begin(), sorted.end());
  const bool is_fine = is_square && sorted.size() == 4 && sorted[0] != sorted[1] &&
                       sorted[1] != sorted[2] && sorted[2] != sorted[3];
  if (!is_fine)
    return fail(ErrorCode::BadInput,
                fmt::format("layout holds the angles {}; two rows of two were expected, all four "
                            "different (180 deg is 0), as [[90, 45], [135, 0]]",
                            fmt::join(angles, ", ")),
                node.where("layout"));
  out.angles_deg = angles;
  return {};
}

Result<void> check_polarimeter(const Node &node, const Polarimeter &p, bool has_axis) {
  const auto fault = [&](const std::string &text) {
    return fail(ErrorCode::BadInput, text, node.where("type"));
  };
  if (p.type == PolarimeterType::Mosaic && p.angles_deg.size() != 4)
    return fault("a mosaic needs its layout: makers' sheets disagree. Add layout = [[90, 45], "
                 "[135, 0]] as your camera has it");
  if (p.type == PolarimeterType::FourCamera && p.angles_deg.size() < 3)
    return fault("four_camera needs angles_deg, three or more analysers");
  if (p.type == PolarimeterType::SpinningHwpDualBeam && !(p.period_s > 0))
    return fault("spinning_hwp_dual_beam needs period_s, of a turn of the plate");
  if (p.type != PolarimeterType::None && !has_axis)
    return fault("a polarimeter without x_axis_deg: which way it stands is not known. Add the "
                 "angle of its x axis, counter-clockwise from the zenith direction (altaz) or "
                 "from north (equatorial)");
  return {};
}

/// Keys of [polarimeter] that say something to a type.
bool says_something(const std::string &key, PolarimeterType type) {
  if (key == "layout")
    return type == PolarimeterType::Mosaic;
  if (key == "angles_deg" || key == "pupils")
    return type == PolarimeterType::FourCamera;
  if (key == "retardance_deg" || key == "plate_zero_deg")
    return has_plate(type);
  if (key == "period_s")
    return type == PolarimeterType::SpinningHwpDualBeam;
  return type != PolarimeterType::None;
}

/// What is given and not used is a slip: of the key, or of the type.
void add_idle_keys(const Node &node, PolarimeterType type, Problems &problems) {
  for (const char *key : {"layout", "angles_deg", "pupils", "retardance_deg", "plate_zero_deg",
                          "period_s", "extinction", "q0", "u0"})
    if (node.has(key) && !says_something(key, type))
      problems.add({ErrorCode::BadInput,
                    fmt::format("{} says nothing to a polarimeter of type \"{}\"; leave it out, or "
                                "give the type that has it",
                                key, name_of(type)),
                    node.where(key)});
}

/// Own polarization of the instrument.
Result<void> read_own(const Node &node, Polarimeter &out) {
  Problems problems;
  problems.went(read_number(node, "q0", {-1, 1, "-1 to 1"}, out.q0));
  problems.went(read_number(node, "u0", {-1, 1, "-1 to 1"}, out.u0));
  if (std::hypot(out.q0, out.u0) > 1)
    problems.add({ErrorCode::BadInput,
                  fmt::format("q0 = {}, u0 = {}: together they polarize by {:.3g}; at most 1 was "
                              "expected",
                              out.q0, out.u0, std::hypot(out.q0, out.u0)),
                  node.where(node.has("q0") ? "q0" : "u0")});
  return problems.told();
}

Result<void> read_polarimeter(const Node &node, bool is_whole, Polarimeter &out) {
  const auto &names = polarimeter_names();
  UMOV_ASSIGN(type, node.choice("type", name_of(out.type), names));
  out.type =
      static_cast<PolarimeterType>(std::find(names.begin(), names.end(), type) - names.begin());
  Problems problems;
  const auto number = [&](const char *name, const Bounds &bounds, double &value) {
    problems.went(read_number(node, name, bounds, value));
  };
  add_idle_keys(node, out.type, problems);
  problems.went(read_layout(node, out));
  problems.went(read_curve(node, "extinction", {1, 1e12, "more than 1"}, out.extinction));
  problems.went(read_curve(node, "retardance_deg", {-720, 720, "-720 to 720"}, out.retardance_deg));
  number("plate_zero_deg", {-360, 360, "-360 to 360"}, out.plate_zero_deg);
  number("period_s", positive, out.period_s);
  number("x_axis_deg", {-360, 360, "-360 to 360"}, out.x_axis_deg);
  problems.went(read_own(node, out));
  const auto pupils =
      problems.taken(node.choice("pupils", out.has_separate_pupils ? "separate" : "common",
                                 {"common", "separate"}),
                     std::string());
  out.has_separate_pupils = pupils == "separate";
  if (!problems.has_some())
    problems.went(check_polarimeter(node, out, is_whole || node.has("x_axis_deg")));
  return problems.told();
}

std::string curve_toml(const Tabulated &curve) {
  if (curve.wavelength_nm.empty())
    return shortest(curve.value.front());
  return fmt::format("{{ wavelength_nm = {}, value = {} }}", list_toml(curve.wavelength_nm),
                     list_toml(curve.value));
}

std::string polarimeter_toml(const Polarimeter &p) {
  std::string out = fmt::format("\n[polarimeter]\ntype = \"{}\"\n", name_of(p.type));
  const auto put = [&](const char *key, const std::string &value) {
    if (says_something(key, p.type))
      out += fmt::format("{} = {}\n", key, value);
  };
  const auto &a = p.angles_deg;
  if (p.type == PolarimeterType::Mosaic)
    put("layout", fmt::format("[[{}, {}], [{}, {}]]", shortest(a[0]), shortest(a[1]),
                              shortest(a[2]), shortest(a[3])));
  put("angles_deg", list_toml(a));
  if (std::isfinite(p.extinction.value.front()))
    put("extinction", curve_toml(p.extinction));
  put("retardance_deg", curve_toml(p.retardance_deg));
  put("plate_zero_deg", shortest(p.plate_zero_deg));
  put("period_s", shortest(p.period_s));
  put("pupils", p.has_separate_pupils ? "\"separate\"" : "\"common\"");
  put("x_axis_deg", shortest(p.x_axis_deg));
  put("q0", shortest(p.q0));
  put("u0", shortest(p.u0));
  return out;
}

} // namespace

Result<void> read_instrument_tables(const Node &top, Instrument &out) {
  const bool is_whole = !out.name.empty();
  Problems problems;
  if (top.has("telescope")) {
    UMOV_ASSIGN(node, top.child("telescope"));
    problems.went(read_telescope(node, out.telescope));
  }
  if (top.has("detector")) {
    UMOV_ASSIGN(node, top.child("detector"));
    problems.went(read_detector(node, out.detector));
  }
  if (top.has("polarimeter")) {
    UMOV_ASSIGN(node, top.child("polarimeter"));
    problems.went(read_polarimeter(node, is_whole, out.polarimeter));
  }
  return problems.told();
}

std::string instrument_tables_toml(const Instrument &i) {
  const Telescope &t = i.telescope;
  const Detector &d = i.detector;
  std::string out = fmt::format(
      "\n[telescope]\naperture_m = {}\nobstruction = {}\nfocal_length_m = {}\nthroughput = {}\n"
      "port = {}\nmirror = {}\nmount = \"{}\"\nderotator = {}\ntracking = \"{}\"\n"
      "tracking_error_arcsec = {}\n",
      shortest(t.aperture_m), shortest(t.obstruction), shortest(t.focal_length_m),
      curve_toml(t.throughput), port_toml(t), quoted(t.mirror),
      t.mount == Mount::AltAz ? "altaz" : "equatorial", t.has_derotator,
      tracking_names[static_cast<int>(t.tracking)], shortest(t.tracking_error_arcsec));
  out += fmt::format(
      "\n[detector]\nmodel = \"{}\"\npixel_um = {}\n{}"
      "read_e = {}\ndark_e_s = {}\ngain_e_adu = {}\nbits = {}\nbias_adu = {}\n"
      "well_e = {}\nnonlinearity = {}\nshutter = \"{}\"\n",
      name_of(d.model), shortest(d.pixel_um),
      d.size_px[0] > 0 ? fmt::format("size_px = [{}, {}]\n", d.size_px[0], d.size_px[1]) : "",
      shortest(d.read_e), shortest(d.dark_e_s), shortest(d.gain_e_adu), d.bits,
      shortest(d.bias_adu), shortest(d.well_e), shortest(d.nonlinearity),
      d.has_rolling_shutter ? "rolling" : "global");
  if (d.has_rolling_shutter)
    out += fmt::format("line_time_s = {}\n", shortest(d.line_time_s));
  if (d.em_gain != 1)
    out += fmt::format("em_gain = {}\n", shortest(d.em_gain));
  if (d.dead_time_s > 0)
    out += fmt::format("dead_time_s = {}\nparalyzable = {}\n", shortest(d.dead_time_s),
                       d.is_paralyzable);
  return out + polarimeter_toml(i.polarimeter);
}

} // namespace scenario

std::vector<std::string> instrument_names() {
  std::vector<std::string> out;
  for (const EmbeddedFile &file : instrument_files())
    out.emplace_back(file.stem);
  std::sort(out.begin(), out.end());
  return out;
}

Result<Instrument> read_instrument_text(const std::string &text, const std::string &path) {
  UMOV_ASSIGN(document, scenario::parse_toml(text, path));
  const scenario::Node top(document, "instrument_file", "", path);
  UMOV_TRY(top.check());
  for (const char *name : {"description", "source", "assumed", "telescope", "detector"})
    UMOV_TRY(top.require(name));
  Instrument out;
  const std::filesystem::path file = path;
  out.description = top.text("description", "");
  out.source = top.text("source", "");
  out.assumed = top.text("assumed", "");
  const scenario::Node tables(document, "", "", path);
  UMOV_TRY(scenario::read_instrument_tables(tables, out));
  for (const auto &[table, key] : {std::pair{"telescope", "aperture_m"},
                                   {"telescope", "focal_length_m"},
                                   {"detector", "pixel_um"}}) {
    UMOV_ASSIGN(node, tables.child(table));
    UMOV_TRY(node.require(key));
  }
  out.name = file.stem().string();
  return out;
}

Result<Instrument> read_instrument(const std::string &name_or_path) {
  if (name_or_path.ends_with(".toml")) {
    UMOV_ASSIGN(text, read_file(name_or_path));
    return read_instrument_text(text, name_or_path);
  }
  for (const EmbeddedFile &file : instrument_files())
    if (name_or_path == file.stem)
      return read_instrument_text(std::string(file.bytes),
                                  "data/instruments/" + name_or_path + ".toml");
  const auto near = nearest_name(name_or_path, instrument_names());
  return fail(ErrorCode::BadInput,
              fmt::format("unknown instrument \"{}\".{} Known: umov instrument list.", name_or_path,
                          near ? fmt::format(" Did you mean \"{}\"?", *near) : ""));
}

std::string instrument_as_toml(const Instrument &i) {
  return fmt::format("description = {}\nsource = {}\nassumed = {}\n",
                     scenario::quoted(i.description), scenario::quoted(i.source),
                     scenario::quoted(i.assumed)) +
         scenario::instrument_tables_toml(i);
}

} // namespace umov
