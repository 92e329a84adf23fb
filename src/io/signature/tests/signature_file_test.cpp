#include <cmath>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <umov/io/signature_file.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

constexpr std::size_t cells = 4;

/// Light that is linear in nothing, written down here.
bool shine(std::span<const Pose> poses, StokesTable &out) {
  out.resize(poses.size(), 2);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Vec3<Body> half = poses[k].sun + poses[k].observer;
    for (std::size_t b = 0; b < 2; ++b) {
      BandResult one;
      one.stokes.i = std::max(0.0, 0.5 + half.x + 0.1 * static_cast<double>(b) * half.y);
      one.stokes.q = 0.3 * one.stokes.i * half.z / 2;
      out.put(k, b, one);
    }
  }
  return true;
}

StokesTable all_light() {
  StokesTable out;
  EXPECT_TRUE(shine(signature_poses(cells, 0, signature_pairs(cells), 0), out));
  return out;
}

std::string bytes() {
  const std::vector<float> sums(signature_pairs(cells) * 3, 0.25f);
  return signature_bytes({"box", "abc", "def", {"a", "b"}, {"x", "y", "z"}, 0.0046}, cells,
                         pack_light(all_light()), 0.125, sums)
      .value();
}

TEST(SignatureFile, SayWhatTheyHaveRoomFor) {
  EXPECT_TRUE(check_signature_size(200, 64));
  EXPECT_FALSE(check_signature_size(200, 65));
  EXPECT_FALSE(check_signature_size(201, 3));
}

TEST(Signature, PairsAreOnceEachAndInParts) {
  const auto all = signature_poses(cells, 0, signature_pairs(cells), 0.01);
  ASSERT_EQ(all.size(), 25u * 26 / 2);
  const auto part = signature_poses(cells, 100, 200, 0.01);
  for (std::size_t k = 0; k < part.size(); ++k) {
    EXPECT_EQ(part[k].sun.x, all[100 + k].sun.x);
    EXPECT_EQ(part[k].observer.z, all[100 + k].observer.z);
  }
}

TEST(Signature, LooksUpWhatWasPutInAtTheNodes) {
  const StokesTable light = all_light();
  const PackedLight packed = pack_light(light);
  const Signature signature{"box", cells, 2, packed.ln_least, packed.ln_step, 0, packed.code};
  const auto poses = signature_poses(cells, 0, signature_pairs(cells), 0);
  StokesTable found;
  ASSERT_TRUE(lighting_of(signature, 1)(poses, found));
  for (std::size_t k = 0; k < light.i.size(); ++k) {
    // Half a step of the codes, 9 ln 10 / 65,534 / 2 = 1.6e-4, and the rounding of floats.
    EXPECT_NEAR(found.i[k], light.i[k], 2e-4 * light.i[k] + 1e-8);
    EXPECT_NEAR(found.q[k], light.q[k], 2e-4 * std::abs(light.q[k]) + 2e-5 * light.i[k] + 1e-8);
  }
  // Sun and observer swapped: the same light.
  std::vector<Pose> swapped = poses;
  for (Pose &pose : swapped)
    std::swap(pose.sun, pose.observer);
  StokesTable other;
  ASSERT_TRUE(lighting_of(signature, 1)(swapped, other));
  EXPECT_EQ(other.i, found.i);
  // Between nodes 45 deg apart it is off by some tens of per cent, and says so.
  const double error = interpolation_error(signature, shine, 1);
  EXPECT_GT(error, 0.01);
  EXPECT_LT(error, 1);
}

TEST(SignatureFile, ThereAndBack) {
  const std::string file = testing::TempDir() + "signature_test.umovsig";
  std::ofstream(file, std::ios::binary) << bytes();
  const auto read = SignatureFile::open(file, true);
  ASSERT_TRUE(read) << read.error().text();
  const SignatureView &view = read->view();
  EXPECT_EQ(view.text.name, "box");
  EXPECT_EQ(view.text.bands, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(view.text.columns.size(), 3u);
  EXPECT_EQ(view.signature.error, 0.125);
  ASSERT_EQ(view.abundances.size(), signature_pairs(cells) * 3);
  EXPECT_EQ(view.abundances.back(), 0.25f);
  const PackedLight packed = pack_light(all_light());
  EXPECT_TRUE(std::equal(packed.code.begin(), packed.code.end(), view.signature.code.begin(),
                         view.signature.code.end()));
  std::remove(file.c_str());
}

TEST(SignatureFile, WhatIsWrittenIsRead) {
  // The same bound for who writes and who reads: light of an error beyond all others, light too
  // faint for codes, who lit it, and what no file holds.
  const SignatureText text{"box", "abc", "def", {"a", "b"}, {}, 0.0046, "Card of paper"};
  StokesTable faint = all_light();
  for (std::vector<double> *column : {&faint.i, &faint.q})
    for (double &value : *column)
      value *= 1e-32; // the least of nine decades is below exp(-80) = 2e-35
  for (const PackedLight &light : {pack_light(all_light()), pack_light(faint)}) {
    const auto made = signature_bytes(text, cells, light, signature_error_most, {});
    ASSERT_TRUE(made) << made.error().text();
    const auto read = parse_signature(*made, "file", true);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->text.device, "Card of paper");
    EXPECT_EQ(read->signature.error, signature_error_most);
  }
  for (const double error : {2 * signature_error_most, -1.0}) {
    const auto refused = signature_bytes(text, cells, pack_light(all_light()), error, {});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("cannot be kept in a file"), std::string::npos);
  }
  // A look-up that is off by 1e30 of the light is told as off by the most that is told.
  const PackedLight packed = pack_light(all_light());
  const Signature bright{"box", cells, 2, packed.ln_least + 60, packed.ln_step, 0, packed.code};
  EXPECT_EQ(interpolation_error(bright, shine, 1), signature_error_most);
}

TEST(SignatureFile, DamageIsSaid) {
  const std::string good = bytes();
  const auto read = [](const std::string &text) { return parse_signature(text, "file", true); };
  ASSERT_TRUE(read(good));
  for (std::size_t at = 0; at < good.size(); at += 7) { // any byte changed
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x20);
    const auto refused = read(bad);
    ASSERT_FALSE(refused) << at;
    EXPECT_EQ(refused.error().code, ErrorCode::BadInput);
  }
  for (const std::size_t size : {std::size_t{0}, std::size_t{8}, std::size_t{79}, good.size() - 8})
    EXPECT_FALSE(read(good.substr(0, size))) << size;
  EXPECT_FALSE(read(good + "12345678"));
  EXPECT_FALSE(SignatureFile::open("/nowhere/x.umovsig"));
  EXPECT_FALSE(SignatureFile::open("/tmp"));
}

} // namespace
} // namespace umov
