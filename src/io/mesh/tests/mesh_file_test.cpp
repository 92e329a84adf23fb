// Files of every format but OBJ: what is legal and seldom met, and what is refused with which
// words.

#include <atomic>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/mesh_file.h>
#include <umov/shape/primitives.h>
#include <umov/shape/topology.h>
#include <unistd.h>

namespace umov {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

const MeshFileOptions metres{.unit = "m", .up = "+Z"};

/// A folder of this process: tests run side by side.
fs::path own_folder() {
  const fs::path out =
      fs::path(testing::TempDir()) / ("umov_mesh_file_" + std::to_string(getpid()));
  fs::create_directories(out);
  return out;
}

/// Writes a file and reads it as a mesh.
Result<MeshFile> read(const std::string &name, const std::string &bytes,
                      const MeshFileOptions &options = metres, Diagnostics *told = nullptr) {
  const fs::path folder = own_folder();
  EXPECT_TRUE(write_file_atomically(folder / name, bytes));
  Diagnostics diagnostics;
  return read_mesh(folder / name, options, told != nullptr ? *told : diagnostics);
}

template <class T> std::string bytes_of(const std::vector<T> &values) {
  std::string out(values.size() * sizeof(T), '\0');
  std::memcpy(out.data(), values.data(), out.size());
  return out;
}

/// A glTF document of one square (two triangles) at the root; `buffer` lies beside it.
struct Square {
  Json json = Json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "panel", "mesh": 0}],
    "materials": [{"name": "foil"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
    "buffers": [{"byteLength": 60, "uri": "square.bin"}]})");
  std::string buffer = bytes_of<float>({0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0}) +
                       bytes_of<std::uint16_t>({0, 1, 2, 0, 2, 3});

  [[nodiscard]] Result<MeshFile> read(Diagnostics *told = nullptr) const {
    (void)umov::read("square.bin", buffer); // no mesh; only there to be read
    return umov::read("square.gltf", json.dump(), metres, told);
  }
};

TEST(GltfReader, ReadsTrianglesMaterialsAndNodes) {
  const auto out = Square().read();
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(out->format, "glTF");
  EXPECT_EQ(out->mesh.groups, std::vector<std::string>{"foil"});
  EXPECT_EQ(out->mesh.nodes, std::vector<std::string>{"panel"});
  EXPECT_EQ(out->mesh.positions.size(), 4u);
  EXPECT_EQ(inspect(out->mesh).area_m2, 2.0);
  EXPECT_EQ(out->files.size(), 1u);
}

TEST(GltfReader, IsInMetresWithYUpWhereNothingElseIsSaid) {
  Square square;
  (void)square.read();
  Diagnostics diagnostics;
  const auto out = read("square.gltf", square.json.dump(), {});
  ASSERT_TRUE(out) << out.error().text();
  const MeshReport found = inspect(out->mesh); // 2 x 1 in x and y becomes 2 x 1 in x and z
  EXPECT_EQ(found.upper.z - found.lower.z, 1.0);
  EXPECT_EQ(found.upper.y - found.lower.y, 0.0);
}

TEST(GltfReader, PlacesNodesAndKeepsWindingsWhereTheyMirror) {
  Square square;
  square.json["nodes"] = Json::parse(R"([
    {"name": "craft", "translation": [10, 0, 0], "children": [1, 2]},
    {"name": "wing", "mesh": 0, "scale": [1, 1, 3], "rotation": [0, 0.70710678, 0, 0.70710678]},
    {"name": "wing", "mesh": 0, "scale": [-1, 1, 1]}])");
  const auto out = square.read();
  ASSERT_TRUE(out) << out.error().text();
  ASSERT_EQ(out->nodes.size(), 2u);
  EXPECT_EQ(out->nodes[0].path, "craft/wing");
  EXPECT_EQ(out->nodes[1].path, "craft/wing#2"); // names that repeat are told apart
  EXPECT_EQ(out->nodes[0].origin_m, (Vec3<Body>{10, 0, 0}));
  // Turned by 90 deg about y, +z becomes +x; mirrored in x, the face still shows +z.
  const Vec3<Body> first = area_vector_doubled(out->mesh, out->mesh.triangles[0]);
  const Vec3<Body> second = area_vector_doubled(out->mesh, out->mesh.triangles[2]);
  EXPECT_NEAR(first.x, 2.0, 1e-6);
  EXPECT_NEAR(second.z, 2.0, 1e-6);
  EXPECT_NEAR(inspect(out->mesh).lower.x, 8.0, 1e-6);
}

TEST(GltfReader, ReadsWhatIsSeldomMet) {
  Square strip; // the same square as a strip without indices, corners 0 1 3 2
  strip.buffer = bytes_of<float>({0, 0, 0, 2, 0, 0, 0, 1, 0, 2, 1, 0});
  strip.buffer.resize(60);
  strip.json["meshes"][0]["primitives"][0] =
      Json::parse(R"({"attributes": {"POSITION": 0}, "mode": 5})");
  Square sparse; // zeros, with three corners put in their places
  sparse.json["accessors"][0] = Json::parse(R"({"componentType": 5126, "count": 4, "type": "VEC3",
    "sparse": {"count": 3, "indices": {"bufferView": 2, "componentType": 5121}, "values": {"bufferView": 3}}})");
  sparse.json["bufferViews"] = Json::parse(
      R"([{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        {"buffer": 0, "byteOffset": 60, "byteLength": 3}, {"buffer": 0, "byteOffset": 12, "byteLength": 36}])");
  sparse.json["buffers"][0]["byteLength"] = 63;
  sparse.buffer += std::string("\1\2\3");
  Square quantized; // KHR_mesh_quantization: integers of 16 bits, each row in 8 bytes
  quantized.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  quantized.buffer = bytes_of<std::int16_t>({0, 0, 0, 9, 2, 0, 0, 9, 2, 1, 0, 9, 0, 1, 0, 9}) +
                     std::string(16, '\0') + quantized.buffer.substr(48);
  quantized.json["accessors"][0]["componentType"] = 5122;
  quantized.json["bufferViews"][0]["byteStride"] = 8;
  for (const Square &one : {strip, sparse, quantized}) {
    const auto out = one.read();
    ASSERT_TRUE(out) << out.error().text();
    EXPECT_EQ(out->mesh.triangles.size(), 2u);
    EXPECT_EQ(inspect(out->mesh).area_m2, 2.0);
    for (const Triangle &t : out->mesh.triangles)
      EXPECT_EQ(area_vector_doubled(out->mesh, t), (Vec3<Body>{0, 0, 2}));
  }
}

struct BadGltf {
  const char *name, *patch; ///< JSON Patch (RFC 6902)
  const char *word;
};

class GltfRefused : public testing::TestWithParam<BadGltf> {};

TEST_P(GltfRefused, SaysWhatAndWhere) {
  Square square;
  square.json = square.json.patch(Json::parse(GetParam().patch));
  const auto out = square.read();
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, ErrorCode::BadInput);
  EXPECT_TRUE(out.error().where.file.ends_with("square.gltf"));
  EXPECT_NE(out.error().message.find(GetParam().word), std::string::npos) << out.error().text();
}

#define SET(path, value) R"([{"op": "add", "path": ")" path R"(", "value": )" value "}]"
INSTANTIATE_TEST_SUITE_P(
    Documents, GltfRefused,
    testing::Values(
        BadGltf{"version", SET("/asset/version", "\"1.0\""), "2.0 was expected"},
        BadGltf{"no_asset", R"([{"op": "remove", "path": "/asset"}])", "asset.version"},
        BadGltf{"draco", SET("/extensionsRequired", "[\"KHR_draco_mesh_compression\"]"),
                "KHR_draco"},
        BadGltf{"count_zero", SET("/accessors/0/count", "0"), "accessors[0].count is 0"},
        BadGltf{"count_huge", SET("/accessors/0/count", "4611686018427387904"),
                "accessors[0].count"},
        BadGltf{"count_above", SET("/accessors/0/count", "5"), "accessors[0].count is 5"},
        BadGltf{"count_text", SET("/accessors/0/count", "\"4\""), "accessors[0].count"},
        BadGltf{"offset_wraps", SET("/accessors/0/byteOffset", "18446744073709551608"),
                "byteOffset"},
        BadGltf{"view_offset", SET("/bufferViews/0/byteOffset", "61"), "bufferViews[0].byteOffset"},
        BadGltf{"view_length", SET("/bufferViews/0/byteLength", "61"), "bufferViews[0].byteLength"},
        BadGltf{"stride", SET("/bufferViews/0/byteStride", "253"), "byteStride"},
        BadGltf{"type", SET("/accessors/0/componentType", "5124"), "5124"},
        BadGltf{"kind", SET("/accessors/0/type", "\"VEC2\""), "2 components"},
        BadGltf{"index_kind", SET("/accessors/1/componentType", "5122"), "5121, 5123 or 5125"},
        BadGltf{"no_accessor", SET("/meshes/0/primitives/0/indices", "2"), "indices is 2"},
        BadGltf{"no_mesh", SET("/nodes/0/mesh", "-1"), "nodes[0].mesh is -1"},
        BadGltf{"no_position", SET("/meshes/0/primitives/0/attributes", "{}"), "POSITION"},
        BadGltf{"cycle", SET("/nodes/0/children", "[0]"), "reached twice"},
        BadGltf{"twice", SET("/scenes/0/nodes", "[0, 0]"), "reached twice"},
        BadGltf{"matrix", SET("/nodes/0/matrix", "[1, 2]"), "list of 16 numbers"},
        BadGltf{"quaternion", SET("/nodes/0/rotation", "[0, 0, 0, 0]"), "length 0"},
        BadGltf{"skin", SET("/nodes/0/skin", "0"), "skeleton"},
        BadGltf{"escape", SET("/buffers/0/uri", "\"../square.bin\""), "leaves the folder"},
        BadGltf{"escape_hidden", SET("/buffers/0/uri", "\"%2e%2e/square.bin\""),
                "leaves the folder"},
        BadGltf{"absolute", SET("/buffers/0/uri", "\"/etc/passwd\""), "leaves the folder"},
        BadGltf{"scheme", SET("/buffers/0/uri", "\"file:///etc/passwd\""), "leaves the folder"},
        BadGltf{"missing", SET("/buffers/0/uri", "\"none.bin\""), "none.bin"},
        BadGltf{"base64", SET("/buffers/0/uri", "\"data:;base64,?\""), "base64 digits"},
        BadGltf{"short", SET("/buffers/0/byteLength", "61"), "at most 60"},
        BadGltf{"no_list", SET("/nodes", "7"), "nodes is 7"},
        BadGltf{"no_object", SET("/nodes/0", "7"), "nodes[0] is 7"},
        BadGltf{"points", SET("/meshes/0/primitives/0/mode", "0"), "no face"}),
    [](const auto &test) { return std::string(test.param.name); });

TEST(GltfReader, RefusesBadNumbersAndIndices) {
  Square nan, index, far;
  nan.buffer = bytes_of<float>({NAN}) + nan.buffer.substr(4);
  index.buffer[48] = 4;
  far.json["nodes"][0]["scale"] = {1e12, 1e12, 1e12};
  for (const auto &[square, word] :
       {std::pair{nan, "(nan, 0, 0)"}, {index, "a number below 4"}, {far, "placed by its nodes"}}) {
    const auto out = square.read();
    ASSERT_FALSE(out);
    EXPECT_NE(out.error().message.find(word), std::string::npos) << out.error().text();
  }
}

TEST(GltfReader, RefusesDeepAndBrokenJson) {
  const std::string deep = "{\"a\":" + std::string(100'000, '[');
  for (const auto &[text, word] : {std::pair<std::string, const char *>{deep, "nested"},
                                   {"{\"asset\": 1e999}", "out of range"},
                                   {"{\n\"asset\" {}", "broken"},
                                   {"{}", "asset.version"}}) {
    const auto out = read("broken.gltf", text);
    ASSERT_FALSE(out);
    EXPECT_NE(out.error().message.find(word), std::string::npos) << out.error().text();
  }
  const auto out = read("broken.gltf", "{\n\"asset\" {}");
  EXPECT_EQ(out.error().where.line, 2u);
}

TEST(StlReader, ReadsTextWithNamesAndPolygons) {
  const std::string facet = "facet normal nan nan nan\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                            "vertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const auto out =
      read("a.stl", "solid left wing\n" + facet + "endsolid\nSOLID\n" + facet + "endsolid\n");
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(out->mesh.groups, (std::vector<std::string>{"left wing", "default"}));
  EXPECT_EQ(out->mesh.triangles.size(), 4u);
  EXPECT_EQ(out->mesh.positions.size(), 4u); // equal corners are one
}

TEST(StlReader, KnowsBinaryFilesThatBeginAsTextsDo) {
  std::string bytes = "solid but binary";
  bytes.resize(80, ' ');
  bytes += bytes_of<std::uint32_t>({1}) + bytes_of<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0});
  bytes += std::string(2, '\0');
  const auto out = read("named.obj", bytes); // the content tells, not the name
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(out->format, "STL");
  EXPECT_EQ(out->mesh.triangles.size(), 1u);
}

TEST(PlyReader, ReadsBothOrdersOfBytesAndSkipsWhatItDoesNotKnow) {
  const std::string header =
      "element vertex 4\nproperty double x\nproperty double y\nproperty double z\nproperty uchar "
      "red\n"
      "property list uchar int tags\nelement face 1\nproperty list uchar ushort vertex_index\n"
      "element edge 1\nproperty int a\nend_header\n";
  const auto big = [](auto value) {
    std::string out(sizeof(value), '\0');
    std::memcpy(out.data(), &value, sizeof(value));
    return std::string(out.rbegin(), out.rend());
  };
  std::string body;
  for (const auto &[x, y] : {std::pair{0., 0.}, {2., 0.}, {2., 1.}, {0., 1.}})
    body += big(x) + big(y) + big(0.) + "r" + "\1" + big(7);
  body += "\4" + big(std::uint16_t{0}) + big(std::uint16_t{1}) + big(std::uint16_t{2}) +
          big(std::uint16_t{3}) + big(1);
  const auto binary = read("a.ply", "ply\nformat binary_big_endian 1.0\n" + header + body);
  const auto text = read("b.ply", "ply\r\nformat ascii 1.0\ncomment a\n" + header +
                                      "0 0 0 1 0 2 0 0 1 1 5\n2 1 0 1 0 0 1 0 1 0\n4 0 1 2 3\n9\n");
  for (const auto &out : {binary, text}) {
    ASSERT_TRUE(out) << out.error().text();
    EXPECT_EQ(out->mesh.triangles.size(), 2u);
    EXPECT_EQ(inspect(out->mesh).area_m2, 2.0);
  }
}

struct BadFile {
  const char *name, *file;
  std::string bytes;
  const char *word;
};

class MeshFileRefused : public testing::TestWithParam<BadFile> {};

TEST_P(MeshFileRefused, SaysWhat) {
  const auto out = read(GetParam().file, GetParam().bytes);
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, ErrorCode::BadInput);
  EXPECT_NE(out.error().text().find(GetParam().word), std::string::npos) << out.error().text();
}

const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string glb = std::string("glTF\2\0\0\0", 8);

INSTANTIATE_TEST_SUITE_P(
    Files, MeshFileRefused,
    testing::Values(
        BadFile{"stl_counts", "a.stl", std::string(80, ' ') + "\xFF\xFF\xFF\xFF",
                "counts 4294967295"},
        BadFile{"stl_empty", "a.stl", "", "0 bytes"},
        BadFile{"stl_no_face", "a.stl", "solid a\nendsolid a\n", "no face"},
        BadFile{"stl_cut", "a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0", ":4:10"},
        BadFile{"stl_nan", "a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 nan 0\n",
                "\"nan\""},
        BadFile{"stl_word", "a.stl", "solid\nfacet normal 0 0 1\nouter lop\n",
                "\"loop\" was expected"},
        BadFile{"ply_magic", "a.ply", "plx\n", "\"ply\" in the first line"},
        BadFile{"ply_no_end", "a.ply", "ply\nformat ascii 1.0\n", "end_header"},
        BadFile{
            "ply_counts", "a.ply",
            "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\nproperty float x\n"
            "end_header\n",
            "counts 2000000000"},
        BadFile{"ply_no_property", "a.ply", "ply\nformat ascii 1.0\nelement vertex 9\nend_header\n",
                "no property"},
        BadFile{"ply_no_z", "a.ply",
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                "end_header\n1 2 3 4\n",
                "lacks x, y or z"},
        BadFile{"ply_type", "a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n",
                ":4"},
        BadFile{"ply_list_type", "a.ply",
                "ply\nformat ascii 1.0\nelement face 1\nproperty list float int vertex_index\n",
                "whole numbers"},
        BadFile{"ply_index", "a.ply", ply + "0 0 0 1 0 0 1 1 0\n3 0 1 3\n", "names vertex 3"},
        BadFile{"ply_negative", "a.ply", ply + "0 0 0 1 0 0 1 1 0\n3 0 1 -1\n", "names vertex -1"},
        BadFile{"ply_list", "a.ply", ply + "0 0 0 1 0 0 1 1 0\n255 0 1 2\n", "list of 255"},
        BadFile{"ply_nan", "a.ply", ply + "0 0 0 1 nan 0 1 1 0\n3 0 1 2\n",
                "a.ply:10: vertex 2 of 3"},
        BadFile{"ply_cut", "a.ply", ply + "0 0 0 1 0 0 1 1 0\n3 0 1", "end of the file"},
        BadFile{"glb_short", "a.glb", "glTF", "4 bytes"},
        BadFile{"glb_version", "a.glb", std::string("glTF\1\0\0\0", 8) + std::string(20, '\0'),
                "version 1"},
        BadFile{"glb_length", "a.glb", glb + "\xFF\xFF\xFF\x7F" + std::string(20, '\0'),
                "2147483647"},
        BadFile{"glb_chunk", "a.glb",
                glb + std::string("\x20\0\0\0", 4) + "\xFF\xFF\xFF\xFFJSON" + std::string(12, ' '),
                "a chunk of 4294967295 bytes"},
        BadFile{"glb_no_json", "a.glb",
                glb + std::string("\x18\0\0\0\4\0\0\0BIN\0abcd", 16) + std::string(8, ' '),
                "no JSON"},
        BadFile{"off_broken", "a.off", "OFF\n3 1 0\n0 0 0\n", "a.off"},
        BadFile{"dae_broken", "a.dae", "<?xml version=\"1.0\"?><COLLADA>", "a.dae"},
        BadFile{"packed", "a.obj.gz", "\x1F\x8B\x08", "gunzip"},
        BadFile{"unknown", "a.xyz", "what is this", "neither the content nor the suffix"}),
    [](const auto &test) { return std::string(test.param.name); });

TEST(MeshFile, AsksForUnitAndAxisWhereTheFormatHasNone) {
  const auto out = read("a.ply", ply + "0 0 0 1 0 0 1 1 0\n3 0 1 2\n", {});
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().message.find("no unit. The bounding box is 1 x 1 x 0"), std::string::npos)
      << out.error().text();
}

TEST(MeshFile, LimitsTriangles) {
  Square square;
  EXPECT_TRUE(square.read());
  MeshFileOptions few = metres;
  few.max_triangles = 1;
  const auto out = read("square.gltf", square.json.dump(), few);
  ASSERT_FALSE(out);
}

class MeshWritten : public testing::TestWithParam<const char *> {};

TEST_P(MeshWritten, ReadsBackTheSame) {
  Mesh mesh = make_hst();
  const fs::path path = own_folder() / (std::string("hst.") + GetParam());
  Diagnostics diagnostics;
  ASSERT_TRUE(write_mesh(path, mesh, diagnostics));
  const bool is_gltf = std::string(GetParam()).starts_with("gl");
  const auto out = read_mesh(path, is_gltf ? MeshFileOptions{} : metres, diagnostics);
  ASSERT_TRUE(out) << out.error().text();
  const MeshReport wanted = inspect(mesh), found = inspect(out->mesh);
  EXPECT_EQ(found.triangles, wanted.triangles);
  EXPECT_TRUE(found.is_closed);
  EXPECT_EQ(found.inconsistent_edges, 0u);
  EXPECT_NEAR(found.volume_m3, wanted.volume_m3, 1e-6 * wanted.volume_m3); // 32 bits
  EXPECT_NEAR(found.upper.z, wanted.upper.z, 1e-6);
  if (is_gltf) {
    EXPECT_EQ(out->mesh.groups, mesh.groups);
    for (std::size_t g = 0; g < mesh.groups.size(); ++g)
      EXPECT_NEAR(found.group_area_m2[g], wanted.group_area_m2[g], 1e-4);
    EXPECT_EQ(out->mesh.triangles[7].normal[0] != no_index, true);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshWritten, testing::Values("glb", "gltf", "stl", "ply", "obj"),
                         [](const auto &test) { return std::string(test.param); });

TEST(StlReader, RefusesLinesOfTensOfThousandsOfWords) {
  std::string text = "solid a\n";
  for (int k = 0; k < 1500; ++k) // 18 words each
    text +=
        "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet ";
  const auto out = read("long.stl", text + "\nendsolid a\n");
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().where.line, 2u);
  EXPECT_NE(out.error().message.find("more than 20000 words"), std::string::npos);
}

TEST(MeshFile, ComesFromTheBytesThatWereGiven) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  Diagnostics diagnostics;
  const auto out = read_mesh_bytes(obj, "/nowhere/a.obj", metres, diagnostics);
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(out->mesh.triangles.size(), 1u);
  // Assimp opens the file itself: one that is not what was given is noticed.
  const fs::path path = own_folder() / "changed.off";
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  ASSERT_TRUE(write_file_atomically(path, off));
  EXPECT_TRUE(read_mesh_bytes(off, path, metres, diagnostics));
  const auto other = read_mesh_bytes(off + "\n", path, metres, diagnostics);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("changed while it was read"), std::string::npos);
}

TEST(MeshFile, TellsTheHashOfEachFurtherFile) {
  const auto out = Square().read();
  ASSERT_TRUE(out) << out.error().text();
  ASSERT_EQ(out->files.size(), 1u);
  EXPECT_EQ(out->files[0].sha256, sha256_hex(Square().buffer));
}

TEST(MeshFile, KeepsTheTreeWhenWritten) {
  Square square;
  square.json["nodes"] = Json::parse(
      R"([{"name": "craft", "children": [1, 2]}, {"name": "left", "mesh": 0},
          {"name": "right", "mesh": 0, "translation": [0, 5, 0]}])");
  const auto first = square.read();
  ASSERT_TRUE(first) << first.error().text();
  const fs::path path = own_folder() / "tree.glb";
  Diagnostics diagnostics;
  ASSERT_TRUE(write_mesh(path, first->mesh, diagnostics));
  const auto second = read_mesh(path, {}, diagnostics);
  ASSERT_TRUE(second) << second.error().text();
  EXPECT_EQ(second->mesh.nodes, (std::vector<std::string>{"craft/left", "craft/right"}));
  EXPECT_EQ(second->mesh.nodes, first->mesh.nodes);
  EXPECT_EQ(second->mesh.groups, first->mesh.groups);
}

TEST(MeshFile, IsReadNoFurtherOnceStopped) {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  Diagnostics diagnostics;
  ASSERT_TRUE(write_file_atomically(own_folder() / "stopped.off", off));
  for (const char *suffix : {".obj", ".stl", ".ply", ".glb", ".gltf"})
    ASSERT_TRUE(write_mesh(own_folder() / (std::string("stopped") + suffix), make_sphere(1, 500),
                           diagnostics));
  const std::atomic<bool> cancel = true;
  MeshFileOptions stopped = metres;
  for (const char *suffix : {".off", ".obj", ".stl", ".ply", ".glb", ".gltf"}) {
    const fs::path path = own_folder() / (std::string("stopped") + suffix);
    stopped.cancel = nullptr;
    EXPECT_TRUE(read_mesh(path, stopped, diagnostics)) << suffix;
    stopped.cancel = &cancel;
    const auto out = read_mesh(path, stopped, diagnostics);
    ASSERT_FALSE(out) << suffix;
    EXPECT_EQ(out.error().code, ErrorCode::Interrupted) << suffix << out.error().text();
  }
}

// Each line was looked through to the end of the file for a mark of a comment: 50 MB of them took
// half an hour. Now four times the lines take some four times as long; 10 leaves room for a busy
// machine, and the old way took 16.
TEST(OffReader, TakesAsLongAsTheFileIsLong) {
  const auto seconds_of = [](std::size_t triangles) {
    std::string text = "OFF\n" + std::to_string(3 * triangles) + " 0 0\n";
    for (std::size_t v = 0; v < 3 * triangles; ++v)
      text += "0.25 0.125 0.0625\n";
    const std::clock_t begin = std::clock();
    Diagnostics diagnostics;
    (void)read_mesh_bytes(text, own_folder() / "none.off", metres, diagnostics); // no face
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  };
  const double once = std::min(seconds_of(50'000), seconds_of(50'000));
  EXPECT_LT(seconds_of(200'000), 10 * once);
}

} // namespace
} // namespace umov
