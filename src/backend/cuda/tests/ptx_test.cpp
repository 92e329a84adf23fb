// What becomes of the program of cards, read without one: NVIDIA's run-time compiler makes machine
// code and assembly (PTX) of the texts that the library carries, for four generations of cards.
// tools/check_cuda fetches the two compilers for them.

#include "backend/cuda/card.h"

#include <gtest/gtest.h>
#include <regex>

namespace umov::backend {
namespace {

/// A capability, and the compiler that still knows it: CUDA 13 has dropped Volta (7.0).
struct Target {
  int capability;
  const char *folder;
};

class Program : public testing::TestWithParam<Target> {
protected:
  static Result<CardImage> compiled() {
    const std::filesystem::path folders[] = {GetParam().folder};
    constexpr int any_driver = 1'000'000;
    const auto loaded = CardCompiler::load(folders, any_driver);
    if (!loaded)
      throw Failure(loaded.error());        // not skipped: tools/check_cuda has fetched it
    for (const CardCompiler &one : *loaded) // the system may have others
      if (one.file().starts_with(GetParam().folder))
        return one.compile(GetParam().capability, false);
    return fail(ErrorCode::Device, std::string("no compiler in ") + GetParam().folder);
  }
};

/// The text of one entry of an assembly.
std::string entry_of(const std::string &assembly, const std::string &name) {
  const std::size_t begin = assembly.find(".entry " + name);
  if (begin == std::string::npos)
    return "";
  return assembly.substr(begin, assembly.find("\n}", begin) - begin);
}

struct Use {
  int stack = -1, stores = -1, loads = -1, registers = -1;
};
/// What ptxas -v says of an entry.
Use use_of(const std::string &log, const std::string &name) {
  Use out;
  const std::size_t begin = log.find("Compiling entry function '" + name);
  if (begin == std::string::npos)
    return out;
  const std::string rest = log.substr(begin);
  std::smatch found;
  if (std::regex_search(rest, found,
                        std::regex("(\\d+) bytes stack frame, (\\d+) bytes spill stores, "
                                   "(\\d+) bytes spill loads"))) {
    out.stack = std::stoi(found[1]);
    out.stores = std::stoi(found[2]);
    out.loads = std::stoi(found[3]);
  }
  if (std::regex_search(rest, found, std::regex("Used (\\d+) registers")))
    out.registers = std::stoi(found[1]);
  return out;
}

TEST_P(Program, SumsInSinglePrecisionInRegisters) {
  const auto image = compiled();
  ASSERT_TRUE(image) << image.error().text();
  EXPECT_EQ(image->bytes.substr(1, 3), "ELF");
  // Lists of a chunk's facets and sums of a family of lobes stand in a thread's own memory; what
  // registers cannot hold should not: a few words are none of a loop's.
  struct Sum {
    const char *name;
    int registers;
  };
  // 512 threads of a multiprocessor, and 384 where curved parts are narrower than their elements
  constexpr Sum sums[] = {{"umov_sum_poses", 128}, {"umov_sum_curved_poses", 168}};
  for (const Sum &sum : sums) {
    const Use use = use_of(image->log, sum.name);
    EXPECT_GT(use.stack, 0) << image->log;
    EXPECT_LE(use.stack, 6 * 1024);
    EXPECT_LE(use.stores, 64) << image->log;
    EXPECT_LE(use.loads, 64);
    EXPECT_LE(use.registers, sum.registers);
    // Double is where directions are subtracted, and nowhere else.
    const std::string text = entry_of(image->assembly, sum.name);
    ASSERT_GT(text.size(), 100'000u) << sum.name;
    EXPECT_EQ(text.find(".f64"), std::string::npos) << sum.name;
    EXPECT_EQ(text.find("call"), std::string::npos) << sum.name; // all in one
  }
  const Use prepare = use_of(image->log, "umov_prepare_poses");
  EXPECT_EQ(prepare.stores, 0) << image->log;
  for (const char *name : {"umov_colour_poses", "umov_weigh_poses"}) {
    const Use use = use_of(image->log, name);
    EXPECT_EQ(use.stack, 0) << image->log;
    EXPECT_EQ(use.stores, 0);
    EXPECT_LE(use.registers, 128);
    const std::string text = entry_of(image->assembly, name);
    ASSERT_GT(text.size(), 5000u) << name;
    EXPECT_EQ(text.find(".f64"), std::string::npos) << name;
    EXPECT_EQ(text.find("call"), std::string::npos) << name;
  }
  EXPECT_NE(entry_of(image->assembly, "umov_prepare_poses").find(".f64"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    ptx, Program,
    testing::Values(Target{70, UMOV_NVRTC12_FOLDER}, Target{75, UMOV_NVRTC_FOLDER},
                    Target{80, UMOV_NVRTC_FOLDER}, Target{90, UMOV_NVRTC_FOLDER}),
    [](const auto &of) { return "sm_" + std::to_string(of.param.capability); });

} // namespace
} // namespace umov::backend
