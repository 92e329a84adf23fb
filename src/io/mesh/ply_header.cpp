#include "io/mesh/ply_header.h"

#include "io/mesh/mesh_parts.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <optional>

namespace umov::mesh_io::ply {
namespace {

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr TypeName type_names[] = {
    {"char", Type::Int8},      {"int8", Type::Int8},       {"uchar", Type::UInt8},
    {"uint8", Type::UInt8},    {"short", Type::Int16},     {"int16", Type::Int16},
    {"ushort", Type::UInt16},  {"uint16", Type::UInt16},   {"int", Type::Int32},
    {"int32", Type::Int32},    {"uint", Type::UInt32},     {"uint32", Type::UInt32},
    {"float", Type::Float32},  {"float32", Type::Float32}, {"double", Type::Float64},
    {"float64", Type::Float64}};
constexpr std::size_t longest_header = 64u << 10; ///< real ones have a few hundred bytes

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> out;
  for (std::size_t at = line.find_first_not_of(" \t"); at != std::string_view::npos;) {
    const std::size_t stop = std::min(line.find_first_of(" \t", at), line.size());
    out.push_back(line.substr(at, stop - at));
    at = line.find_first_not_of(" \t", stop);
  }
  return out;
}

class HeaderReader {
public:
  HeaderReader(std::string_view bytes, const std::string &file)
      : bytes_(bytes.substr(0, longest_header)), file_(file) {}

  Result<Header> read();

private:
  std::optional<std::string_view> line();
  Result<void> take(const std::vector<std::string_view> &words);
  Result<void> take_form(const std::vector<std::string_view> &words);
  Result<void> take_element(const std::vector<std::string_view> &words);
  Result<void> take_property(const std::vector<std::string_view> &words);
  Result<Type> type(std::string_view name) const;
  [[nodiscard]] tl::unexpected<Error> bad(std::string_view found, const char *expected) const {
    return fail(ErrorCode::BadInput,
                fmt::format("\"{}\" in the header of a PLY file; {} was expected. Export the file "
                            "again.",
                            clean_name(found.substr(0, 60)), expected),
                {file_, out_.lines});
  }

  std::string_view bytes_;
  const std::string &file_;
  Header out_;
  bool has_form_ = false;
};

std::optional<std::string_view> HeaderReader::line() {
  const std::size_t end = bytes_.find_first_of("\r\n", out_.body);
  if (end == std::string_view::npos)
    return {};
  const std::string_view out = bytes_.substr(out_.body, end - out_.body);
  out_.body = end + (bytes_.substr(end, 2) == "\r\n" ? 2 : 1);
  ++out_.lines;
  return out;
}

Result<Type> HeaderReader::type(std::string_view name) const {
  const auto *found = std::find_if(std::begin(type_names), std::end(type_names),
                                   [&](const TypeName &t) { return t.name == name; });
  if (found == std::end(type_names))
    return bad(name, "a type (char, uchar, short, ushort, int, uint, float or double)");
  return found->type;
}

Result<void> HeaderReader::take_form(const std::vector<std::string_view> &words) {
  if (words.size() != 3 || words[2] != "1.0")
    return bad(words.back(), "format ascii, binary_little_endian or binary_big_endian 1.0");
  has_form_ = true;
  if (words[1] == "ascii")
    out_.form = Form::Text;
  else if (words[1] == "binary_little_endian")
    out_.form = Form::Little;
  else if (words[1] == "binary_big_endian")
    out_.form = Form::Big;
  else
    return bad(words[1], "format ascii, binary_little_endian or binary_big_endian 1.0");
  return {};
}

Result<void> HeaderReader::take_element(const std::vector<std::string_view> &words) {
  Element element;
  if (words.size() != 3)
    return bad(words.back(), "element NAME COUNT");
  const std::string_view count = words[2];
  const auto [stop, status] =
      std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (status != std::errc() || stop != count.data() + count.size() || element.count > 1u << 31)
    return bad(count, "a count below 2147483648");
  element.name = clean_name(words[1]);
  for (const Element &other : out_.elements)
    if (other.name == element.name)
      return bad(words[1], "each element once");
  out_.elements.push_back(element);
  return {};
}

Result<void> HeaderReader::take_property(const std::vector<std::string_view> &words) {
  Property property;
  property.is_list = words.size() > 1 && words[1] == "list";
  if (out_.elements.empty() || words.size() != (property.is_list ? 5u : 3u))
    return bad(words.back(), "property TYPE NAME or property list TYPE TYPE NAME below an element");
  UMOV_ASSIGN(value, type(words[property.is_list ? 3 : 1]));
  property.type = value;
  if (property.is_list) {
    UMOV_ASSIGN(count, type(words[2]));
    if (count == Type::Float32 || count == Type::Float64)
      return bad(words[2], "a type of whole numbers");
    property.count = count;
  }
  property.name = clean_name(words.back());
  out_.elements.back().properties.push_back(property);
  return {};
}

Result<void> HeaderReader::take(const std::vector<std::string_view> &words) {
  if (words[0] == "format")
    return take_form(words);
  if (words[0] == "element")
    return take_element(words);
  if (words[0] == "property")
    return take_property(words);
  if (words[0] == "comment" || words[0] == "obj_info")
    return {};
  return bad(words[0], "format, element, property, comment or end_header");
}

Result<Header> HeaderReader::read() {
  for (auto text = line(); text; text = line()) {
    const auto words = split(*text);
    if (out_.lines == 1) {
      if (words.size() != 1 || words[0] != "ply")
        return bad(*text, "\"ply\" in the first line");
      continue;
    }
    if (words.empty())
      continue;
    if (words[0] == "end_header") {
      if (!has_form_)
        return bad("end_header", "a line \"format ...\" before it");
      return std::move(out_);
    }
    UMOV_TRY(take(words));
  }
  return fail(ErrorCode::BadInput,
              "the header of a PLY file without \"end_header\"; the file was cut off or is "
              "another format. Export or fetch it again.",
              {file_});
}

} // namespace

std::size_t size_of(Type type) {
  switch (type) {
  case Type::Int8:
  case Type::UInt8:
    return 1;
  case Type::Int16:
  case Type::UInt16:
    return 2;
  case Type::Int32:
  case Type::UInt32:
  case Type::Float32:
    return 4;
  case Type::Float64:
    break;
  }
  return 8;
}

Result<Header> read_header(std::string_view bytes, const std::string &file) {
  return HeaderReader(bytes, file).read();
}

} // namespace umov::mesh_io::ply
