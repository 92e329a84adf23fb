// NDM/XML: <omm>, alone or in <ndm>. pugixml knows no entities but the five of XML, so a document
// type has nothing to offer here and is refused.

#include "io/elements/omm_message.h"

#include <algorithm>
#include <pugixml.hpp>
#include <umov/core/text.h>

namespace umov::omm {
namespace {

/// Lines of byte offsets.
class Lines {
public:
  explicit Lines(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n')
        ends_.push_back(i);
  }
  [[nodiscard]] std::size_t of(std::ptrdiff_t offset) const {
    const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0));
    return static_cast<std::size_t>(std::lower_bound(ends_.begin(), ends_.end(), at) -
                                    ends_.begin()) +
           1;
  }

private:
  std::vector<std::size_t> ends_;
};

/// Every element without children below a node, down to the depth that the schema has.
Result<void> take_leaves(pugi::xml_node node, int depth, const Lines &lines,
                         const std::string &file, Message &out) {
  constexpr int deepest = 6;
  for (const pugi::xml_node child : node.children()) {
    if (child.type() != pugi::node_element)
      continue;
    const std::string name = child.name();
    const bool is_leaf =
        !child.find_child([](pugi::xml_node n) { return n.type() == pugi::node_element; });
    if (!is_leaf && depth < deepest) {
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
  const auto done =
      document.load_buffer(text.data(), text.size(),
                           pugi::parse_default | pugi::parse_doctype | pugi::parse_trim_pcdata);
  const Lines lines(text);
  if (!done)
    return fail(ErrorCode::BadInput, std::string("is no XML: ") + done.description(),
                {file, lines.of(done.offset)});
  for (const pugi::xml_node node : document.children())
    if (node.type() == pugi::node_doctype)
      return fail(ErrorCode::BadInput,
                  "has a document type definition; none was expected. Nothing is expanded and "
                  "nothing is fetched: remove it.",
                  {file, lines.of(node.offset_debug())});
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
