#pragma once
// Private: opens XML that strangers send.

#include "io/ccsds/xml_lines.h"

#include <pugixml.hpp>
#include <string>
#include <umov/core/result.h>

namespace umov {

/// Reads `text` into `out`. pugixml knows no entities but the five of XML, so a document type has
/// nothing to offer and is refused. BadInput with the line.
inline Result<void> open_xml(std::string_view text, const std::string &file, const XmlLines &lines,
                             pugi::xml_document &out) {
  const auto done =
      out.load_buffer(text.data(), text.size(),
                      pugi::parse_default | pugi::parse_doctype | pugi::parse_trim_pcdata);
  if (!done)
    return fail(ErrorCode::BadInput,
                std::string("is no XML: ") + done.description() +
                    ". It may be cut off or changed: fetch the file again.",
                {file, lines.of(done.offset)});
  for (const pugi::xml_node node : out.children())
    if (node.type() == pugi::node_doctype)
      return fail(ErrorCode::BadInput,
                  "has a document type definition; none was expected. Nothing is expanded and "
                  "nothing is fetched: remove it.",
                  {file, lines.of(node.offset_debug())});
  return {};
}

} // namespace umov
