#include <umov/scale/merge.h>

#include "scale/picked_rows.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/jobs/invert_each.h>
#include <umov/scale/reduction.h>
#include <umov/scale/rows_file.h>
#include <utility>

namespace umov::scale {
namespace {

/// The file of a shard whose bytes are those of its name.
Result<RowsFile> open_checked(const JobFolder &folder, const Shard &shard) {
  const std::string name = folder.file_of(shard).string();
  UMOV_ASSIGN(file, RowsFile::open(name));
  if (file.sha256().substr(0, shard.sha256.size()) != shard.sha256)
    return fail(ErrorCode::BadInput,
                "its bytes are not those of its name: the file is damaged. umov scale repair " +
                    folder.path().string() + " makes it anew.",
                {name});
  const RowsHead &head = file.head();
  const jobs::IndexRange range = folder.lock().range(shard.index);
  if (head.key != folder.key() || head.index != shard.index || head.range.first != range.first ||
      head.range.count != range.count || file.tables() != folder.lock().tables)
    return fail(
        ErrorCode::BadInput,
        fmt::format("it holds other rows than its name says (shard {}): a file was renamed. "
                    "umov scale repair {} makes it anew.",
                    head.index, folder.path().string()),
        {name});
  return std::move(file);
}

/// The one file of each shard, in order.
Result<std::vector<Shard>> all_shards(const JobFolder &folder, bool with_bytes = false) {
  UMOV_ASSIGN(there, folder.shards(with_bytes));
  std::vector<Shard> out;
  std::vector<std::size_t> missing;
  for (std::size_t k = 0; k < folder.lock().shards(); ++k) {
    const auto found = there.find(k);
    if (found == there.end()) {
      missing.push_back(k);
    } else if (found->second.size() > 1) {
      return fail(ErrorCode::BadInput,
                  fmt::format("shard {} is there with unlike bytes ({} and {}): two programs or "
                              "machines do not agree. umov scale repair makes it anew.",
                              k, found->second[0].name, found->second[1].name),
                  {folder.path().string()});
    } else {
      out.push_back(found->second.front());
    }
  }
  if (missing.empty())
    return out;
  const std::size_t told = std::min<std::size_t>(missing.size(), 10);
  return fail(ErrorCode::BadInput,
              fmt::format("{} of {} shards are missing: {}{}. umov scale run {} makes them.",
                          missing.size(), folder.lock().shards(),
                          fmt::join(missing.begin(),
                                    missing.begin() + static_cast<std::ptrdiff_t>(told), ", "),
                          told < missing.size() ? ", ..." : "", folder.path().string()),
              {folder.path().string()});
}

/// All rows by a column, which goes; ties stay in the order of the shards.
Table in_order(const Table &table, const std::string &by) {
  const auto &key = std::get<std::vector<double>>(table.find(by)->cells);
  std::vector<std::size_t> rows(table.rows());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::ranges::stable_sort(rows, {}, [&key](std::size_t row) { return key[row]; });
  Table out = picked(table, rows);
  out.remove(by);
  return out;
}

/// What is known of a table when all shards have been looked at, and must be before its first row
/// is written.
struct Ahead {
  std::vector<std::string> warnings; ///< of the header
  std::vector<std::size_t> widths;   ///< RowsFile::widths of all
};

/// Files are not compared with their hashes yet: their rows are, before anything is kept.
Result<Ahead> look_ahead(const JobFolder &folder, const std::vector<Shard> &shards,
                         std::size_t table, const jobs::Monitor &monitor) {
  const JobLock &lock = folder.lock();
  Ahead out;
  std::vector<std::size_t> counts(lock.tallies.size());
  for (const Shard &shard : shards) {
    if (monitor.is_cancelled())
      return fail(ErrorCode::Interrupted, "stopped by the user");
    UMOV_ASSIGN(file, RowsFile::open(folder.file_of(shard)));
    if (file.tables() != lock.tables)
      continue; // what is wrong with it is told when it is checked
    const std::vector<std::size_t> widths = file.widths(table);
    out.widths.resize(std::max(out.widths.size(), widths.size()));
    for (std::size_t c = 0; c < widths.size(); ++c)
      out.widths[c] = std::max(out.widths[c], widths[c]);
    for (std::size_t n = 0; n < std::min(counts.size(), file.tallies().size()); ++n)
      counts[n] += file.tallies()[n];
  }
  if (table != 0 && lock.reductions.empty())
    return out;
  out.warnings = lock.warnings;
  UMOV_ASSIGN(told, jobs::sentences(lock.tallies, counts, lock.total));
  out.warnings.insert(out.warnings.end(), told.begin(), told.end());
  return out;
}

/// Tells a block what is ahead of it.
void tell(Table &block, const Ahead &ahead) {
  jobs::note_warnings(block, ahead.warnings);
  std::vector<std::string> names;
  for (const Column &column : block.columns())
    names.push_back(column.name);
  for (std::size_t c = 0; c < std::min(names.size(), ahead.widths.size()); ++c)
    block.set_width(names[c], ahead.widths[c]);
}

/// The blocks of a table, shard by shard, to `take`; `sink` hears of a stop.
template <class F>
Result<void> for_each_block(const JobFolder &folder, const std::vector<Shard> &shards,
                            std::size_t table, TableSink &sink, const jobs::Monitor &monitor,
                            F &&take) {
  for (const Shard &shard : shards) {
    if (monitor.is_cancelled())
      return tl::unexpected(sink.stop({ErrorCode::Interrupted, "stopped by the user", {}}));
    UMOV_ASSIGN(file, open_checked(folder, shard));
    for (std::size_t b = 0; b < file.blocks(table); ++b) {
      UMOV_ASSIGN(block, file.block(table, b));
      UMOV_TRY(take(std::move(block)));
    }
    monitor.advance("shards", shard.index + 1, shards.size());
  }
  return {};
}

/// What all shards keep of the rows, put together.
Result<void> merge_reduced(const JobFolder &folder, std::size_t number, TableSink &sink,
                           const jobs::Monitor &monitor) {
  UMOV_ASSIGN(shards, all_shards(folder));
  UMOV_ASSIGN(ahead, look_ahead(folder, shards, number, monitor));
  UMOV_ASSIGN(all, make_reducer(folder.lock().reductions.at(number)));
  UMOV_TRY(for_each_block(folder, shards, number, sink, monitor,
                          [&all](Table &&block) { return all->join(block); }));
  if (all->rows() == 0 && !folder.lock().nothing.empty())
    return fail(ErrorCode::Nothing, folder.lock().nothing);
  Table table = all->table();
  jobs::note_warnings(table, ahead.warnings);
  UMOV_TRY(sink.add(std::move(table)));
  return sink.finish();
}

} // namespace

Result<void> merge(const JobFolder &folder, const std::string &table, TableSink &sink,
                   const jobs::Monitor &monitor) {
  const JobLock &lock = folder.lock();
  const auto wanted = std::ranges::find(lock.tables, table);
  if (wanted == lock.tables.end())
    return fail(ErrorCode::Usage, fmt::format("--table {}: no table of this job; {} was expected",
                                              printable(table), fmt::join(lock.tables, " or ")));
  const auto number = static_cast<std::size_t>(wanted - lock.tables.begin());
  if (!lock.reductions.empty())
    return merge_reduced(folder, number, sink, monitor);
  const bool is_sorted = number == 0 && !lock.order.empty();
  UMOV_ASSIGN(shards, all_shards(folder));
  UMOV_ASSIGN(ahead, look_ahead(folder, shards, number, monitor));
  Table all;                  // of a table that is sorted
  std::optional<Table> empty; // what stands in place of all where none has a row
  std::size_t rows = 0;
  bool is_first = true;
  UMOV_TRY(
      for_each_block(folder, shards, number, sink, monitor, [&](Table &&block) -> Result<void> {
        rows += block.rows();
        if (block.rows() == 0) {
          if (!empty)
            empty = std::move(block);
          return {};
        }
        if (is_sorted) {
          all.append(std::move(block));
          return {};
        }
        if (std::exchange(is_first, false))
          tell(block, ahead);
        return sink.add(std::move(block));
      }));
  if (rows == 0 && number == 0 && !lock.nothing.empty())
    return fail(ErrorCode::Nothing, lock.nothing);
  if (rows == 0 && !empty)
    return fail(ErrorCode::Nothing, "the job has no row: nothing was found in any shard");
  if (rows == 0)
    all = std::move(*empty);
  if (is_sorted)
    all = in_order(all, lock.order);
  if (rows == 0 || is_sorted) {
    tell(all, ahead);
    UMOV_TRY(sink.add(std::move(all)));
  }
  return sink.finish();
}

Result<void> check_answers(const JobFolder &folder, const jobs::Monitor &monitor) {
  const JobLock &lock = folder.lock();
  if (lock.problems.empty())
    return {};
  UMOV_ASSIGN(shards, all_shards(folder));
  std::vector<std::string> out;
  for (const Shard &shard : shards) {
    if (monitor.is_cancelled())
      return fail(ErrorCode::Interrupted, "stopped by the user");
    UMOV_ASSIGN(file, open_checked(folder, shard));
    for (std::size_t b = 0; b < file.blocks(0); ++b) {
      UMOV_ASSIGN(block, file.block(0, b));
      for (std::size_t row = 0; row < block.rows(); ++row)
        if (std::string text = block.text(lock.problems, row); !text.empty())
          out.push_back(std::move(text));
    }
  }
  return jobs::all_answered(out, lock.total);
}

Result<Verdict> verify(const JobFolder &folder, const jobs::Monitor &monitor) {
  UMOV_ASSIGN(there, folder.shards());
  Verdict out;
  out.shards = folder.lock().shards();
  for (std::size_t k = 0; k < out.shards; ++k) {
    if (monitor.is_cancelled())
      return fail(ErrorCode::Interrupted, "stopped by the user");
    const auto found = there.find(k);
    if (found == there.end()) {
      out.missing.push_back(k);
      continue;
    }
    std::vector<Shard> good;
    for (const Shard &shard : found->second)
      (open_checked(folder, shard) ? good : out.damaged).push_back(shard);
    if (good.size() > 1)
      out.doubled.insert(out.doubled.end(), good.begin(), good.end());
    out.done += good.size() == 1 ? 1U : 0U;
    monitor.advance("shards", k + 1, out.shards);
  }
  return out;
}

std::string describe(const Verdict &verdict, const JobFolder &folder) {
  std::string out = fmt::format("{} of {} shards are whole", verdict.done, verdict.shards);
  if (!verdict.missing.empty())
    out += fmt::format("; {} missing, the first is {}", verdict.missing.size(),
                       verdict.missing.front());
  for (const Shard &shard : verdict.damaged)
    out += "; damaged: " + folder.file_of(shard).string();
  for (const Shard &shard : verdict.doubled)
    out += "; not the only one of its shard: " + folder.file_of(shard).string();
  return out;
}

void remove_bad(const JobFolder &folder, const Verdict &verdict) {
  std::error_code unknown;
  for (const auto *bad : {&verdict.damaged, &verdict.doubled})
    for (const Shard &shard : *bad)
      std::filesystem::remove(folder.file_of(shard), unknown);
}

Result<void> write_manifest(const JobFolder &folder) {
  UMOV_ASSIGN(shards, all_shards(folder, true));
  std::size_t bytes = 0;
  std::string list; // as text: a hundred thousand objects of JSON take a second
  for (const Shard &shard : shards) {
    bytes += shard.bytes;
    const jobs::IndexRange range = folder.lock().range(shard.index);
    fmt::format_to(std::back_inserter(list),
                   "{}\n  {{\"bytes\": {}, \"count\": {}, \"file\": \"{}\", \"first\": {}, "
                   "\"sha256_128\": \"{}\"}}",
                   list.empty() ? "" : ",", shard.bytes, range.count, shard.name, range.first,
                   shard.sha256);
  }
  return write_file_atomically(
      folder.path() / "manifest.json",
      fmt::format("{{\n \"bytes\": {},\n \"key\": \"{}\",\n \"program\": \"umov {}\",\n "
                  "\"shards\": [{}\n ],\n \"total\": {},\n \"unit\": {}\n}}\n",
                  bytes, folder.key(), version, list, folder.lock().total,
                  nlohmann::json(folder.lock().unit).dump()));
}

} // namespace umov::scale
