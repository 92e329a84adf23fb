// The reference: one facet at a time in double.

#include "backend/facet_loops.inl.h"

#include <algorithm>
#include <bit>

namespace umov::backend {
namespace {

struct ScalarMachine {
  using R = double;
  using T = double;
  using S = double;
  using Mask = bool;
  static constexpr std::size_t width = 1;
  static double load(const double *p) { return *p; }
  static double load_any(const double *p) { return *p; }
  static void store_any(double x, double *p) { *p = x; }
  static double total(double x) { return x; }
  static bool any(bool x) { return x; }
  static bool all_three(const std::uint32_t *a, const std::uint32_t *b, const std::uint32_t *c,
                        std::uint32_t value) {
    return *a == value && *b == value && *c == value;
  }
  static void prefetch(const MaskBlock *) {}
  static std::uint32_t bits(bool x) { return x ? 1 : 0; }
  static std::uint32_t first_bit(std::uint32_t) { return 0; }
  class Packer {
  public:
    explicit Packer(bool keep) : keep_(keep) {}
    [[nodiscard]] std::size_t count() const { return keep_ ? 1 : 0; }
    static void put(double x, double *to) { *to = x; }
    static void put_indices(std::uint32_t first, std::uint32_t *to) { *to = first; }

  private:
    bool keep_;
  };

  static int joint(const std::uint32_t *a, const std::uint32_t *b) {
    return std::popcount(*a & *b);
  }

  template <std::size_t A, std::size_t B>
  static void count_lanes(const kernel::EntryLook &sun, const kernel::EntryLook &seen,
                          std::size_t words, std::size_t s, const float *weight, double &mean,
                          double &square) {
    mean = square = 0;
    for (std::size_t k = 0; k < A * B; ++k) {
      int count = 0;
      for (std::size_t w = 0; w < words; ++w)
        count += joint(sun.block[k / B][w].word + s, seen.block[k % B][w].word + s);
      mean += static_cast<double>(weight[k]) * count;
      square += static_cast<double>(weight[k]) * count * count;
    }
  }

  static void count_long(const kernel::EntryLook &sun, const kernel::EntryLook &seen,
                         std::size_t words, float *count) {
    for (std::size_t k = 0; k < 9; ++k) {
      int sum = 0;
      for (std::size_t w = 0; w < words; ++w)
        sum += joint(sun.block[k / 3][w / lanes].word + w % lanes,
                     seen.block[k % 3][w / lanes].word + w % lanes);
      count[k] = static_cast<float>(sum);
    }
  }
};

} // namespace

void sum_facets(const SceneData<double> &scene, const Masks *masks, const MaskErrorModel &model,
                const PoseData<double> &pose, PoseSums &out) {
  kernel::FacetLoops<ScalarMachine>(scene, masks, model, pose, out).run();
}

void list_weighed(const SceneData<double> &scene, const Masks *masks, const MaskErrorModel &model,
                  const PoseData<double> &pose, WeighedList &out) {
  PoseSums unused;
  kernel::FacetLoops<ScalarMachine>(scene, masks, model, pose, unused).list_weighed(out);
}

void list_seen(const SceneData<double> &scene, const Masks *masks, const MaskErrorModel &model,
               const PoseData<double> &pose, SeenList &out) {
  list_seen(scene, scene.chunks, masks, model, pose, out);
}

void list_seen(const SceneData<double> &scene, View<const Chunk> chunks, const Masks *masks,
               const MaskErrorModel &model, const PoseData<double> &pose, SeenList &out) {
  PoseSums unused;
  kernel::FacetLoops<ScalarMachine>(scene, masks, model, pose, unused).list_seen(chunks, out);
}

} // namespace umov::backend
