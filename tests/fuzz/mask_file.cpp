// Masks in a file. Everyone can make the key and the checksum, which keep no secrets: they are put
// in, so that what is behind them is reached.

#include "fuzz/target.h"

#include "light/fast/mask_file.h"

#include <cstring>
#include <sys/mman.h>
#include <umov/core/files.h>
#include <unistd.h>

namespace {

using namespace umov;

constexpr std::size_t header_bytes = 120, key_at = 16, checksum_at = 24;

/// Two groups of small classes and one large class.
GroupPlan plan() {
  GroupPlan out;
  for (const bool is_large : {false, false, true}) {
    GroupPlan::Group group;
    group.member.fill(no_index);
    group.member[0] = static_cast<std::uint32_t>(out.groups.size());
    group.words = is_large ? backend::lanes : 1;
    group.is_large = is_large;
    out.groups.push_back(group);
  }
  return out;
}

/// Of a triangle of one class, with the plan's groups.
std::uint64_t key() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.push_back({{0, 1, 2}});
  FacetClasses classes;
  classes.list.emplace_back().normal = {0, 0, 1};
  return mask_key(mesh, classes, plan(), {4, 2});
}

/// Fowler, Noll & Vo's hash as the format has it: list by list, the header's field being 0.
class Checksum {
public:
  void add(std::string_view part) {
    for (; part.size() >= 8; part.remove_prefix(8)) {
      std::uint64_t word = 0;
      std::memcpy(&word, part.data(), 8);
      value_ = (value_ ^ word) * 0x100000001B3ull;
      value_ ^= value_ >> 29;
    }
    for (const char c : part)
      value_ = (value_ ^ static_cast<unsigned char>(c)) * 0x100000001B3ull;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_ = 0xCBF29CE484222325ull;
};

/// The bytes with their key, and with the checksum of lists as long as the plan has them.
std::string signed_bytes(std::string_view input, const MaskStore &lists) {
  std::string out(input);
  if (out.size() < header_bytes)
    return out;
  std::uint64_t own_key = 0;
  std::memcpy(&own_key, out.data() + key_at, 8);
  if (const std::uint64_t right = key(); own_key != 0) // 0: of another mesh
    std::memcpy(out.data() + key_at, &right, 8);
  std::memset(out.data() + checksum_at, 0, 8);
  Checksum sum;
  std::string_view rest = out;
  const auto take = [&](std::size_t bytes) {
    bytes = std::min(bytes, rest.size());
    sum.add(rest.substr(0, bytes));
    rest.remove_prefix(bytes);
  };
  take(header_bytes);
  take(lists.groups.size() * sizeof(backend::GroupMask));
  for (const MaskTableStore *table : {&lists.small, &lists.large}) {
    take(table->offset.size() * sizeof(std::uint32_t));
    take(table->row.size() * sizeof(MaskRow));
  }
  take(rest.size());
  const std::uint64_t value = sum.value();
  std::memcpy(out.data() + checksum_at, &value, 8);
  return out;
}

/// A file that has a name and no place on a disk.
class MemoryFile {
public:
  explicit MemoryFile(std::string_view bytes = {})
      : descriptor_(::memfd_create("masks", MFD_CLOEXEC)) {
    fuzz::require(::write(descriptor_, bytes.data(), bytes.size()) ==
                      static_cast<ssize_t>(bytes.size()),
                  "memory to write to");
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile &) = delete;
  MemoryFile &operator=(const MemoryFile &) = delete;
  [[nodiscard]] std::string bytes() const {
    std::string out(static_cast<std::size_t>(::lseek(descriptor_, 0, SEEK_END)), '\0');
    const ssize_t read = ::pread(descriptor_, out.data(), out.size(), 0);
    fuzz::require(read == static_cast<ssize_t>(out.size()), "what was written is there");
    return out;
  }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
  int descriptor_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const MaskSize cells{4, 2};
  const MaskStore lists = empty_masks(plan(), cells);
  const std::string bytes = signed_bytes(fuzz::text_of(data, size), lists);
  const MemoryFile file(bytes), again;
  const auto read = read_masks(file.path(), key(), plan(), cells);
  if (!fuzz::is_read(read))
    return 0;
  // What the loops will look at lies in the pool.
  for (const MaskTableStore *table : {&read->small, &read->large})
    for (const std::uint32_t offset : table->offset)
      fuzz::require(offset < read->pool.size(), "offsets lie within the pool");
  fuzz::require(write_masks(again.path(), *read, key()).has_value() && again.bytes() == bytes,
                "what is read is what was written");
  return 0;
}
