#include <umov/scale/job_folder.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <memory>
#include <string_view>
#include <sys/stat.h>
#include <umov/core/files.h>
#include <umov/core/temporary.h>
#include <unistd.h>

namespace umov::scale {
namespace {

namespace fs = std::filesystem;

constexpr const char *job_file = "job.json";
/// Above so many shards they stand in folders of a thousand.
constexpr std::size_t flat_shards = 10'000, per_folder = 1000;

std::string number_of(std::size_t index) { return fmt::format("{:08d}", index); }

tl::unexpected<Error> device(const std::string &what, const fs::path &path) {
  return fail(ErrorCode::Device,
              fmt::format("cannot {}: {}. Choose another folder.", what, std::strerror(errno)),
              {path.string()});
}

Result<JobLock> read_lock(const fs::path &folder) {
  if (!file_exists(folder / job_file))
    return fail(ErrorCode::BadInput,
                fmt::format("holds no job ({} is not there). Check the name, or begin one: umov "
                            "scale run FOLDER VERB ...",
                            job_file),
                {folder.string()});
  UMOV_ASSIGN(text, read_file(folder / job_file));
  return lock_from_json(text, (folder / job_file).string());
}

/// Puts a file in place unless one of that name is there: of two who try at once one succeeds.
Result<bool> create(const fs::path &path, const std::string &bytes) {
  const fs::path temporary = temporary_name(path);
  UMOV_TRY(write_file_atomically(temporary, bytes));
  const int linked = ::link(temporary.c_str(), path.c_str());
  const int cause = errno;
  ::unlink(temporary.c_str());
  if (linked != 0 && cause != EEXIST) {
    errno = cause;
    return device("write", path);
  }
  return linked == 0;
}

/// "00000012-KEY-SHA.rows" of a job with that key.
std::optional<Shard> shard_of(std::string_view name, std::string_view key) {
  if (name.size() != 8 + 1 + 16 + 1 + 32 + 5 || !name.ends_with(".rows") || name[8] != '-' ||
      name.substr(9, 16) != key || name[25] != '-')
    return std::nullopt;
  const std::string_view sum = name.substr(26, 32);
  std::size_t index = 0;
  const auto read = std::from_chars(name.data(), name.data() + 8, index);
  if (read.ptr != name.data() + 8 ||
      sum.find_first_not_of("0123456789abcdef") != std::string_view::npos)
    return std::nullopt;
  return Shard{index, std::string(name), std::string(sum)};
}

/// Something in a folder. A hundred thousand of them are looked through: what a name and a kind
/// cost is what the system's listing costs, without a path or a question for each.
struct Entry {
  int folder = -1; ///< descriptor
  const dirent *listed = nullptr;

  [[nodiscard]] std::string_view name() const { return listed->d_name; }
  /// Follows links.
  [[nodiscard]] std::optional<struct stat> about() const {
    struct stat out {};
    return ::fstatat(folder, listed->d_name, &out, 0) == 0 ? std::optional(out) : std::nullopt;
  }
  [[nodiscard]] bool is_file() const { return is_of(DT_REG, S_IFREG); }
  [[nodiscard]] bool is_folder() const { return is_of(DT_DIR, S_IFDIR); }

private:
  [[nodiscard]] bool is_of(unsigned char listed_as, mode_t kind) const {
    if (listed->d_type != DT_UNKNOWN && listed->d_type != DT_LNK)
      return listed->d_type == listed_as;
    const auto there = about();
    return there && (there->st_mode & S_IFMT) == kind;
  }
};

/// Calls `take` for all that stands in a folder; the cause where it cannot be listed.
template <class Take> int for_each_entry(const fs::path &folder, const Take &take) {
  const std::unique_ptr<DIR, int (*)(DIR *)> open(::opendir(folder.c_str()), ::closedir);
  if (!open)
    return errno;
  errno = 0;
  while (const dirent *listed = ::readdir(open.get())) {
    take(Entry{::dirfd(open.get()), listed});
    errno = 0;
  }
  return errno;
}

} // namespace

JobFolder::JobFolder(fs::path path, JobLock lock)
    : path_(std::move(path)), lock_(std::move(lock)), key_(lock_.key()) {}

Result<JobFolder> JobFolder::open(const fs::path &path) {
  UMOV_ASSIGN(lock, read_lock(path));
  return JobFolder(fs::absolute(path), std::move(lock));
}

Result<JobFolder> JobFolder::begin(const fs::path &path, const JobLock &lock) {
  std::error_code code;
  const bool has_job = file_exists(path / job_file);
  if (!has_job && fs::exists(path, code) && !fs::is_empty(path, code))
    return fail(ErrorCode::Device,
                "holds something else than a job of umov scale. Name a new folder.",
                {path.string()});
  for (const char *part : {"shards", "tmp", "failed"})
    if (fs::create_directories(path / part, code); code)
      return fail(ErrorCode::Device, "cannot be made: " + code.message(), {(path / part).string()});
  UMOV_ASSIGN(is_new, create(path / job_file, to_json(lock)));
  JobFolder ours(fs::absolute(path), lock);
  if (is_new)
    return ours;
  UMOV_ASSIGN(there, read_lock(path));
  if (there.key() == ours.key_)
    return JobFolder(fs::absolute(path), std::move(there));
  std::string difference = first_difference(there.identity, lock.identity);
  if (difference.empty())
    difference = fmt::format("was {} {} of {} in shards of {}, is {} {} of {} in shards of {}",
                             there.verb, there.unit, there.total, there.per_shard, lock.verb,
                             lock.unit, lock.total, lock.per_shard);
  return fail(ErrorCode::BadInput,
              "is the folder of another job: " + difference +
                  ". Name another folder, or go on with that job: umov scale run " + path.string(),
              {path.string()});
}

fs::path JobFolder::folder_of(std::size_t index) const {
  const fs::path all = path_ / "shards";
  return lock_.shards() > flat_shards ? all / fmt::format("{:05d}", index / per_folder) : all;
}

fs::path JobFolder::file_of(const Shard &shard) const {
  return folder_of(shard.index) / shard.name;
}

Shard JobFolder::named(std::size_t index, const std::string &sha256) const {
  const std::string sum = sha256.substr(0, 32);
  std::error_code exists;
  fs::create_directories(folder_of(index), exists);
  return {index, fmt::format("{}-{}-{}.rows", number_of(index), key_, sum), sum};
}

fs::path JobFolder::growing(std::size_t index) const {
  return path_ / "tmp" / (number_of(index) + ".rows");
}

Result<Shards> JobFolder::shards(bool with_bytes) const {
  Shards out;
  const fs::path all = path_ / "shards";
  const bool is_flat = lock_.shards() <= flat_shards;
  const auto take = [&](const Entry &entry, std::optional<std::size_t> thousand) {
    auto shard = shard_of(entry.name(), key_);
    // A copy elsewhere is none of ours: each number has one place.
    if (!shard || shard->index >= lock_.shards() ||
        !(is_flat ? !thousand : thousand == shard->index / per_folder) || !entry.is_file())
      return;
    if (const auto about = with_bytes ? entry.about() : std::nullopt)
      shard->bytes = static_cast<std::size_t>(about->st_size);
    out[shard->index].push_back(std::move(*shard));
  };
  std::vector<std::size_t> thousands;
  int cause = for_each_entry(all, [&](const Entry &entry) {
    const std::string_view name = entry.name();
    std::size_t number = 0;
    if (is_flat)
      take(entry, std::nullopt);
    else if (name.size() == 5 &&
             std::from_chars(name.data(), name.data() + 5, number).ptr == name.data() + 5 &&
             entry.is_folder())
      thousands.push_back(number);
  });
  std::ranges::sort(thousands); // what follows is put in order as it comes
  for (std::size_t k = 0; k < thousands.size() && cause == 0; ++k)
    cause = for_each_entry(all / fmt::format("{:05d}", thousands[k]),
                           [&](const Entry &entry) { take(entry, thousands[k]); });
  if (cause != 0)
    return fail(ErrorCode::Device, std::string("cannot be listed: ") + std::strerror(cause),
                {all.string()});
  return out;
}

std::optional<Shard> JobFolder::find(std::size_t index) const {
  const std::string begin = number_of(index);
  std::optional<Shard> out;
  for_each_entry(folder_of(index), [&](const Entry &entry) {
    if (!out && entry.name().starts_with(begin))
      out = shard_of(entry.name(), key_);
  });
  return out;
}

void JobFolder::sweep() const {
  std::error_code unknown;
  for (const auto &entry : fs::directory_iterator(path_ / "tmp", unknown))
    fs::remove(entry.path(), unknown);
}

void JobFolder::tell_failed(const FailedShard &failed) const {
  // What cannot be told here stands among the missing all the same.
  (void)write_file_atomically(path_ / "failed" / (number_of(failed.index) + ".json"),
                              to_json(failed, lock_.range(failed.index)));
}

void JobFolder::forget_failed(std::size_t index) const {
  std::error_code unknown;
  fs::remove(path_ / "failed" / (number_of(index) + ".json"), unknown);
}

std::vector<FailedShard> JobFolder::failed() const {
  std::vector<FailedShard> out;
  std::error_code unknown;
  for (const auto &entry : fs::directory_iterator(path_ / "failed", unknown)) {
    const auto text = read_file(entry.path());
    auto one = text ? failed_from_json(*text) : std::nullopt;
    if (one && one->index < lock_.shards())
      out.push_back(std::move(*one));
  }
  return out;
}

} // namespace umov::scale
