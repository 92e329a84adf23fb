#include "io/ccsds/keywords.h"
#include "io/xml_text.h"

#include <pugixml.hpp>

namespace umov::ccsds {
namespace {

void put(pugi::xml_node parent, const Field &field, std::string_view unit) {
  constexpr std::string_view user = "USER_DEFINED_";
  pugi::xml_node node;
  if (field.key.starts_with(user)) {
    node = parent.append_child("USER_DEFINED");
    node.append_attribute("parameter") = field.key.substr(user.size()).c_str();
  } else {
    node = parent.append_child(field.key.c_str());
  }
  if (!unit.empty())
    node.append_attribute("units") = std::string(unit).c_str();
  node.append_child(pugi::node_pcdata).set_value(field.text.c_str());
}

void put(pugi::xml_node parent, const std::vector<Field> &fields) {
  for (const Field &field : fields)
    put(parent, field, field.unit);
}

/// A unit of its own, or the standard one where KVN has no room for any.
std::string_view unit_of(const Message &message, const Record &record, const Field &field) {
  if (!field.unit.empty())
    return field.unit;
  return message.kind == Kind::Oem && is_in_data_line(message.kind, record.name)
             ? standard_unit(field.key)
             : std::string_view();
}

/// Euler angles and rates name their axis in an attribute (504.0-B, annex on XML).
void put_rotation(pugi::xml_node parent, const Field &field, std::size_t number) {
  pugi::xml_node node = parent.append_child(("rotation" + std::to_string(number)).c_str());
  node.append_attribute(field.key.ends_with("_RATE") ? "rate" : "angle") = field.key.c_str();
  node.append_child(pugi::node_pcdata).set_value(field.text.c_str());
}

Result<void> put_attitude(pugi::xml_node state, const Message &message, const Segment &segment,
                          const Record &record) {
  UMOV_ASSIGN(form, needed_form(message, segment));
  pugi::xml_node node = state.append_child(form->element);
  for (const Field &field : record.fields)
    if (field.key == "COMMENT" || field.key == "EPOCH")
      put(node, field, "");
  for (const AttitudeForm::Group &group : form->groups) {
    const std::string_view name = group.element;
    pugi::xml_node below = name.empty() ? node : node.append_child(group.element);
    std::size_t number = 0;
    for (const std::string &key : group.keys) {
      UMOV_ASSIGN(field, needed_field(message, record, key));
      if (name == "rotationAngles" || name == "rotationRates")
        put_rotation(below, *field, ++number);
      else
        put(below, *field, field->unit);
    }
  }
  return {};
}

Result<void> put_data(pugi::xml_node data, const Message &message, const Segment &segment) {
  for (const Record &record : segment.data) {
    if (record.name == "comment") {
      put(data, record.fields);
      continue;
    }
    // Comments before a data line stand beside its element.
    const bool is_line =
        is_in_data_line(message.kind, record.name) && record.name != "covarianceMatrix";
    if (is_line)
      for (const Field &field : record.fields)
        if (field.key == "COMMENT")
          put(data, field, "");
    pugi::xml_node node = data.append_child(record.name.c_str());
    if (message.kind == Kind::Aem) {
      Record plain = record;
      std::erase_if(plain.fields, [](const Field &field) { return field.key == "COMMENT"; });
      UMOV_TRY(put_attitude(node, message, segment, plain));
      continue;
    }
    for (const Field &field : record.fields)
      if (!(is_line && field.key == "COMMENT"))
        put(node, field, unit_of(message, record, field));
  }
  return {};
}

} // namespace

Result<std::string> write_xml(const Message &message) {
  throw_where_memory_ends();
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node root = document.append_child(info_of(message.kind).element);
  root.append_attribute("id") = (std::string("CCSDS_") + to_text(message.kind) + "_VERS").c_str();
  root.append_attribute("version") = message.version.c_str();
  put(root.append_child("header"), message.header);
  pugi::xml_node body = root.append_child("body");
  for (const Segment &segment : message.segments) {
    pugi::xml_node node = body.append_child("segment");
    put(node.append_child("metadata"), segment.metadata);
    UMOV_TRY(put_data(node.append_child("data"), message, segment));
  }
  return text_of(document);
}

} // namespace umov::ccsds
