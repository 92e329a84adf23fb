// Masks kept in a file.

#include "light/tests/engine_cases.h"

#include <algorithm>
#include <cstring>
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

// What another engine has traced is copied: nothing is left to trace for the same poses, and the
// light is that of an engine alone, whose rows were traced one by one.
TEST_F(MaskFile, RowsOfAnotherEngineAreCopied) {
  options_.is_lazy = true;
  const Engine elder(scene(), options_), younger(scene(), options_), alone(scene(), options_);
  younger.take_masks_of(elder);
  const auto poses = random_poses(200, solar_radius), more = random_poses(300, solar_radius);
  const StokesTable seen = evaluated(elder, poses), copied = evaluated(younger, poses);
  EXPECT_TRUE(elder.has_new_masks());
  EXPECT_FALSE(younger.has_new_masks());
  EXPECT_EQ(copied.i, seen.i);
  EXPECT_EQ(copied.i_err, seen.i_err);
  // Poses that the elder has not seen, before and after it has.
  const StokesTable expected = evaluated(alone, more);
  EXPECT_EQ(evaluated(younger, more).i, expected.i);
  EXPECT_EQ(evaluated(elder, more).i, expected.i);
  // Masks of another mesh are no help, and do no harm.
  const Scene other = scene_of(make_box_wing({500, 0}), NormalMode::Flat, four_materials());
  const Engine stranger(other, options_), as_it_is(other, options_);
  stranger.take_masks_of(elder);
  EXPECT_EQ(evaluated(stranger, poses).i, evaluated(as_it_is, poses).i);
  EXPECT_TRUE(stranger.has_new_masks());
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

/// A file of masks with a right checksum, whatever else it says. Header: words of 8 bytes.
class Forgery {
public:
  enum Word {
    checksum = 3,
    groups = 4,
    longest = 6,
    narrow_cells = 7,
    narrow_entries = 8,
    narrow_offsets = 9,
    narrow_rows = 10,
    wide_cells = 11,
    wide_entries = 12,
    wide_offsets = 13,
    wide_rows = 14,
    words = 15
  };
  explicit Forgery(std::string bytes) : bytes_(std::move(bytes)) {}
  [[nodiscard]] std::uint64_t get(Word word) const {
    std::uint64_t out = 0;
    std::memcpy(&out, bytes_.data() + 8 * word, 8);
    return out;
  }
  void set(Word word, std::uint64_t value) { std::memcpy(bytes_.data() + 8 * word, &value, 8); }
  void set_half(std::size_t at, std::uint32_t value) { std::memcpy(bytes_.data() + at, &value, 4); }
  void erase(std::size_t at, std::size_t count) { bytes_.erase(at, count); }
  static constexpr std::size_t header = 8 * words;
  [[nodiscard]] std::size_t end_of_groups() const { return header + 8 * get(groups); }

  /// The bytes with their checksum.
  std::string done() {
    set(checksum, 0);
    value_ = 0xCBF29CE484222325ull;
    add(0, header);
    std::size_t at = header;
    const auto part = [&](std::size_t size) {
      size = std::min(size, bytes_.size() - at);
      add(at, size);
      at += size;
    };
    part(8 * get(groups));
    for (const Word list : {narrow_offsets, narrow_rows, wide_offsets, wide_rows})
      part((list == narrow_rows || list == wide_rows ? 8 : 4) * get(list));
    part(bytes_.size() - at);
    set(checksum, value_);
    return bytes_;
  }

private:
  void add(std::size_t at, std::size_t count) {
    for (; count >= 8; count -= 8, at += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes_.data() + at, 8);
      value_ = (value_ ^ word) * 0x100000001B3ull;
      value_ ^= value_ >> 29;
    }
    for (; count > 0; --count, ++at)
      value_ = (value_ ^ static_cast<unsigned char>(bytes_[at])) * 0x100000001B3ull;
  }
  std::string bytes_;
  std::uint64_t value_ = 0;
};

// The checksum has no key: who writes it right must not lead the sums out of their memory.
TEST_F(MaskFile, AForgedFileIsRefused) {
  const Scene plain = scene_of(make_box_wing({1000, 0}), NormalMode::Flat, {white_lambert()});
  options_.masks.refine_above = 0;
  ASSERT_TRUE(Engine(plain, options_).save_masks(file_));
  const std::string good = read_file(file_).value();
  const auto refused = [&](auto change) {
    Forgery file(good);
    change(file);
    EXPECT_TRUE(write_file_atomically(file_, file.done()));
    return refusal(plain, options_);
  };
  EXPECT_EQ(refused([](Forgery &) {}), ""); // the checksum of this test is the engine's
  EXPECT_NE(refused([](Forgery &file) {
              file.erase(Forgery::header, file.end_of_groups() - Forgery::header);
              file.set(Forgery::groups, 0);
            }),
            "");
  for (const Forgery::Word word : {Forgery::longest, Forgery::narrow_cells, Forgery::wide_cells,
                                   Forgery::narrow_entries, Forgery::wide_entries})
    for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{1} << 40, ~std::uint64_t{0}})
      EXPECT_NE(refused([&](Forgery &file) { file.set(word, file.get(word) ^ value ^ 2); }), "")
          << word << " " << value;
  // Places within the file: an entry of a group, what follows it, an offset.
  EXPECT_NE(refused([](Forgery &file) { file.set_half(Forgery::header, 1u << 30); }), "");
  EXPECT_NE(refused([](Forgery &file) { file.set_half(Forgery::header + 4, 0x02FFFFFF); }), "");
  EXPECT_NE(refused([](Forgery &file) { file.set_half(file.end_of_groups(), 0xFFFFFF00); }), "");
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
