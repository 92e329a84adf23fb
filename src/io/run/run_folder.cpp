#include <umov/io/run_folder.h>

#include "io/run/manifest_read.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdio.h>
#include <umov/core/files.h>
#include <umov/core/journal.h>
#include <umov/core/temporary.h>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace umov {
namespace {

namespace fs = std::filesystem;
constexpr const char *program = "umov";

tl::unexpected<Error> trouble(const fs::path &path, const std::string &text) {
  return fail(ErrorCode::Device, text, {path.string()});
}

constexpr const char *complete = "complete", *stopped_early = "stopped early";

/// The manifest that umov wrote into a folder; empty for any other folder.
std::optional<OldManifest> manifest_of(const fs::path &folder) {
  constexpr std::size_t limit = 16u << 20; // ours have some KB, a name for each file of the folder
  const auto text = read_file(folder / "manifest.json", limit);
  return text ? read_manifest(*text) : std::nullopt;
}

/// Status of the run that umov wrote into a folder; empty for any other folder.
std::optional<std::string> status_of(const fs::path &folder) {
  const auto manifest = manifest_of(folder);
  return manifest ? std::optional(manifest->status) : std::nullopt;
}

/// What a run writes: a folder with anything else in it is never replaced as a whole.
constexpr const char *our_files[] = {"lightcurve.ecsv",    "lightcurve.csv", "lightcurve.fits",
                                     "passes.ecsv",        "report.html",    "manifest.json",
                                     "scenario.lock.toml", "log.txt"};

/// report_2.html, report_3.html, ...: pages of further objects.
bool is_further_page(std::string_view name) {
  constexpr std::string_view begin = "report_", end = ".html";
  if (!name.starts_with(begin) || !name.ends_with(end) || name.size() <= begin.size() + end.size())
    return false;
  name = name.substr(begin.size(), name.size() - begin.size() - end.size());
  return name.find_first_not_of("0123456789") == std::string_view::npos;
}

/// A folder in ours holds only files that the manifest lists ("inputs/mesh.obj").
bool holds_only_listed(const fs::path &below, const fs::path &folder,
                       const std::vector<std::string> &listed) {
  std::error_code code;
  fs::recursive_directory_iterator at(below, code);
  for (; !code && at != fs::recursive_directory_iterator(); at.increment(code)) {
    const std::string name = at->path().lexically_relative(folder).generic_string();
    std::error_code unknown;
    if (!at->is_directory(unknown) && std::find(listed.begin(), listed.end(), name) == listed.end())
      return false;
  }
  return !code;
}

constexpr const char *frames = "frames", *frame_files = "frame_";

/// A folder of nothing but frames.
bool holds_frames_only(const fs::path &folder) {
  if (folder.filename() != frames)
    return false;
  std::error_code code;
  for (const auto &entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    std::error_code unknown;
    if (!name.starts_with(frame_files) || !name.ends_with(".fits") || entry.is_directory(unknown))
      return false;
  }
  return !code;
}

/// What a folder holds that umov did not write.
std::vector<std::string> strangers_in(const fs::path &folder) {
  std::vector<std::string> out;
  std::error_code code;
  const auto manifest = manifest_of(folder);
  const auto listed = manifest ? manifest->files : std::vector<std::string>();
  for (const auto &entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    if (std::find(std::begin(our_files), std::end(our_files), name) == std::end(our_files) &&
        !is_further_page(name) &&
        !(entry.is_directory(code) && !entry.is_symlink(code) && holds_frames_only(entry.path())) &&
        std::find(listed.begin(), listed.end(), name) == listed.end() &&
        !(!listed.empty() && entry.is_directory(code) && !entry.is_symlink(code) &&
          holds_only_listed(entry.path(), folder, listed)))
      out.push_back(name);
  }
  return out;
}

/// Nothing in a folder that a killed run left is anybody else's: the files of a run, whole or half.
bool holds_only_ours(const fs::path &folder) {
  std::vector<std::string> all = strangers_in(folder);
  std::erase_if(all, [](const std::string &name) { return name.find(".part-") != name.npos; });
  return all.empty();
}

/// Something in a folder that umov did not write; empty if there is nothing.
std::string stranger_in(const fs::path &folder) {
  const auto all = strangers_in(folder);
  return all.empty() ? std::string() : all.front();
}

/// Why a folder with something in it is not ours to replace.
std::string in_the_way(const fs::path &folder) {
  if (const std::string stranger = stranger_in(folder); !stranger.empty())
    return fmt::format("\"{}\", which umov did not write", printable(stranger));
  std::error_code code;
  if (fs::exists(folder / "manifest.json", code))
    return "a manifest.json that umov did not write";
  const fs::directory_iterator first(folder, code);
  return fmt::format("{} and no manifest.json of umov",
                     code || first == fs::directory_iterator()
                         ? std::string("something")
                         : "\"" + printable(first->path().filename().string()) + "\"");
}

bool is_free(const fs::path &folder) {
  std::error_code code;
  return !fs::exists(folder, code) ||
         (fs::is_directory(folder, code) && fs::is_empty(folder, code)) ||
         (status_of(folder) == stopped_early && stranger_in(folder).empty());
}

/// Nearest folder above that exists: where a new one would be made.
fs::path existing_parent(fs::path path) {
  std::error_code code;
  while (!path.empty() && !fs::exists(path, code) && path != path.parent_path())
    path = path.parent_path();
  return path.empty() ? fs::path(".") : path;
}

/// Removes a folder unless it was released.
struct Temporary {
  explicit Temporary(fs::path folder)
      : path(std::move(folder)),
        descriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    hold_temporary(descriptor);
  }
  Temporary(const Temporary &) = delete;
  Temporary &operator=(const Temporary &) = delete;
  fs::path path;
  int descriptor;
  ~Temporary() {
    if (descriptor >= 0)
      ::close(descriptor);
    std::error_code code;
    try {
      if (!path.empty())
        fs::remove_all(path, code);
    } catch (const std::bad_alloc &) { // who writes here again removes it
    }
  }
};

/// What runs that were killed left of this folder; what the user had put in there is not ours.
void remove_abandoned(const fs::path &folder) {
  std::error_code unknown;
  for (const fs::path &old : abandoned_temporaries(folder, "."))
    if (fs::is_directory(old, unknown) && holds_only_ours(old))
      fs::remove_all(old, unknown);
}

/// A new folder beside another one, with its permissions.
Result<fs::path> make_beside(const fs::path &folder) {
  std::error_code code;
  for (int attempt = 0; attempt < 100; ++attempt) {
    const fs::path out = temporary_name(folder, ".");
    if (fs::create_directory(out, code)) { // false if somebody has it
      std::error_code unknown;
      if (const auto old = fs::status(folder, unknown); fs::is_directory(old))
        fs::permissions(out, old.permissions(), unknown);
      return out;
    }
    if (code)
      break;
  }
  return trouble(folder.parent_path(), "no folder can be made here: " + code.message());
}

/// Asked again when the run is over: hours may lie between, in which the folder is the user's.
bool is_replaceable(const fs::path &folder) {
  std::error_code code;
  const auto status = fs::symlink_status(folder, code);
  if (!fs::exists(status))
    return true;
  return fs::is_directory(status) && (fs::is_empty(folder, code) || status_of(folder));
}

/// What the user put into the old folder moves to the new one; if it cannot, the old folder stays.
Result<void> bring_back_strangers(Temporary &old, const fs::path &full) {
  for (const std::string &name : strangers_in(old.path)) {
    const fs::path from = old.path / name, to = full / name;
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0)
      continue;
    std::error_code code;
    if (errno == EINVAL && !fs::exists(fs::symlink_status(to, code))) // no such flag here
      if (fs::rename(from, to, code); !code)
        continue;
    const fs::path kept = std::exchange(old.path, {});
    return trouble(full, fmt::format("is written, but \"{}\", which umov did not write, could not "
                                     "be kept in it. It is in {}: move it.",
                                     name, kept.string()));
  }
  return {};
}

/// Exchanges a new folder with the one that stands there, if any.
Result<void> put_in_place(Temporary &fresh, const fs::path &full) {
  std::error_code code;
  if (!fs::exists(full, code)) {
    fs::rename(fresh.path, full, code);
    if (code)
      return trouble(full, "cannot be put in place: " + code.message());
    fresh.path.clear();
    return {};
  }
  if (::renameat2(AT_FDCWD, fresh.path.c_str(), AT_FDCWD, full.c_str(), RENAME_EXCHANGE) != 0) {
    // A file system without exchange: the old folder steps aside first.
    const fs::path old = fresh.path.string() + "-old";
    fs::rename(full, old, code);
    if (!code) {
      fs::rename(fresh.path, full, code);
      if (std::error_code unknown; code)
        fs::rename(old, full, unknown); // as it was
    }
    if (code)
      return trouble(full, "cannot be replaced: " + code.message());
    fresh.path = old;
  } // after an exchange the temporary name holds the old folder, which goes
  return bring_back_strangers(fresh, full);
}

} // namespace

Result<void> RunFolder::check_named_by_file(const fs::path &target, const fs::path &file) {
  std::error_code code;
  const fs::path inside =
      fs::absolute(target, code).lexically_normal().lexically_relative(fs::current_path(code));
  if (inside.empty() || *inside.begin() != ".." || !fs::exists(target, code))
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("output.dir = \"{0}\" is outside the working folder and is there "
                          "already. To replace it name it yourself: -o {0}",
                          target.string()),
              {file.string()});
}

Result<RunFolder> RunFolder::open(const fs::path &target, bool force) {
  RunFolder out;
  std::error_code code;
  out.target_ = target;
  if (out.target_.filename().empty()) // "out/" is "out"
    out.target_ = out.target_.parent_path();
  // Through symbolic links and "." to the folder that is meant.
  if (fs::exists(out.target_, code))
    if (const fs::path real = fs::canonical(out.target_, code); !code)
      out.real_ = real;
  if (out.real_.empty())
    out.real_ = fs::absolute(out.target_, code).lexically_normal();
  if (fs::exists(out.target_, code) && !fs::is_directory(out.target_, code))
    return trouble(target, "is a file; the name of a folder was expected");
  if (fs::is_directory(out.target_, code) && !fs::is_empty(out.target_, code) &&
      (!status_of(out.target_) || !stranger_in(out.target_).empty())) {
    if (!force)
      return trouble(target, fmt::format("holds {}. Choose another folder (output.dir) or pass "
                                         "--force to put the files beside it.",
                                         in_the_way(out.target_)));
    out.is_foreign_ = true;
  }
  if (const auto old = manifest_of(out.target_))
    out.replaced_utc_ = old->started_utc;
  // The working folder cannot be exchanged under the user's feet.
  if (out.real_ == fs::current_path(code))
    out.is_foreign_ = true;
  const fs::path parent = existing_parent(fs::absolute(out.target_, code).parent_path());
  // Tried, not asked: the right to write says little on special file systems.
  std::string probe = (parent / ".umov-XXXXXX").string();
  if (::mkdtemp(probe.data()) != nullptr)
    ::rmdir(probe.c_str());
  else
    return trouble(parent, std::string("cannot be written to: ") + std::strerror(errno) +
                               ". Choose another folder (output.dir).");
  return out;
}

fs::path RunFolder::journal_path() const {
  return Journal::name_for(is_foreign_ ? real_ / "lightcurve" : real_);
}

void RunFolder::spare_complete_run() {
  if (!is_free(target_))
    step_aside(".partial");
}

void RunFolder::step_aside(const std::string &suffix) {
  const std::string base = (target_ == "." ? real_ : target_).string() + suffix;
  target_ = base;
  for (int k = 2; !is_free(target_); ++k)
    target_ = base + std::to_string(k);
  std::error_code code;
  real_ = fs::absolute(target_, code).lexically_normal();
  is_foreign_ = false;
}

Result<void> RunFolder::write(const fs::path &folder, const std::string &name) const {
  std::error_code code;
  if (const fs::path full = folder / name; full.parent_path() != folder)
    if (fs::create_directories(full.parent_path(), code); code)
      return trouble(full.parent_path(), "cannot be made: " + code.message());
  return write_file_atomically(folder / name, files_.at(name));
}

struct RunFolder::Staged {
  explicit Staged(fs::path made) : folder(std::move(made)) {}
  Temporary folder;
};

Result<fs::path> RunFolder::subfolder(const std::string &name) {
  UMOV_TRY(begin());
  const fs::path out = staged_->folder.path / name;
  std::error_code code;
  if (fs::create_directories(out, code); code)
    return trouble(out, "cannot be made: " + code.message());
  return out;
}

Result<void> RunFolder::begin() {
  if (staged_)
    return {};
  std::error_code code;
  fs::create_directories(real_.parent_path(), code);
  remove_abandoned(real_);
  UMOV_ASSIGN(made, make_beside(real_));
  staged_ = std::make_shared<Staged>(made);
  return {};
}

/// Into a folder of the user's: what was begun beside it moves there, folder by folder.
Result<void> RunFolder::put_into_foreign() {
  for (const auto &[name, bytes] : files_)
    UMOV_TRY(write(real_, name));
  std::error_code code;
  if (staged_)
    for (const auto &entry : fs::directory_iterator(staged_->folder.path, code)) {
      const fs::path to = real_ / entry.path().filename();
      if (fs::exists(to) && !holds_frames_only(to))
        return trouble(to, "holds files that umov did not write. Choose another folder.");
      fs::remove_all(to, code);
      fs::rename(entry.path(), to, code);
      if (code)
        return trouble(to, "cannot be put in place: " + code.message());
    }
  return {};
}

Result<void> RunFolder::commit() {
  if (is_foreign_)
    return put_into_foreign();
  std::error_code code;
  UMOV_TRY(begin());
  Temporary &fresh = staged_->folder;
  // It tells which files are ours, also of what a kill leaves of this folder.
  if (const auto manifest = files_.find("manifest.json"); manifest != files_.end())
    UMOV_TRY(write(fresh.path, manifest->first));
  for (const auto &[name, bytes] : files_)
    if (name != "manifest.json")
      UMOV_TRY(write(fresh.path, name));
  if (!is_replaceable(real_)) // somebody put something of his own there while the run went on
    step_aside(".new");
  UMOV_TRY(put_in_place(fresh, real_));
  if (const int fd = ::open(real_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      fd >= 0) {
    ::fsync(fd);
    ::close(fd);
  }
  staged_.reset(); // with it what stood there before
  return {};
}

std::string make_manifest(const ManifestInput &input) {
  nlohmann::ordered_json out;
  out["program"] = program;
  out["version"] = version;
  out["git"] = source_revision;
  out["conventions_version"] = conventions_version;
#ifdef __clang__
  out["compiler"] = __VERSION__; // names itself
#else
  out["compiler"] = "g++ " __VERSION__;
#endif
  out["command_line"] = input.command_line;
  out["status"] = input.stopped.empty() ? complete : stopped_early;
  if (!input.stopped.empty())
    out["stopped"] = input.stopped;
  out["started_utc"] = input.started_utc;
  out["elapsed_s"] =
      std::chrono::duration<double>(std::chrono::system_clock::now() - input.started).count();
  out["seed"] = input.seed;
  out["threads"] = input.threads;
  out["light"] = nlohmann::ordered_json::array();
  for (const ManifestInput::Light &one : input.light)
    out["light"].push_back({{"object", one.object},
                            {"method", one.method},
                            {"visibility", one.visibility},
                            {"instruction_set", one.instruction_set},
                            {"device", one.device.empty() ? "cpu" : one.device}});
  out["inputs"] = nlohmann::ordered_json::array();
  for (const auto &[path, hash] : input.inputs)
    out["inputs"].push_back({{"path", path}, {"sha256", hash}});
  out["warnings"] = input.warnings;
  if (!input.files.empty())
    out["files"] = input.files;
  // Names of files are bytes, not always UTF-8: hours of work must not end here.
  return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace umov
