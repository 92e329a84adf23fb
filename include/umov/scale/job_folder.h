#pragma once
// The folder of a job in parts: what is to be done, what is done, and nothing else (docs/scale.md).

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <umov/jobs/ranged_job.h>
#include <vector>

namespace umov::scale {

/// What was measured before the job began, for one of its poses, objects, passes or exposures.
struct Rate {
  double cpu_s = 0, bytes = 0;
  double setup_cpu_s = 0; ///< of a process before its first row
  double once_cpu_s = 0;  ///< of the whole job: masks, which all processes read
  double shard_bytes = 0; ///< of each shard besides: of what is kept of its rows

  /// What a shard of so many may take, with all that is done once.
  [[nodiscard]] double at_most_s(std::size_t per_shard) const {
    return setup_cpu_s + once_cpu_s + cpu_s * static_cast<double>(per_shard);
  }
};

/// Everything that is decided once for the whole job: job.json.
struct JobLock {
  std::string verb;
  std::vector<std::string> arguments; ///< of the verb
  std::string directory;              ///< that names of files among them are relative to
  std::string instruction_set;        ///< that workers are held to; "": the best there is
  std::string identity;               ///< RangedJob::identity
  std::string unit;
  std::size_t total = 0, per_shard = 1;
  std::vector<std::size_t> layout;
  std::vector<std::string> tables;
  std::string order;
  std::vector<std::string> reductions; ///< what is kept of the rows; empty: all of them
  std::string nothing, problems;       ///< RangedJob::nothing and RangedJob::problems
  std::vector<std::string> warnings;   ///< RangedJob::warnings
  std::vector<jobs::Tally> tallies;    ///< RangedJob::tallies
  Rate rate;

  /// What the bytes of a shard depend on, as 16 hexadecimal digits.
  [[nodiscard]] std::string key() const;
  /// How many.
  [[nodiscard]] std::size_t shards() const { return (total + per_shard - 1) / per_shard; }
  /// The indices of a shard.
  [[nodiscard]] jobs::IndexRange range(std::size_t shard) const;
};

/// The JSON text and back; BadInput for what is none.
std::string to_json(const JobLock &lock);
Result<JobLock> lock_from_json(const std::string &text, const std::string &file);
/// The first line that differs between two identities: "was ..., is ...".
std::string first_difference(const std::string &was, const std::string &is);

/// A finished shard.
struct Shard {
  std::size_t index = 0;
  std::string name;      ///< of its file, without folder
  std::string sha256;    ///< the first 32 digits
  std::size_t bytes = 0; ///< of its file, where they were asked for
};

/// Shards by index; several where their bytes differ.
using Shards = std::map<std::size_t, std::vector<Shard>>;

/// A range that could not be done: failed/KKKKKKKK.json.
struct FailedShard {
  std::size_t index = 0;
  int code = 0; ///< as an exit code; 128 and more: the signal that ended it
  std::size_t attempts = 1;
  std::string message, host;
};

/// The text of that file for the rows of a range, and back; nothing for another text. What is read
/// is printable.
std::string to_json(const FailedShard &failed, const jobs::IndexRange &range);
std::optional<FailedShard> failed_from_json(const std::string &text);

/// One folder.
class JobFolder {
public:
  /// Makes the folder and writes job.json; a folder of the same job is taken as it is. BadInput
  /// naming what differs for one of another job, Device for one that holds anything else.
  static Result<JobFolder> begin(const std::filesystem::path &path, const JobLock &lock);
  /// A folder with its job.json.
  static Result<JobFolder> open(const std::filesystem::path &path);

  /// Where it is.
  [[nodiscard]] const std::filesystem::path &path() const { return path_; }
  /// What job it holds.
  [[nodiscard]] const JobLock &lock() const { return lock_; }
  /// JobLock::key of that.
  [[nodiscard]] const std::string &key() const { return key_; }
  /// What is there, and how large where that is asked for. Names of other jobs are not counted.
  [[nodiscard]] Result<Shards> shards(bool with_bytes = false) const;
  /// Of the shard, if it is there.
  [[nodiscard]] std::optional<Shard> find(std::size_t index) const;
  /// Where the file of a shard stands.
  [[nodiscard]] std::filesystem::path file_of(const Shard &shard) const;
  /// The name that a shard gets.
  [[nodiscard]] Shard named(std::size_t index, const std::string &sha256) const;
  /// Under which its file grows.
  [[nodiscard]] std::filesystem::path growing(std::size_t index) const;
  /// Removes what killed processes left half done. Only where nobody is at work.
  void sweep() const;

  /// Keeps what is known of a shard that cannot be made, for whoever works next.
  void tell_failed(const FailedShard &failed) const;
  /// It shall be tried again.
  void forget_failed(std::size_t index) const;
  /// Those that are kept.
  [[nodiscard]] std::vector<FailedShard> failed() const;

private:
  JobFolder(std::filesystem::path path, JobLock lock);
  [[nodiscard]] std::filesystem::path folder_of(std::size_t index) const;
  std::filesystem::path path_;
  JobLock lock_;
  std::string key_;
};

} // namespace umov::scale
