#include <umov/light/stokes_table.h>

#include <cmath>

namespace umov {

void add(const BandResult &more, BandResult &to) {
  to.stokes += more.stokes;
  to.half_width.i = std::hypot(to.half_width.i, more.half_width.i);
  to.half_width.q = std::hypot(to.half_width.q, more.half_width.q);
  to.half_width.u = std::hypot(to.half_width.u, more.half_width.u);
  to.half_width.v = std::hypot(to.half_width.v, more.half_width.v);
}

const char *name_of(PoseMethod method) {
  switch (method) {
  case PoseMethod::Exact:
    return "exact";
  case PoseMethod::Masks:
    return "masks";
  case PoseMethod::Mended:
    return "mended";
  case PoseMethod::Rays:
    return "rays";
  }
  return "";
}

void StokesTable::resize(std::size_t poses, std::size_t band_count) {
  bands = band_count;
  for (auto *column : {&i, &q, &i_err, &q_err})
    column->resize(poses * band_count);
  for (auto *column : {&u, &v, &u_err, &v_err}) // most poses have neither
    column->assign(poses * band_count, 0);
  is_dark.resize(poses);
  method.assign(poses, PoseMethod::Exact);
  indirect.clear();
  glint_share.clear();
  material_i.clear();
  band_err.clear();
}

BandResult StokesTable::at(std::size_t pose, std::size_t band) const {
  const std::size_t k = pose * bands + band;
  return {{i[k], q[k], u[k], v[k]}, {i_err[k], q_err[k], u_err[k], v_err[k]}};
}

void StokesTable::put(std::size_t pose, std::size_t band, const BandResult &result) {
  const std::size_t k = pose * bands + band;
  const auto &[s, e] = result;
  i[k] = s.i, q[k] = s.q, u[k] = s.u, v[k] = s.v;
  i_err[k] = e.i, q_err[k] = e.q, u_err[k] = e.u, v_err[k] = e.v;
}

} // namespace umov
