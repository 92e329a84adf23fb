// The reference: one facet at a time in double.

#include "backend/one_facet_machine.h"

namespace umov::backend {
namespace {

struct ScalarMachine : OneFacetMachine<double, double, groups_per_chunk> {};

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
