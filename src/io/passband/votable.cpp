// VOTables of the SVO Filter Profile Service (Rodrigo, Solano & Bayo 2012): parameters of the
// filter, and a table of wavelength and transmission. pugixml knows no entities but the five of
// XML, so a document type has nothing to offer here and is refused.

#include "io/ccsds/xml_open.h"
#include "io/passband/curve_text.h"

#include <fmt/format.h>
#include <pugixml.hpp>
#include <umov/core/text.h>

namespace umov::passband {
namespace {

/// The name of an element without its namespace.
std::string_view local_name(pugi::xml_node node) {
  const std::string_view name = node.name();
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// The first element of a name below a node, down to the depth of a VOTable.
pugi::xml_node first_below(pugi::xml_node node, std::string_view name, int depth = 0) {
  constexpr int deepest = 8;
  for (const pugi::xml_node child : node.children()) {
    if (local_name(child) == name)
      return child;
    if (depth < deepest)
      if (const pugi::xml_node found = first_below(child, name, depth + 1))
        return found;
  }
  return {};
}

struct Reader {
  const std::string &file;
  const XmlLines &lines;

  [[nodiscard]] tl::unexpected<Error> problem(pugi::xml_node node, const std::string &text) const {
    return fail(ErrorCode::BadInput, text, {file, lines.of(node.offset_debug())});
  }
};

/// What the parameters of the table say; others are none of our business.
Result<void> take_parameters(const Reader &reader, pugi::xml_node table, Curve &out) {
  std::string system, zero_unit;
  double zero = 0;
  for (const pugi::xml_node node : table.children()) {
    if (local_name(node) != "PARAM")
      continue;
    const std::string_view name = node.attribute("name").value();
    const std::string value(trimmed(node.attribute("value").value()));
    if (name == "filterID") {
      out.source = "SVO Filter Profile Service, " + printable(value.substr(0, 100));
    } else if (name == "WavelengthUnit") {
      out.form.unit = value;
    } else if (name == "DetectorType") {
      if (value != "0" && value != "1" && value != "energy" && value != "photon")
        return reader.problem(
            node, fmt::format("DetectorType \"{}\"; 0 (energy) or 1 (photon) was expected",
                              printable(value.substr(0, 40))));
      out.form.detector =
          value == "1" || value == "photon" ? DetectorKind::Photon : DetectorKind::Energy;
    } else if (name == "MagSys") {
      system = value;
    } else if (name == "ZeroPoint") {
      const auto number = parse_number(value);
      if (!number || !(*number > 0))
        return reader.problem(node, fmt::format("ZeroPoint \"{}\"; a positive number was expected",
                                                printable(value.substr(0, 40))));
      zero = *number;
      if (const std::string unit = node.attribute("unit").value(); !unit.empty())
        zero_unit = unit;
    } else if (name == "ZeroPointUnit") {
      zero_unit = value;
    }
  }
  if (system == "Vega" && zero_unit == "Jy")
    out.vega_zero_jy = zero;
  return {};
}

Result<void> take_rows(const Reader &reader, pugi::xml_node rows, Curve &out) {
  for (const pugi::xml_node row : rows.children()) {
    if (local_name(row) != "TR")
      continue;
    std::vector<std::optional<double>> cells;
    for (const pugi::xml_node cell : row.children())
      if (local_name(cell) == "TD")
        cells.push_back(parse_number(trimmed(cell.child_value())));
    if (cells.size() != 2 || !cells[0] || !cells[1])
      return reader.problem(row, "a row <TR> without two numbers <TD>: wavelength and "
                                 "transmission were expected");
    out.wavelength.push_back(*cells[0]);
    out.response.push_back(*cells[1]);
    out.line.push_back(reader.lines.of(row.offset_debug()));
  }
  if (out.wavelength.empty())
    return reader.problem(rows, "<TABLEDATA> has no row <TR>");
  return {};
}

} // namespace

Result<Curve> read_votable(const std::string &text, const std::string &file) {
  pugi::xml_document document;
  const XmlLines lines(text);
  UMOV_TRY(open_xml(text, file, lines, document));
  const Reader reader{file, lines};
  const pugi::xml_node root = document.document_element();
  const pugi::xml_node table = first_below(root, "TABLE");
  if (local_name(root) != "VOTABLE" || !table)
    return reader.problem(root, "no <TABLE> in a <VOTABLE>; one of the SVO Filter Profile Service "
                                "was expected");
  const pugi::xml_node rows = first_below(table, "TABLEDATA");
  if (!rows)
    return reader.problem(table, "the table has no <TABLEDATA>; other forms of its rows are not "
                                 "read. Save it as TABLEDATA.");
  Curve out;
  for (const pugi::xml_node node : table.children())
    if (local_name(node) == "FIELD" && out.form.unit.empty())
      out.form.unit = node.attribute("unit").value(); // the first column is the wavelength
  UMOV_TRY(take_parameters(reader, table, out));
  UMOV_TRY(take_rows(reader, rows, out));
  return out;
}

} // namespace umov::passband
