// PLY, the polygon file format (Turk 1994): text or binary in either order of bytes.

#include "io/mesh/bytes.h"
#include "io/mesh/mesh_parts.h"
#include "io/mesh/ply_header.h"
#include "io/mesh/readers.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <umov/core/stop.h>
#include <umov/core/text.h>

namespace umov::mesh_io {
namespace {

using ply::Element;
using ply::Property;
using ply::Type;

constexpr const char *again = "Export or fetch the file again.";

/// Numbers of the body one after the other, whatever the form.
class Values {
public:
  Values(std::string_view bytes, const ply::Header &header, const std::string &file,
         const std::atomic<bool> *cancel)
      : bytes_(bytes), at_(header.body), form_(header.form), line_(header.lines + 1), file_(file),
        cancel_(cancel) {}

  /// False at the end or at a word that is no number; `error` says which.
  bool next(Type type, double &out) {
    leave_if_stopped(cancel_, taken_++);
    return form_ == ply::Form::Text ? word(out) : raw(type, out);
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[nodiscard]] Where where() const {
    return form_ == ply::Form::Text ? Where{file_, line_} : Where{file_};
  }
  [[nodiscard]] const std::string &found() const { return found_; }

private:
  bool word(double &out);
  bool raw(Type type, double &out);

  std::string_view bytes_;
  std::size_t at_;
  ply::Form form_;
  std::size_t line_;
  const std::string &file_;
  const std::atomic<bool> *cancel_;
  std::size_t taken_ = 0;
  std::string found_ = "the end of the file";
};

bool Values::word(double &out) {
  constexpr std::string_view blanks = " \t\r\n\v\f";
  while (at_ < bytes_.size() && blanks.find(bytes_[at_]) != std::string_view::npos)
    line_ += bytes_[at_++] == '\n' ? 1u : 0u;
  const std::size_t begin = at_;
  while (at_ < bytes_.size() && blanks.find(bytes_[at_]) == std::string_view::npos)
    ++at_;
  const std::string_view text = bytes_.substr(begin, at_ - begin);
  if (text.empty())
    return false;
  const auto value = text.size() <= 64 ? parse_number(text) : std::nullopt;
  if (!value) {
    found_ = "\"" + clean_name(text.substr(0, 40)) + "\"";
    return false;
  }
  out = *value;
  return true;
}

bool Values::raw(Type type, double &out) {
  if (left() < ply::size_of(type)) {
    at_ = bytes_.size();
    return false;
  }
  const std::endian order = form_ == ply::Form::Little ? std::endian::little : std::endian::big;
  const auto take = [&](auto example) {
    out = static_cast<double>(number_at<decltype(example)>(bytes_, at_, order));
  };
  switch (type) {
  case Type::Int8:
    take(std::int8_t{});
    break;
  case Type::UInt8:
    take(std::uint8_t{});
    break;
  case Type::Int16:
    take(std::int16_t{});
    break;
  case Type::UInt16:
    take(std::uint16_t{});
    break;
  case Type::Int32:
    take(std::int32_t{});
    break;
  case Type::UInt32:
    take(std::uint32_t{});
    break;
  case Type::Float32:
    take(float{});
    break;
  case Type::Float64:
    take(double{});
    break;
  }
  at_ += ply::size_of(type);
  return true;
}

/// Where the properties of a vertex that are read stand in its row.
struct VertexRow {
  std::array<std::size_t, 3> position{}, normal{};
  std::array<std::size_t, 2> texture{};
  bool has_normal = false, has_texture = false;
};

class PlyReader {
public:
  PlyReader(std::string_view bytes, const std::string &file, const ply::Header &header,
            const MeshFileOptions &options)
      : header_(header), file_(file), values_(bytes, header, file, options.cancel),
        options_(options), polygons_(out_.mesh, options) {}

  Result<MeshFile> read(Diagnostics &diagnostics);

private:
  Result<void> check_counts() const;
  Result<VertexRow> vertex_row(const Element &element) const;
  Result<void> read_vertices(const Element &element);
  Result<void> read_faces(const Element &element);
  Result<void> skip(const Element &element);
  Result<void> read_list(const Property &property, const Element &element, std::size_t row,
                         std::vector<double> &out);
  Result<void> make_faces();
  tl::unexpected<Error> broken(const Element &element, std::size_t row) const;

  const ply::Header &header_;
  const std::string &file_;
  Values values_;
  const MeshFileOptions &options_;
  MeshFile out_;
  GroupIndex groups_{out_.mesh};
  PolygonMaker polygons_;
  bool has_normals_ = false;
  std::vector<std::uint32_t> corners_; ///< of all faces, one after the other
  std::vector<std::uint32_t> sizes_;   ///< corners of each face
};

tl::unexpected<Error> PlyReader::broken(const Element &element, std::size_t row) const {
  return fail(ErrorCode::BadInput,
              fmt::format("{} {} of {}: {} stands where a number was expected. {}", element.name,
                          row + 1, element.count, values_.found(), again),
              values_.where());
}

/// A file cannot hold more rows than bytes: believed counts would be reserved and walked.
Result<void> PlyReader::check_counts() const {
  std::size_t least = 0;
  for (const Element &element : header_.elements) {
    std::size_t row = 0;
    for (const Property &p : element.properties)
      row += header_.form == ply::Form::Text ? 2 : ply::size_of(p.is_list ? p.count : p.type);
    if (element.count > 0 && row == 0)
      return fail(ErrorCode::BadInput,
                  fmt::format("element {} has no property; at least one was expected. {}",
                              element.name, again),
                  {file_});
    // The last number of a text needs no blank behind it.
    if (element.count > 0 && element.count > (values_.left() + 1 - least) / row)
      return fail(ErrorCode::BadInput,
                  fmt::format("the header counts {} of element {}, but the {} bytes that follow it "
                              "cannot hold them. The file was cut off or damaged: export or fetch "
                              "it again.",
                              element.count, element.name, values_.left()),
                  {file_});
    least += element.count * row;
  }
  return {};
}

Result<VertexRow> PlyReader::vertex_row(const Element &element) const {
  VertexRow out;
  const auto find = [&](const char *name) {
    std::size_t i = 0;
    while (i < element.properties.size() && element.properties[i].name != name)
      ++i;
    return i;
  };
  const std::size_t none = element.properties.size();
  out.position = {find("x"), find("y"), find("z")};
  for (const std::size_t at : out.position)
    if (at == none || element.properties[at].is_list)
      return fail(ErrorCode::BadInput,
                  fmt::format("element vertex lacks x, y or z; all three were expected. {}", again),
                  {file_});
  out.normal = {find("nx"), find("ny"), find("nz")};
  out.has_normal = std::find(out.normal.begin(), out.normal.end(), none) == out.normal.end();
  for (const auto &[u, v] : {std::pair{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}})
    if (!out.has_texture && find(u) != none && find(v) != none) {
      out.texture = {find(u), find(v)};
      out.has_texture = true;
    }
  return out;
}

/// One list of a row; its length is never believed beyond the bytes that are left.
Result<void> PlyReader::read_list(const Property &property, const Element &element, std::size_t row,
                                  std::vector<double> &out) {
  out.clear();
  double count = 0;
  if (!values_.next(property.count, count))
    return broken(element, row);
  if (!(count >= 0) || count != std::floor(count) ||
      count > static_cast<double>(values_.left() + 1))
    return fail(ErrorCode::BadInput,
                fmt::format("{} {} of {}: a list of {} values; the file has {} more bytes. {}",
                            element.name, row + 1, element.count, count, values_.left(), again),
                values_.where());
  for (auto left = static_cast<std::size_t>(count); left > 0; --left) {
    double value = 0;
    if (!values_.next(property.type, value))
      return broken(element, row);
    out.push_back(value);
  }
  return {};
}

Result<void> PlyReader::read_vertices(const Element &element) {
  UMOV_ASSIGN(row, vertex_row(element));
  has_normals_ = row.has_normal;
  std::vector<double> values(element.properties.size()), list;
  for (std::size_t i = 0; i < element.count; ++i) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (element.properties[k].is_list)
        UMOV_TRY(read_list(element.properties[k], element, i, list));
      else if (!values_.next(element.properties[k].type, values[k]))
        return broken(element, i);
    }
    const auto three = [&](const std::array<std::size_t, 3> &at) {
      return Vec3<Body>{values[at[0]], values[at[1]], values[at[2]]};
    };
    const Vec3<Body> v = three(row.position);
    const Vec3<Body> n = row.has_normal ? three(row.normal) : Vec3<Body>{};
    for (const Vec3<Body> one : {v, n})
      if (is_out_of_reach(one))
        return fail(
            ErrorCode::BadInput,
            fmt::format("vertex {} of {} has {}; finite numbers up to {:g} were expected. {}",
                        i + 1, element.count, point_text(one), farthest, again),
            values_.where());
    out_.mesh.positions.push_back(v);
    if (row.has_normal)
      out_.mesh.normals.push_back(n);
    if (row.has_texture)
      polygons_.textures.push_back({values[row.texture[0]], values[row.texture[1]]});
  }
  return {};
}

Result<void> PlyReader::read_faces(const Element &element) {
  std::vector<double> list;
  double ignored = 0;
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < element.count; ++i)
    for (const Property &p : element.properties) {
      if (!p.is_list) {
        if (!values_.next(p.type, ignored))
          return broken(element, i);
        continue;
      }
      UMOV_TRY(read_list(p, element, i, list));
      if (p.name != "vertex_indices" && p.name != "vertex_index")
        continue;
      triangles += list.size() < 3 ? 0 : list.size() - 2;
      if (triangles > options_.max_triangles)
        return too_many_triangles(options_.max_triangles, values_.where());
      for (const double index : list) {
        if (!(index >= 0) || index != std::floor(index) || index >= 4294967295.0)
          return fail(ErrorCode::BadInput,
                      fmt::format("face {} of {} names vertex {}; whole numbers from 0 were "
                                  "expected. {}",
                                  i + 1, element.count, index, again),
                      values_.where());
        corners_.push_back(static_cast<std::uint32_t>(index));
      }
      sizes_.push_back(static_cast<std::uint32_t>(list.size()));
    }
  return {};
}

Result<void> PlyReader::skip(const Element &element) {
  std::vector<double> list;
  double ignored = 0;
  for (std::size_t i = 0; i < element.count; ++i)
    for (const Property &p : element.properties) {
      if (p.is_list)
        UMOV_TRY(read_list(p, element, i, list));
      else if (!values_.next(p.type, ignored))
        return broken(element, i);
    }
  return {};
}

/// After everything was read: nothing says that the vertices come first.
Result<void> PlyReader::make_faces() {
  const std::size_t vertices = out_.mesh.positions.size();
  std::size_t at = 0;
  std::vector<Corner> corners;
  for (std::size_t face = 0; face < sizes_.size(); at += sizes_[face], ++face) {
    corners.clear();
    for (std::size_t k = 0; k < sizes_[face]; ++k) {
      const std::uint32_t v = corners_[at + k];
      if (v >= vertices)
        return fail(ErrorCode::BadInput,
                    fmt::format("face {} of {} names vertex {}; there are {}, counted from 0. {}",
                                face + 1, sizes_.size(), v, vertices, again),
                    {file_});
      corners.push_back(
          {v, has_normals_ ? v : no_index, polygons_.textures.empty() ? no_index : v});
    }
    UMOV_TRY(polygons_.add(corners, groups_.of("default"), {file_}));
  }
  return {};
}

Result<MeshFile> PlyReader::read(Diagnostics &diagnostics) {
  UMOV_TRY(check_counts());
  bool has_strips = false;
  for (const Element &element : header_.elements) {
    if (element.name == "vertex")
      UMOV_TRY(read_vertices(element));
    else if (element.name == "face")
      UMOV_TRY(read_faces(element));
    else
      UMOV_TRY(skip(element));
    has_strips = has_strips || element.name == "tristrips";
  }
  if (has_strips && sizes_.empty())
    return fail(ErrorCode::BadInput,
                "triangle strips (element tristrips); faces were expected. Export it with faces.",
                {file_});
  UMOV_TRY(make_faces());
  polygons_.finish();
  polygons_.warn(diagnostics, {file_});
  out_.format = "PLY";
  join_equal(out_.mesh, options_.cancel);
  return std::move(out_);
}

} // namespace

Result<MeshFile> read_ply(std::string_view bytes, const std::string &file,
                          const MeshFileOptions &options, Diagnostics &diagnostics) {
  UMOV_ASSIGN(header, ply::read_header(bytes, file));
  return PlyReader(bytes, file, header, options).read(diagnostics);
}

} // namespace umov::mesh_io
