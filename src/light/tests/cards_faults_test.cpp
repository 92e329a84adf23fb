// What cards and drivers do when they fail, lack memory or are not what was hoped for.

#include "light/tests/paper_cards.h"

#include <fstream>
#include <sys/wait.h>
#include <umov/light/instruction_set.h>
#include <umov/light/light_model.h>

namespace umov::cases {
namespace {

TEST(Cards, TooLittleMemoryIsAskedForInHalves) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const auto poses = random_poses(9000);
  const StokesTable whole = evaluated(on_card(scene, Visibility::Masks), poses);
  {
    const Setting few("UMOV_FAKE_POSES", "700"); // said by the launch: out of memory in the middle
    EXPECT_EQ(evaluated(on_card(scene, Visibility::Masks), poses).i, whole.i);
  }
  const Setting small("UMOV_FAKE_MEMORY", "8000000"); // said when room is asked for
  EXPECT_EQ(evaluated(on_card(scene, Visibility::Masks), poses).i, whole.i);
}

TEST(Cards, WhatDoesNotFitIsRefusedWithItsBytes) {
  const Scene scene = scene_of(make_box_wing({3000, 0}), NormalMode::Flat, four_materials());
  const auto cards = open_cards(with_fakes()).value();
  {
    const Setting none("UMOV_FAKE_MEMORY", "1000");
    const auto used = engine_of(scene, Visibility::None).use_cards(cards);
    ASSERT_FALSE(used);
    EXPECT_EQ(used.error().code, ErrorCode::Device);
    EXPECT_NE(used.error().message.find("bytes and Card of paper has 1000 left"), std::string::npos)
        << used.error().message;
  }
  Engine engine = engine_of(scene, Visibility::Masks);
  const Setting small("UMOV_FAKE_MEMORY", "200000"); // facets fit, masks do not
  ASSERT_TRUE(engine.use_cards(cards));
  try {
    (void)evaluated(engine, random_poses(3));
    ADD_FAILURE() << "the masks were taken";
  } catch (const Failure &failure) {
    EXPECT_EQ(failure.error().code, ErrorCode::Device);
    EXPECT_NE(failure.error().message.find("the masks take"), std::string::npos)
        << failure.error().message;
  }
}

TEST(Cards, TheProcessorTakesOverWhereMasksNoLongerFit) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  EngineOptions options;
  options.masks = {20'000, 24, 24, 0};
  options.is_lazy = true;
  Engine engine(scene, options), alone(scene, options);
  ASSERT_TRUE(engine.use_cards(open_cards(with_fakes()).value(), true));
  const auto few = random_poses(4), more = random_poses(200);
  (void)evaluated(engine, few);
  EXPECT_EQ(engine.why_cards_were_left(), "");
  const std::string card = "Card of paper, compute 8.0, compiler 13.0, driver of CUDA 13.2";
  EXPECT_EQ(engine.lit_by(), card);
  {
    const Setting full("UMOV_FAKE_MEMORY", "100000");
    EXPECT_EQ(evaluated(engine, more).i, evaluated(alone, more).i); // the processor's bytes
  }
  EXPECT_NE(engine.why_cards_were_left().find("the masks take"), std::string::npos)
      << engine.why_cards_were_left();
  EXPECT_EQ(evaluated(engine, few).i, evaluated(alone, few).i); // and for good
  EXPECT_EQ(engine.lit_by(), card + " and the processor");
  EXPECT_EQ(alone.lit_by(), "");
}

TEST(Cards, WhatTheyDidNotLightIsNotTheirs) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const auto poses = random_poses(600);
  const Setting none("UMOV_FAKE_FULL", "0");
  auto how = with_fakes();
  how.choice = DeviceChoice::Auto;
  LightOptions options;
  options.method = LightMethod::Masks;
  options.device = how;
  const auto model = make_light(scene, {}, options);
  ASSERT_TRUE(model) << model.error().text();
  EXPECT_EQ((*model)->device(), "Card of paper");
  StokesTable out;
  ASSERT_TRUE((*model)->evaluate(poses, out));
  EXPECT_TRUE((*model)->device().starts_with("cpu: computing on")) << (*model)->device();
  EXPECT_EQ((*model)->lit_by(), "");
  EXPECT_EQ((*model)->instruction_set(), engine_instruction_set());
}

TEST(Cards, WhatIsUnderWayIsWaitedForWhenACardIsLost) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const auto set = open_cards(with_fakes()).value();
  Engine engine = engine_of(scene, Visibility::Masks);
  ASSERT_TRUE(engine.use_cards(set));
  const Setting second("UMOV_FAKE_LAUNCHES", "4"); // in the middle of the second batch
  EXPECT_THROW((void)evaluated(engine, random_poses(20'000)), Failure);
  EXPECT_EQ(of_driver<std::size_t()>("umov_fake_under_way")(), 0U);
}

TEST(Cards, TheCallersContextIsGivenBack) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const auto current = [] {
    void *out = nullptr;
    of_driver<int(void **)>("cuCtxGetCurrent")(&out);
    return out;
  };
  int theirs = 0; // of another library in this process
  of_driver<int(void *)>("cuCtxSetCurrent")(&theirs);
  {
    const Engine engine = on_card(scene, Visibility::Masks);
    EXPECT_EQ(current(), &theirs);
    (void)evaluated(engine, random_poses(100));
    EXPECT_EQ(current(), &theirs);
  }
  EXPECT_EQ(current(), &theirs);
}

TEST(Cards, AForkedProcessIsToldThatItHasNoCard) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const auto how = with_fakes();
  ASSERT_TRUE(open_cards(how));
  const Engine engine = on_card(scene, Visibility::Masks);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    int wrong = 0;
    const auto again = open_cards(with_fakes());
    wrong += again || again.error().message.find("forked") == std::string::npos ? 1 : 0;
    try {
      StokesTable out;
      (void)engine.evaluate(random_poses(3), out, 1);
      wrong += 2;
    } catch (const Failure &failure) {
      wrong += failure.error().message.find("forked") == std::string::npos ? 4 : 0;
    }
    ::_exit(wrong);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(Cards, TheProcessorTakesOverWhereNoBatchFits) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const auto poses = random_poses(600);
  Engine engine = engine_of(scene, Visibility::Masks);
  const Engine alone = engine_of(scene, Visibility::Masks);
  ASSERT_TRUE(engine.use_cards(open_cards(with_fakes()).value(), true));
  const Setting few("UMOV_FAKE_POSES", "100");
  EXPECT_EQ(evaluated(engine, poses).i, evaluated(alone, poses).i);
  EXPECT_NE(engine.why_cards_were_left(), "");
}

TEST(Cards, ACardThatIsLostIsNotLeft) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  Engine engine = engine_of(scene, Visibility::Masks);
  ASSERT_TRUE(engine.use_cards(open_cards(with_fakes()).value(), true));
  const Setting soon("UMOV_FAKE_LAUNCHES", "1");
  EXPECT_THROW((void)evaluated(engine, random_poses(300)), Failure);
  EXPECT_EQ(engine.why_cards_were_left(), "");
}

TEST(Cards, ALostCardIsAFailureOfTheDevice) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const Engine engine = on_card(scene, Visibility::Masks);
  const Setting soon("UMOV_FAKE_LAUNCHES", "3"); // the second batch
  try {
    (void)evaluated(engine, random_poses(20'000));
    ADD_FAILURE() << "nothing was noticed";
  } catch (const Failure &failure) {
    EXPECT_EQ(failure.error().code, ErrorCode::Device);
    EXPECT_NE(failure.error().message.find("CUDA_ERROR_LAUNCH_FAILED"), std::string::npos)
        << failure.error().message;
  }
}

/// The message of cards that cannot be opened.
std::string refusal(const DeviceOptions &options) {
  const auto cards = open_cards(options);
  EXPECT_FALSE(cards);
  if (cards)
    return "";
  EXPECT_EQ(cards.error().code, ErrorCode::Device);
  return cards.error().message;
}

TEST(Cards, WhatLacksIsSaid) {
  const auto has = [](const std::string &text, const char *part) {
    return text.find(part) != std::string::npos;
  };
  {
    const Setting broken("UMOV_FAKE_INIT", "100");
    const std::string said = refusal(with_fakes());
    EXPECT_TRUE(has(said, "CUDA_ERROR_NO_DEVICE (100, no CUDA-capable device")) << said;
  }
  {
    const Setting none("UMOV_FAKE_CARDS", "0");
    EXPECT_TRUE(has(refusal(with_fakes()), "finds no card"));
  }
  {
    const Setting old("UMOV_FAKE_LOAD", "222");
    EXPECT_TRUE(has(refusal(with_fakes()), "driver is of CUDA 13.2"));
  }
  {
    const Setting newer("UMOV_FAKE_OLDEST", "85");
    EXPECT_TRUE(has(refusal(with_fakes()), "compute capability 8.0 is too old"));
  }
  const Setting broken("UMOV_FAKE_COMPILE", "6");
  EXPECT_TRUE(has(refusal(with_fakes()), "made to fail by UMOV_FAKE_COMPILE"));
}

TEST(Cards, TheNewestCompilerThatTheDriverTakesIsTaken) {
  const std::filesystem::path both[] = {std::string(UMOV_FAKE_CUDA) + "_newer", UMOV_FAKE_CUDA};
  const auto taken = [&] {
    const auto cards = open_cards({DeviceChoice::Cuda, {both, both + 2}, new_cache()});
    return cards ? identity_of(**cards) : cards.error().message;
  };
  const auto has = [](const std::string &text, const char *part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(taken(), "compiler 13.0")) << taken(); // of 13.0 and 13.5, for a driver of 13.2
  const std::string doctor = describe_cards({both, both + 2}).value();
  EXPECT_TRUE(has(doctor, "compiler 13.0 (13.5 of ")) << doctor;
  EXPECT_TRUE(has(doctor, "is newer than the driver and passed over)")) << doctor;
  {
    const Setting newer("UMOV_FAKE_DRIVER", "13050");
    EXPECT_TRUE(has(taken(), "compiler 13.5")) << taken();
    const Setting picky("UMOV_FAKE_REFUSES", "13050"); // the next one
    EXPECT_TRUE(has(taken(), "compiler 13.0")) << taken();
  }
  const Setting older("UMOV_FAKE_DRIVER", "12080"); // the least new first, and both are refused
  EXPECT_TRUE(has(taken(), "CUDA_ERROR_UNSUPPORTED_PTX_VERSION")) << taken();
  EXPECT_TRUE(has(taken(), "the driver is of CUDA 12.8")) << taken();
  EXPECT_TRUE(has(describe_cards({both, both + 2}).value(), "13.0 (newer than the driver"));
}

TEST(Cards, FoldersAreThoseNamedAndThoseOfPackages) {
  const std::filesystem::path base = new_cache(), one = base / "one", two = base / "two";
  const auto packages = [](const std::filesystem::path &environment) {
    return environment / "lib/python3.11/site-packages/nvidia";
  };
  std::filesystem::create_directories(packages(one) / "cuda_nvrtc/lib");
  std::filesystem::create_directories(packages(one) / "cu13/lib");
  std::filesystem::create_directories(packages(one) / "cublas");
  std::filesystem::create_directories(packages(two) / "cu13/lib");
  const std::filesystem::path environments[] = {one, "", base / "absent", two, one};
  const std::vector<std::filesystem::path> wanted{"/a", "b c", packages(one) / "cu13/lib",
                                                  packages(one) / "cuda_nvrtc/lib",
                                                  packages(two) / "cu13/lib"};
  EXPECT_EQ(device_folders(":/a:b c::/a", environments), wanted);
  EXPECT_TRUE(device_folders("", {}).empty());
}

TEST(Cards, TheirNumberIsNoPartOfWhatBytesDependOn) {
  const auto of = [](const char *cards) {
    const Setting many("UMOV_FAKE_CARDS", cards);
    return open_cards(with_fakes()).value();
  };
  EXPECT_EQ(name_of(*of("2")), "2 x Card of paper");
  EXPECT_EQ(identity_of(*of("2")), identity_of(*of("1")));
  const std::string before = identity_of(*of("1"));
  const Setting other("UMOV_FAKE_VERSION", "12080");
  EXPECT_NE(identity_of(*of("1")), before);
}

TEST(Cards, CompiledKernelsAreKept) {
  const auto cache = new_cache(), other = new_cache();
  ASSERT_TRUE(open_cards(with_fakes(cache)));
  ASSERT_TRUE(open_cards(with_fakes(other))); // else the same cards would be given again
  const Setting broken("UMOV_FAKE_COMPILE", "6");
  EXPECT_TRUE(open_cards(with_fakes(cache)));                         // nothing had to be compiled
  for (const auto &file : std::filesystem::directory_iterator(cache)) // damaged
    std::ofstream(file.path(), std::ios::app) << "x";
  EXPECT_TRUE(open_cards(with_fakes(other)));
  EXPECT_FALSE(open_cards(with_fakes(cache)));
}

} // namespace
} // namespace umov::cases
