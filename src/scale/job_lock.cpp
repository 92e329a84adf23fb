#include <umov/scale/job_folder.h>

#include "core/parse_place.h"
#include "scale/whole_number.h"

#include <algorithm>
#include <fmt/format.h>
#include <new>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>

namespace umov::scale {

using nlohmann::json;

std::string JobLock::key() const {
  return sha256_hex(fmt::format("umov scale 1\n{}\n{} in {}\n{}", verb, total, per_shard, identity))
      .substr(0, 16);
}

jobs::IndexRange JobLock::range(std::size_t shard) const {
  const std::size_t first = shard * per_shard;
  return {first, std::min(per_shard, total - first)};
}

std::string to_json(const JobLock &lock) {
  json tallies = json::array();
  for (const jobs::Tally &tally : lock.tallies)
    tallies.push_back({{"unit", tally.unit}, {"words", tally.words}, {"all", tally.all}});
  const json out{{"umov_scale", 1},
                 {"key", lock.key()},
                 {"verb", lock.verb},
                 {"arguments", lock.arguments},
                 {"directory", lock.directory},
                 {"instruction_set", lock.instruction_set},
                 {"unit", lock.unit},
                 {"total", lock.total},
                 {"per_shard", lock.per_shard},
                 {"shards", lock.shards()},
                 {"layout", lock.layout},
                 {"tables", lock.tables},
                 {"order", lock.order},
                 {"reduce", lock.reductions},
                 {"nothing", lock.nothing},
                 {"problems", lock.problems},
                 {"warnings", lock.warnings},
                 {"tallies", std::move(tallies)},
                 {"predicted",
                  {{"cpu_s", lock.rate.cpu_s},
                   {"bytes", lock.rate.bytes},
                   {"setup_cpu_s", lock.rate.setup_cpu_s},
                   {"once_cpu_s", lock.rate.once_cpu_s},
                   {"shard_bytes", lock.rate.shard_bytes}}},
                 {"job", lock.identity}};
  return out.dump(1) + "\n";
}

Result<JobLock> lock_from_json(const std::string &text, const std::string &file) {
  JobLock out;
  try {
    const json all = json::parse(text);
    if (whole_at(all, "umov_scale") != 1)
      throw std::runtime_error("of another version of the form");
    all.at("verb").get_to(out.verb);
    all.at("arguments").get_to(out.arguments);
    all.at("directory").get_to(out.directory);
    all.at("instruction_set").get_to(out.instruction_set);
    all.at("unit").get_to(out.unit);
    out.total = whole_at(all, "total");
    out.per_shard = whole_at(all, "per_shard");
    for (const json &rows : list_at(all, "layout"))
      out.layout.push_back(whole_of(rows, "layout"));
    all.at("tables").get_to(out.tables);
    all.at("order").get_to(out.order);
    out.nothing = all.value("nothing", ""); // jobs begun by 0.1 have none
    out.problems = all.value("problems", "");
    if (all.contains("reduce"))
      all.at("reduce").get_to(out.reductions);
    if (all.contains("warnings"))
      all.at("warnings").get_to(out.warnings);
    const json tallies = all.value("tallies", json::array());
    for (const json &tally : list_of(tallies, "tallies"))
      out.tallies.push_back({tally.at("unit").get<std::string>(),
                             tally.at("words").get<std::string>(),
                             tally.at("all").get<std::string>()});
    all.at("job").get_to(out.identity);
    out.rate = {all.at("predicted").at("cpu_s").get<double>(),
                all.at("predicted").at("bytes").get<double>(),
                all.at("predicted").at("setup_cpu_s").get<double>(),
                all.at("predicted").value("once_cpu_s", 0.0), // jobs begun by 0.1 have none
                all.at("predicted").value("shard_bytes", 0.0)};
    if (!out.reductions.empty() && out.reductions.size() != out.tables.size())
      throw std::runtime_error("with other tables than it is reduced to");
    if (out.per_shard == 0 || out.tables.empty())
      throw std::runtime_error("without shards or tables");
    if (all.at("key").get<std::string>() != out.key())
      throw std::runtime_error("its key does not fit what it says: it was changed by hand");
  } catch (const std::bad_alloc &) {
    throw; // of what is whole
  } catch (const std::exception &problem) {
    return fail(ErrorCode::BadInput,
                text.empty()
                    ? std::string("is empty: it was cut off when the job was begun. Remove "
                                  "the folder and begin the job again.")
                    : fmt::format("is no job of umov scale: {}. Name the folder of one, "
                                  "or begin a job in a new folder.",
                                  json_words(problem.what())),
                {file});
  }
  return out;
}

std::string first_difference(const std::string &was, const std::string &is) {
  std::size_t a = 0, b = 0;
  while (a < was.size() || b < is.size()) {
    const std::string one = was.substr(a, was.find('\n', a) - a);
    const std::string other = is.substr(b, is.find('\n', b) - b);
    if (one != other)
      return fmt::format("was \"{}\", is \"{}\"", one.substr(0, 200), other.substr(0, 200));
    a = std::min(was.size(), a + one.size() + 1);
    b = std::min(is.size(), b + other.size() + 1);
  }
  return "";
}

} // namespace umov::scale
