// Buffers of a glTF document: the chunk of a GLB, base64 in place, or a file beside it; and the
// numbers in them.

#include "io/mesh/bytes.h"
#include "io/mesh/gltf/document.h"
#include "io/mesh/mesh_parts.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>

namespace umov::mesh_io::gltf {
namespace {

constexpr std::size_t most_bytes = 512u << 20; ///< of all buffers together

std::optional<std::string> from_base64(std::string_view text, const std::atomic<bool> *cancel) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> value{};
  value.fill(-1);
  for (std::size_t i = 0; i < digits.size(); ++i)
    value[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
  while (!text.empty() && text.back() == '=')
    text.remove_suffix(1);
  std::string out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    leave_if_stopped(cancel, out.size());
    const int digit = value[static_cast<unsigned char>(c)];
    if (digit < 0)
      return {};
    bits = (bits << 6) | static_cast<std::uint32_t>(digit);
    held += 6;
    if (held >= 8) {
      held -= 8;
      out += static_cast<char>((bits >> held) & 0xFF);
    }
  }
  return out;
}

/// A URI with its %20 and the like written out; nothing where one is broken.
std::optional<std::string> unescaped(std::string_view uri) {
  const auto hex = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      out += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex(uri[i + 2]) : -1;
    if (high < 0 || low < 0)
      return {};
    out += static_cast<char>(16 * high + low);
    i += 2;
  }
  return out;
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos &&
         uri.substr(0, colon).find('/') == std::string_view::npos;
}

std::size_t bytes_of(int component_type) {
  return component_type <= 5121 ? 1 : component_type <= 5123 ? 2 : 4;
}

} // namespace

Result<std::string> Document::load_uri(const std::string &uri, const std::string &place) {
  const std::string brief = "\"" + clean_name(uri.substr(0, 60)) + "\"";
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    const std::string head = uri.substr(0, comma);
    auto bytes = comma != std::string::npos && head.ends_with(";base64")
                     ? from_base64(std::string_view(uri).substr(comma + 1), cancel_)
                     : std::nullopt;
    if (!bytes)
      return bad(place + ".uri", brief, "\"data:...;base64,\" and base64 digits");
    return std::move(*bytes);
  }
  const auto name = unescaped(uri);
  if (!name || name->empty() || name->find('\0') != std::string::npos)
    return bad(place + ".uri", brief, "the name of a file");
  if (has_scheme(uri) || leaves_folder(*name))
    return fail(ErrorCode::BadInput,
                fmt::format("{}.uri is {}, which leaves the folder of the mesh. Put the buffer "
                            "beside the glTF file, or export one GLB file.",
                            place, brief),
                {file_});
  auto bytes = read_file(folder_ / *name);
  if (!bytes)
    return fail(ErrorCode::BadInput,
                fmt::format("{}.uri: {}. Put the buffer beside the glTF file, or export one GLB "
                            "file.",
                            place, bytes.error().text()),
                {file_});
  files_.push_back({folder_ / *name, sha256_hex(*bytes)});
  return bytes;
}

Result<std::string> Document::load_buffer(const Json &buffer, const std::string &place,
                                          std::size_t i) {
  const auto uri = buffer.find("uri");
  if (uri != buffer.end()) {
    if (!uri->is_string())
      return bad(place + ".uri", "no text", "the name of a file");
    return load_uri(uri->get<std::string>(), place);
  }
  if (i != 0 || !chunk_)
    return bad(place, "without \"uri\"", "a uri, or the binary chunk of a GLB file");
  return std::move(*chunk_); // buffer 0 is asked for once and kept
}

Result<std::string_view> Document::buffer(std::size_t i) {
  if (const auto known = buffers_.find(i); known != buffers_.end())
    return std::string_view(*known->second);
  const std::string place = fmt::format("buffers[{}]", i);
  const Json &buffer = entry("buffers", i);
  if (!buffer.contains("byteLength"))
    return bad(place, "without \"byteLength\"", "one");
  UMOV_ASSIGN(bytes, load_buffer(buffer, place, i));
  UMOV_ASSIGN(length, whole(buffer, "byteLength", place, 0, 1, std::size_t{1} << 52));
  if (length > bytes.size())
    return bad(place + ".byteLength", std::to_string(length),
               fmt::format("at most {}, what its data have (were they cut off?)", bytes.size()));
  bytes.resize(length);
  bytes_read_ += length;
  if (bytes_read_ > most_bytes)
    return bad("the size of all buffers", fmt::format("{} bytes and more", bytes_read_),
               fmt::format("at most {}", most_bytes));
  const auto kept = std::make_shared<const std::string>(std::move(bytes));
  buffers_.emplace(i, kept);
  return std::string_view(*kept);
}

Result<std::string_view> Document::view_bytes(std::size_t view, std::size_t &stride) {
  const std::string place = fmt::format("bufferViews[{}]", view);
  const Json &json = entry("bufferViews", view);
  UMOV_ASSIGN(which, index(json, "buffer", place, "buffers"));
  if (!which || !json.contains("byteLength"))
    return bad(place, "without \"buffer\" or \"byteLength\"", "both");
  UMOV_ASSIGN(bytes, buffer(*which));
  UMOV_ASSIGN(offset, whole(json, "byteOffset", place, 0, 0, bytes.size()));
  UMOV_ASSIGN(length, whole(json, "byteLength", place, 0, 1, bytes.size() - offset));
  UMOV_ASSIGN(step, whole(json, "byteStride", place, 0, 1, 252));
  stride = step;
  return bytes.substr(offset, length);
}

Result<Accessor::Run> Document::run(const Json &from, const std::string &place, std::size_t count,
                                    std::size_t element_bytes, bool may_stride) {
  UMOV_ASSIGN(view, index(from, "bufferView", place, "bufferViews"));
  Accessor::Run out;
  if (!view)
    return out;
  UMOV_ASSIGN(bytes, view_bytes(*view, out.stride));
  UMOV_ASSIGN(offset, whole(from, "byteOffset", place, 0, 0, bytes.size()));
  if (out.stride == 0 || !may_stride)
    out.stride = element_bytes;
  out.bytes = bytes.substr(offset);
  // In this order nothing can wrap around.
  if (out.bytes.size() < element_bytes ||
      count - 1 > (out.bytes.size() - element_bytes) / out.stride)
    return bad(place + ".count", std::to_string(count),
               fmt::format("what the {} bytes from its offset on hold", out.bytes.size()));
  return out;
}

Result<void> Document::read_sparse(const Json &sparse, const std::string &place, Accessor &out) {
  if (!sparse.is_object() || !sparse.contains("count") || !sparse.contains("indices") ||
      !sparse["indices"].is_object() || !sparse.contains("values") || !sparse["values"].is_object())
    return bad(place, "incomplete", "count, indices and values");
  UMOV_ASSIGN(count, whole(sparse, "count", place, 0, 1, out.count_));
  const Json &indices = sparse["indices"];
  UMOV_ASSIGN(type, whole(indices, "componentType", place + ".indices", 0, 5121, 5125));
  Accessor which;
  which.type_ = static_cast<int>(type);
  which.count_ = count;
  if (!which.is_index() || !indices.contains("bufferView") ||
      !sparse["values"].contains("bufferView"))
    return bad(place, "without proper indices and values",
               "componentType 5121, 5123 or 5125, and bufferViews");
  UMOV_ASSIGN(run_of_indices,
              run(indices, place + ".indices", count, bytes_of(which.type_), false));
  UMOV_ASSIGN(values, run(sparse["values"], place + ".values", count,
                          bytes_of(out.type_) * out.components_, false));
  which.run_ = run_of_indices;
  for (std::size_t k = 0; k < count; ++k) {
    leave_if_stopped(cancel_, k);
    const auto element = static_cast<std::uint32_t>(which.value(k, 0));
    if (element >= out.count_ || (k > 0 && element <= out.replaced_.back()))
      return bad(fmt::format("{}.indices, number {},", place, k), std::to_string(element),
                 fmt::format("a rising list below {}", out.count_));
    out.replaced_.push_back(element);
  }
  out.replacements_ = values;
  return {};
}

Result<Accessor> Document::read_accessor(std::size_t i) {
  const std::string place = fmt::format("accessors[{}]", i);
  const Json &json = entry("accessors", i);
  Accessor out;
  for (const char *key : {"componentType", "count", "type"})
    if (!json.contains(key))
      return bad(place, fmt::format("without \"{}\"", key), "componentType, count and type");
  UMOV_ASSIGN(type, whole(json, "componentType", place, 0, 5120, 5126));
  if (type == 5124)
    return bad(place + ".componentType", "5124", "5120 to 5123, 5125 or 5126");
  out.type_ = static_cast<int>(type);
  UMOV_ASSIGN(count, whole(json, "count", place, 0, 1, max_elements_));
  out.count_ = count;
  constexpr std::array<std::string_view, 4> kinds{"SCALAR", "VEC2", "VEC3", "VEC4"};
  const std::string kind = json["type"].is_string() ? json["type"].get<std::string>() : "";
  const auto at = std::find(kinds.begin(), kinds.end(), kind) - kinds.begin();
  if (at == std::ssize(kinds))
    return bad(place + ".type", "\"" + clean_name(kind) + "\"", "SCALAR, VEC2, VEC3 or VEC4");
  out.components_ = static_cast<std::size_t>(at) + 1;
  out.is_normalized_ = json.contains("normalized") && json["normalized"].is_boolean() &&
                       json["normalized"].get<bool>();
  UMOV_ASSIGN(run_of_values,
              run(json, place, out.count_, bytes_of(out.type_) * out.components_, true));
  out.run_ = run_of_values;
  if (json.contains("sparse"))
    UMOV_TRY(read_sparse(json["sparse"], place + ".sparse", out));
  return out;
}

Result<const Accessor *> Document::accessor(std::size_t i) {
  if (const auto known = accessors_.find(i); known != accessors_.end())
    return known->second.get();
  UMOV_ASSIGN(one, read_accessor(i));
  return accessors_.emplace(i, std::make_shared<const Accessor>(std::move(one)))
      .first->second.get();
}

bool Accessor::is_index() const {
  return components_ == 1 && !is_normalized_ && (type_ == 5121 || type_ == 5123 || type_ == 5125);
}

double Accessor::number(const Run &run, std::size_t element, std::size_t component) const {
  if (run.bytes.empty())
    return 0;
  const std::size_t at = element * run.stride + component * bytes_of(type_);
  const auto scaled = [&](double value, double most) {
    return is_normalized_ ? std::max(value / most, -1.0) : value;
  };
  switch (type_) {
  case 5120:
    return scaled(number_at<std::int8_t>(run.bytes, at), 127);
  case 5121:
    return scaled(number_at<std::uint8_t>(run.bytes, at), 255);
  case 5122:
    return scaled(number_at<std::int16_t>(run.bytes, at), 32767);
  case 5123:
    return scaled(number_at<std::uint16_t>(run.bytes, at), 65535);
  case 5125:
    return scaled(number_at<std::uint32_t>(run.bytes, at), 4294967295.0);
  default:
    return static_cast<double>(number_at<float>(run.bytes, at));
  }
}

double Accessor::value(std::size_t element, std::size_t component) const {
  if (!replaced_.empty()) {
    const auto found = std::lower_bound(replaced_.begin(), replaced_.end(), element);
    if (found != replaced_.end() && *found == element)
      return number(replacements_, static_cast<std::size_t>(found - replaced_.begin()), component);
  }
  return number(run_, element, component);
}

} // namespace umov::mesh_io::gltf
