#include "light/fast/masks.h"

#include "light/fast/octahedron.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

/// Rays just below a facet's horizon are turned up to this sine: a zero there would drag the
/// interpolation down at grazing directions.
constexpr double least_sine = 0.002;

/// Blocks of one direction and where each entry's are: hidden, free, or counted from the first.
struct Row {
  std::vector<backend::MaskBlock> blocks;
  std::vector<std::uint32_t> offset;
};
constexpr std::uint32_t all_hidden = 0xFFFFFFFE, all_free = 0xFFFFFFFF;

Occluder::Point as_point(Vec3<Body> d) {
  return {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
}

class RowTracer {
public:
  RowTracer(const Occluder &occluder, double reach) : occluder_(occluder), reach_(reach) {}

  void add(const MaskEntry &entry, Vec3<Body> direction, Row &row) {
    block_.assign(entry.blocks, backend::MaskBlock{});
    bool is_all_free = true, is_all_hidden = true;
    for (std::size_t lane = 0; lane < entry.normal.size(); ++lane) {
      const double sine = dot(entry.normal[lane], direction);
      // Directions that no pose asks this lane about are whatever the others are.
      if (entry.points[lane].origin.empty() || sine < -reach_) {
        fill_lane(entry, lane);
        continue;
      }
      const Vec3<Body> ray = sine < least_sine
                                 ? normalized(direction + (least_sine - sine) * entry.normal[lane])
                                 : direction;
      const auto &origins = entry.points[lane].origin;
      directions_.assign(origins.size(), as_point(ray));
      free_.resize(origins.size());
      occluder_.is_free(origins, directions_, free_);
      for (std::size_t i = 0; i < origins.size(); ++i) {
        if (free_[i] != 0) {
          set(entry, lane, i);
          is_all_hidden = false;
        } else {
          is_all_free = false;
        }
      }
    }
    if (is_all_free) {
      row.offset.push_back(all_free);
    } else if (is_all_hidden) {
      row.offset.push_back(all_hidden);
    } else {
      row.offset.push_back(static_cast<std::uint32_t>(row.blocks.size()));
      row.blocks.insert(row.blocks.end(), block_.begin(), block_.end());
    }
  }

private:
  void set(const MaskEntry &entry, std::size_t lane, std::size_t i) {
    const std::size_t word = i / 32;
    if (entry.is_large)
      block_[word / backend::lanes].word[word % backend::lanes] |= 1u << (i % 32);
    else
      block_[word].word[lane] |= 1u << (i % 32);
  }
  void fill_lane(const MaskEntry &entry, std::size_t lane) {
    for (backend::MaskBlock &b : block_) {
      if (entry.is_large)
        std::memset(b.word, 0xFF, sizeof b.word);
      else
        b.word[lane] = 0xFFFFFFFFu;
    }
  }

  const Occluder &occluder_;
  double reach_;
  std::vector<backend::MaskBlock> block_;
  std::vector<Occluder::Point> directions_;
  std::vector<unsigned char> free_;
};

} // namespace

MaskStore empty_masks(const GroupPlan &plan, const MaskSize &size) {
  MaskStore out;
  for (const GroupPlan::Group &group : plan.groups) {
    MaskTableStore &table = group.is_large ? out.large : out.small;
    out.groups.push_back({static_cast<std::uint32_t>(table.entries), group.words, group.is_large});
    table.entries += group.is_large ? backend::lanes : 1;
    out.longest = std::max(out.longest, blocks_of(out.groups.back()));
  }
  out.small.cells = size.small_cells;
  out.large.cells = size.large_cells;
  for (MaskTableStore *table : {&out.small, &out.large}) {
    const std::size_t directions = table->entries > 0 ? table->directions() : 0;
    // With room for the register that begins at the last one.
    table->offset.assign(directions > 0 ? directions * table->entries + backend::lanes : 0, 0);
    table->row.assign(directions, {untraced, 0});
  }
  out.pool.assign(std::size_t{2} * out.longest, backend::MaskBlock{});
  std::memset(out.pool.data() + out.longest, 0xFF, out.longest * sizeof(backend::MaskBlock));
  return out;
}

MaskTracer::MaskTracer(const Scene &scene, const Elements &elements, const FacetClasses &classes,
                       const GroupPlan &plan, const Occluder &occluder,
                       const std::atomic<bool> *cancel)
    : occluder_(occluder) {
  for (const GroupPlan::Group &group : plan.groups) {
    leave_if_stopped(cancel);
    MaskEntry entry;
    entry.is_large = group.is_large;
    entry.blocks = group.is_large ? group.words / backend::lanes : group.words;
    for (const std::uint32_t of : group.member) {
      entry.normal.push_back(of == no_index ? Vec3<Body>{} : classes.list[of].normal);
      entry.points.push_back(of == no_index
                                 ? ClassPoints{}
                                 : spread_points(scene, elements, classes, of,
                                                 std::size_t{32} * group.words, occluder));
      if (group.is_large) {
        large_.push_back(std::move(entry));
        entry = {large_.back().blocks, true, {}, {}};
      }
    }
    if (!group.is_large)
      small_.push_back(std::move(entry));
  }
}

void MaskTracer::trace(std::span<const std::uint32_t> directions, bool is_large, unsigned threads,
                       MaskStore &masks, const std::atomic<bool> *cancel) const {
  MaskTableStore &table = is_large ? masks.large : masks.small;
  const std::vector<MaskEntry> &entries = is_large ? large_ : small_;
  std::vector<Row> rows(directions.size());
  parallel_for(directions.size(), threads, [&](std::size_t k) {
    if (is_stopped(cancel)) // a row of a large mesh takes a hundredth of a second
      return;
    RowTracer tracer(occluder_, grid_reach(table.cells));
    for (const MaskEntry &entry : entries)
      tracer.add(entry, grid_direction(table.cells, directions[k]), rows[k]);
  });
  if (is_stopped(cancel))
    return;
  const backend::Masks known = masks.view();
  std::size_t blocks = masks.pool.size();
  for (const Row &row : rows)
    blocks += row.blocks.size();
  if (blocks > masks.pool.capacity()) // a series asks for few rows at a time
    masks.pool.reserve(std::max(blocks, 2 * masks.pool.capacity()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto base = static_cast<std::uint32_t>(masks.pool.size());
    table.row[directions[k]] = {base, static_cast<std::uint32_t>(rows[k].blocks.size())};
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const std::uint32_t o = rows[k].offset[e];
      table.offset[directions[k] * entries.size() + e] = o == all_hidden ? known.hidden()
                                                         : o == all_free ? known.free()
                                                                         : base + o;
    }
    masks.pool.insert(masks.pool.end(), rows[k].blocks.begin(), rows[k].blocks.end());
    rows[k] = {};
  }
}

namespace {

void add_rows(const MaskTableStore &known, const MaskStore &from, MaskTableStore &table,
              MaskStore &to) {
  for (std::size_t d = 0; d < table.row.size(); ++d) {
    const MaskRow row = known.row[d];
    if (table.row[d].first != untraced || row.first == untraced)
      continue;
    const auto base = static_cast<std::uint32_t>(to.pool.size());
    const std::uint32_t shared = 2 * to.longest; // wholly hidden and wholly free stand before
    table.row[d] = {base, row.count};
    for (std::size_t e = d * table.entries; e < (d + 1) * table.entries; ++e)
      table.offset[e] =
          known.offset[e] < shared ? known.offset[e] : base + (known.offset[e] - row.first);
    const auto first = from.pool.begin() + static_cast<std::ptrdiff_t>(row.first);
    to.pool.insert(to.pool.end(), first, first + static_cast<std::ptrdiff_t>(row.count));
  }
}

} // namespace

void add_rows(const MaskStore &known, MaskStore &masks) {
  add_rows(known.small, known, masks.small, masks);
  add_rows(known.large, known, masks.large, masks);
}

std::size_t memory_of(const MaskStore &masks) {
  return masks.pool.size() * sizeof(backend::MaskBlock) +
         (masks.small.offset.size() + masks.large.offset.size()) * sizeof(std::uint32_t) +
         masks.groups.size() * sizeof(backend::GroupMask);
}

} // namespace umov
