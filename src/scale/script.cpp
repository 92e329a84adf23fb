#include <umov/scale/script.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace umov::scale {
namespace {

/// For a shell: within single quotes, unless it needs none.
std::string quoted(const std::string &text) {
  if (text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                             "_-./:+,=@%") == std::string::npos)
    return text;
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// Within single quotes in the arguments of a submit file, which stand in double ones.
std::string quoted_for_condor(const std::string &text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' || c == '"' ? std::string(2, c) : std::string(1, c);
  return out + "'";
}

/// Of the process that does shards: who starts it takes some, and batch systems end a task that has
/// more than it asked for.
std::size_t memory_of_work_mb(const ScriptSettings &settings) {
  return settings.memory_mb * 9 / 10;
}

} // namespace

std::string slurm_script(const JobFolder &folder, const ScriptSettings &s) {
  const std::string path = folder.path().string();
  const auto minutes = static_cast<long>(std::ceil(s.wall_s / 60));
  return fmt::format(
      "#!/bin/bash\n"
      "# {0} shards of {1} {2} each, shared among {3} tasks; finished shards are left out, so "
      "that\n"
      "# the same script goes on after whatever ended it. Then: {4} scale merge {5} -o TABLE\n"
      "#SBATCH --job-name=umov\n"
      "#SBATCH --array=0-{6}\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task={7}\n"
      "#SBATCH --mem={8}M\n"
      "#SBATCH --time={9:02d}:{10:02d}:00\n"
      "#SBATCH --requeue\n"
      "#SBATCH --output={11}\n"
      "{12}"
      "exec {4} scale run {5} --part \"$SLURM_ARRAY_TASK_ID/{3}\" \\\n"
      "     --threads \"${{SLURM_CPUS_PER_TASK:-1}}\" --memory-mb {13} -q\n",
      folder.lock().shards(), folder.lock().per_shard, folder.lock().unit, s.tasks,
      quoted(s.program), quoted(path), s.tasks - 1, s.threads, s.memory_mb, minutes / 60,
      minutes % 60, quoted(path + "/log/%A_%a.txt"),
      s.partition.empty() ? "" : "#SBATCH --partition=" + s.partition + "\n", memory_of_work_mb(s));
}

std::string condor_script(const JobFolder &folder, const ScriptSettings &s) {
  const std::string path = folder.path().string();
  return fmt::format(
      "# {0} shards of {1} {2} each, shared among {3} tasks; finished shards are left out, so "
      "that\n"
      "# the same file goes on after whatever ended it. The folder must be seen by all machines.\n"
      "executable = {4}\n"
      "arguments = \"scale run {9} --part $(Process)/{3} --threads {6} "
      "--memory-mb {10} -q\"\n"
      "transfer_executable = false\n"
      "should_transfer_files = no\n"
      "request_cpus = {6}\n"
      "request_memory = {7}MB\n"
      "+MaxRuntime = {8:.0f}\n"
      "output = {5}/log/$(Cluster)_$(Process).out\n"
      "error = {5}/log/$(Cluster)_$(Process).err\n"
      "log = {5}/log/$(Cluster).log\n"
      "queue {3}\n",
      folder.lock().shards(), folder.lock().per_shard, folder.lock().unit, s.tasks, s.program, path,
      s.threads, s.memory_mb, s.wall_s, quoted_for_condor(path), memory_of_work_mb(s));
}

} // namespace umov::scale
