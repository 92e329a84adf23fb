#pragma once
// Private: a glTF 2.0 document: its JSON, its buffers, and numbers in them, nothing of which is
// believed before it is held against the bytes that are there.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <umov/io/mesh_file.h>
#include <vector>

namespace umov::mesh_io::gltf {

using Json = nlohmann::json;

/// Numbers of one kind in a buffer.
class Accessor {
public:
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t components() const { return components_; }
  [[nodiscard]] bool is_index() const; ///< scalar, unsigned, not normalized
  /// A component of an element; normalized integers become -1..1 or 0..1.
  [[nodiscard]] double value(std::size_t element, std::size_t component) const;

private:
  friend class Document;
  struct Run {
    std::string_view bytes; ///< from the first element on; empty: zeros
    std::size_t stride = 0;
  };
  [[nodiscard]] double number(const Run &run, std::size_t element, std::size_t component) const;

  std::size_t count_ = 0, components_ = 1;
  int type_ = 5126; ///< componentType of the format: 5120 int8 to 5126 float
  bool is_normalized_ = false;
  Run run_;
  std::vector<std::uint32_t> replaced_; ///< sparse: elements in rising order ...
  Run replacements_;                    ///< ... and what stands for them
};

class Document {
public:
  /// Takes JSON or GLB apart. `path`: for messages, and the folder of external buffers. What is
  /// asked of it later throws Failure (Interrupted) once `cancel`, which may be null, became true.
  static Result<Document> open(std::string_view bytes, const std::filesystem::path &path,
                               std::size_t max_elements, const std::atomic<bool> *cancel);

  [[nodiscard]] const std::string &file() const { return file_; }
  /// The number of entries of a list of the document, such as "nodes".
  [[nodiscard]] std::size_t size(const char *list) const;
  /// Entry of a list; `i` lies below `size`. Entries that are no objects are refused in `open`.
  [[nodiscard]] const Json &entry(const char *list, std::size_t i) const { return json()[list][i]; }
  [[nodiscard]] const Json &json() const { return *json_; }
  /// The accessor of that number, checked when first asked for.
  Result<const Accessor *> accessor(std::size_t i);
  /// Index of an entry of `list` under a key, if the key is there.
  Result<std::optional<std::size_t>> index(const Json &from, const char *key,
                                           const std::string &place, const char *list) const;
  /// A whole number from `low` to `high` under a key, or `fallback` where it is absent.
  Result<std::size_t> whole(const Json &from, const char *key, const std::string &place,
                            std::size_t fallback, std::size_t low, std::size_t high) const;
  [[nodiscard]] tl::unexpected<Error> bad(const std::string &place, const std::string &found,
                                          const std::string &expected) const;
  /// Buffers read from files.
  [[nodiscard]] const std::vector<MeshPart> &files() const { return files_; }

private:
  Result<void> split_glb(std::string_view bytes, std::string_view &json);
  Result<void> parse(std::string_view text, bool is_glb);
  Result<void> check_lists() const;
  Result<void> check_version() const;
  Result<std::string_view> buffer(std::size_t i);
  Result<std::string> load_buffer(const Json &buffer, const std::string &place, std::size_t i);
  Result<std::string> load_uri(const std::string &uri, const std::string &place);
  Result<std::string_view> view_bytes(std::size_t view, std::size_t &stride);
  Result<Accessor::Run> run(const Json &from, const std::string &place, std::size_t count,
                            std::size_t element_bytes, bool may_stride);
  Result<Accessor> read_accessor(std::size_t i);
  Result<void> read_sparse(const Json &sparse, const std::string &place, Accessor &out);

  std::string file_;
  std::filesystem::path folder_;
  std::size_t max_elements_ = 0;
  const std::atomic<bool> *cancel_ = nullptr;
  std::shared_ptr<const Json> json_;
  std::optional<std::string> chunk_; ///< the second part of a GLB
  std::map<std::size_t, std::shared_ptr<const std::string>> buffers_;
  std::map<std::size_t, std::shared_ptr<const Accessor>> accessors_;
  std::size_t bytes_read_ = 0;
  std::vector<MeshPart> files_;
};

} // namespace umov::mesh_io::gltf
