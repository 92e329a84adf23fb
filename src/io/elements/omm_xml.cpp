// NDM/XML: <omm>, alone or in <ndm>.

#include "io/ccsds/xml_open.h"
#include "io/elements/omm_message.h"

#include <umov/core/text.h>

namespace umov::omm {
namespace {

/// Every element without children below a node, down to the depth that the schema has.
Result<void> take_leaves(pugi::xml_node node, int depth, const XmlLines &lines,
                         const std::string &file, Message &out) {
  constexpr int xml_deepest = 6;
  for (const pugi::xml_node child : node.children()) {
    if (child.type() != pugi::node_element)
      continue;
    const std::string name = child.name();
    const bool is_leaf =
        !child.find_child([](pugi::xml_node n) { return n.type() == pugi::node_element; });
    if (!is_leaf && depth < xml_deepest) {
      UMOV_TRY(take_leaves(child, depth + 1, lines, file, out));
    } else if (name == "USER_DEFINED") {
      UMOV_TRY(put(out, file, "USER_DEFINED_" + std::string(child.attribute("parameter").value()),
                   {child.child_value(), "", lines.of(child.offset_debug())}));
    } else if (name != "COMMENT" && is_leaf) {
      UMOV_TRY(put(out, file, name,
                   {std::string(trimmed(child.child_value())), child.attribute("units").value(),
                    lines.of(child.offset_debug())}));
    }
  }
  return {};
}

} // namespace

Result<void> read_xml(std::string_view text, const std::string &file, const Sink &sink) {
  pugi::xml_document document;
  const XmlLines lines(text);
  UMOV_TRY(open_xml(text, file, lines, document));
  std::size_t messages = 0;
  const auto read = [&](pugi::xml_node omm) -> Result<void> {
    Message message{{}, lines.of(omm.offset_debug()), ++messages};
    if (auto taken = take_leaves(omm, 0, lines, file, message); !taken)
      return sink(tl::unexpected(std::move(taken).error()));
    return sink(std::move(message));
  };
  const pugi::xml_node root = document.document_element();
  if (std::string_view(root.name()) == "omm")
    return read(root);
  if (std::string_view(root.name()) == "ndm") {
    for (const pugi::xml_node omm : root.children("omm"))
      UMOV_TRY(read(omm));
    if (messages > 0)
      return {};
  }
  return fail(ErrorCode::BadInput,
              std::string("the element <") + root.name() +
                  "> was found, <omm> or <ndm> with <omm> in it "
                  "was expected",
              {file, lines.of(root.offset_debug())});
}

} // namespace umov::omm
