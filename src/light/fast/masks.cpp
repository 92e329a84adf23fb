#include "light/fast/masks.h"

#include "light/fast/octahedron.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <umov/core/parallel.h>

namespace umov {
namespace {

/// Rays just below a facet's horizon are turned up to this sine: a zero there would drag the
/// interpolation down at grazing directions.
constexpr double least_sine = 0.002;

/// Points of the lanes of an entry: a whole group, or one class with words of its own.
struct Entry {
  std::size_t blocks = 0; ///< of 64 bytes
  bool is_large = false;
  std::vector<Vec3<Body>> normal;  ///< per lane; one for a large one
  std::vector<ClassPoints> points; ///< per lane
};

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

  void add(const Entry &entry, Vec3<Body> direction, Row &row) {
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
  void set(const Entry &entry, std::size_t lane, std::size_t i) {
    const std::size_t word = i / 32;
    if (entry.is_large)
      block_[word / backend::lanes].word[word % backend::lanes] |= 1u << (i % 32);
    else
      block_[word].word[lane] |= 1u << (i % 32);
  }
  void fill_lane(const Entry &entry, std::size_t lane) {
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

/// Traces a table's entries in all directions and appends the blocks to the pool.
void fill_table(MaskStore &masks, MaskTableStore &table, std::size_t cells,
                const std::vector<Entry> &entries, const Occluder &occluder, unsigned threads) {
  table.cells = cells;
  table.entries = entries.size();
  const std::size_t directions = entries.empty() ? 0 : table.directions();
  std::vector<Row> rows(directions);
  parallel_for(directions, threads, [&](std::size_t d) {
    RowTracer tracer(occluder, grid_reach(cells));
    for (const Entry &entry : entries)
      tracer.add(entry, grid_direction(cells, d), rows[d]);
  });
  const backend::Masks known = masks.view();
  std::size_t blocks = masks.pool.size();
  for (const Row &row : rows)
    blocks += row.blocks.size();
  masks.pool.reserve(blocks);
  table.offset.reserve(directions * entries.size());
  for (Row &row : rows) {
    const auto base = static_cast<std::uint32_t>(masks.pool.size());
    table.row.push_back({base, static_cast<std::uint32_t>(row.blocks.size())});
    for (const std::uint32_t o : row.offset)
      table.offset.push_back(o == all_hidden ? known.hidden()
                             : o == all_free ? known.free()
                                             : base + o);
    masks.pool.insert(masks.pool.end(), row.blocks.begin(), row.blocks.end());
    row = {};
  }
}

} // namespace

MaskStore build_masks(const Scene &scene, const Elements &elements, const FacetClasses &classes,
                      const GroupPlan &plan, const Occluder &occluder, const MaskSize &size,
                      unsigned threads) {
  MaskStore out;
  std::vector<Entry> small, large;
  for (const GroupPlan::Group &group : plan.groups) {
    backend::GroupMask mask;
    mask.words = group.words;
    mask.is_large = group.is_large;
    mask.entry = static_cast<std::uint32_t>(group.is_large ? large.size() : small.size());
    Entry entry;
    entry.is_large = group.is_large;
    entry.blocks = group.is_large ? group.words / backend::lanes : group.words;
    for (const std::uint32_t of : group.member) {
      entry.normal.push_back(of == no_index ? Vec3<Body>{} : classes.list[of].normal);
      entry.points.push_back(of == no_index
                                 ? ClassPoints{}
                                 : spread_points(scene, elements, classes, of,
                                                 std::size_t{32} * group.words, occluder));
      if (group.is_large) {
        large.push_back(std::move(entry));
        entry = {large.back().blocks, true, {}, {}};
      }
    }
    if (!group.is_large)
      small.push_back(std::move(entry));
    out.groups.push_back(mask);
    out.longest =
        std::max(out.longest,
                 static_cast<std::uint32_t>(group.is_large ? large.back().blocks : group.words));
  }
  out.pool.assign(std::size_t{2} * out.longest, backend::MaskBlock{});
  std::memset(out.pool.data() + out.longest, 0xFF, out.longest * sizeof(backend::MaskBlock));
  fill_table(out, out.small, size.small_cells, small, occluder, threads);
  fill_table(out, out.large, size.large_cells, large, occluder, threads);
  return out;
}

std::size_t memory_of(const MaskStore &masks) {
  return masks.pool.size() * sizeof(backend::MaskBlock) +
         (masks.small.offset.size() + masks.large.offset.size()) * sizeof(std::uint32_t) +
         masks.groups.size() * sizeof(backend::GroupMask);
}

} // namespace umov
