// STL: triangles without shared corners, as text or as 50 bytes each. The facet normals of the file
// are left aside: the order of the corners says the same, and exporters often get them wrong.

#include "io/mesh/bytes.h"
#include "io/mesh/mesh_parts.h"
#include "io/mesh/obj_lines.h"
#include "io/mesh/readers.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/stop.h>

namespace umov::mesh_io {
namespace {

using obj::Word;

constexpr std::size_t header_bytes = 80, count_bytes = 4, facet_bytes = 50;

std::string lower(std::string_view text) {
  std::string out(text.substr(0, 40));
  for (char &c : out)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

class TextReader {
public:
  TextReader(std::string_view text, const std::string &file, const MeshFileOptions &options)
      : lines_(text, file, options.cancel), polygons_(out_.mesh, options) {}

  Result<MeshFile> read(Diagnostics &diagnostics);

private:
  Result<void> read_solids(Diagnostics &diagnostics);
  /// The next word of the body, or an empty one at the end.
  Word word();
  Result<void> expect(const char *wanted);
  Result<void> facet(const Word &begin);
  Result<Vec3<Body>> vector();

  obj::Lines lines_;
  std::vector<Word> words_;
  std::size_t next_ = 0;
  Word last_;
  MeshFile out_;
  GroupIndex groups_{out_.mesh};
  PolygonMaker polygons_;
  std::string solid_ = "default";
};

Word TextReader::word() {
  if (next_ >= words_.size()) {
    next_ = 0;
    if (!lines_.next(words_))
      return {};
  }
  return last_ = words_[next_++];
}

Result<void> TextReader::expect(const char *wanted) {
  const Word found = word();
  if (lower(found.text) == wanted)
    return {};
  if (found.text.empty())
    return fail(ErrorCode::BadInput,
                fmt::format("the file ends where \"{}\" was expected; it was cut off. Export or "
                            "fetch it again.",
                            wanted),
                lines_.where(last_));
  return fail(ErrorCode::BadInput,
              fmt::format("\"{}\" stands where \"{}\" was expected. Export the file again.",
                          clean_name(found.text.substr(0, 40)), wanted),
              lines_.where(found));
}

Result<Vec3<Body>> TextReader::vector() {
  Vec3<Body> out;
  for (double *value : {&out.x, &out.y, &out.z}) {
    const Word found = word();
    if (found.text.empty())
      return fail(ErrorCode::BadInput,
                  "the file ends inside a vertex; it was cut off. Export or fetch it again.",
                  lines_.where(last_));
    UMOV_ASSIGN(number, obj::number(lines_, found));
    *value = number;
  }
  if (is_out_of_reach(out))
    return fail(ErrorCode::BadInput,
                fmt::format("a vertex at {}; coordinates up to {:g} were expected", point_text(out),
                            farthest),
                lines_.where(last_));
  return out;
}

Result<void> TextReader::facet(const Word &begin) {
  // The normal may be any three words: some exporters write NaN for slivers.
  UMOV_TRY(expect("normal"));
  for (int k = 0; k < 3; ++k)
    word();
  UMOV_TRY(expect("outer"));
  UMOV_TRY(expect("loop"));
  std::vector<Corner> corners;
  for (Word at = word(); lower(at.text) != "endloop"; at = word()) {
    if (lower(at.text) != "vertex")
      return fail(ErrorCode::BadInput,
                  fmt::format("\"{}\" stands where \"vertex\" or \"endloop\" was expected; the "
                              "file is damaged or cut off. Export or fetch it again.",
                              clean_name(at.text.substr(0, 40))),
                  lines_.where(at.text.empty() ? last_ : at));
    UMOV_ASSIGN(v, vector());
    corners.push_back({.vertex = static_cast<std::uint32_t>(out_.mesh.positions.size())});
    out_.mesh.positions.push_back(v);
  }
  UMOV_TRY(polygons_.add(corners, groups_.of(solid_), lines_.where(begin)));
  return expect("endfacet");
}

Result<void> TextReader::read_solids(Diagnostics &diagnostics) {
  bool is_open = false;
  for (Word at = word(); !at.text.empty(); at = word()) {
    const std::string key = lower(at.text);
    if (key == "solid" || key == "endsolid") { // the name takes the rest of the line
      const std::string name = clean_name(obj::name_from(words_, next_));
      next_ = words_.size();
      is_open = key == "solid";
      if (is_open)
        solid_ = name.empty() ? "default" : name;
    } else if (key == "facet") {
      UMOV_TRY(facet(at));
    } else {
      return fail(ErrorCode::BadInput,
                  fmt::format("\"{}\" stands where \"facet\" or \"endsolid\" was expected. Export "
                              "the file again.",
                              clean_name(at.text.substr(0, 40))),
                  lines_.where(at));
    }
  }
  if (is_open)
    diagnostics.warn("the last solid has no \"endsolid\"; was the file cut off?",
                     lines_.where(last_));
  return {};
}

Result<MeshFile> TextReader::read(Diagnostics &diagnostics) {
  const auto done = read_solids(diagnostics);
  if (lines_.cut_line() > 0)
    return fail(ErrorCode::BadInput,
                fmt::format("a line of more than {} words; write each vertex on a line of its own",
                            obj::words_max),
                {lines_.file(), lines_.cut_line()});
  UMOV_TRY(done);
  polygons_.finish();
  polygons_.warn(diagnostics, {lines_.file()});
  return std::move(out_);
}

Result<MeshFile> read_binary(std::string_view bytes, const std::string &file,
                             const MeshFileOptions &options, Diagnostics &diagnostics) {
  if (bytes.size() < header_bytes + count_bytes)
    return fail(
        ErrorCode::BadInput,
        fmt::format("{} bytes, and no \"solid\" at the beginning; an STL file is text or has "
                    "a header of {} bytes. Export or fetch it again.",
                    bytes.size(), header_bytes + count_bytes),
        {file});
  const std::size_t count = number_at<std::uint32_t>(bytes, header_bytes);
  const std::size_t there = (bytes.size() - header_bytes - count_bytes) / facet_bytes;
  if (count > there)
    return fail(ErrorCode::BadInput,
                fmt::format("the header counts {} triangles, but the {} bytes of the file hold {}. "
                            "It was cut off or is no STL: export or fetch it again.",
                            count, bytes.size(), there),
                {file});
  if (count > options.max_triangles)
    return too_many_triangles(options.max_triangles, {file});
  if (bytes.size() != header_bytes + count_bytes + count * facet_bytes)
    diagnostics.warn(fmt::format("{} bytes follow the {} triangles of the header; they were not "
                                 "read",
                                 bytes.size() - header_bytes - count_bytes - count * facet_bytes,
                                 count),
                     {file});
  MeshFile out;
  GroupIndex groups(out.mesh);
  for (std::size_t i = 0; i < count; ++i) {
    leave_if_stopped(options.cancel, i);
    Triangle triangle;
    triangle.front = triangle.back = groups.of("default");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = header_bytes + count_bytes + i * facet_bytes + 12 * (k + 1);
      const Vec3<Body> v{number_at<float>(bytes, at), number_at<float>(bytes, at + 4),
                         number_at<float>(bytes, at + 8)};
      if (is_out_of_reach(v))
        return fail(ErrorCode::BadInput,
                    fmt::format("triangle {} of {} has a vertex at {}; finite coordinates up to "
                                "{:g} were expected. Export or fetch the file again.",
                                i + 1, count, point_text(v), farthest),
                    {file});
      triangle.vertex[k] = static_cast<std::uint32_t>(out.mesh.positions.size());
      out.mesh.positions.push_back(v);
    }
    out.mesh.triangles.push_back(triangle);
  }
  return out;
}

} // namespace

bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= header_bytes + count_bytes &&
         bytes.size() ==
             header_bytes + count_bytes +
                 std::size_t{number_at<std::uint32_t>(bytes, header_bytes)} * facet_bytes;
}

bool is_text_stl(std::string_view bytes) {
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos || lower(bytes.substr(begin, 5)) != "solid")
    return false;
  // A binary header may begin with "solid" too, but has zeros before long.
  return bytes.substr(0, header_bytes + count_bytes).find('\0') == std::string_view::npos;
}

Result<MeshFile> read_stl(std::string_view bytes, const std::string &file,
                          const MeshFileOptions &options, Diagnostics &diagnostics) {
  const bool is_binary = is_binary_stl(bytes) || !is_text_stl(bytes);
  auto out = is_binary ? read_binary(bytes, file, options, diagnostics)
                       : TextReader(bytes, file, options).read(diagnostics);
  if (out) {
    out->format = "STL";
    join_equal(out->mesh, options.cancel);
  }
  return out;
}

} // namespace umov::mesh_io
