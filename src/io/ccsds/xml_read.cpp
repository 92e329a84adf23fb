// NDM/XML.

#include "io/ccsds/keywords.h"
#include "io/ccsds/xml_open.h"

#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov::ccsds {
namespace {

class XmlReader {
public:
  XmlReader(XmlLines lines, const std::string &file) : lines_(std::move(lines)) {
    out_.file = file;
  }

  Result<Message> read(const pugi::xml_document &document) {
    pugi::xml_node root = document.document_element();
    if (std::string_view(root.name()) == "ndm") {
      std::size_t count = 0;
      pugi::xml_node only;
      for (const pugi::xml_node child : root.children())
        if (child.type() == pugi::node_element && find_kind(child.name()) != nullptr) {
          only = child;
          ++count;
        }
      if (count != 1)
        return refuse(root, fmt::format("<ndm> holds {} of <opm>, <oem>, <aem> and <tdm>, expected "
                                        "one. Split the file.",
                                        count));
      root = only;
    }
    const KindInfo *info = find_kind(root.name());
    if (info == nullptr)
      return refuse(root,
                    fmt::format("the element <{}> was found; <opm>, <oem>, <aem> or <tdm> was "
                                "expected",
                                root.name()));
    out_.kind = info->kind;
    out_.version = root.attribute("version").value();
    for (const pugi::xml_node node : root.child("header").children())
      if (node.type() == pugi::node_element)
        out_.header.push_back(field_of(node));
    for (const pugi::xml_node segment : root.child("body").children("segment"))
      UMOV_TRY(take_segment(segment));
    return std::move(out_);
  }

private:
  [[nodiscard]] tl::unexpected<Error> refuse(pugi::xml_node node, const std::string &text) const {
    return fail(ErrorCode::BadInput, text, {out_.file, lines_.of(node.offset_debug())});
  }

  [[nodiscard]] Field field_of(pugi::xml_node node) const {
    std::string key = node.name();
    if (key == "USER_DEFINED")
      key = "USER_DEFINED_" + std::string(node.attribute("parameter").value());
    // Euler angles of AEM name their axis in an attribute.
    if (const std::string angle = node.attribute("angle").value(); !angle.empty())
      key = angle;
    if (const std::string rate = node.attribute("rate").value(); !rate.empty())
      key = rate;
    return {key, std::string(trimmed(node.child_value())), node.attribute("units").value(),
            lines_.of(node.offset_debug())};
  }

  /// Every element without children below a node.
  void take_leaves(pugi::xml_node node, int depth, std::vector<Field> &fields) const {
    constexpr int deepest = 6;
    for (const pugi::xml_node child : node.children()) {
      if (child.type() != pugi::node_element)
        continue;
      const bool is_leaf =
          !child.find_child([](pugi::xml_node n) { return n.type() == pugi::node_element; });
      if (is_leaf)
        fields.push_back(field_of(child));
      else if (depth < deepest)
        take_leaves(child, depth + 1, fields);
    }
  }

  Result<void> take_segment(pugi::xml_node node) {
    Segment &segment = out_.segments.emplace_back();
    take_leaves(node.child("metadata"), 0, segment.metadata);
    std::vector<Field> comments; // of the record to come
    for (const pugi::xml_node child : node.child("data").children()) {
      if (child.type() != pugi::node_element)
        continue;
      if (std::string_view(child.name()) == "COMMENT") {
        comments.push_back(field_of(child));
        continue;
      }
      Record record{child.name(), std::exchange(comments, {}), lines_.of(child.offset_debug())};
      const std::size_t first = record.fields.size();
      take_leaves(child, 0, record.fields);
      if (record.fields.size() == first)
        return refuse(child, fmt::format("<{}> is empty", child.name()));
      if (is_in_data_line(out_.kind, record.name))
        for (Field &field : record.fields)
          if (field.unit == standard_unit(field.key))
            field.unit.clear();
      segment.data.push_back(std::move(record));
    }
    if (!comments.empty())
      segment.data.push_back({"comment", std::move(comments), 0});
    return {};
  }

  XmlLines lines_;
  Message out_;
};

} // namespace

Result<Message> read_xml(std::string_view text, const std::string &file) {
  pugi::xml_document document;
  XmlLines lines(text);
  UMOV_TRY(open_xml(text, file, lines, document));
  return XmlReader(std::move(lines), file).read(document);
}

} // namespace umov::ccsds
