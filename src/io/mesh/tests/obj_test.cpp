#include <cmath>
#include <gtest/gtest.h>
#include <tiny_obj_loader.h>
#include <umov/io/obj.h>
#include <umov/shape/primitives.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

const MeshFileOptions in_metres{.unit = "m", .up = "+Z"};

Result<MeshFile> read(const std::string &text, Diagnostics &diagnostics,
                      const MeshFileOptions &options = in_metres) {
  const MtlLoader none = [](const std::string &) -> Result<std::string> {
    return fail(ErrorCode::BadInput, "none");
  };
  return read_obj_text(text, "a.obj", options, none, diagnostics);
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

struct BadLine {
  const char *name;
  std::string text;
  std::size_t line, column;
  const char *word;
};

class ObjRefused : public testing::TestWithParam<BadLine> {};

TEST_P(ObjRefused, SaysWhereAndWhat) {
  Diagnostics diagnostics;
  const auto result = read(GetParam().text, diagnostics);
  ASSERT_FALSE(result);
  const Error &error = result.error();
  EXPECT_EQ(error.code, ErrorCode::BadInput);
  EXPECT_EQ(error.where.line, GetParam().line) << error.text();
  EXPECT_EQ(error.where.column, GetParam().column) << error.text();
  EXPECT_NE(error.message.find(GetParam().word), std::string::npos) << error.text();
}

INSTANTIATE_TEST_SUITE_P(
    Lines, ObjRefused,
    testing::Values(BadLine{"nan", "v 1 2 nan\n", 1, 7, "nan"},
                    BadLine{"inf", "v inf 2 3\n", 1, 3, "inf"},
                    BadLine{"overflow", "v 1e999 2 3\n", 1, 3, "1e999"},
                    BadLine{"comma", "v 1,5 2 3\n", 1, 3, "comma"},
                    BadLine{"hex", "v 0x1p3 2 3\n", 1, 3, "0x1p3"},
                    BadLine{"long", "v " + std::string(200, '1') + " 2 3\n", 1, 3, "1111"},
                    BadLine{"short_vertex", "v 1 2\n", 1, 1, "3 were expected"},
                    BadLine{"index_zero", square + "f 0 1 2\n", 5, 3, "\"0\""},
                    BadLine{"index_above", square + "f 1 2 5\n", 5, 7, "1 to 4"},
                    BadLine{"index_below", square + "f 1 2 -5\n", 5, 7, "-4"},
                    BadLine{"index_2_31", square + "f 1 2 2147483648\n", 5, 7, "2147483648"},
                    BadLine{"index_2_63", square + "f 1 2 9223372036854775808\n", 5, 7, "92233"},
                    BadLine{"slashes", square + "f 1// 2 3\n", 5, 3, "v//n"},
                    BadLine{"four_parts", square + "f 1/2/3/4 2 3\n", 5, 3, "v//n"},
                    BadLine{"no_texture", square + "f 1/1 2 3\n", 5, 3, "texture"},
                    BadLine{"escape", "mtllib ../../x.mtl\n", 1, 8, "leaves the folder"},
                    BadLine{"absolute", "mtllib /etc/passwd\n", 1, 8, "leaves the folder"},
                    BadLine{"empty", "", 0, 0, "no face"},
                    BadLine{"no_face", square, 0, 0, "no face"}),
    [](const auto &test) { return std::string(test.param.name); });

TEST(ObjReader, TakesWhatIsLegal) {
  const std::string face = "f 1 2 3 4";
  for (const std::string &text :
       {std::string(square + face), square + "f -4 -3 -2 -1\n",
        "\xEF\xBB\xBF" + square + face + "\n", square + "f 1 2 \\\n 3 4\n",
        square + "# note\n\n" + face + " # end\n",
        std::string("v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n")}) {
    Diagnostics diagnostics;
    const auto result = read(text, diagnostics);
    ASSERT_TRUE(result) << result.error().text();
    EXPECT_EQ(result->mesh.triangles.size(), 2u);
    EXPECT_TRUE(diagnostics.empty());
  }
}

TEST(ObjReader, SplitsLargePolygons) {
  for (const int corners : {17, 10000}) {
    std::string text, face = "f";
    for (int i = 0; i < corners; ++i) {
      const double phi = 2 * 3.14159265358979 * i / corners;
      text += "v " + std::to_string(std::cos(phi)) + " " + std::to_string(std::sin(phi)) + " 0\n";
      face += " " + std::to_string(i + 1);
    }
    Diagnostics diagnostics;
    const auto result = read(text + face, diagnostics); // the face is one long line without an end
    ASSERT_TRUE(result) << result.error().text();
    EXPECT_EQ(result->mesh.triangles.size(), static_cast<std::size_t>(corners - 2));
  }
}

TEST(ObjReader, RefusesPolygonsBeyondTheLimit) {
  std::string face = square + "f";
  for (int i = 0; i < 10'001; ++i)
    face += " " + std::to_string(1 + i % 4);
  Diagnostics diagnostics;
  const auto result = read(face, diagnostics);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().where.line, 5u);
  EXPECT_NE(result.error().message.find("more than 10000 corners"), std::string::npos);
}

TEST(ObjReader, ReadsAnMtlFileOnce) {
  int asked = 0;
  const MtlLoader loader = [&](const std::string &name) -> Result<std::string> {
    ++asked;
    if (name == "a.mtl")
      return std::string("newmtl red\n");
    return fail(ErrorCode::BadInput, "none");
  };
  std::string text;
  for (int i = 0; i < 100; ++i)
    text += "mtllib a.mtl\nmtllib ./a.mtl\nmtllib b.mtl\nmtllib b.mtl a.mtl\n";
  Diagnostics diagnostics;
  const auto result =
      read_obj_text(text + square + "f 1 2 3\n", "a.obj", in_metres, loader, diagnostics);
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_EQ(asked, 3); // "a.mtl", "b.mtl", "b.mtl a.mtl"
  EXPECT_EQ(result->defined, (std::vector<std::string>{"red"}));
}

TEST(ObjReader, NamesArePrintable) {
  Diagnostics diagnostics;
  const auto result = read(square + "usemtl a\x1b[2J\nf 1 2 3\nusemtl b\xE9\nf 1 3 4\n"
                                    "usemtl c\xC3\xA9\nf 1 2 4\n",
                           diagnostics);
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_EQ(result->mesh.groups, (std::vector<std::string>{"a?[2J", "b?", "c\xC3\xA9"}));
  EXPECT_EQ(diagnostics.warnings().size(), 1u);
}

TEST(ObjReader, WarnsOfWhatItSkips) {
  Diagnostics diagnostics;
  const auto result = read(square + "f 1 2 3\nl 1\nf 1 2\n", diagnostics);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->mesh.triangles.size(), 1u);
  EXPECT_EQ(diagnostics.warnings().size(), 2u);
}

TEST(ObjReader, WarnsOfConcaveAndCrossingPolygons) {
  const std::string points = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n";
  Diagnostics concave, crossing;
  ASSERT_TRUE(read(points + "f 1 2 3 4 5 6\n", concave));
  EXPECT_EQ(concave.warnings().size(), 1u);
  ASSERT_TRUE(read(points + "f 1 3 2 6\n", crossing));
  EXPECT_EQ(crossing.warnings().size(), 1u);
}

TEST(ObjReader, NamesMayHoldBlanksAndHashes) {
  Diagnostics diagnostics;
  const MtlLoader loader = [](const std::string &name) -> Result<std::string> {
    if (name == "my file.mtl")
      return std::string("newmtl red#2\n");
    return fail(ErrorCode::BadInput, "none");
  };
  const auto result =
      read_obj_text("mtllib my file.mtl\n" + square + "usemtl red#2 # a note\nf 1 2 3\n", "a.obj",
                    in_metres, loader, diagnostics);
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_EQ(result->defined, (std::vector<std::string>{"red#2"}));
  EXPECT_EQ(result->mesh.groups[0], "red#2");
  EXPECT_TRUE(diagnostics.empty());
}

TEST(ObjReader, KeepsGroupsByMaterialElseByName) {
  Diagnostics diagnostics;
  const auto result =
      read(square + "o body\nf 1 2 3\nusemtl gold foil\nf 1 3 4\nusemtl b\nf 4 3 1\n"
                    "usemtl gold foil\nf 2 3 4\n",
           diagnostics);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->mesh.groups, (std::vector<std::string>{"body", "gold foil", "b"}));
  EXPECT_EQ(result->mesh.triangles[3].front, 1u);
}

TEST(ObjReader, AsksForUnitAndUpWithTheBox) {
  Diagnostics diagnostics;
  const std::string big = "v 0 0 0\nv 13200 0 0\nv 13200 4200 0\nf 1 2 3\n";
  const auto no_unit = read(big, diagnostics, {.unit = "", .up = "+Z"});
  ASSERT_FALSE(no_unit);
  EXPECT_NE(
      no_unit.error().message.find("13200 x 4200 x 0: in mm that is 13.2 m, in m it is 13.2 km"),
      std::string::npos)
      << no_unit.error().message;
  EXPECT_FALSE(read(big, diagnostics, {.unit = "m", .up = ""}));
  EXPECT_FALSE(read(big, diagnostics, {.unit = "furlong", .up = "+Z"}));
  EXPECT_FALSE(read(big, diagnostics, {.unit = "m", .up = "Z"}));
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_TRUE(read(big, diagnostics, in_metres));
  EXPECT_EQ(diagnostics.warnings().size(), 1u); // 13 km: "is unit right?"
}

TEST(ObjReader, TurnsTheUpAxisProperly) {
  // The file's up axis must become +Z, and handedness must stay: the volume keeps its sign.
  const Mesh cube = make_chamfered_cube(1, 0.1);
  const std::string text = write_obj(cube, "c").obj + "v 0 0 0\n";
  const struct {
    const char *up;
    Vec3<Body> axis;
  } rows[] = {{"+X", {1, 0, 0}},  {"-X", {-1, 0, 0}}, {"+Y", {0, 1, 0}},
              {"-Y", {0, -1, 0}}, {"+Z", {0, 0, 1}},  {"-Z", {0, 0, -1}}};
  for (const auto &row : rows) {
    Diagnostics diagnostics;
    const std::string marked = text + "v " + std::to_string(row.axis.x) + " " +
                               std::to_string(row.axis.y) + " " + std::to_string(row.axis.z) + "\n";
    const auto result = read(marked, diagnostics, {.unit = "m", .up = row.up});
    ASSERT_TRUE(result);
    EXPECT_NEAR(result->mesh.positions.back().z, 1, 1e-12) << row.up;
    EXPECT_GT(inspect(result->mesh).volume_m3, 0.9) << row.up;
  }
}

TEST(ObjReader, RefusesTooManyTriangles) {
  Diagnostics diagnostics;
  MeshFileOptions few = in_metres;
  few.max_triangles = 1;
  EXPECT_FALSE(read(square + "f 1 2 3 4\n", diagnostics, few));
}

TEST(ObjWriter, ReadsBackBitForBit) {
  for (const Mesh &mesh :
       {make_hst(), make_agena(), make_sphere(0.7, 500), make_plate(1, 2, true)}) {
    const ObjText text = write_obj(mesh, "m");
    Diagnostics diagnostics;
    const auto result = read(text.obj, diagnostics);
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->mesh.positions == mesh.positions);
    EXPECT_TRUE(result->mesh.normals == mesh.normals);
    EXPECT_EQ(result->mesh.groups, mesh.groups);
    ASSERT_EQ(result->mesh.triangles.size(), mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      EXPECT_EQ(result->mesh.triangles[i].vertex, mesh.triangles[i].vertex);
      EXPECT_EQ(result->mesh.triangles[i].normal, mesh.triangles[i].normal);
      EXPECT_EQ(result->mesh.triangles[i].front, mesh.triangles[i].front);
    }
  }
}

TEST(ObjReader, AgreesWithTinyobjloader) {
  // tinyobjloader holds floats: 2^-23 relative. Our shapes as files, per material.
  for (const Mesh &mesh : {make_hst(), make_agena()}) {
    const ObjText text = write_obj(mesh, "m");
    tinyobj::ObjReader oracle;
    ASSERT_TRUE(oracle.ParseFromString(text.obj, text.mtl));
    Diagnostics diagnostics;
    const auto ours = read(text.obj, diagnostics);
    ASSERT_TRUE(ours);
    std::size_t count = 0;
    std::vector<double> area(oracle.GetMaterials().size());
    const auto &v = oracle.GetAttrib().vertices;
    for (const auto &shape : oracle.GetShapes())
      for (std::size_t f = 0; f < shape.mesh.num_face_vertices.size(); ++f, ++count) {
        Vec3<Body> p[3];
        for (std::size_t k = 0; k < 3; ++k) {
          const auto i = static_cast<std::size_t>(shape.mesh.indices[3 * f + k].vertex_index);
          p[k] = {static_cast<double>(v[3 * i]), static_cast<double>(v[3 * i + 1]),
                  static_cast<double>(v[3 * i + 2])};
        }
        area[static_cast<std::size_t>(shape.mesh.material_ids[f])] +=
            norm(cross(p[1] - p[0], p[2] - p[0])) / 2;
      }
    EXPECT_EQ(count, ours->mesh.triangles.size());
    const MeshReport report = inspect(ours->mesh);
    for (std::size_t g = 0; g < area.size(); ++g)
      EXPECT_NEAR(area[g], report.group_area_m2[g], 1e-5 * report.group_area_m2[g]);
  }
}

} // namespace
} // namespace umov

namespace umov {
namespace {

TEST(ObjReader, TakesTheDirectionFieldFromTheTexture) {
  // u grows along +y of the file on the first face and along -x on the second; +Y up turns them.
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 0 1\nvt 1 0\nvt 0 0\nvt -1 0\nvt 0 1\n"
      "f 1/1 2/2 3/3\nf 1/4 2/5 3/6\n";
  Diagnostics diagnostics;
  const auto read = read_obj_text(
      text, "t.obj", {.unit = "m", .up = "+Y"},
      [](const std::string &) { return fail(ErrorCode::BadInput, ""); }, diagnostics);
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->mesh.tangents.size(), 2u);
  // (x, y, z) becomes (x, -z, y).
  EXPECT_NEAR(norm(read->mesh.tangents[0] - Vec3<Body>{0, 0, 1}), 0, 1e-15);
  EXPECT_NEAR(norm(read->mesh.tangents[1] - Vec3<Body>{-1, 0, 0}), 0, 1e-15);
}

} // namespace
} // namespace umov
