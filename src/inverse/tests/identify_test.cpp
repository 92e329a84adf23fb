#include "inverse/tests/box_light.h"

#include <umov/inverse/identify.h>

namespace umov {
namespace {

/// Boxes of other sides and colours than each other, their light written down here without the
/// engine: diffuse faces with a broad lobe each.
class AnyBox {
public:
  explicit AnyBox(std::uint64_t seed, double shine = 20) : shine_(shine) {
    for (std::uint64_t f = 0; f < 6; ++f) {
      const auto u = uniform4(seed, 11, f), v = uniform4(seed, 12, f);
      face_[f] = {
          0.2 + 2 * uniform4(seed, 13, f / 2)[0], {0.1 + u[0], 0.1 + u[1]}, 0.2 * u[2], 0.1 + v[0]};
    }
  }
  bool operator()(std::span<const Pose> poses, StokesTable &out) const {
    out.resize(poses.size(), 2);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Pose &p = poses[k];
      const Vec3<Body> half = normalized(p.sun + p.observer);
      for (std::size_t b = 0; b < 2; ++b) {
        BandResult light;
        for (std::size_t f = 0; f < 6; ++f) {
          const double side = f % 2 == 0 ? 1 : -1;
          const Vec3<Body> n{f / 2 == 0 ? side : 0, f / 2 == 1 ? side : 0, f / 2 == 2 ? side : 0};
          const double s = std::max(0.0, dot(n, p.sun)), o = std::max(0.0, dot(n, p.observer));
          const double lobe =
              s > 0 && o > 0 ? face_[f].gloss * std::pow(std::max(0.0, dot(n, half)), shine_) : 0;
          light.stokes.i += face_[f].area * (face_[f].colour[b] * s * o + lobe);
          light.stokes.q += face_[f].area * face_[f].polarized * lobe;
        }
        out.put(k, b, light);
      }
    }
    return true;
  }

private:
  struct Face {
    double area = 0, colour[2] = {0, 0}, polarized = 0, gloss = 0;
  };
  Face face_[6];
  double shine_; ///< the larger, the narrower the lobes
};

/// Signatures of boxes, as a library would lend them.
class Boxes {
public:
  explicit Boxes(std::size_t count, double shine = 20) {
    constexpr std::size_t cells = 20;
    for (std::size_t k = 0; k < count; ++k) {
      const AnyBox box(100 + k, shine);
      StokesTable light;
      box(signature_poses(cells, 0, signature_pairs(cells), 0), light);
      packed_.push_back(pack_light(light));
      signatures_.push_back({"", cells, 2, packed_[k].ln_least, packed_[k].ln_step, 0, {}});
    }
    for (std::size_t k = 0; k < count; ++k) {
      signatures_[k].code = packed_[k].code;
      signatures_[k].error = interpolation_error(signatures_[k], AnyBox(100 + k, shine), k);
    }
  }
  [[nodiscard]] Candidates candidates() const {
    return {signatures_.size(), [this](std::size_t k, const LookAtCandidate &look) {
              const std::size_t column[] = {0, 1};
              look(signatures_[k], column);
              return Result<void>();
            }};
  }

private:
  std::vector<PackedLight> packed_;
  std::vector<Signature> signatures_;
};

const Boxes &six_boxes() {
  static const Boxes boxes(6);
  return boxes;
}

Quaternion any_attitude(std::uint64_t trial) {
  return attitude_grid(100'003)[static_cast<std::size_t>(uniform4(98, 3, trial)[0] * 100'003)];
}

IdentifyOptions quick() {
  IdentifyOptions out;
  out.search.errors.floor_median = 0.01;
  out.search.grid = 8000;
  out.look_grid = 8000;
  return out;
}

ObservedCurve seen(const AnyBox &box, std::uint64_t trial, std::size_t epochs = 24) {
  ObservedCurve curve = pass(epochs);
  observe(curve, box, {any_attitude(trial), {}}, 50, trial);
  return curve;
}

TEST(Identify, TheObjectIsFoundInAnyAttitudeAtAnySize) {
  int right = 0, sure = 0;
  constexpr std::uint64_t trials = 6;
  for (std::uint64_t t = 0; t < trials; ++t) {
    const std::size_t truth = t % 6;
    const auto answer = identify(seen(AnyBox(100 + truth), t), six_boxes().candidates(), quick());
    ASSERT_TRUE(answer) << answer.error().text();
    right += answer->order.front() == truth ? 1 : 0;
    sure += answer->candidates[truth].probability > 0.5 ? 1 : 0;
    double all = answer->none;
    for (const CandidateFit &fit : answer->candidates)
      all += fit.probability;
    EXPECT_NEAR(all, 1, 1e-9);
  }
  // 95 % are asked for: 4 or fewer of 6 come in 3 % of such tests.
  EXPECT_GE(right, 5);
  EXPECT_GE(sure, 3); // tables alone, whose rows are worth half of their number here
}

/// The own light of boxes, for the best of the library.
IdentifyOptions with_own_light(const ObservedCurve &curve, std::vector<std::size_t> &asked) {
  IdentifyOptions out = quick();
  out.search.errors.zero_point_sd = 0.003;
  out.search.errors.floor = 0.01;
  const SearchOptions search = out.search;
  out.own_light = [&curve, &asked, search](std::size_t k) -> Result<std::optional<OwnAnswer>> {
    asked.push_back(k);
    const AnyBox box(100 + k);
    const CurveModel model(curve, box, {0, 1});
    auto found = search_pose(model, search);
    if (!found)
      return tl::unexpected(found.error());
    return std::optional(
        OwnAnswer{std::move(*found), CurveLikelihood(curve, search.errors).log_variance()});
  };
  return out;
}

TEST(Identify, AnObjectThatIsNotThereIsNone) {
  // Two bands and a face or two at a time: only what the boxes of the library cannot do at all, in
  // their own light and any attitude, can be told from them.
  int none = 0, possible = 0;
  for (const std::uint64_t t : {2, 3, 4}) {
    ObservedCurve curve = pass(24);
    observe(curve, AnyBox(200 + t), {any_attitude(t), {}}, 200, t);
    std::vector<std::size_t> asked;
    const IdentifyOptions options = with_own_light(curve, asked);
    bool fits = false;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto own = options.own_light(k);
      ASSERT_TRUE(own);
      const double dof = static_cast<double>((*own)->answer.measurements);
      fits = fits || (*own)->answer.chi2 < 1.5 * dof; // 4 sigma of chi-square for 144 numbers
    }
    const auto answer = identify(curve, six_boxes().candidates(), options);
    ASSERT_TRUE(answer) << answer.error().text();
    possible += fits ? 0 : 1;
    none += !fits && answer->none > 0.5 ? 1 : 0;
  }
  EXPECT_GE(possible, 2);
  EXPECT_EQ(none, possible);
}

TEST(Identify, ConstantLightIsNoObject) {
  ObservedCurve curve = seen(AnyBox(100), 1);
  for (ObservedSample &s : curve.samples) {
    s.i = 7 * (1 + 0.02 * noise(5, 2 * s.epoch + s.band));
    s.i_sd = 0.14;
    s.q = s.u = 0;
  }
  const auto answer = identify(curve, six_boxes().candidates(), quick());
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_GT(answer->none, 0.5);
}

TEST(Identify, OneEpochIsNeverSure) {
  for (std::uint64_t t = 0; t < 3; ++t) {
    const auto answer = identify(seen(AnyBox(100 + t), t, 1), six_boxes().candidates(), quick());
    ASSERT_TRUE(answer) << answer.error().text();
    for (const CandidateFit &fit : answer->candidates)
      EXPECT_LT(fit.probability, 0.95);
  }
}

TEST(Identify, ThreadsAndOrderOfTheLibraryChangeNothing) {
  const ObservedCurve curve = seen(AnyBox(103), 3);
  IdentifyOptions one = quick();
  one.search.threads = 1;
  const auto a = identify(curve, six_boxes().candidates(), quick());
  const auto b = identify(curve, six_boxes().candidates(), one);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->none, b->none);
  Candidates turned = six_boxes().candidates();
  turned.lend = [from = turned.lend](std::size_t k, const LookAtCandidate &look) {
    return from(5 - k, look);
  };
  const auto c = identify(curve, turned, quick());
  ASSERT_TRUE(c);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(a->candidates[k].probability, b->candidates[k].probability);
    EXPECT_NEAR(a->candidates[k].probability, c->candidates[5 - k].probability, 1e-12);
  }
}

TEST(Identify, WhatIsCutIsTold) {
  // Six boxes, room for one: of a curve of faint light others are as good.
  ObservedCurve curve = pass(6);
  observe(curve, AnyBox(100), {any_attitude(1), {}}, 0.5, 1);
  IdentifyOptions options = quick();
  options.shortlist = options.finalists = 1;
  const auto answer = identify(curve, six_boxes().candidates(), options);
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_TRUE(answer->is_cut);
}

TEST(Identify, OwnLightIsAskedOfTheBest) {
  std::vector<std::size_t> asked;
  ObservedCurve curve = pass(24);
  observe(curve, AnyBox(103), {any_attitude(3), {}}, 200, 3);
  const auto answer = identify(curve, six_boxes().candidates(), with_own_light(curve, asked));
  ASSERT_TRUE(answer) << answer.error().text();
  ASSERT_FALSE(asked.empty());
  EXPECT_LE(asked.size(), IdentifyOptions().own);
  EXPECT_EQ(answer->order.front(), 3u);
  EXPECT_EQ(answer->candidates[3].by, JudgedBy::Model);
  EXPECT_GT(answer->candidates[3].probability, 0.95);
}

TEST(Identify, AnObjectOfNarrowGlintsIsSearched) {
  // One of lobes of 4 deg among others of 15: judged at attitudes 12 deg apart, as they stand, its
  // glints miss what was seen of them, and an object that has none is better (here of number 5).
  constexpr double shine = 300;
  const Boxes sharp(6, shine);
  for (const std::size_t truth : {3, 4, 5}) {
    IdentifyOptions options = quick();
    options.finalists = 1;
    Candidates mixed = six_boxes().candidates();
    mixed.lend = [truth, broad = mixed.lend,
                  narrow = sharp.candidates().lend](std::size_t k, const LookAtCandidate &look) {
      return k == truth ? narrow(k, look) : broad(k, look);
    };
    const auto answer = identify(seen(AnyBox(100 + truth, shine), truth), mixed, options);
    ASSERT_TRUE(answer) << answer.error().text();
    EXPECT_EQ(answer->candidates[truth].by, JudgedBy::Table) << truth;
  }
}

/// Boxes whose table of number 3 is another's, so that it is left out of the searches.
Candidates misled() {
  Candidates out = six_boxes().candidates();
  out.lend = [from = out.lend](std::size_t k, const LookAtCandidate &look) {
    return from(k == 3 ? 0 : k, look);
  };
  return out;
}

TEST(Identify, ObjectsThatTheTablesLeftOutAreAskedBeforeNone) {
  std::vector<std::size_t> asked;
  ObservedCurve curve = pass(24);
  observe(curve, AnyBox(103), {any_attitude(3), {}}, 200, 3);
  IdentifyOptions options = with_own_light(curve, asked);
  options.shortlist = options.finalists = options.own = 1;
  const auto answer = identify(curve, misled(), options);
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_EQ(answer->order.front(), 3u);
  EXPECT_EQ(answer->candidates[3].by, JudgedBy::Model);
  EXPECT_GT(answer->candidates[3].probability, 0.95);
  EXPECT_EQ(answer->unasked, 0u);
}

TEST(Identify, NoneIsNotSureWhereSomeWereNotAsked) {
  std::vector<std::size_t> asked;
  ObservedCurve curve = pass(24);
  observe(curve, AnyBox(103), {any_attitude(3), {}}, 200, 3);
  IdentifyOptions options = with_own_light(curve, asked);
  options.shortlist = options.finalists = options.own = options.own_in_doubt = 1;
  options.has_own_light = [](std::size_t k) { return k != 5; };
  const auto answer = identify(curve, misled(), options);
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_EQ(asked.size(), 1u);
  // Six objects, one asked, of one nobody has the light. The four others keep their odds to "none"
  // before the data, .95/6 to .05: it has .05 of .05 + 4 x .95/6.
  EXPECT_EQ(answer->unasked, 4u);
  EXPECT_NEAR(answer->none, 0.05 / (0.05 + 4 * 0.95 / 6), 1e-6);
  double all = answer->none;
  for (const CandidateFit &fit : answer->candidates)
    all += fit.probability;
  EXPECT_NEAR(all, 1, 1e-9);
  for (std::size_t j = 0; j + 1 < answer->order.size(); ++j)
    EXPECT_GE(answer->candidates[answer->order[j]].probability,
              answer->candidates[answer->order[j + 1]].probability);
}

TEST(Identify, WhoseLightNobodyHasIsAskedOnceAndNotUnasked) {
  std::vector<std::size_t> asked;
  ObservedCurve curve = pass(24);
  observe(curve, AnyBox(202), {any_attitude(2), {}}, 200, 2);
  IdentifyOptions options = with_own_light(curve, asked);
  options.own_light = [&asked](std::size_t k) -> Result<std::optional<OwnAnswer>> {
    asked.push_back(k);
    return std::optional<OwnAnswer>();
  };
  const auto answer = identify(curve, six_boxes().candidates(), options);
  ASSERT_TRUE(answer) << answer.error().text();
  std::ranges::sort(asked);
  EXPECT_EQ(std::ranges::adjacent_find(asked), asked.end());
  EXPECT_EQ(answer->unasked, 0u);
}

TEST(Identify, EpochsOfOneCellDoNotRuleOutByATable) {
  // 60 epochs of a sixtieth of the pass: Sun and observer move by less than a cell of the tables,
  // all rows share one error of these, and e-folds of sixty rows are worth those of one or two.
  std::vector<std::size_t> asked;
  ObservedCurve curve = pass(3600);
  curve.epochs.resize(60);
  observe(curve, AnyBox(103), {any_attitude(6), {}}, 200, 3);
  IdentifyOptions options = with_own_light(curve, asked);
  options.finalists = options.own = options.own_in_doubt = 1;
  Candidates four = misled();
  four.count = 4;
  const auto answer = identify(curve, four, options);
  ASSERT_TRUE(answer) << answer.error().text();
  for (const std::size_t k : {0, 2, 3}) // more than e^30 behind, row by row
    EXPECT_LT(answer->candidates[k].peak, answer->none_log_evidence - 30);
  EXPECT_EQ(answer->unasked, 3u);
  EXPECT_NEAR(answer->none, 0.05 / (0.05 + 3 * 0.95 / 4), 1e-6); // the odds before the data
}

TEST(Identify, WhatWasCutAndAskedIsNotCut) {
  // All six are equally far at first sight; room for one, and all are asked since none explains it.
  std::vector<std::size_t> asked;
  ObservedCurve curve = pass(24);
  observe(curve, AnyBox(202), {any_attitude(2), {}}, 200, 2);
  IdentifyOptions options = with_own_light(curve, asked);
  Candidates same = six_boxes().candidates();
  same.lend = [from = same.lend](std::size_t, const LookAtCandidate &look) {
    return from(0, look);
  };
  options.shortlist = options.finalists = options.own = 1;
  const auto answer = identify(curve, same, options);
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_EQ(asked.size(), 6u);
  EXPECT_FALSE(answer->is_cut);
  options.own_light = {};
  const auto tables = identify(curve, same, options);
  ASSERT_TRUE(tables) << tables.error().text();
  EXPECT_TRUE(tables->is_cut);
}

/// Own light of a given ln evidence, for all, of a fit as good as chance has it in the median.
IdentifyOptions with_evidence(double log_evidence, bool is_settled) {
  IdentifyOptions out = quick();
  out.own_light = [=](std::size_t) -> Result<std::optional<OwnAnswer>> {
    OwnAnswer own;
    own.answer.log_evidence = log_evidence;
    own.answer.chi2 = 100;
    own.answer.measurements = 101;
    own.answer.is_settled = is_settled;
    return std::optional(own);
  };
  return out;
}

TEST(Identify, NoneHasTheKinOfThoseThatAreAskedLate) {
  ObservedCurve curve = pass(24);
  observe(curve, AnyBox(202), {any_attitude(2), {}}, 200, 2);
  IdentifyOptions options = with_evidence(-1e6, true);
  const auto searched = identify(curve, six_boxes().candidates(), options);
  options.shortlist = options.own = 1; // no table rules one out: all are asked
  const auto late = identify(curve, six_boxes().candidates(), options);
  ASSERT_TRUE(searched && late);
  // The same six terms in another order: rounding.
  EXPECT_NEAR(searched->none_log_evidence, late->none_log_evidence, 1e-9);
  EXPECT_EQ(late->unsettled, 0u);
}

TEST(Identify, NoneIsOpenWhereASearchNearItDidNotComeToRest) {
  ObservedCurve curve = pass(24);
  observe(curve, AnyBox(202), {any_attitude(2), {}}, 200, 2);
  IdentifyOptions options = with_evidence(-1e6, false);
  Candidates one = six_boxes().candidates();
  one.count = 1;
  const auto far = identify(curve, one, options);
  ASSERT_TRUE(far);
  EXPECT_EQ(far->unsettled, 0u);
  for (const bool is_settled : {false, true}) {
    options.own_light = with_evidence(far->none_log_evidence - 10, is_settled).own_light;
    const auto near = identify(curve, one, options);
    ASSERT_TRUE(near);
    EXPECT_GT(near->none, 0.95);
    EXPECT_EQ(near->unsettled, is_settled ? 0u : 1u);
  }
}

TEST(Identify, ErrorsOfALibraryAreHandedOn) {
  Candidates broken = six_boxes().candidates();
  broken.lend = [](std::size_t, const LookAtCandidate &) -> Result<void> {
    return fail(ErrorCode::BadInput, "is damaged", {"lib/a.umovsig"});
  };
  const ObservedCurve curve = seen(AnyBox(100), 1);
  const auto answer = identify(curve, broken, quick());
  ASSERT_FALSE(answer);
  EXPECT_NE(answer.error().text().find("a.umovsig"), std::string::npos);
  EXPECT_FALSE(identify(curve, {}, quick()));
  EXPECT_FALSE(identify(ObservedCurve(), six_boxes().candidates(), quick()));
}

} // namespace
} // namespace umov
