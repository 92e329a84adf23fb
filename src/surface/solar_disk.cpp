#include "surface/solar_disk.h"

#include "kernel/disk_lobe.h"
#include "kernel/facet.inl.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <umov/core/quantity.h>
#include <umov/core/vec3.h>

namespace umov {
namespace {

/// Azimuth of the edge's point that is nearest to the normal, and how near it is in radii.
struct Nearest {
  double beta, distance;
};

/// Half vectors of a disk of directions around l.
class DiskImage {
public:
  DiskImage(Vec3<Facet> l, Vec3<Facet> v, double l_v, double radius_rad)
      : l_(l), v_(v), sine_(std::sin(radius_rad)) {
    const Vec3<Facet> across = cross(v, l);
    const double length = norm(across);
    // Without a plane (phase 0 or 180) any pair of axes serves: the image is round or empty there.
    e2_ = length > 1e-12 ? across / length : any_perpendicular(l);
    e1_ = cross(e2_, l);
    half_cosine_ = std::sqrt(std::max(0.0, (1 + l_v) / 2));
  }
  /// At the share `r` of the radius (small angles) and the azimuth beta.
  [[nodiscard]] Vec3<Facet> at(double r, double beta) const {
    const Vec3<Facet> source =
        kernel::disk_direction(l_, e1_, e2_, sine_, r, std::cos(beta), std::sin(beta));
    return normalized(source + v_);
  }
  /// Coordinate of the surface normal in the scattering plane, from the image's centre towards l.
  [[nodiscard]] double along_plane() const { return cross(e2_, normalized(l_ + v_)).z; }
  /// In the plane at the image's centre, where the image is an ellipse.
  [[nodiscard]] Nearest nearest_edge() const;

private:
  Vec3<Facet> l_, v_, e1_, e2_;
  double sine_, half_cosine_ = 0;
};

Nearest DiskImage::nearest_edge() const {
  const Vec3<Facet> h = normalized(l_ + v_);
  const double x = cross(e2_, h).z / (0.5 * sine_), y = e2_.z * half_cosine_ / (0.5 * sine_);
  const double r = std::hypot(x, y);
  constexpr double least = 1e-3; // the parabolas serve down to there
  return {r > 0 ? std::atan2(y, x) : 0, std::clamp(std::abs(r - 1), least, 1.0)};
}

/// Degree 5 on the disk with seven nodes.
double by_nodes(const Distribution &normals, const DiskImage &image) {
  double sum = normals.density(image.at(0, 0)) * kernel::source_node_weight<double>(0);
  for (std::size_t k = 1; k < kernel::source_nodes; ++k)
    sum += normals.density(image.at(kernel::source_ring, static_cast<double>(k - 1) * pi / 3)) *
           kernel::source_node_weight<double>(k);
  return sum;
}

/// Many nodes on rings of equal area, for what has no contour form (anisotropic lobes).
double by_rings(const Distribution &normals, const DiskImage &image) {
  constexpr int rings = 12, spokes = 24;
  double sum = 0;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < spokes; ++k)
      sum += normals.density(
          image.at(std::sqrt((i + 0.5) / rings), 2 * pi * (k + 0.5 * (i % 2)) / spokes));
  return sum / (rings * spokes);
}

/// Mean of D over the image by Green's theorem: int over the image of D dw is the contour integral
/// of C(theta) dphi, with theta, phi about the normal and C the integral of D sin(theta) from 0.
/// Smooth for every width of the lobe, exact for a mirror (C constant: 2 pi inside, 0 outside).
double by_contour(const Distribution &normals, const DiskImage &image) {
  constexpr std::size_t steps = 48; // pairs of nodes
  const Nearest near = image.nearest_edge();
  // phi runs fastest where the edge passes the normal: nodes crowd there, beta ~ distance sinh(k
  // t).
  const double k = std::asinh(pi / near.distance);
  struct Node {
    double x, y, z, beyond;
  };
  std::array<Node, 2 * steps + 1> node{};
  for (std::size_t i = 0; i < 2 * steps; ++i) {
    const double t = static_cast<double>(i) / steps - 1;
    const Vec3<Facet> h = image.at(1, near.beta + near.distance * std::sinh(k * t));
    node[i] = {h.x, h.y, h.z, normals.beyond(h.z) / (2 * pi)};
  }
  node.back() = node.front();
  // Simpson in t; the increments of phi are exact angles, so their sum is the winding number.
  double turn = 0, outer = 0, area = 0;
  for (std::size_t i = 0; i < 2 * steps; i += 2) {
    const Node &a = node[i], &b = node[i + 1], &c = node[i + 2];
    const auto angle = [](const Node &p, const Node &q) {
      return std::atan2(p.x * q.y - p.y * q.x, p.x * q.x + p.y * q.y);
    };
    const double first = angle(a, b), second = angle(b, c), dphi = first + second;
    turn += dphi;
    // The middle node is not quite the middle angle: a parabola through three uneven points.
    const double u = std::abs(dphi) > 0 ? std::clamp(first / dphi, 0.2, 0.8) : 0.5;
    const double wb = 1 / (6 * u * (1 - u)), wa = 0.5 - wb * (1 - u), wc = 1 - wa - wb;
    outer += dphi * (wa * a.beyond + wb * b.beyond + wc * c.beyond);
    area += dphi * (wa * (1 - a.z) + wb * (1 - b.z) + wc * (1 - c.z));
  }
  const double inside = std::abs(turn) > pi ? std::copysign(2 * pi, turn) : 0; // winding number
  const double whole = normals.beyond(1) / (2 * pi);
  return area != 0 ? std::max(0.0, (inside * whole - outer) / area) : 0;
}

/// By the facet kernels' closed forms, where the lobe is wide enough for them.
std::optional<double> by_kernel(const KernelForm &form, Vec3<Facet> l, Vec3<Facet> v,
                                const kernel::DiskImage &disk) {
  kernel::LobeConstants<double> lobe;
  lobe.kind = form.kind;
  lobe.shape = form.shape;
  if (form.kind == LobeKind::BlinnPhong)
    lobe.peak = kernel::blinn_phong_peak(form.shape);
  kernel::LobeAtPose<double> at;
  kernel::put_lobe_at_pose(lobe, disk, at);
  if (at.uses_chords)
    return {};
  const double apart = norm(l - v);
  kernel::FacetPose<double> pose;
  pose.along_scale = apart > 1e-7 ? 1 / apart : 0;
  pose.half_shift = apart > 1e-7 ? disk.shift() : 0;
  const Vec3<Facet> half = kernel::mean_half_vector(l, v, any_perpendicular(l), apart, disk);
  pose.half[0] = half.x;
  pose.half[1] = half.y;
  pose.half[2] = half.z;
  return kernel::lobe_density(
      lobe, at, pose,
      kernel::from_half(pose, kernel::apart_from_half(pose, 0.0, 0.0, 1.0), l.z, v.z));
}

} // namespace

double density_over_disk(const Distribution &normals, Vec3<Facet> l, Vec3<Facet> v, double l_v,
                         double radius_rad) {
  const Vec3<Facet> sum = l + v;
  const double length = norm(sum);
  if (!(length > 1e-15))
    return 0; // phase 180: no half vector
  const Vec3<Facet> h = sum / length;
  if (!(radius_rad > 0))
    return normals.density(h);
  const kernel::DiskImage disk = kernel::disk_image(radius_rad, l_v);
  if (const auto form = normals.kernel_form()) {
    if (const auto value = by_kernel(*form, l, v, disk))
      return h.z > 0 ? *value : 0;
  }
  const double width = normals.width();
  const double q = width > 0 ? disk.across / (width * width) : HUGE_VAL;
  const DiskImage image(l, v, l_v, radius_rad);
  if (!normals.kernel_form() && q < kernel::nodes_max)
    return by_nodes(normals, image);
  if (!normals.is_isotropic())
    return by_rings(normals, image);
  // The image is not evenly bright (dw_l = 4 h.v dw_h): its brightness where the lobe looks, at the
  // mean of the product of both.
  const double tangent = std::sqrt(std::max(0.0, (1 - l_v) / std::max(1 + l_v, 1e-15)));
  const double x = std::clamp(image.along_plane(), -radius_rad / 2, radius_rad / 2);
  return by_contour(normals, image) *
         std::max(0.0, 1 - x * tangent * disk.along / (disk.along + width * width));
}

} // namespace umov
