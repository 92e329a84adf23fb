#include <umov/core/result.h>

namespace umov {

std::string to_text(const Where &where) {
  std::string out = where.file;
  if (where.line > 0)
    out += (out.empty() ? "line " : ":") + std::to_string(where.line);
  if (where.line > 0 && where.column > 0)
    out += ":" + std::to_string(where.column);
  return out.empty() ? out : out + ": ";
}

} // namespace umov
