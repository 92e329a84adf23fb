#pragma once
// Private: an Orbit Mean-Elements Message as the text holds it, whatever its form.

#include <functional>
#include <map>
#include <string>
#include <umov/core/result.h>
#include <umov/orbit/elements.h>
#include <vector>

namespace umov::omm {

/// One value, as written.
struct Field {
  std::string text;
  std::string unit; ///< "" if none is given
  std::size_t line = 0;
};

/// One message; keywords as in CCSDS 502.0-B-3.
struct Message {
  std::map<std::string, Field> fields;
  std::size_t line = 0;   ///< where it begins; 0 if the form has no lines
  std::size_t number = 0; ///< in the file, from 1
};

/// Takes messages as they are found; an error ends the reading.
using Sink = std::function<Result<void>(Result<Message>)>;

/// Puts a field; BadInput if it is there already.
Result<void> put(Message &message, const std::string &file, const std::string &key, Field field);

/// Readers of the four forms. A text that is none of that form is an error of theirs; an error in
/// one message goes to the sink, and reading goes on where the form allows.
Result<void> read_kvn(std::string_view text, const std::string &file, const Sink &sink);
Result<void> read_xml(std::string_view text, const std::string &file, const Sink &sink);
Result<void> read_json(std::string_view text, const std::string &file, const Sink &sink);
Result<void> read_csv(std::string_view text, const std::string &file, const Sink &sink);

/// Which metadata a form must state: catalogues in JSON and CSV leave out what is always the same.
enum class Metadata { Required, Optional };

/// The elements. BadInput for a missing or impossible field, another theory, frame or time scale.
Result<ElementSet> elements_of(const Message &message, const std::string &file, Metadata metadata);

} // namespace umov::omm
