// The curves of data/filters, and Gaussians about the paper's wavelengths.

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/embedded.h>
#include <umov/core/text.h>
#include <umov/io/passband_file.h>

UMOV_EMBEDDED(filter_names)

namespace umov {

const std::vector<EmbeddedFile> &filter_curves_files();

namespace {

/// A row of data/filters/bands.csv; its form is fixed, so there is nothing to report.
struct Known {
  std::string name, stem;
  double vega_zero = 0;
  std::string vega_source;
};

std::vector<Known> read_names() {
  std::vector<Known> out;
  std::string_view text = filter_names();
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const auto cells = line.starts_with('#') ? std::nullopt : csv_cells(line);
    if (cells && cells->size() == 4 && parse_number((*cells)[2].text))
      out.push_back(
          {(*cells)[0].text, (*cells)[1].text, *parse_number((*cells)[2].text), (*cells)[3].text});
  }
  return out;
}

const std::vector<Known> &known() {
  static const std::vector<Known> table = read_names();
  return table;
}

/// What a name has before its point.
std::string group_of(const std::string &name) { return name.substr(0, name.find('.')); }

constexpr std::array wide_centres_nm{425, 550, 650};

Result<Passband> curve_of(const Known &one) {
  for (const EmbeddedFile &file : filter_curves_files())
    if (one.stem == file.stem) {
      UMOV_ASSIGN(out,
                  read_passband_text(std::string(file.bytes), "data/filters/" + one.stem + ".ecsv",
                                     {"", DetectorKind::Photon}));
      out.name = one.name;
      out.vega_zero = one.vega_zero;
      out.vega_source = one.vega_source;
      return std::move(out);
    }
  return fail(ErrorCode::Internal, one.stem + ": not compiled in");
}

/// What was meant by an unknown name: other capitals, a letter alone or of another system, letters
/// in a row, a wavelength, a slip.
std::string suggestion(const std::string &name) {
  if (const std::string digits = name.substr(0, name.find_first_not_of("0123456789."));
      !digits.empty() &&
      (digits.size() == name.size() || lowered(name.substr(digits.size())) == "nm"))
    return fmt::format(" Did you mean \"nm:{}\"?", digits);
  if (name.size() > 1 && name.find_first_not_of("UBVRI") == std::string::npos) {
    std::vector<std::string> each;
    for (const char letter : name)
      each.push_back(fmt::format("\"Bessell.{}\"", letter));
    return fmt::format(" Did you mean [{}]?", fmt::join(each, ", "));
  }
  std::vector<std::string> names = passband_names(), alike;
  const std::string letter = name.substr(name.rfind('.') + 1);
  for (const std::string &one : names) {
    for (const std::string &known_as : {one, group_of(one)})
      if (lowered(known_as) == lowered(name))
        return fmt::format(" Did you mean \"{}\"?", known_as);
    if (one.substr(one.find('.') + 1) == letter)
      alike.push_back(fmt::format("\"{}\"", one));
  }
  const auto near = nearest_name(name, names);
  if (!alike.empty() && (name.find('.') == std::string::npos || !near))
    return fmt::format(" Did you mean {}?", fmt::join(alike, " or "));
  return near ? fmt::format(" Did you mean \"{}\"?", *near) : "";
}

} // namespace

std::vector<std::string> passband_names() {
  std::vector<std::string> out;
  for (const Known &one : known())
    out.push_back(one.name);
  for (const int nm : wide_centres_nm)
    out.push_back(fmt::format("rgb_wide.{}", nm));
  return out;
}

std::vector<std::string> passband_group(const std::string &name) {
  std::vector<std::string> out;
  for (const std::string &one : passband_names())
    if (group_of(one) == name)
      out.push_back(one);
  return out;
}

Result<Passband> find_passband(const std::string &name) {
  for (const Known &one : known())
    if (name == one.name || name == one.stem)
      return curve_of(one);
  for (const int nm : wide_centres_nm)
    if (name == fmt::format("rgb_wide.{}", nm)) {
      Passband out = gaussian_passband(name, nm, 80);
      out.source = "a Gaussian of 80 nm full width about a wavelength of the paper: an assumption";
      return out;
    }
  return fail(ErrorCode::BadInput,
              fmt::format("unknown band \"{}\".{} A wavelength is written \"nm:550\", a file of "
                          "one's own \"file:x.vot\". Known: umov bands list.",
                          printable(name), suggestion(name)));
}

} // namespace umov
