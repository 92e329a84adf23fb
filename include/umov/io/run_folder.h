#pragma once
// The output folder of a run: complete or not there.

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <umov/core/result.h>
#include <utility>
#include <vector>

namespace umov {

/// Collects the files of a run and puts them in place at once. A folder that umov wrote (it has our
/// manifest.json, and nothing else of anybody's) is replaced as a whole when the new one is
/// complete; a kill at any moment leaves the old or the new one. With `force` the files are put,
/// one by one, into a folder of the user's.
class RunFolder {
public:
  /// Refuses (Device) what it must not or cannot write to, before any work is done.
  static Result<RunFolder> open(const std::filesystem::path &target, bool force);
  /// For a `target` that a scenario file names, not the user, who may have that file from others:
  /// outside the working folder one may be made, but BadInput for one that is there already.
  static Result<void> check_named_by_file(const std::filesystem::path &target,
                                          const std::filesystem::path &file);

  /// A file of the folder, or of one in it ("inputs/x.obj"), written at the end with all others.
  void add(std::string name, std::string bytes) { files_[std::move(name)] = std::move(bytes); }
  /// A folder within the new one ("frames") for files that are too many to be held in memory:
  /// whoever asks writes into it, and `commit` puts it in place with all others. Of its files those
  /// count as umov's whose names begin with its own, less the s: "frames/frame_000001.fits".
  Result<std::filesystem::path> subfolder(const std::string &name);
  /// For the rows of a run that stopped early: what stands in the target stays there, unless it is
  /// the rest of such a run itself; the files then go to "<target>.partial".
  void spare_complete_run();
  /// Writes everything. On failure the target is as it was. What the user put into the folder while
  /// the run went on stays in it; if it is no longer umov's, the files go to "<target>.new".
  Result<void> commit();
  /// Where the folder will stand.
  [[nodiscard]] const std::filesystem::path &path() const { return target_; }
  /// When the run began whose folder this one replaces; "" if it replaces none.
  [[nodiscard]] const std::string &replaced_utc() const { return replaced_utc_; }
  /// Where finished blocks are kept while the run goes on: beside the folder, or in one that is not
  /// ours alone.
  [[nodiscard]] std::filesystem::path journal_path() const;

private:
  void step_aside(const std::string &suffix);
  Result<void> begin();
  Result<void> put_into_foreign();
  Result<void> write(const std::filesystem::path &folder, const std::string &name) const;

  std::string replaced_utc_;
  std::filesystem::path target_; ///< as the user named it
  std::filesystem::path real_;   ///< where that is
  bool is_foreign_ = false;
  std::map<std::string, std::string> files_;
  struct Staged; ///< the new folder, where it was begun before `commit`
  std::shared_ptr<Staged> staged_;
};

/// What manifest.json says besides versions and build.
struct ManifestInput {
  std::vector<std::pair<std::string, std::string>> inputs; ///< path, SHA-256
  std::uint64_t seed = 0;
  unsigned threads = 1;
  std::vector<std::string> command_line;
  std::string started_utc; ///< clock time given by the caller
  /// When the command began: elapsed_s counts from then until the manifest is made, which comes
  /// after tables and pages.
  std::chrono::system_clock::time_point started = std::chrono::system_clock::now();
  std::vector<std::string> warnings;
  std::string stopped; ///< why the run ended early; "" = complete
  /// How an object was lit: what was really used, not what was asked.
  struct Light {
    std::string object, method, visibility, instruction_set, device;
  };
  std::vector<Light> light;
  /// Names of files besides those that every run writes: with them the folder is still ours.
  std::vector<std::string> files;
};

/// JSON text; the key "program" marks the folder as ours.
std::string make_manifest(const ManifestInput &input);

} // namespace umov
