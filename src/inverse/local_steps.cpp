#include "inverse/local_steps.h"

#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {

LocalSteps::Root LocalSteps::root_at(Quaternion place, double times) const {
  constexpr std::size_t count = 12;
  const double same = chord_square(1e-7);
  std::vector<double> squares;
  around_.squares_from(place, squares);
  struct Near {
    double square = 1e300;
    std::size_t at = 0;
  };
  std::array<Near, count> nearest; // rising
  for (std::size_t k = 0; k < squares.size(); ++k)
    if (squares[k] < nearest.back().square && squares[k] > same) {
      nearest.back() = {squares[k], k};
      for (std::size_t j = count - 1; j > 0 && nearest[j].square < nearest[j - 1].square; --j)
        std::swap(nearest[j], nearest[j - 1]);
    }
  double xx = 0, yx = 0, yy = 0, zx = 0, zy = 0, zz = 0, found = 0;
  for (const Near &one : nearest) {
    if (!(one.square < 1e300))
      break;
    const Vec3<Body> d = turn_between(place, around_.at(one.at));
    xx += d.x * d.x;
    yx += d.y * d.x;
    yy += d.y * d.y;
    zx += d.z * d.x;
    zy += d.z * d.y;
    zz += d.z * d.z;
    ++found;
  }
  const double part = times * times / std::max(found, 1.0), least = times * times * least_square_;
  Root l{};
  l[0] = std::sqrt(xx * part + least);
  l[1] = yx * part / l[0];
  l[2] = std::sqrt(std::max(yy * part + least - l[1] * l[1], least / 2));
  l[3] = zx * part / l[0];
  l[4] = (zy * part - l[3] * l[1]) / l[2];
  l[5] = std::sqrt(std::max(zz * part + least - l[3] * l[3] - l[4] * l[4], least / 2));
  return l;
}

Vec3<Body> LocalSteps::step(const Root &l, const Vec3<Body> &z) {
  return {l[0] * z.x, l[1] * z.x + l[2] * z.y, l[3] * z.x + l[4] * z.y + l[5] * z.z};
}

double LocalSteps::log_density(const Root &l, const Vec3<Body> &step) {
  const double x = step.x / l[0], y = (step.y - l[1] * x) / l[2],
               z = (step.z - l[3] * x - l[4] * y) / l[5];
  return -(x * x + y * y + z * z) / 2 - std::log(l[0] * l[2] * l[5]);
}

} // namespace umov::inverse
