// Elements to text. Numbers are the shortest that give back the same element.

#include <umov/io/elements_file.h>

#include "io/elements/write_tle.h"
#include "io/xml_text.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/time/epoch.h>

namespace umov {
namespace {

/// Revolutions per day that give back the same radians per minute.
std::string revolutions_text(double rad_per_min) {
  const double exact = rad_per_min / (2 * pi / 1440);
  for (int digits = 1; digits < 17; ++digits) {
    std::string text = fmt::format("{:.{}g}", exact, digits);
    if (parse_number(text).value_or(0) * (2 * pi / 1440) == rad_per_min)
      return text;
  }
  return shortest(exact);
}

struct Item {
  const char *key, *unit;
  std::string text;
  bool is_number;
};

std::vector<Item> metadata_of(const ElementSet &set) {
  return {{"OBJECT_NAME", "", set.name.empty() ? "UNKNOWN" : set.name, false},
          {"OBJECT_ID", "",
           set.international_designator.empty() ? "UNKNOWN"
                                                : long_designator(set.international_designator),
           false},
          {"CENTER_NAME", "", "EARTH", false},
          {"REF_FRAME", "", "TEME", false},
          {"TIME_SYSTEM", "", "UTC", false},
          {"MEAN_ELEMENT_THEORY", "", "SGP4", false}};
}
std::vector<Item> elements_of(const ElementSet &set) {
  std::string epoch = to_iso_exact(set.epoch);
  epoch.pop_back(); // the Z: TIME_SYSTEM says so
  const auto degrees = [](double radians) { return degrees_text(Angle::radians(radians)); };
  return {{"EPOCH", "", epoch, false},
          {"MEAN_MOTION", "rev/day", revolutions_text(set.mean_motion), true},
          {"ECCENTRICITY", "", shortest(set.eccentricity), true},
          {"INCLINATION", "deg", degrees(set.inclination), true},
          {"RA_OF_ASC_NODE", "deg", degrees(set.raan), true},
          {"ARG_OF_PERICENTER", "deg", degrees(set.argument_of_perigee), true},
          {"MEAN_ANOMALY", "deg", degrees(set.mean_anomaly), true}};
}
std::vector<Item> tle_parameters_of(const ElementSet &set) {
  return {{"EPHEMERIS_TYPE", "", std::to_string(set.ephemeris_type), true},
          {"CLASSIFICATION_TYPE", "", std::string(1, set.classification), false},
          {"NORAD_CAT_ID", "", std::to_string(set.norad_cat_id), true},
          {"ELEMENT_SET_NO", "", std::to_string(set.element_number), true},
          {"REV_AT_EPOCH", "", std::to_string(set.revolution), true},
          {"BSTAR", "1/ER", shortest(set.bstar), true},
          {"MEAN_MOTION_DOT", "rev/day**2", shortest(set.mean_motion_dot), true},
          {"MEAN_MOTION_DDOT", "rev/day**3", shortest(set.mean_motion_ddot), true}};
}
std::vector<Item> all_of(const ElementSet &set) {
  auto out = metadata_of(set);
  for (auto *part : {&elements_of, &tle_parameters_of})
    for (Item &item : (*part)(set))
      out.push_back(std::move(item));
  return out;
}

std::string kvn_of(const std::vector<ElementSet> &sets, const std::string &created) {
  std::string out;
  for (const ElementSet &set : sets) {
    out += fmt::format("CCSDS_OMM_VERS = 2.0\nCREATION_DATE = {}\nORIGINATOR = umov\n\n", created);
    for (const Item &item : all_of(set))
      out += fmt::format("{} = {}{}\n", item.key, item.text,
                         *item.unit != 0 ? fmt::format(" [{}]", item.unit) : std::string());
    out += '\n';
  }
  return out;
}

void put(pugi::xml_node parent, const std::vector<Item> &items) {
  for (const Item &item : items) {
    pugi::xml_node node = parent.append_child(item.key);
    if (*item.unit != 0)
      node.append_attribute("units") = item.unit;
    node.text() = item.text.c_str();
  }
}

std::string xml_of(const std::vector<ElementSet> &sets, const std::string &created) {
  throw_where_memory_ends();
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node ndm = document.append_child("ndm");
  for (const ElementSet &set : sets) {
    pugi::xml_node omm = ndm.append_child("omm");
    omm.append_attribute("id") = "CCSDS_OMM_VERS";
    omm.append_attribute("version") = "2.0";
    pugi::xml_node header = omm.append_child("header");
    header.append_child("CREATION_DATE").text() = created.c_str();
    header.append_child("ORIGINATOR").text() = "umov";
    pugi::xml_node segment = omm.append_child("body").append_child("segment");
    put(segment.append_child("metadata"), metadata_of(set));
    pugi::xml_node data = segment.append_child("data");
    put(data.append_child("meanElements"), elements_of(set));
    put(data.append_child("tleParameters"), tle_parameters_of(set));
  }
  return text_of(document);
}

/// Names given by a program may hold anything; what is no UTF-8 must not stop the writing.
std::string json_text(const std::string &text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_of(const std::vector<ElementSet> &sets) {
  std::string out = "[";
  for (const ElementSet &set : sets) {
    out += out.size() > 1 ? ",\n {" : "\n {";
    bool is_first = true;
    for (const Item &item : all_of(set)) {
      out += fmt::format("{}\"{}\":{}", is_first ? "" : ",", item.key,
                         item.is_number ? item.text : json_text(item.text));
      is_first = false;
    }
    out += '}';
  }
  return out + "\n]\n";
}

std::string csv_of(const std::vector<ElementSet> &sets) {
  std::string out;
  const auto put = [&](const std::vector<Item> &items, bool is_head) {
    for (std::size_t k = 0; k < items.size(); ++k) {
      std::string cell = is_head ? items[k].key : items[k].text;
      if (cell.find_first_of(",\"\r\n") != std::string::npos) {
        for (std::size_t i = 0; (i = cell.find('"', i)) != std::string::npos; i += 2)
          cell.insert(i, 1, '"');
        cell = "\"" + cell + "\"";
      }
      if (k > 0)
        out += ',';
      out += cell;
    }
    out += '\n';
  };
  for (const ElementSet &set : sets) {
    if (out.empty())
      put(all_of(set), true);
    put(all_of(set), false);
  }
  return out;
}

} // namespace

std::string long_designator(const std::string &text) {
  const bool is_short =
      text.size() >= 6 && text.size() <= 8 &&
      std::all_of(text.begin(), text.begin() + 5, [](char c) { return c >= '0' && c <= '9'; });
  if (!is_short)
    return text;
  return (text.substr(0, 2) < "57" ? "20" : "19") + text.substr(0, 2) + "-" + text.substr(2);
}

Result<std::string> write_elements(const std::vector<ElementSet> &sets, ElementsForm form,
                                   Epoch<Utc> created, Diagnostics &diagnostics) {
  const std::string when = to_iso(created, 3).substr(0, 19);
  switch (form) {
  case ElementsForm::OmmKvn:
    return kvn_of(sets, when);
  case ElementsForm::OmmXml:
    return xml_of(sets, when);
  case ElementsForm::OmmJson:
    return json_of(sets);
  case ElementsForm::OmmCsv:
    return csv_of(sets);
  case ElementsForm::Tle:
    break;
  }
  return tle_of(sets, diagnostics);
}

} // namespace umov
