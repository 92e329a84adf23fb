// Masks kept in a file.

#include "light/tests/engine_cases.h"

#include <filesystem>
#include <umov/core/files.h>

namespace umov::cases {
namespace {

class MaskFile : public testing::Test {
protected:
  MaskFile()
      : file_(std::filesystem::temp_directory_path() /
              ("umov_masks_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    options_.masks = {5'000, 8, 10, 0.02};
  }
  ~MaskFile() override { std::filesystem::remove(file_); }

  Scene scene() const {
    return scene_of(make_box_wing({1000, 0}), NormalMode::Flat, four_materials());
  }
  std::string refusal(const Scene &scene, const EngineOptions &options) const {
    const auto engine = Engine::with_masks(file_, scene, options);
    return engine ? std::string() : engine.error().text();
  }
  std::filesystem::path file_;
  EngineOptions options_;
};

TEST_F(MaskFile, GivesTheSameBytes) {
  const Engine made(scene(), options_);
  ASSERT_TRUE(made.save_masks(file_));
  const auto read = Engine::with_masks(file_, scene(), options_);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->facts().mask_bytes, made.facts().mask_bytes);
  const auto poses = random_poses(300, solar_radius);
  const StokesTable a = evaluated(made, poses), b = evaluated(*read, poses);
  EXPECT_EQ(a.i, b.i);
  EXPECT_EQ(a.i_err, b.i_err);
  // Another material on the same groups sees the same masks.
  auto others = four_materials();
  others[0].index = builtin_index("paper_al").value();
  EXPECT_EQ(refusal(scene_of(make_box_wing({1000, 0}), NormalMode::Flat, others), options_), "");
}

TEST_F(MaskFile, IsRefusedForAnythingElse) {
  ASSERT_TRUE(Engine(scene(), options_).save_masks(file_));
  Mesh moved = make_box_wing({1000, 0});
  moved.positions[17].x += 1e-9;
  EXPECT_NE(refusal(scene_of(moved, NormalMode::Flat, four_materials()), options_)
                .find("was made for another mesh"),
            std::string::npos);
  EngineOptions finer = options_;
  finer.masks.narrow_cells = 12;
  EXPECT_NE(refusal(scene(), finer).find("another accuracy"), std::string::npos);
  // A convex body has none to keep.
  const Scene ball = scene_of(make_sphere(1, 100), NormalMode::Flat, four_materials());
  EXPECT_FALSE(Engine(ball, options_).save_masks(file_));
}

TEST_F(MaskFile, DamageIsFoundWhereverItIs) {
  const Scene plain = scene_of(make_box_wing({1000, 0}), NormalMode::Flat, {white_lambert()});
  options_.masks.refine_above = 0;
  ASSERT_TRUE(Engine(plain, options_).save_masks(file_));
  const std::string good = read_file(file_).value();
  EXPECT_EQ(refusal(plain, options_), "");
  for (const std::size_t length : {std::size_t{0}, std::size_t{7}, std::size_t{50},
                                   std::size_t{100}, good.size() / 2, good.size() - 1}) {
    ASSERT_TRUE(write_file_atomically(file_, good.substr(0, length)));
    EXPECT_NE(refusal(plain, options_), "") << length;
  }
  ASSERT_TRUE(write_file_atomically(file_, good + "x"));
  EXPECT_NE(refusal(plain, options_), "");
  for (std::size_t i = 0; i < good.size(); i += i < 160 ? 4 : good.size() / 9) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x41);
    ASSERT_TRUE(write_file_atomically(file_, bad));
    EXPECT_NE(refusal(plain, options_), "") << "byte " << i;
  }
  std::filesystem::remove(file_);
  EXPECT_NE(refusal(plain, options_).find("cannot be read"), std::string::npos);
}

} // namespace
} // namespace umov::cases
