// What is told and kept of a shard, as JSON and back.

#include "scale/whole_number.h"

#include <array>
#include <fmt/format.h>
#include <new>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/scale/shard_work.h>

namespace umov::scale {
namespace {

using nlohmann::json;

constexpr std::array<const char *, 5> status_names{"done", "there", "failed", "exhausted",
                                                   "refused"};

} // namespace

std::string to_json(const ShardRecord &r) {
  const json out{
      {"index", r.index},     {"status", status_names[static_cast<std::size_t>(r.status)]},
      {"code", r.code},       {"message", r.message.substr(0, 500)},
      {"file", r.file},       {"sha256", r.sha256},
      {"rows", r.rows},       {"bytes", r.bytes},
      {"seconds", r.seconds}, {"cpu_s", r.cpu_s}};
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<ShardRecord> record_from_json(const std::string &line) {
  try {
    const json all = json::parse(line);
    const auto status = all.at("status").get<std::string>();
    ShardRecord out;
    for (std::size_t k = 0; k < status_names.size(); ++k)
      if (status == status_names[k])
        out.status = static_cast<ShardRecord::Status>(k);
    out.index = whole_at(all, "index");
    out.code = code_at(all);
    out.message = printable(all.at("message").get<std::string>());
    all.at("file").get_to(out.file);
    all.at("sha256").get_to(out.sha256);
    out.rows = whole_at(all, "rows");
    out.bytes = whole_at(all, "bytes");
    all.at("seconds").get_to(out.seconds);
    all.at("cpu_s").get_to(out.cpu_s);
    return out;
  } catch (const std::bad_alloc &) {
    throw; // of what is whole
  } catch (const std::exception &problem) {
    return fail(ErrorCode::Internal,
                fmt::format("a worker said \"{}\": {}", printable(line), problem.what()));
  }
}

std::string to_json(const FailedShard &failed, const jobs::IndexRange &range) {
  const json out{{"index", failed.index},       {"first", range.first},
                 {"count", range.count},        {"code", failed.code},
                 {"attempts", failed.attempts}, {"message", failed.message},
                 {"host", failed.host}};
  return out.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::optional<FailedShard> failed_from_json(const std::string &text) {
  try {
    const json all = json::parse(text);
    return FailedShard{whole_at(all, "index"), code_at(all), whole_at(all, "attempts"),
                       printable(all.at("message").get<std::string>()),
                       printable(all.at("host").get<std::string>())};
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &) {
    return std::nullopt; // damaged: the shard is tried again as if nothing were known
  }
}

} // namespace umov::scale
