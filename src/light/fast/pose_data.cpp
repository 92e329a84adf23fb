#include "light/fast/pose_data.h"

#include "backend/pose_constants.h"

namespace umov {

void prepare_pose(const Pose &pose, double cos_phase,
                  const std::vector<kernel::LobeConstants<double>> &lobes, bool has_polarized_body,
                  const backend::Masks *masks, PoseStore<double> &out) {
  const backend::PoseDirections directions{pose.sun, pose.observer, pose.sun_radius_rad, cos_phase};
  const kernel::DiskImage disk = backend::put_directions(directions, has_polarized_body, out.facet);
  out.resize(lobes.size());
  for (std::size_t k = 0; k < lobes.size(); ++k)
    kernel::put_lobe_at_pose(lobes[k], disk, out.lobe_room[k]);
  if (masks != nullptr)
    backend::put_looks(directions, *masks, out);
}

void round_pose(const backend::PoseData<double> &from, PoseStore<float> &to) {
  backend::round_directions(from.facet, to.facet);
  to.resize(from.lobes.size());
  for (std::size_t k = 0; k < from.lobes.size(); ++k)
    kernel::round_lobe_at_pose(from.lobes[k], to.lobe_room[k]);
  to.small_sun = from.small_sun;
  to.small_observer = from.small_observer;
  to.large_sun = from.large_sun;
  to.large_observer = from.large_observer;
}

} // namespace umov
