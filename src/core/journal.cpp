#include <umov/core/journal.h>

#include "core/output_place.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <umov/core/text.h>
#include <unistd.h>

namespace umov {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_line = "umov journal 1\n";
constexpr std::size_t key_bytes = 64, head_bytes = first_line.size() + key_bytes + 1;

/// Stands before the bytes of every block.
struct BlockHead {
  std::array<char, 8> mark;
  std::uint64_t part, number, bytes;
  std::array<char, key_bytes> sum; ///< SHA-256 of the bytes
};
/// In `part` of a block that is a remark.
constexpr std::uint64_t is_remark = std::uint64_t{1} << 63;
constexpr std::array<char, 8> block_mark{'u', 'm', 'b', 'l', 'o', 'c', 'k', '\n'};

bool read_at(int descriptor, void *to, std::size_t bytes, std::uint64_t offset) {
  auto *out = static_cast<char *>(to);
  while (bytes > 0) {
    const ssize_t got = ::pread(descriptor, out, bytes, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR)
      continue;
    if (got <= 0)
      return false;
    out += got;
    offset += static_cast<std::uint64_t>(got);
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

bool write_at(int descriptor, std::string_view bytes, std::uint64_t offset) {
  while (!bytes.empty()) {
    const ssize_t put =
        ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR)
      continue;
    if (put < 0)
      return false;
    offset += static_cast<std::uint64_t>(put);
    bytes.remove_prefix(static_cast<std::size_t>(put));
  }
  return true;
}

std::uint64_t size_of(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode)
             ? static_cast<std::uint64_t>(status.st_size)
             : 0;
}

} // namespace

fs::path Journal::name_for(const fs::path &output) {
  std::error_code unknown;
  if (fs::is_directory(output, unknown))
    return beside(output, "", ".rows.partial");
  const auto place =
      output.empty() || output == "-" ? Result<OutputPlace>({}) : output_place(output);
  if (!place || place->kind != OutputPlace::Kind::File || place->path.empty())
    return {};
  return beside(place->path, "", ".rows.partial");
}

Result<Journal> Journal::open(const fs::path &path, std::string_view job) {
  Journal out;
  out.path_ = path;
  out.key_ = sha256_hex(job);
  if (path.empty())
    return out;
  out.is_on_ = true;
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0)
    return out; // with the first block; trouble shows then
  const auto refuse = [&](const std::string &what) {
    return fail(ErrorCode::Device,
                what + "; the rows finished so far were to be kept here. Move it away.",
                {path.string()});
  };
  if (!S_ISREG(status.st_mode))
    return refuse("is no regular file");
  out.descriptor_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (out.descriptor_ < 0)
    return refuse(std::string("cannot be opened: ") + std::strerror(errno));
  if (::flock(out.descriptor_, LOCK_EX | LOCK_NB) != 0) {
    ::close(std::exchange(out.descriptor_, -1));
    out.is_on_ = false;
    out.found_ = Found::Busy;
    return out;
  }
  if (!out.read_head())
    return refuse("is not a file that umov wrote");
  if (out.found_ == Found::Ours)
    out.read_blocks();
  return out;
}

/// False if somebody else wrote the file. A beginning of a head is what a kill left of one.
bool Journal::read_head() {
  const std::uint64_t size = size_of(descriptor_);
  std::string head(std::min<std::uint64_t>(size, head_bytes), '\0');
  if (!read_at(descriptor_, head.data(), head.size(), 0))
    return false;
  if (head.empty())
    return true;
  if (!head.starts_with(first_line.substr(0, head.size())))
    return false;
  found_ = head.size() == head_bytes && head.substr(first_line.size(), key_bytes) == key_
               ? Found::Ours
               : Found::Foreign;
  return true;
}

/// Up to the first block that is torn or damaged, after which nothing can be trusted.
void Journal::read_blocks() {
  const std::uint64_t size = size_of(descriptor_);
  end_ = head_bytes;
  BlockHead head{};
  std::string bytes;
  while (read_at(descriptor_, &head, sizeof head, end_)) {
    const std::uint64_t offset = end_ + sizeof head;
    if (head.mark != block_mark || head.bytes > size - offset)
      break;
    bytes.resize(head.bytes);
    if (!read_at(descriptor_, bytes.data(), bytes.size(), offset) ||
        sha256_hex(bytes) != std::string_view(head.sum.data(), head.sum.size()))
      break;
    if ((head.part & is_remark) != 0)
      remarks_[head.part & ~is_remark].push_back(bytes);
    else
      places_[{head.part, head.number}] = {offset, head.bytes};
    end_ = offset + head.bytes;
  }
}

Journal::Journal(Journal &&other) noexcept { *this = std::move(other); }
Journal &Journal::operator=(Journal &&other) noexcept {
  std::swap(path_, other.path_);
  std::swap(key_, other.key_);
  std::swap(places_, other.places_);
  std::swap(remarks_, other.remarks_);
  std::swap(end_, other.end_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(is_on_, other.is_on_);
  std::swap(found_, other.found_);
  std::swap(problem_, other.problem_);
  return *this;
}
Journal::~Journal() {
  if (descriptor_ >= 0)
    ::close(descriptor_);
}

std::optional<std::string> Journal::find(Block block) const {
  const auto at = places_.find(block);
  if (at == places_.end())
    return std::nullopt;
  std::string bytes(at->second.bytes, '\0');
  if (!read_at(descriptor_, bytes.data(), bytes.size(), at->second.offset))
    return std::nullopt;
  return bytes;
}

/// The file with its head, before the first block of this process.
bool Journal::begin() {
  if (end_ > 0) // a torn end is written over, and what was longer must not stay behind it
    return size_of(descriptor_) == end_ || ::ftruncate(descriptor_, static_cast<off_t>(end_)) == 0;
  if (descriptor_ < 0) {
    std::error_code unknown; // shows in what follows
    if (path_.has_parent_path())
      fs::create_directories(path_.parent_path(), unknown);
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (descriptor_ < 0)
      return false;
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) { // somebody was faster: the file is his
      ::close(std::exchange(descriptor_, -1));
      return false;
    }
  }
  std::string head(first_line);
  head += key_ + "\n";
  if (::ftruncate(descriptor_, 0) != 0 || !write_at(descriptor_, head, 0))
    return false;
  end_ = head.size();
  return true;
}

/// At the end of the file; false where blocks are not kept.
bool Journal::append(Block block, std::string_view bytes) {
  if (!is_on_)
    return false;
  BlockHead head{block_mark, block.part, block.number, bytes.size(), {}};
  const std::string sum = sha256_hex(bytes);
  std::copy_n(sum.data(), head.sum.size(), head.sum.data());
  const std::string_view head_text(reinterpret_cast<const char *>(&head), sizeof head);
  if (!begin() || !write_at(descriptor_, head_text, end_) ||
      !write_at(descriptor_, bytes, end_ + sizeof head)) {
    give_up();
    return false;
  }
  end_ += sizeof head + bytes.size();
  return true;
}

void Journal::keep(Block block, std::string_view bytes) {
  if (append(block, bytes))
    places_[block] = {end_ - bytes.size(), bytes.size()};
}

void Journal::remark(std::uint64_t part, const std::string &text) {
  std::vector<std::string> &said = remarks_[part];
  if (text.empty() || std::ranges::find(said, text) != said.end())
    return;
  append({part | is_remark, said.size()}, text);
  said.push_back(text);
}

std::vector<std::string> Journal::remarks(std::uint64_t part) const {
  const auto at = remarks_.find(part);
  return at == remarks_.end() ? std::vector<std::string>() : at->second;
}

/// A full disk must not lack the room for the result because of the journal. Blocks found stay
/// readable until the end through the open file.
void Journal::give_up() {
  problem_ = Error{ErrorCode::Device,
                   std::string("finished rows cannot be kept here: ") + std::strerror(errno) +
                       ". The job goes on; if it is ended early, it begins anew.",
                   {path_.string()}};
  is_on_ = false;
  if (descriptor_ >= 0)
    ::unlink(path_.c_str());
}

void Journal::finish() {
  if (descriptor_ >= 0) {
    ::unlink(path_.c_str());
    ::close(std::exchange(descriptor_, -1));
  }
  is_on_ = false;
  places_.clear();
}

} // namespace umov
