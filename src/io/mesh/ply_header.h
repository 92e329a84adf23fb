#pragma once
// Private: the header of a PLY file, which says what its body is made of.

#include <cstddef>
#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <vector>

namespace umov::mesh_io::ply {

enum class Type { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };
std::size_t size_of(Type type);

struct Property {
  std::string name;
  Type type = Type::Float32; ///< of the value, or of the values of a list
  Type count = Type::UInt8;  ///< of the length of a list
  bool is_list = false;
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

enum class Form { Text, Little, Big };

struct Header {
  Form form = Form::Text;
  std::vector<Element> elements;
  std::size_t body = 0;  ///< where the body begins [bytes]
  std::size_t lines = 0; ///< of the header
};

/// BadInput, with the line, for whatever is not as the format wants it.
Result<Header> read_header(std::string_view bytes, const std::string &file);

} // namespace umov::mesh_io::ply
