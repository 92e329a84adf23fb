#include <umov/io/obj.h>

#include "io/mesh/obj_lines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/shape/triangulate.h>

namespace umov {
namespace {

using obj::Lines;
using obj::Word;
namespace fs = std::filesystem;

struct Unit {
  const char *name;
  double metres;
};
/// Statements of the format that change no triangle: smoothing and appearance.
constexpr std::string_view harmless[] = {"s",          "lod", "bevel",  "c_interp", "d_interp",
                                         "shadow_obj", "mg",  "usemap", "maplib",   "trace_obj"};
/// Statements that bring geometry which is not read: the user must know.
constexpr std::string_view unread[] = {"vp",   "deg",  "bmat", "step",  "cstype", "curv", "curv2",
                                       "surf", "parm", "trim", "hole",  "scrv",   "sp",   "end",
                                       "con",  "call", "csh",  "ctech", "stech"};
constexpr double farthest = 1e12; ///< beyond it areas lose their meaning [units of the file]

constexpr Unit units[] = {{"m", 1},     {"cm", 0.01},   {"mm", 0.001},
                          {"km", 1000}, {"in", 0.0254}, {"ft", 0.3048}};

Vec3<Body> turned(Vec3<Body> v, const std::string &up) {
  if (up == "+Y")
    return {v.x, -v.z, v.y};
  if (up == "+X")
    return {v.y, v.z, v.x};
  if (up == "-Z")
    return {v.x, -v.y, -v.z};
  if (up == "-Y")
    return {v.x, v.z, -v.y};
  if (up == "-X")
    return {-v.y, v.z, -v.x};
  return v;
}

struct Corner {
  std::uint32_t vertex = no_index, normal = no_index, texture = no_index;
};

/// True if a name could lead out of the folder of the mesh.
bool leaves_folder(const std::string &name) {
  const fs::path path(name);
  return path.is_absolute() || name.find('\\') != std::string::npos ||
         std::find(path.begin(), path.end(), fs::path("..")) != path.end();
}

class Reader {
public:
  Reader(std::string_view text, const std::string &file, const ObjOptions &options,
         const MtlLoader &load_mtl, Diagnostics &diagnostics)
      : lines_(text, file), options_(options), load_mtl_(load_mtl), diagnostics_(diagnostics) {}

  Result<ObjMesh> read();

private:
  Result<void> take(const std::vector<Word> &words);
  Result<Vec3<Body>> vector(const std::vector<Word> &words, const char *what);
  Result<std::array<double, 2>> texture(const std::vector<Word> &words);
  [[nodiscard]] Vec3<Body> tangent(const std::array<Corner, 3> &corners) const;
  Result<void> take_face(const std::vector<Word> &words);
  Result<Corner> corner(const Word &word);
  Result<std::optional<std::uint32_t>> index(std::string_view text, const Word &word,
                                             std::size_t count, const char *what);
  Result<void> take_mtl(const std::vector<Word> &words);
  Result<void> read_mtl(const std::string &name, const Word &statement);
  Result<void> finish();
  std::uint32_t group();
  [[nodiscard]] std::string box_text(const char *key) const;

  Lines lines_;
  const ObjOptions &options_;
  const MtlLoader &load_mtl_;
  Diagnostics &diagnostics_;
  ObjMesh out_;
  std::map<std::string, std::uint32_t> group_index_;
  std::string material_, object_;
  bool has_material_ = false;
  std::map<std::string, Word, std::less<>> unknown_; ///< statements that are none, where first seen
  std::vector<std::array<double, 2>> texture_;       ///< u, v
  std::size_t skipped_ = 0, short_faces_ = 0, concave_ = 0, crossed_ = 0, bent_ = 0;
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
  if (size == 0)
    return fail(ErrorCode::BadInput,
                fmt::format("{} index \"{}\" in \"{}\", but no {} precedes this line", what, text,
                            word.text.substr(0, 40), what),
                lines_.where(word));
  return fail(
      ErrorCode::BadInput,
      fmt::format("{} index \"{}\" in \"{}\"; 1 to {} (or -1 to -{}) was expected, since {} "
                  "{}{} precede this line",
                  what, text, word.text.substr(0, 40), size, size, size,
                  what == std::string_view("vertex") ? "vertices" : what,
                  what == std::string_view("vertex") ? "" : "s"),
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
      return fail(
          ErrorCode::BadInput,
          fmt::format("corner \"{}\"; v, v/t, v//n or v/t/n was expected", word.text.substr(0, 40)),
          lines_.where(word));
    parts[count] = rest.substr(0, slash);
    rest = more ? rest.substr(slash + 1) : std::string_view();
  }
  Corner out;
  UMOV_ASSIGN(vertex, index(parts[0], word, out_.mesh.positions.size(), "vertex"));
  UMOV_ASSIGN(texture, index(parts[1], word, texture_.size(), "texture coordinate"));
  UMOV_ASSIGN(normal, index(parts[2], word, out_.mesh.normals.size(), "normal"));
  if (!vertex)
    return fail(ErrorCode::BadInput, "a corner without a vertex index", lines_.where(word));
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

/// Direction in which the first texture coordinate grows; zero without one.
Vec3<Body> Reader::tangent(const std::array<Corner, 3> &c) const {
  for (const Corner &one : c)
    if (one.texture == no_index)
      return {};
  const auto &p = out_.mesh.positions;
  const Vec3<Body> a = p[c[1].vertex] - p[c[0].vertex], b = p[c[2].vertex] - p[c[0].vertex];
  const auto &t0 = texture_[c[0].texture], &t1 = texture_[c[1].texture],
             &t2 = texture_[c[2].texture];
  const double du1 = t1[0] - t0[0], dv1 = t1[1] - t0[1], du2 = t2[0] - t0[0], dv2 = t2[1] - t0[1];
  const double area = du1 * dv2 - du2 * dv1;
  const Vec3<Body> along = std::copysign(1.0, area) * (dv2 * a - dv1 * b);
  return area != 0 && norm(along) > 0 ? normalized(along) : Vec3<Body>{};
}

std::uint32_t Reader::group() {
  const std::string &name = has_material_ ? material_ : object_.empty() ? "default" : object_;
  const auto [entry, is_new] =
      group_index_.emplace(name, static_cast<std::uint32_t>(out_.mesh.groups.size()));
  if (is_new)
    out_.mesh.groups.push_back(name);
  return entry->second;
}

Result<void> Reader::take_face(const std::vector<Word> &words) {
  if (words.size() < 4) {
    ++short_faces_;
    return {};
  }
  if (out_.mesh.triangles.size() + words.size() - 3 > options_.max_triangles)
    return fail(ErrorCode::BadInput,
                fmt::format("more than {} triangles; simplify the mesh", options_.max_triangles),
                lines_.where(words[0]));
  std::vector<Corner> corners;
  std::vector<Vec3<Body>> points;
  for (std::size_t i = 1; i < words.size(); ++i) {
    UMOV_ASSIGN(one, corner(words[i]));
    corners.push_back(one);
    points.push_back(out_.mesh.positions[one.vertex]);
  }
  const bool has_normals = std::all_of(corners.begin(), corners.end(),
                                       [](const Corner &c) { return c.normal != no_index; });
  const Triangulation split = triangulate(points);
  concave_ += split.is_simple && !split.is_convex ? 1u : 0u;
  crossed_ += split.is_simple ? 0u : 1u;
  bent_ += split.is_planar ? 0u : 1u;
  for (const auto &t : split.triangles) {
    Triangle triangle;
    triangle.front = triangle.back = group();
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.vertex[k] = corners[t[k]].vertex;
      triangle.normal[k] = has_normals ? corners[t[k]].normal : no_index;
    }
    out_.mesh.triangles.push_back(triangle);
    out_.mesh.tangents.push_back(tangent({corners[t[0]], corners[t[1]], corners[t[2]]}));
  }
  return {};
}

Result<void> Reader::take_mtl(const std::vector<Word> &words) {
  // One name with blanks in it, or several names: the format leaves it open.
  const std::string whole = obj::name_from(words, 1);
  std::vector<std::string> names{whole};
  if (words.size() > 2 && (leaves_folder(whole) || !load_mtl_(whole))) {
    names.clear();
    for (std::size_t i = 1; i < words.size(); ++i)
      names.emplace_back(words[i].text);
  }
  for (const std::string &name : names) {
    if (leaves_folder(name))
      return fail(
          ErrorCode::BadInput,
          fmt::format("mtllib \"{}\" leaves the folder of the mesh; put the MTL file beside "
                      "the OBJ file",
                      name),
          lines_.where(words[1]));
    UMOV_TRY(read_mtl(name, words[0]));
  }
  return {};
}

Result<void> Reader::read_mtl(const std::string &name, const Word &statement) {
  const auto text = load_mtl_(name);
  if (!text) {
    out_.lacks_mtl = true;
    diagnostics_.warn(fmt::format("mtllib \"{}\" cannot be read", name), lines_.where(statement));
    return {};
  }
  out_.files.emplace_back(name);
  Lines lines(*text, name);
  for (std::vector<Word> mtl; lines.next(mtl);)
    if (mtl[0].text == "newmtl")
      out_.defined.push_back(obj::name_from(mtl, 1));
  return {};
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
    texture_.push_back(uv);
  } else if (key == "f") {
    return take_face(words);
  } else if (key == "usemtl") {
    material_ = obj::name_from(words, 1);
    has_material_ = !material_.empty();
  } else if (key == "mtllib") {
    return take_mtl(words);
  } else if (key == "o" || key == "g") {
    object_ = obj::name_from(words, 1);
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

/// The size of the box for messages about units.
std::string Reader::box_text(const char *key) const {
  Vec3<Body> low{INFINITY, INFINITY, INFINITY}, high = -1 * low;
  for (const Vec3<Body> p : out_.mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3<Body> size = high - low;
  const double longest = std::max({size.x, size.y, size.z});
  const auto length = [](double m) {
    return m >= 1000  ? fmt::format("{:.4g} km", m / 1000)
           : m < 0.01 ? fmt::format("{:.4g} mm", m * 1000)
                      : fmt::format("{:.4g} m", m);
  };
  return fmt::format(
      "no {}. The bounding box is {:.6g} x {:.6g} x {:.6g}: in mm that is {}, in m it "
      "is {}. Set unit = \"{}\" (or cm, km, in, ft) and up = \"+Z\" (the axis of the "
      "file that is up).",
      key, size.x, size.y, size.z, length(longest / 1000), length(longest),
      longest > 200 ? "mm" : "m");
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
  if (out_.mesh.triangles.empty())
    return fail(ErrorCode::BadInput, "no face; a mesh of polygons was expected", file);
  if (options_.unit.empty())
    return fail(ErrorCode::BadInput, box_text("unit"), file);
  const auto *unit = std::find_if(std::begin(units), std::end(units),
                                  [&](const Unit &u) { return options_.unit == u.name; });
  if (unit == std::end(units))
    return fail(ErrorCode::BadInput,
                "unit = \"" + options_.unit + "\"; m, cm, mm, km, in or ft was expected", file);
  if (options_.up.empty())
    return fail(ErrorCode::BadInput, box_text("up axis"), file);
  if (options_.up.size() != 2 || (options_.up[0] != '+' && options_.up[0] != '-') ||
      options_.up[1] < 'X' || options_.up[1] > 'Z')
    return fail(ErrorCode::BadInput, "up = \"" + options_.up + "\"; \"+X\" to \"-Z\" was expected",
                file);
  double largest = 0;
  for (Vec3<Body> &p : out_.mesh.positions) {
    p = turned(p * unit->metres, options_.up);
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  if (texture_.empty())
    out_.mesh.tangents.clear();
  for (Vec3<Body> &t : out_.mesh.tangents)
    t = turned(t, options_.up);
  for (Vec3<Body> &n : out_.mesh.normals) {
    const Vec3<Body> t = turned(n, options_.up);
    const double length = norm(t);
    // Already unit to the last bits: left alone, so that writing and reading change nothing.
    n = std::abs(length - 1) < 1e-12 || !(length > 0) ? t : t / length;
  }
  if (largest < 1e-3 || largest > 1e4)
    diagnostics_.warn(
        fmt::format("the mesh reaches {:.3g} m from its origin; is unit = \"{}\" right?", largest,
                    options_.unit),
        file);
  const auto warn = [&](std::size_t count, const char *what) {
    if (count > 0)
      diagnostics_.warn(fmt::format("{} {}", count, what), file);
  };
  warn(skipped_, "points or lines were skipped: they have no area");
  warn(short_faces_, "faces with fewer than three corners were skipped");
  warn(concave_, "polygons are concave; they were split by cutting ears");
  warn(crossed_, "polygons cross themselves; they were split as fans");
  warn(bent_, "polygons are not flat; they were split as they lie");
  return {};
}

Result<ObjMesh> Reader::read() {
  for (std::vector<Word> words; lines_.next(words);)
    UMOV_TRY(take(words));
  UMOV_TRY(finish());
  for (Triangle &t : out_.mesh.triangles) // a zero normal says nothing
    for (std::uint32_t &n : t.normal)
      if (n != no_index && !(norm(out_.mesh.normals[n]) > 0))
        t.normal = {no_index, no_index, no_index};
  return std::move(out_);
}

} // namespace

Result<ObjMesh> read_obj_text(std::string_view text, const std::string &file,
                              const ObjOptions &options, const MtlLoader &load_mtl,
                              Diagnostics &diagnostics) {
  return Reader(text, file, options, load_mtl, diagnostics).read();
}

Result<ObjMesh> read_obj(const fs::path &path, const ObjOptions &options,
                         Diagnostics &diagnostics) {
  UMOV_ASSIGN(text, read_file(path));
  const MtlLoader loader = [&](const std::string &name) {
    return read_file(path.parent_path() / name);
  };
  UMOV_ASSIGN(out, read_obj_text(text, path.string(), options, loader, diagnostics));
  for (fs::path &file : out.files)
    file = path.parent_path() / file;
  return std::move(out);
}

} // namespace umov
