#include <umov/io/obj.h>

#include "io/mesh/mesh_parts.h"
#include "io/mesh/obj_lines.h"
#include "io/mesh/readers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <umov/core/files.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>

namespace umov {
namespace {

using mesh_io::Corner;
using mesh_io::farthest;
using mesh_io::leaves_folder;
using obj::Lines;
using obj::Word;
namespace fs = std::filesystem;

/// Statements of the format that change no triangle: smoothing and appearance.
constexpr std::string_view harmless[] = {"s",          "lod", "bevel",  "c_interp", "d_interp",
                                         "shadow_obj", "mg",  "usemap", "maplib",   "trace_obj"};
/// Statements that bring geometry which is not read: the user must know.
constexpr std::string_view unread[] = {"vp",   "deg",  "bmat", "step",  "cstype", "curv", "curv2",
                                       "surf", "parm", "trim", "hole",  "scrv",   "sp",   "end",
                                       "con",  "call", "csh",  "ctech", "stech"};

class Reader {
public:
  Reader(std::string_view text, const std::string &file, const MeshFileOptions &options,
         const MtlLoader &load_mtl, Diagnostics &diagnostics)
      : lines_(text, file, options.cancel), options_(options), load_mtl_(load_mtl),
        diagnostics_(diagnostics), polygons_(out_.mesh, options) {
    out_.format = "OBJ";
  }

  Result<MeshFile> read();

private:
  Result<void> take(const std::vector<Word> &words);
  Result<Vec3<Body>> vector(const std::vector<Word> &words, const char *what);
  Result<std::array<double, 2>> texture(const std::vector<Word> &words);
  Result<void> take_face(const std::vector<Word> &words);
  Result<Corner> corner(const Word &word);
  Result<std::optional<std::uint32_t>> index(std::string_view text, const Word &word,
                                             std::size_t count, const char *what);
  Result<void> take_mtl(const std::vector<Word> &words);
  Result<void> read_mtl(const std::string &name, const Word &statement);
  Result<bool> takes_mtl(const std::string &name, const Word &statement);
  std::string name_of(const std::vector<Word> &words);
  Result<void> finish();
  void keep_tree();
  std::uint32_t group();

  Lines lines_;
  const MeshFileOptions &options_;
  const MtlLoader &load_mtl_;
  Diagnostics &diagnostics_;
  MeshFile out_;
  mesh_io::GroupIndex groups_{out_.mesh};
  mesh_io::PolygonMaker polygons_;
  std::string material_, object_;
  bool has_material_ = false;
  std::map<std::string, Word, std::less<>> unknown_; ///< statements that are none, where first seen
  std::map<std::string, bool> mtl_; ///< files that were asked for, and whether they could be read
  std::size_t skipped_ = 0;
  bool has_odd_names_ = false;
};

Result<Vec3<Body>> Reader::vector(const std::vector<Word> &words, const char *what) {
  if (words.size() < 4)
    return fail(ErrorCode::BadInput,
                fmt::format("a {} with {} numbers; 3 were expected", what, words.size() - 1),
                lines_.where(words[0]));
  UMOV_ASSIGN(x, obj::number(lines_, words[1]));
  UMOV_ASSIGN(y, obj::number(lines_, words[2]));
  UMOV_ASSIGN(z, obj::number(lines_, words[3]));
  return Vec3<Body>{x, y, z};
}

/// One index of a corner: positive counts from the first element, negative from the last so far.
Result<std::optional<std::uint32_t>> Reader::index(std::string_view text, const Word &word,
                                                   std::size_t count, const char *what) {
  if (text.empty())
    return std::optional<std::uint32_t>{};
  std::int64_t value = 0;
  const auto [stop, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  const auto size = static_cast<std::int64_t>(count);
  if (status == std::errc() && stop == text.data() + text.size()) {
    if (value > 0 && value <= size)
      return std::optional(static_cast<std::uint32_t>(value - 1));
    if (value < 0 && value >= -size)
      return std::optional(static_cast<std::uint32_t>(size + value));
  }
  std::string found = fmt::format("{} index \"{}\"", what, mesh_io::clean_name(text.substr(0, 40)));
  if (text != word.text)
    found += fmt::format(" in \"{}\"", mesh_io::clean_name(word.text.substr(0, 40)));
  constexpr const char *mend = "Correct it, or export the mesh again";
  if (size == 0)
    return fail(ErrorCode::BadInput,
                fmt::format("{}, but no {} precedes this line. {}", found, what, mend),
                lines_.where(word));
  const bool is_vertex = what == std::string_view("vertex");
  return fail(ErrorCode::BadInput,
              fmt::format("{}; 1 to {} (or -1 to -{}) was expected, with {} above this line. {}",
                          found, size, size,
                          counted(count, what, is_vertex ? "vertices" : std::string_view()), mend),
              lines_.where(word));
}

Result<Corner> Reader::corner(const Word &word) {
  std::string_view parts[3];
  std::size_t count = 0;
  std::string_view rest = word.text;
  for (bool more = true; more; ++count) {
    const std::size_t slash = rest.find('/');
    more = slash != std::string_view::npos;
    if (count == 3 || (more && slash + 1 == rest.size()))
      return fail(ErrorCode::BadInput,
                  fmt::format("corner \"{}\"; v, v/t, v//n or v/t/n was expected. Correct it, or "
                              "export the mesh again",
                              mesh_io::clean_name(word.text.substr(0, 40))),
                  lines_.where(word));
    parts[count] = rest.substr(0, slash);
    rest = more ? rest.substr(slash + 1) : std::string_view();
  }
  Corner out;
  UMOV_ASSIGN(vertex, index(parts[0], word, out_.mesh.positions.size(), "vertex"));
  UMOV_ASSIGN(texture, index(parts[1], word, polygons_.textures.size(), "texture coordinate"));
  UMOV_ASSIGN(normal, index(parts[2], word, out_.mesh.normals.size(), "normal"));
  if (!vertex)
    return fail(
        ErrorCode::BadInput,
        fmt::format("corner \"{}\" has no vertex; v, v/t, v//n or v/t/n was expected. Correct "
                    "it, or export the mesh again",
                    mesh_io::clean_name(word.text.substr(0, 40))),
        lines_.where(word));
  out.vertex = *vertex;
  out.normal = normal.value_or(no_index);
  out.texture = texture.value_or(no_index);
  return out;
}

/// vt u [v [w]]: v is 0 where it is absent.
Result<std::array<double, 2>> Reader::texture(const std::vector<Word> &words) {
  std::array<double, 2> out{};
  if (words.size() < 2)
    return fail(ErrorCode::BadInput, "a texture coordinate without numbers",
                lines_.where(words[0]));
  for (std::size_t k = 0; k < 2 && k + 1 < words.size(); ++k) {
    UMOV_ASSIGN(value, obj::number(lines_, words[k + 1]));
    out[k] = value;
  }
  return out;
}

std::uint32_t Reader::group() {
  const std::string node = object_.empty() ? "default" : object_;
  return groups_.of(has_material_ ? material_ : node, node);
}

Result<void> Reader::take_face(const std::vector<Word> &words) {
  std::vector<Corner> corners;
  for (std::size_t i = 1; i < words.size() && words.size() > 3; ++i) {
    UMOV_ASSIGN(one, corner(words[i]));
    corners.push_back(one);
  }
  return polygons_.add(corners, corners.empty() ? 0 : group(), lines_.where(words[0]));
}

Result<void> Reader::take_mtl(const std::vector<Word> &words) {
  // One name with blanks in it, or several names: the format leaves it open.
  const std::string whole = obj::name_from(words, 1);
  std::vector<std::string> names{whole};
  if (words.size() > 2) {
    bool is_one = !leaves_folder(whole);
    if (is_one) {
      UMOV_ASSIGN(is_there, takes_mtl(whole, words[0]));
      is_one = is_there;
    }
    if (!is_one)
      names.clear();
    for (std::size_t i = 1; !is_one && i < words.size(); ++i)
      names.emplace_back(words[i].text);
  }
  for (const std::string &name : names) {
    if (leaves_folder(name))
      return fail(
          ErrorCode::BadInput,
          fmt::format("mtllib \"{}\" leaves the folder of the mesh; put the MTL file beside "
                      "the OBJ file",
                      printable(name)),
          lines_.where(words[1]));
    UMOV_TRY(read_mtl(name, words[0]));
  }
  return {};
}

Result<void> Reader::read_mtl(const std::string &name, const Word &statement) {
  UMOV_ASSIGN(is_there, takes_mtl(name, statement));
  if (is_there)
    return {};
  if (options_.asks_for_mtl)
    diagnostics_.warn(
        fmt::format("mtllib \"{}\" cannot be read; its materials are names alone", printable(name)),
        lines_.where(statement));
  return {};
}

/// Reads a file of materials, once however often it is named; false if it cannot be read.
Result<bool> Reader::takes_mtl(const std::string &name, const Word &statement) {
  constexpr std::size_t most = 1000;
  const auto [known, is_new] = mtl_.emplace(fs::path(name).lexically_normal().string(), false);
  if (!is_new)
    return known->second;
  if (mtl_.size() > most)
    return fail(ErrorCode::BadInput,
                fmt::format("more than {} MTL files; join them into one", most),
                lines_.where(statement));
  const auto text = load_mtl_(name);
  if (!text)
    return false;
  known->second = true;
  out_.files.push_back({name, sha256_hex(*text)});
  Lines lines(*text, name, options_.cancel);
  for (std::vector<Word> mtl; lines.next(mtl);)
    if (mtl[0].text == "newmtl")
      out_.defined.push_back(name_of(mtl));
  return true;
}

/// The name that a statement gives: what would work on a terminal or in a page becomes '?'.
std::string Reader::name_of(const std::vector<Word> &words) {
  bool is_changed = false;
  std::string out = printable(obj::name_from(words, 1), &is_changed);
  has_odd_names_ = has_odd_names_ || is_changed;
  return out;
}

Result<void> Reader::take(const std::vector<Word> &words) {
  const std::string_view key = words[0].text;
  if (key == "v") {
    UMOV_ASSIGN(v, vector(words, "vertex"));
    if (const double reach = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        reach > farthest)
      return fail(
          ErrorCode::BadInput,
          fmt::format("a vertex at {:g}; coordinates up to {:g} were expected", reach, farthest),
          lines_.where(words[1]));
    out_.mesh.positions.push_back(v);
  } else if (key == "vn") {
    UMOV_ASSIGN(n, vector(words, "normal"));
    out_.mesh.normals.push_back(n);
  } else if (key == "vt") {
    UMOV_ASSIGN(uv, texture(words));
    polygons_.textures.push_back(uv);
  } else if (key == "f") {
    return take_face(words);
  } else if (key == "usemtl") {
    material_ = name_of(words);
    has_material_ = !material_.empty();
  } else if (key == "mtllib") {
    return take_mtl(words);
  } else if (key == "o" || key == "g") {
    object_ = name_of(words);
  } else if (key == "l" || key == "p") {
    ++skipped_;
  } else if (std::find(std::begin(harmless), std::end(harmless), key) == std::end(harmless)) {
    if (std::any_of(key.begin(), key.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7f; }))
      return fail(ErrorCode::BadInput,
                  "this is no OBJ text (a byte that is not printable); is it another format?",
                  lines_.where(words[0]));
    unknown_.emplace(key.substr(0, 40), words[0]);
  }
  return {};
}

/// The names of o and g are nodes, without a tree, where they say more than the materials do.
void Reader::keep_tree() {
  Mesh &mesh = out_.mesh;
  const std::set<std::string> nodes(mesh.nodes.begin(), mesh.nodes.end());
  if (nodes.size() < 2 || mesh.nodes == mesh.groups) {
    mesh.nodes.clear();
    return;
  }
  std::map<std::string, std::size_t> triangles;
  for (const Triangle &t : mesh.triangles)
    ++triangles[mesh.nodes[t.front]];
  for (const auto &[name, count] : triangles)
    out_.nodes.push_back({name, {}, count});
}

Result<void> Reader::finish() {
  const Where file{lines_.file()};
  for (const auto &[name, first] : unknown_) {
    const bool is_geometry =
        std::find(std::begin(unread), std::end(unread), name) != std::end(unread);
    const char *what = is_geometry ? "brings geometry that is not read (free-form or another file)"
                                   : "is no statement of the OBJ format";
    diagnostics_.warn(fmt::format("\"{}\" {}; such lines were skipped", name, what),
                      lines_.where(first));
  }
  polygons_.finish();
  keep_tree();
  UMOV_TRY(mesh_io::to_body_frame(out_, options_, lines_.file(), diagnostics_));
  if (skipped_ > 0)
    diagnostics_.warn(
        skipped_ == 1 ? std::string("1 point or line was skipped: it has no area")
                      : fmt::format("{} points or lines were skipped: they have no area", skipped_),
        file);
  if (has_odd_names_)
    diagnostics_.warn("names hold bytes that are no printable UTF-8; each of them became '?'",
                      file);
  polygons_.warn(diagnostics_, file);
  return {};
}

Result<MeshFile> Reader::read() {
  for (std::vector<Word> words; lines_.next(words);)
    UMOV_TRY(take(words));
  UMOV_TRY(finish());
  return std::move(out_);
}

} // namespace

Result<MeshFile> read_obj_text(std::string_view text, const std::string &file,
                               const MeshFileOptions &options, const MtlLoader &load_mtl,
                               Diagnostics &diagnostics) {
  return without_failures(
      [&] { return Reader(text, file, options, load_mtl, diagnostics).read(); });
}

Result<MeshFile> mesh_io::read_obj_bytes(std::string_view bytes, const fs::path &path,
                                         const MeshFileOptions &options, Diagnostics &diagnostics) {
  const MtlLoader loader = [&](const std::string &name) {
    return read_file(path.parent_path() / name);
  };
  UMOV_ASSIGN(out, read_obj_text(bytes, path.string(), options, loader, diagnostics));
  for (MeshPart &file : out.files)
    file.path = path.parent_path() / file.path;
  return std::move(out);
}

Result<MeshFile> read_obj(const fs::path &path, const MeshFileOptions &options,
                          Diagnostics &diagnostics) {
  UMOV_ASSIGN(text, read_file(path));
  return mesh_io::read_obj_bytes(text, path, options, diagnostics);
}

} // namespace umov
