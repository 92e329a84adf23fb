#include "light/fast/mask_file.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <umov/core/files.h>

namespace umov {
namespace {

/// Fowler, Noll & Vo's hash over words of eight bytes: tells files apart, does not keep secrets.
class Hash {
public:
  void add(const void *data, std::size_t bytes) {
    const char *p = static_cast<const char *>(data);
    for (; bytes >= 8; bytes -= 8, p += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, p, 8);
      value_ = (value_ ^ word) * 0x100000001B3ull;
      value_ ^= value_ >> 29; // what is high would never reach down
    }
    for (; bytes > 0; --bytes, ++p)
      value_ = (value_ ^ static_cast<unsigned char>(*p)) * 0x100000001B3ull;
  }
  template <class T> void add(const T &one) { add(&one, sizeof one); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_ = 0xCBF29CE484222325ull;
};

/// Everything of fixed size, in front.
struct Header {
  char magic[8] = {'u', 'm', 'o', 'v', 'm', 's', 'k', '3'};
  std::uint64_t byte_order = 0x0102030405060708ull; ///< the machine's own
  std::uint64_t key = 0, checksum = 0;              ///< of everything else in the file
  std::uint64_t groups = 0, blocks = 0, longest = 0;
  struct Table {
    std::uint64_t cells = 0, entries = 0, offsets = 0, rows = 0;
  } small, large;
};

/// A part of the file as bytes.
template <class List> std::span<char> bytes_of(List &list) {
  return {reinterpret_cast<char *>(list.data()), list.size() * sizeof(*list.data())};
}

/// All lists, in the order of the file.
template <class F> void for_each_list(MaskStore &masks, const F &f) {
  f(bytes_of(masks.groups));
  for (MaskTableStore *table : {&masks.small, &masks.large}) {
    f(bytes_of(table->offset));
    f(bytes_of(table->row));
  }
  f(bytes_of(masks.pool));
}

std::uint64_t checksum_of(Header header, MaskStore &masks) {
  Hash hash;
  header.checksum = 0;
  hash.add(header);
  for_each_list(masks, [&](std::span<char> part) { hash.add(part.data(), part.size()); });
  return hash.value();
}

Header header_of(const MaskStore &masks, std::uint64_t key) {
  Header out;
  out.key = key;
  out.groups = masks.groups.size();
  out.blocks = masks.pool.size();
  out.longest = masks.longest;
  const auto put = [](Header::Table &to, const MaskTableStore &from) {
    to = {from.cells, from.entries, from.offset.size(), from.row.size()};
  };
  put(out.small, masks.small);
  put(out.large, masks.large);
  return out;
}

bool is_same(const Header::Table &a, const Header::Table &b) {
  return a.cells == b.cells && a.entries == b.entries && a.offsets == b.offsets && a.rows == b.rows;
}

/// The groups of a file, byte by byte: a bool of a file may hold anything. What follows it is
/// padding.
bool is_same(const backend::GroupMask &a, const backend::GroupMask &b) {
  return std::memcmp(&a, &b, offsetof(backend::GroupMask, is_large) + 1) == 0;
}

/// Offsets and rows stay within the pool, whoever wrote the file.
bool is_consistent(const MaskStore &masks, bool is_large) {
  const MaskTableStore &table = is_large ? masks.large : masks.small;
  std::vector<std::size_t> blocks(table.entries, 0);
  for (const backend::GroupMask &group : masks.groups)
    if (group.is_large == is_large)
      std::fill_n(blocks.begin() + group.entry, is_large ? backend::lanes : 1, blocks_of(group));
  for (std::size_t k = 0; k < table.offset.size(); ++k)
    if (table.offset[k] + blocks[k % table.entries] > masks.pool.size())
      return false;
  return std::all_of(table.row.begin(), table.row.end(), [&](const MaskRow &row) {
    return row.first == untraced || std::size_t{row.first} + row.count <= masks.pool.size();
  });
}

} // namespace

std::uint64_t mask_key(const Mesh &mesh, const FacetClasses &classes, const GroupPlan &plan,
                       const MaskSize &size) {
  Hash hash;
  for (const Vec3<Body> &p : mesh.positions)
    for (const double x : {p.x, p.y, p.z})
      hash.add(x);
  for (const Triangle &t : mesh.triangles)
    hash.add(t.vertex.data(), sizeof t.vertex);
  for (const FacetClass &c : classes.list) {
    for (const double x : {c.normal.x, c.normal.y, c.normal.z, c.area_m2})
      hash.add(x);
    hash.add(c.slot);
    hash.add(c.count);
  }
  for (const GroupPlan::Group &group : plan.groups) {
    hash.add(group.member.data(), sizeof group.member);
    hash.add(std::uint32_t{group.words});
    hash.add(std::uint32_t{group.is_large ? 1u : 0u});
  }
  hash.add(std::uint64_t{size.small_cells});
  hash.add(std::uint64_t{size.large_cells});
  return hash.value();
}

Result<void> write_masks(const std::filesystem::path &path, const MaskStore &masks,
                         std::uint64_t key) {
  auto &all = const_cast<MaskStore &>(masks); // the lists are only read
  Header header = header_of(masks, key);
  header.checksum = checksum_of(header, all);
  UMOV_ASSIGN(file, FileInProgress::open(path));
  UMOV_TRY(file.write({reinterpret_cast<const char *>(&header), sizeof header}));
  Result<void> done;
  for_each_list(all, [&](std::span<char> part) {
    if (done)
      done = file.write({part.data(), part.size()});
  });
  UMOV_TRY(std::move(done));
  return file.commit();
}

Result<MaskStore> read_masks(const std::filesystem::path &path, std::uint64_t key,
                             const GroupPlan &plan, const MaskSize &size) {
  const auto refuse = [&](const std::string &what) {
    return fail(ErrorCode::BadInput, what + ". Remove it to have it made anew.", {path.string()});
  };
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    return fail(ErrorCode::BadInput, "cannot be read", {path.string()});
  std::error_code unknown;
  const std::uint64_t bytes = std::filesystem::file_size(path, unknown);
  Header header;
  MaskStore out = empty_masks(plan, size);
  out.pool.clear(); // comes from the file
  const Header wanted = header_of(out, key);
  if (unknown || bytes < sizeof header ||
      !stream.read(reinterpret_cast<char *>(&header), sizeof header) ||
      std::memcmp(header.magic, wanted.magic, sizeof header.magic) != 0)
    return refuse("is not a file of masks of this version");
  if (header.byte_order != wanted.byte_order)
    return refuse("was made on a machine with another byte order");
  if (header.key != key)
    return refuse("was made for another mesh, other material groups or another accuracy");
  // The key tells files apart and keeps no secrets: sizes and places are the plan's, and the file's
  // have to be the same. Nothing is reserved on a lie's word.
  if (header.groups != wanted.groups || header.longest != wanted.longest ||
      !is_same(header.small, wanted.small) || !is_same(header.large, wanted.large))
    return refuse("is damaged: its groups or directions are not those of this mesh");
  std::uint64_t fixed = sizeof header;
  for_each_list(out, [&](std::span<char> part) { fixed += part.size(); });
  if (header.blocks < std::uint64_t{2} * out.longest ||
      header.blocks > bytes / sizeof(backend::MaskBlock) ||
      fixed + header.blocks * sizeof(backend::MaskBlock) != bytes)
    return refuse("is damaged or cut short");
  const std::vector<backend::GroupMask> groups = out.groups;
  out.pool.resize(header.blocks);
  for_each_list(out, [&](std::span<char> part) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
  });
  if (!stream || checksum_of(header, out) != header.checksum ||
      !std::equal(groups.begin(), groups.end(), out.groups.begin(),
                  [](const auto &a, const auto &b) { return is_same(a, b); }) ||
      !is_consistent(out, false) || !is_consistent(out, true))
    return refuse("is damaged");
  return out;
}

} // namespace umov
