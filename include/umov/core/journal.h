#pragma once
// Finished blocks of a long job, kept in a file while it runs: after a kill the same job goes on.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <utility>
#include <vector>

namespace umov {

/// A file of numbered blocks, each with its checksum, that knows the job it belongs to. Whatever
/// happens to it costs nothing but the work of the blocks: a torn end is dropped, and where blocks
/// cannot be kept the file goes and `problem` says why. One process at a time has it.
class Journal {
public:
  /// A block of a part of the job: of an object, of a table.
  struct Block {
    std::uint64_t part = 0, number = 0;
    /// In order of parts.
    friend bool operator<(const Block &a, const Block &b) {
      return a.part != b.part ? a.part < b.part : a.number < b.number;
    }
  };
  /// What stood in the file when it was opened.
  enum class Found {
    Nothing,
    Ours,    ///< blocks of the same job
    Foreign, ///< of another job, or damaged from the start: nothing of it is used
    Busy     ///< another process is at it: this one keeps nothing
  };

  /// Keeps nothing and finds nothing.
  Journal() = default;
  /// `job`: a text that differs whenever the blocks could. The file is made with the first block;
  /// an empty path keeps nothing. Device for what is no journal or cannot be read.
  static Result<Journal> open(const std::filesystem::path &path, std::string_view job);
  /// "NAME.rows.partial" beside the file or folder that an output of that name becomes; empty for
  /// what is neither (a pipe, a device, "-" or no name).
  static std::filesystem::path name_for(const std::filesystem::path &output);
  Journal(Journal &&other) noexcept;
  Journal &operator=(Journal &&other) noexcept;
  ~Journal(); ///< the file stays

  /// What the file was.
  [[nodiscard]] Found found() const { return found_; }
  /// Number of blocks that can be found, without remarks.
  [[nodiscard]] std::size_t count() const { return places_.size(); }
  /// The bytes of a block, if it was kept.
  [[nodiscard]] std::optional<std::string> find(Block block) const;
  /// Appends a block.
  void keep(Block block, std::string_view bytes);
  /// Keeps what holds for blocks of a part of the job, as who made them; once, however often it is
  /// said. An empty text is nothing. Parts are below 2^63.
  void remark(std::uint64_t part, const std::string &text);
  /// What was remarked of a part, by this process and by those before it, oldest first.
  [[nodiscard]] std::vector<std::string> remarks(std::uint64_t part) const;
  /// The job is done: the file goes.
  void finish();
  /// Where it is.
  [[nodiscard]] const std::filesystem::path &path() const { return path_; }
  /// Why blocks are no longer kept.
  [[nodiscard]] const std::optional<Error> &problem() const { return problem_; }

private:
  struct Place {
    std::uint64_t offset = 0, bytes = 0;
  };
  bool read_head();
  void read_blocks();
  bool begin();
  bool append(Block block, std::string_view bytes);
  void give_up();
  std::filesystem::path path_;
  std::string key_; ///< hash of the job
  std::map<Block, Place> places_;
  std::map<std::uint64_t, std::vector<std::string>> remarks_;
  std::uint64_t end_ = 0; ///< of the last whole block
  int descriptor_ = -1;
  bool is_on_ = false;
  Found found_ = Found::Nothing;
  std::optional<Error> problem_;
};

} // namespace umov
