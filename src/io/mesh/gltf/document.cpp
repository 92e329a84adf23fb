#include "io/mesh/gltf/document.h"

#include "core/parse_place.h"
#include "io/mesh/bytes.h"
#include "io/mesh/mesh_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <tuple>
#include <umov/core/stop.h>

namespace umov::mesh_io::gltf {
namespace {

constexpr std::uint32_t glb_magic = 0x46546C67, json_chunk = 0x4E4F534A, bin_chunk = 0x004E4942;
constexpr int deepest = 64;                  ///< brackets in brackets
constexpr std::size_t most_values = 4 << 20; ///< of the JSON; large scenes have some 100,000

/// What a scan before parsing finds: trees of a hostile text would fill the memory.
struct Scan {
  int depth = 0, deepest = 0;
  std::size_t values = 0;
};

Scan scan(std::string_view text, const std::atomic<bool> *cancel) {
  Scan out;
  bool is_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    leave_if_stopped(cancel, i);
    const char c = text[i];
    if (is_text) {
      i += c == '\\' ? 1u : 0u;
      is_text = c != '"';
    } else if (c == '"') {
      is_text = true;
    } else if (c == '{' || c == '[') {
      out.deepest = std::max(out.deepest, ++out.depth);
      ++out.values;
    } else if (c == '}' || c == ']') {
      --out.depth;
    } else if (c == ',') {
      ++out.values;
    }
  }
  return out;
}

/// Letters of a text one after the other as long as nobody stops it: buffers written in place are
/// hundreds of megabytes of one word.
class Letters {
public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char *;
  using reference = const char &;

  Letters(const char *at, const std::atomic<bool> *cancel) : at_(at), cancel_(cancel) {}
  reference operator*() const { return *at_; }
  Letters &operator++() {
    leave_if_stopped(cancel_, read_++);
    ++at_;
    return *this;
  }
  friend bool operator==(const Letters &a, const Letters &b) { return a.at_ == b.at_; }
  friend bool operator!=(const Letters &a, const Letters &b) { return a.at_ != b.at_; }

private:
  const char *at_;
  const std::atomic<bool> *cancel_;
  std::size_t read_ = 0;
};

/// How a value is shown in a message.
std::string shown(const Json &value) {
  std::string out = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return out.size() > 40 ? out.substr(0, 40) + "..." : out;
}

constexpr const char *lists[] = {"scenes",      "nodes",     "meshes",  "materials",
                                 "bufferViews", "accessors", "buffers", "skins"};

} // namespace

tl::unexpected<Error> Document::bad(const std::string &place, const std::string &found,
                                    const std::string &expected) const {
  return fail(ErrorCode::BadInput,
              fmt::format("{} is {}; {} was expected. Export or fetch the file again.", place,
                          found, expected),
              {file_});
}

std::size_t Document::size(const char *list) const {
  const auto found = json().find(list);
  return found == json().end() ? 0 : found->size();
}

Result<std::size_t> Document::whole(const Json &from, const char *key, const std::string &place,
                                    std::size_t fallback, std::size_t low, std::size_t high) const {
  const auto found = from.find(key);
  if (found == from.end())
    return fallback;
  const double value = found->is_number() ? found->get<double>() : -1;
  if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high)) ||
      value != std::floor(value))
    return bad(place + "." + key, shown(*found),
               fmt::format("a whole number from {} to {}", low, high));
  return static_cast<std::size_t>(value);
}

Result<std::optional<std::size_t>> Document::index(const Json &from, const char *key,
                                                   const std::string &place,
                                                   const char *list) const {
  if (!from.contains(key))
    return std::optional<std::size_t>{};
  const std::size_t count = size(list);
  if (count == 0)
    return bad(place + "." + key, shown(from[key]), fmt::format("a file with \"{}\"", list));
  UMOV_ASSIGN(value, whole(from, key, place, 0, 0, count - 1));
  return std::optional(value);
}

Result<void> Document::split_glb(std::string_view bytes, std::string_view &json) {
  const auto cut = [&](const std::string &what) {
    return fail(
        ErrorCode::BadInput,
        fmt::format("{}. The GLB file was cut off or damaged: export or fetch it again.", what),
        {file_});
  };
  if (bytes.size() < 20)
    return cut(fmt::format("{} bytes; a header of 12 and a chunk were expected", bytes.size()));
  const auto version = number_at<std::uint32_t>(bytes, 4),
             length = number_at<std::uint32_t>(bytes, 8);
  if (version != 2)
    return cut(fmt::format("version {}; 2 was expected", version));
  if (length > bytes.size())
    return cut(fmt::format("the header speaks of {} bytes, the file has {}", length, bytes.size()));
  bytes = bytes.substr(0, length);
  bool has_json = false;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const std::size_t size = number_at<std::uint32_t>(bytes, at);
    const auto kind = number_at<std::uint32_t>(bytes, at + 4);
    at += 8;
    if (size > bytes.size() - at)
      return cut(fmt::format("a chunk of {} bytes where {} are left", size, bytes.size() - at));
    if (!has_json && kind != json_chunk)
      return cut("the first chunk is no JSON; JSON was expected");
    if (kind == json_chunk && !has_json)
      json = bytes.substr(at, size);
    else if (kind == bin_chunk && !chunk_)
      chunk_ = std::string(bytes.substr(at, size));
    has_json = true;
    at += size;
  }
  return {};
}

Result<void> Document::parse(std::string_view text, bool is_glb) {
  if (text.starts_with("\xEF\xBB\xBF"))
    text.remove_prefix(3);
  const Scan found = scan(text, cancel_);
  if (found.deepest > deepest || found.values > most_values)
    return fail(ErrorCode::BadInput,
                fmt::format("JSON of {} values, nested {} deep; up to {} and {} were expected. "
                            "Simplify the file.",
                            found.values, found.deepest, most_values, deepest),
                {file_});
  try {
    const Letters end(text.data() + text.size(), nullptr);
    json_ = std::make_shared<const Json>(Json::parse(Letters(text.data(), cancel_), end));
  } catch (const Json::parse_error &problem) {
    Where where{file_};
    if (!is_glb) // nlohmann counts bytes from 1
      std::tie(where.line, where.column) =
          line_and_column(text, problem.byte - std::min<std::size_t>(problem.byte, 1));
    return fail(ErrorCode::BadInput,
                fmt::format("the JSON of the glTF file is broken ({}). Export or fetch it again.",
                            json_words(problem.what())),
                std::move(where));
  } catch (const Json::exception &) { // a number that no double holds
    return fail(ErrorCode::BadInput,
                "the JSON of the glTF file has a number out of range; finite numbers were "
                "expected. Export or fetch it again.",
                {file_});
  }
  if (!json().is_object())
    return bad("the JSON", shown(json()), "an object with \"asset\"");
  return {};
}

Result<void> Document::check_lists() const {
  for (const char *name : lists) {
    const auto list = json().find(name);
    if (list == json().end())
      continue;
    if (!list->is_array())
      return bad(name, shown(*list), "a list");
    for (std::size_t i = 0; i < list->size(); ++i)
      if (!(*list)[i].is_object())
        return bad(fmt::format("{}[{}]", name, i), shown((*list)[i]), "an object");
  }
  return {};
}

Result<void> Document::check_version() const {
  const auto asset = json().find("asset");
  const bool has_version = asset != json().end() && asset->is_object() &&
                           asset->contains("version") && (*asset)["version"].is_string();
  if (!has_version)
    return fail(ErrorCode::BadInput,
                "no asset.version; a glTF file of version 2 was expected. Is it another kind of "
                "JSON?",
                {file_});
  const std::string version = (*asset)["version"].get<std::string>();
  if (!version.starts_with("2."))
    return bad("asset.version", "\"" + clean_name(version) + "\"", "2.0");
  const auto extensions = json().find("extensionsRequired");
  if (extensions == json().end())
    return {};
  if (!extensions->is_array())
    return bad("extensionsRequired", shown(*extensions), "a list");
  // What changes the look only, and quantization, which the accessors read anyway.
  constexpr std::string_view harmless[] = {
      "KHR_materials_", "KHR_texture_", "KHR_mesh_quantization", "KHR_lights_",
      "KHR_xmp",        "EXT_texture_", "KHR_animation_",        "EXT_lights_"};
  for (const Json &one : *extensions) {
    const std::string name = one.is_string() ? one.get<std::string>() : shown(one);
    if (std::none_of(std::begin(harmless), std::end(harmless),
                     [&](std::string_view known) { return name.starts_with(known); }))
      return fail(
          ErrorCode::BadInput,
          fmt::format("the file requires the extension {}, which umov does not read. Export "
                      "it without (no Draco or meshopt compression, no instancing).",
                      clean_name(name)),
          {file_});
  }
  return {};
}

Result<Document> Document::open(std::string_view bytes, const std::filesystem::path &path,
                                std::size_t max_elements, const std::atomic<bool> *cancel) {
  Document out;
  out.cancel_ = cancel;
  out.file_ = path.string();
  out.folder_ = path.parent_path();
  out.max_elements_ = max_elements;
  std::string_view json = bytes;
  const bool is_glb = bytes.size() >= 4 && number_at<std::uint32_t>(bytes, 0) == glb_magic;
  if (is_glb)
    UMOV_TRY(out.split_glb(bytes, json));
  UMOV_TRY(out.parse(json, is_glb));
  UMOV_TRY(out.check_lists());
  UMOV_TRY(out.check_version());
  return out;
}

} // namespace umov::mesh_io::gltf
