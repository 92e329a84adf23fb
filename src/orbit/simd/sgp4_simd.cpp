// SGP4 over lanes, for each instruction set of the processor family, chosen when the program runs.

#ifdef __wasm__
#define HWY_COMPILE_ONLY_SCALAR // Highway 1.0.3 has no doubles there
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "orbit/simd/sgp4_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target comes first: it includes this file once for each instruction set.
#include "orbit/simd/double_lanes.inl.h"

#include "kernel/sgp4.inl.h"
#include "orbit/sgp4_model.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kernel/begin.h"

constexpr std::size_t lane_count = hn::MaxLanes(DoubleTag());
using LaneNumbers = Sgp4Numbers<DoubleLanes>;

/// One number of every lane's object.
using Column = std::array<double, lane_count>;
/// Numbers of the lanes' objects, side by side.
struct Columns {
  alignas(64) std::array<Column, sgp4_number_count> column;

  void set_lane(std::size_t lane, const sgp4::Numbers &numbers) {
    std::array<double, sgp4_number_count> flat;
    std::memcpy(flat.data(), &numbers, sizeof flat);
    for (std::size_t k = 0; k < sgp4_number_count; ++k)
      column[k][lane] = flat[k];
  }
  [[nodiscard]] LaneNumbers numbers() const {
    static_assert(sizeof(LaneNumbers) == sizeof(Columns::column));
    LaneNumbers out;
    std::memcpy(static_cast<void *>(&out), column.data(), sizeof out);
    return out;
  }
};

HWY_INLINE DoubleLanes load(const Column &column) { return hn::LoadU(DoubleTag(), column.data()); }
HWY_INLINE Column stored(DoubleLanes x) {
  Column out;
  hn::StoreU(x.v, DoubleTag(), out.data());
  return out;
}

/// Writes the first `count` lanes through `state_of(lane)` and `code_of(lane)`.
template <class StateOf, class CodeOf>
HWY_INLINE void write(const Sgp4State<DoubleLanes> &s, std::size_t count, StateOf state_of,
                      CodeOf code_of) {
  const Column x = stored(s.x), y = stored(s.y), z = stored(s.z), vx = stored(s.vx),
               vy = stored(s.vy), vz = stored(s.vz), code = stored(s.code);
  for (std::size_t i = 0; i < count; ++i) {
    code_of(i) = static_cast<Sgp4Code>(static_cast<int>(code[i]));
    state_of(i) = code[i] == 0 ? TemeState{{x[i], y[i], z[i]}, {vx[i], vy[i], vz[i]}} : TemeState{};
  }
}

/// Nodes of the resonance that a span of times needs.
struct NodeTable {
  std::vector<sgp4::Node> forward, backward;

  NodeTable(const sgp4::Constants &c, const double *minutes, std::size_t count) {
    if (c.kind.resonance == Resonance::None)
      return;
    const auto [low, high] = std::minmax_element(minutes, minutes + count);
    forward = sgp4::resonance_nodes(c, step_count(*high), true);
    backward = sgp4::resonance_nodes(c, step_count(-*low), false);
  }
  static int step_count(double minutes) {
    return static_cast<int>(std::max(minutes, 0.0) / resonance_step_minutes);
  }
  [[nodiscard]] ResonanceNode<DoubleLanes> of(const Column &minutes) const {
    if (forward.empty())
      return {DoubleLanes(0), DoubleLanes(0), DoubleLanes(0)};
    Column at, angle, motion;
    for (std::size_t i = 0; i < lane_count; ++i) {
      const double t = minutes[i];
      const sgp4::Node &node = t > 0 ? forward[static_cast<std::size_t>(step_count(t))]
                                     : backward[static_cast<std::size_t>(step_count(-t))];
      at[i] = node.minutes;
      angle[i] = node.angle;
      motion[i] = node.motion;
    }
    return {load(at), load(angle), load(motion)};
  }
};

void over_times(const sgp4::Constants &c, const double *minutes, std::size_t count,
                TemeState *states, Sgp4Code *codes) {
  if (count == 0)
    return;
  Columns columns;
  for (std::size_t lane = 0; lane < lane_count; ++lane)
    columns.set_lane(lane, c.numbers);
  const LaneNumbers numbers = columns.numbers();
  const NodeTable nodes(c, minutes, count);
  for (std::size_t first = 0; first < count; first += lane_count) {
    const std::size_t here = std::min(lane_count, count - first);
    Column t;
    for (std::size_t i = 0; i < lane_count; ++i)
      t[i] = minutes[first + std::min(i, here - 1)];
    const auto s = sgp4_state(c.kind, numbers, nodes.of(t), load(t));
    write(
        s, here, [&](std::size_t i) -> TemeState & { return states[first + i]; },
        [&](std::size_t i) -> Sgp4Code & { return codes[first + i]; });
  }
}

void over_objects(const sgp4::Constants *const *objects, const double *minutes, std::size_t count,
                  TemeState *const *states, Sgp4Code *const *codes) {
  Columns columns;
  for (std::size_t first = 0; first < count; first += lane_count) {
    const std::size_t here = std::min(lane_count, count - first);
    Column t, at, angle, motion;
    for (std::size_t i = 0; i < lane_count; ++i) {
      const std::size_t k = first + std::min(i, here - 1);
      columns.set_lane(i, objects[k]->numbers);
      t[i] = minutes[k];
      const sgp4::Node node = sgp4::resonance_node(*objects[k], t[i]);
      at[i] = node.minutes;
      angle[i] = node.angle;
      motion[i] = node.motion;
    }
    const auto s = sgp4_state(objects[first]->kind, columns.numbers(),
                              {load(at), load(angle), load(motion)}, load(t));
    write(
        s, here, [&](std::size_t i) -> TemeState & { return *states[first + i]; },
        [&](std::size_t i) -> Sgp4Code & { return *codes[first + i]; });
  }
}

#include "kernel/end.h"

#if HWY_ONCE
namespace umov::kernel {
HWY_EXPORT(over_times);
HWY_EXPORT(over_objects);
} // namespace umov::kernel

namespace umov::sgp4 {

void states_over_times(const Constants &c, const double *minutes, std::size_t count,
                       TemeState *states, Sgp4Code *codes) {
  using namespace kernel; // the table of HWY_EXPORT stands there
  HWY_DYNAMIC_DISPATCH(over_times)(c, minutes, count, states, codes);
}

void states_over_objects(const Constants *const *objects, const double *minutes, std::size_t count,
                         TemeState *const *states, Sgp4Code *const *codes) {
  using namespace kernel;
  HWY_DYNAMIC_DISPATCH(over_objects)(objects, minutes, count, states, codes);
}

} // namespace umov::sgp4
#endif
