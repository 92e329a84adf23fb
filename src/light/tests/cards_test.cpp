// The whole way poses -> "card" -> Stokes, with a driver that runs the kernels of cards on the host
// (src/backend/cuda/tests/fake_driver.cpp), held against the scalar reference in double; and what
// cards and drivers do when they fail.

#include "light/tests/engine_cases.h"

#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <umov/light/instruction_set.h>
#include <umov/light/light_model.h>
#include <unistd.h>

namespace umov::cases {
namespace {

/// A variable of the environment for as long as the object lives.
class Setting {
public:
  Setting(const char *name, const std::string &value) : name_(name) {
    ::setenv(name, value.c_str(), 1);
  }
  ~Setting() { ::unsetenv(name_); }
  Setting(const Setting &) = delete;
  Setting &operator=(const Setting &) = delete;

private:
  const char *name_;
};

/// Cards anew: each caller's cache folder is another one.
std::filesystem::path new_cache() {
  static int number = 0;
  return std::filesystem::path(testing::TempDir()) /
         ("umov_cards_" + std::to_string(::getpid()) + "_" + std::to_string(++number));
}

/// The card on paper, whatever else there is. For tools/gpu_check, UMOV_TEST_CUDA names the folders
/// of a real one's driver and compiler ("system": where the system has them).
DeviceOptions with_fakes(const std::filesystem::path &cache = new_cache()) {
  if (const char *real = std::getenv("UMOV_TEST_CUDA")) {
    const char *const active = std::getenv("VIRTUAL_ENV");
    const std::filesystem::path environments[] = {active == nullptr ? "" : active};
    return {DeviceChoice::Cuda, device_folders(real, environments),
            std::filesystem::path(testing::TempDir()) / "umov_kernels"};
  }
  return {DeviceChoice::Cuda, {UMOV_FAKE_CUDA}, cache};
}

Engine on_card(const Scene &scene, Visibility visibility) {
  Engine out = engine_of(scene, visibility);
  const auto cards = open_cards(with_fakes());
  EXPECT_TRUE(cards) << cards.error().text();
  const auto used = out.use_cards(*cards);
  EXPECT_TRUE(used) << used.error().text();
  return out;
}

/// Quantiles of what differs from double: I over the larger of I and a tenth of the median light
/// (the floor that accuracies refer to), Q/I where there is as much light.
struct Parity {
  double i_median = 0, i_worst = 0, q_median = 0;
};
Parity parity(const StokesTable &found, const StokesTable &exact) {
  const double floor = 0.1 * quantile(exact.i, 0.5);
  std::vector<double> i, q;
  for (std::size_t k = 0; k < exact.i.size(); ++k) {
    i.push_back(std::abs(found.i[k] - exact.i[k]) / std::max(exact.i[k], floor));
    if (exact.i[k] > floor)
      q.push_back(std::abs(found.q[k] / found.i[k] - exact.q[k] / exact.i[k]));
  }
  return {quantile(i, 0.5), quantile(i, 1), quantile(q, 0.5)};
}

struct Case {
  const char *name;
  Scene scene;
  Visibility visibility;
};

Material with_lobe(const char *name, const DistributionChoice &lobe, Shadowing shadowing) {
  Material out = interface_of(name, 1);
  out.distribution = lobe;
  out.shadowing = shadowing;
  return out;
}

/// Meshes and materials of the engine's own tests: every lobe, every masking, body light of every
/// kind, roughness by band, smooth normals, a surface without a kernel.
std::vector<Case> all_cases() {
  std::vector<Case> out;
  const Mesh cube = make_chamfered_cube(1, 0.1), ball = make_sphere(1, 300);
  const DistributionChoice lobes[] = {blinn_phong(5),
                                      blinn_phong(200),
                                      blinn_phong(1000),
                                      {"beckmann", {{"alpha", 0.2}}, {}, {}, {}},
                                      {"beckmann", {{"alpha", 0.03}}, {}, {}, {}},
                                      {"ggx", {{"alpha", 0.15}}, {}, {}, {}},
                                      {"ggx", {{"alpha", 0.03}}, {}, {}, {}}};
  for (const auto &lobe : lobes)
    for (const Shadowing shadowing : {Shadowing::Ashikhmin, Shadowing::Smith, Shadowing::Separable})
      out.push_back({"lobe",
                     scene_of(cube, NormalMode::Flat, {with_lobe("paper_al", lobe, shadowing)}),
                     Visibility::None});
  for (const Interreflection kind :
       {Interreflection::None, Interreflection::Unpolarized, Interreflection::SingleBounceQ}) {
    Material material = builtin_material("paper_asi").value();
    material.interreflection = kind;
    out.push_back({"diffuse", scene_of(ball, NormalMode::Flat, {material}), Visibility::None});
  }
  Material silicon = builtin_material("paper_asi").value();
  silicon.body->is_polarized = true;
  out.push_back({"body", scene_of(cube, NormalMode::Flat, {silicon}), Visibility::None});
  Material by_band = interface_of("paper_al", 200);
  by_band.apparent_roughness = ApparentRoughness{0.8, 550, {}};
  out.push_back({"by band", scene_of(ball, NormalMode::Flat, {by_band}), Visibility::None});
  Material brushed = interface_of("paper_al", 1);
  brushed.distribution = {"ashikhmin_shirley", {{"nu", 10}, {"nv", 300}}, {}, {}, {}};
  brushed.direction = Vec3<Body>{1, 0, 0};
  out.push_back({"no kernel", scene_of(ball, NormalMode::Flat, {brushed}), Visibility::None});
  Material film = interface_of("paper_al", 200); // interferes too fast to be interpolated: its sums
  film.layers = {{constant_index({1.5, 0}), 50'000, true}}; // come out to be coloured
  out.push_back({"thick film", scene_of(cube, NormalMode::Flat, {film}), Visibility::None});
  out.push_back({"smooth", scene_of(make_cylinder(1, 2, 24), NormalMode::Smooth, four_materials()),
                 Visibility::None});
  out.push_back({"box with wings",
                 scene_of(make_box_wing({3000, 0}), NormalMode::Flat, four_materials()),
                 Visibility::Masks});
  return out;
}

TEST(Cards, AgreeWithScalarDouble) {
  for (const Case &one : all_cases()) {
    const auto poses = random_poses(200, solar_radius);
    const Parity p = parity(evaluated(on_card(one.scene, one.visibility), poses),
                            evaluated(engine_of(one.scene, one.visibility, true), poses));
    EXPECT_LT(p.i_median, 2e-4) << one.name;
    EXPECT_LT(p.i_worst, 1e-3) << one.name;
    EXPECT_LT(p.q_median, 2e-5) << one.name;
  }
}

TEST(Cards, HalfWidthsAreThoseOfTheProcessor) {
  const Scene scene = scene_of(make_box_wing({3000, 0}), NormalMode::Flat, four_materials());
  const auto poses = random_poses(200, solar_radius);
  const StokesTable found = evaluated(on_card(scene, Visibility::Masks), poses),
                    exact = evaluated(engine_of(scene, Visibility::Masks, true), poses);
  std::size_t uncertain = 0;
  for (std::size_t k = 0; k < exact.i_err.size(); ++k) {
    uncertain += exact.i_err[k] > 1e-4 * exact.i[k] ? 1u : 0u;
    EXPECT_NEAR(found.i_err[k], exact.i_err[k], 2e-3 * exact.i_err[k] + 1e-4 * exact.i[k]) << k;
  }
  EXPECT_GT(uncertain, 100u); // masks do err
}

TEST(Cards, WholeSatellitesAgreeWithJoinedFacetsToo) {
  for (const Mesh &mesh : {make_hst(), make_agena()})
    for (const double cluster_rad : {0.0, 3 * pi / 180}) {
      const Scene scene = scene_of(mesh, NormalMode::Smooth, four_materials());
      EngineOptions options;
      options.masks = {10'000, 16, 16, 0};
      options.cluster_rad = cluster_rad;
      Engine card(scene, options);
      ASSERT_TRUE(card.use_cards(open_cards(with_fakes()).value()));
      options.is_double = true;
      const auto poses = random_poses(100, solar_radius);
      const StokesTable found = evaluated(card, poses),
                        exact = evaluated(Engine(scene, options), poses);
      const Parity p = parity(found, exact);
      EXPECT_LT(p.i_median, 2e-4) << cluster_rad;
      EXPECT_LT(p.i_worst, 1e-3) << cluster_rad;
      EXPECT_LT(p.q_median, 2e-5) << cluster_rad;
      for (std::size_t k = 0; k < exact.i_err.size(); ++k)
        EXPECT_NEAR(found.i_err[k], exact.i_err[k], 2e-3 * exact.i_err[k] + 1e-4 * exact.i[k]) << k;
    }
}

TEST(Cards, ColoursOfACardAreThoseOfItsSums) {
  // With the share of glints asked for, sums come out and the processor colours them.
  for (const Case &one : all_cases()) {
    const auto poses = random_poses(40, solar_radius);
    const Engine engine = on_card(one.scene, one.visibility);
    LightTask task;
    task.has_glints = true;
    StokesTable sums;
    ASSERT_TRUE(engine.evaluate(poses, sums, task));
    const StokesTable light = evaluated(engine, poses);
    EXPECT_EQ(light.is_dark, sums.is_dark);
    EXPECT_EQ(light.method, sums.method);
    constexpr double least = 1e-37; // where single precision has fewer digits
    for (std::size_t k = 0; k < light.i.size(); ++k) {
      // A dozen roundings to 2^-24.
      const double near = 3e-6 * sums.i[k] + least;
      const auto expect = [&](double of_card, double wanted, double tolerance) {
        EXPECT_NEAR(of_card, wanted, tolerance) << one.name << " " << k;
      };
      expect(light.i[k], sums.i[k], near);
      expect(light.q[k], sums.q[k], near);
      expect(light.u[k], sums.u[k], near);
      expect(light.i_err[k], sums.i_err[k], 1e-4 * sums.i_err[k] + least);
      expect(light.q_err[k], sums.q_err[k], 1e-4 * sums.q_err[k] + least);
      expect(light.u_err[k], sums.u_err[k], 1e-4 * sums.u_err[k] + least);
      expect(light.v_err[k], sums.v_err[k], 1e-4 * sums.v_err[k] + least);
    }
  }
}

TEST(Cards, TheBytesDoNotDependOnTheSplit) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const auto poses = random_poses(9000, solar_radius);
  const Engine engine = on_card(scene, Visibility::Masks);
  const StokesTable whole = evaluated(engine, poses);
  {
    const Setting two("UMOV_FAKE_CARDS", "3");
    const StokesTable shared = evaluated(on_card(scene, Visibility::Masks), poses, 1);
    EXPECT_EQ(shared.i, whole.i);
    EXPECT_EQ(shared.q_err, whole.q_err);
  }
  for (const std::size_t size : {std::size_t{1}, std::size_t{77}, std::size_t{4097}}) {
    const std::size_t first = 40;
    const auto span = std::span(poses).subspan(first, size);
    const std::vector<Pose> some(span.begin(), span.end());
    const StokesTable part = evaluated(engine, some);
    for (std::size_t k = 0; k < size * part.bands; ++k) {
      EXPECT_EQ(part.i[k], whole.i[first * whole.bands + k]);
      EXPECT_EQ(part.q[k], whole.q[first * whole.bands + k]);
      EXPECT_EQ(part.i_err[k], whole.i_err[first * whole.bands + k]);
    }
  }
}

TEST(Cards, AbundancesAreThoseOfTheProcessor) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const auto poses = random_poses(300, solar_radius);
  AbundanceTable found, wanted;
  ASSERT_TRUE(on_card(scene, Visibility::Masks).abundances(poses, found));
  ASSERT_TRUE(engine_of(scene, Visibility::Masks, true).abundances(poses, wanted));
  ASSERT_EQ(found.sum.size(), wanted.sum.size());
  const double scale = *std::max_element(wanted.sum.begin(), wanted.sum.end());
  std::size_t uncertain = 0;
  for (std::size_t k = 0; k < wanted.sum.size(); ++k) {
    EXPECT_NEAR(found.sum[k], wanted.sum[k], 2e-4 * wanted.sum[k] + 1e-6 * scale) << k;
    // The variance of looked-up shares is a difference of squares: 2^-24 of a square is 2.4e-4 of
    // its root, and the half-width 1.96 of that.
    EXPECT_NEAR(found.half_width[k], wanted.half_width[k],
                2e-3 * wanted.half_width[k] + 5e-4 * wanted.sum[k] + 2e-6 * scale)
        << k;
    uncertain += wanted.half_width[k] > 1e-3 * wanted.sum[k] ? 1U : 0U;
  }
  EXPECT_GT(uncertain, 100U);
  EXPECT_EQ(found.is_dark, wanted.is_dark);
}

TEST(Cards, RaysMendWhatTheirMasksLeave) {
  // What is mended is traced by the processor, from the pose and the sums of the card.
  const Scene scene = scene_of(box_wing(), NormalMode::Flat, four_materials());
  EngineOptions options;
  options.masks = {10'000, 16, 16, 0.002};
  options.doubts_all = true;
  Engine engine(scene, options);
  const auto poses = random_poses(60);
  const StokesTable wanted = evaluated(engine, poses);
  ASSERT_TRUE(engine.use_cards(open_cards(with_fakes()).value()));
  const StokesTable found = evaluated(engine, poses);
  std::size_t mended = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    mended += found.method[k] == PoseMethod::Mended ? 1u : 0u;
    const BandResult a = found.at(k, 1), b = wanted.at(k, 1);
    EXPECT_NEAR(a.stokes.i, b.stokes.i, a.half_width.i + b.half_width.i) << k;
  }
  EXPECT_GT(mended, 10u);
}

TEST(Cards, LazyMasksArePutAgainWhenTheyGrow) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  EngineOptions options;
  options.masks = {20'000, 24, 24, 0};
  Engine all(scene, options);
  options.is_lazy = true;
  Engine lazy(scene, options);
  const auto cards = open_cards(with_fakes()).value();
  ASSERT_TRUE(all.use_cards(cards));
  ASSERT_TRUE(lazy.use_cards(cards));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto poses = random_poses(4 * (k + 1));
    EXPECT_EQ(evaluated(lazy, poses).i, evaluated(all, poses).i) << k;
  }
}

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

/// Calls of the driver for kernels since it was started.
std::size_t launches() {
  void *const driver =
      ::dlopen((std::string(UMOV_FAKE_CUDA) + "/libcuda.so.1").c_str(), RTLD_NOW | RTLD_LOCAL);
  EXPECT_NE(driver, nullptr);
  return reinterpret_cast<std::size_t (*)()>(::dlsym(driver, "umov_fake_launches"))();
}

TEST(Cards, BandsWithACurveAreLitInBatchesAsLongAsOthers) {
  // Nobody else's number: 9,000 poses in two shares, three kernels each, with a curve or without.
  const auto poses = random_poses(9000);
  std::size_t count[2];
  for (const bool has_curve : {false, true}) {
    std::vector<Band> bands{{"nm:600", Wavelength::nm(600)}};
    if (has_curve)
      bands.push_back(*band_of(gaussian_passband("green", 540, 60)));
    const auto materials = four_materials();
    const Mesh mesh = make_chamfered_cube(1, 0.1);
    Diagnostics diagnostics;
    const std::vector<Material> of(mesh.groups.size(), materials.front());
    const auto scene = make_scene(mesh, NormalMode::Flat, bands, of, of, diagnostics);
    ASSERT_TRUE(scene) << scene.error().text();
    LightOptions options;
    options.method = LightMethod::Masks;
    options.device = with_fakes();
    const auto model = make_light(*scene, {}, options);
    ASSERT_TRUE(model) << model.error().text();
    const std::size_t before = launches();
    StokesTable out;
    ASSERT_TRUE((*model)->evaluate(poses, out));
    count[has_curve ? 1 : 0] = launches() - before;
  }
  EXPECT_EQ(count[0], 6u);
  EXPECT_EQ(count[1], count[0]);
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
    EXPECT_TRUE(has(refusal(with_fakes()), "CUDA_ERROR_NO_DEVICE"));
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
