#include "jobs/job_journal.h"

#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/light/instruction_set.h>

namespace umov::jobs {

std::string job_text(const Scenario &scenario, const std::vector<InputFile> &inputs,
                     const std::string &more) {
  std::string out = fmt::format("umov {} {} {} {}\n", version, source_revision, conventions_version,
                                engine_instruction_set());
  for (const InputFile &input : inputs)
    out += fmt::format("{} {}\n", input.sha256, input.path);
  return out + more + "\n" + locked_scenario(scenario);
}

std::string signature_job(const Scenario &scenario, const std::vector<InputFile> &inputs,
                          std::size_t cells, const std::string &device) {
  return sha256_hex(job_text(
      scenario, inputs,
      fmt::format("signature of {} cells{}", cells, device.empty() ? "" : "; device " + device)));
}

Result<Journal> open_journal(const JobOptions &options, const std::string &job,
                             const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(out, Journal::open(options.journal, job));
  const std::string name = out.path().string();
  switch (out.found()) {
  case Journal::Found::Nothing:
    break;
  case Journal::Found::Ours:
    monitor.tell(fmt::format("going on from {}, which has {}", name,
                             counted(out.count(), "finished block")));
    break;
  case Journal::Found::Foreign:
    diagnostics.warn(fmt::format("{} is of another job (its scenario, options or version differ) "
                                 "or damaged: this one begins anew",
                                 name));
    break;
  case Journal::Found::Busy:
    diagnostics.warn(fmt::format("another umov is writing {}: this one keeps no finished rows, and "
                                 "whichever ends last gives the result",
                                 name));
    break;
  }
  return std::move(out);
}

Result<std::string> cards_for(const DeviceOptions &device) {
  if (device.choice == DeviceChoice::Cpu)
    return "";
  const auto cards = open_cards(device);
  if (!cards && device.choice == DeviceChoice::Cuda)
    return tl::unexpected(cards.error());
  return cards ? identity_of(**cards) : std::string();
}

Result<std::string> device_text(const DeviceOptions &device) {
  UMOV_ASSIGN(cards, cards_for(device));
  if (cards.empty())
    return "";
  return (device.choice == DeviceChoice::Auto ? "; processor or device " : "; device ") + cards;
}

Result<void> check_device_of_shards(const DeviceOptions &device) {
  if (device.choice != DeviceChoice::Auto)
    return {};
  return fail(
      ErrorCode::Usage,
      "--device auto would light some shards by a card and others by the processor, which do not "
      "agree to the last digit. Give --device cuda or --device cpu.");
}

std::string lit_by(const Journal &journal, std::uint64_t part, const std::string &now) {
  const std::vector<std::string> all = journal.remarks(part);
  return all.empty() ? now : fmt::format("{}", fmt::join(all, "; then "));
}

Error with_way_on(Error stopped, Journal &journal) {
  const bool is_ended_from_outside =
      stopped.code == ErrorCode::Interrupted || stopped.code == ErrorCode::Device;
  if (!is_ended_from_outside) { // it would end there again, and what mends it is another job
    journal.finish();
    return stopped;
  }
  if (journal.count() > 0 && !journal.problem())
    stopped.message += (stopped.message.ends_with('.') ? "" : ".") +
                       std::string(" The same command goes on from there.");
  return stopped;
}

} // namespace umov::jobs
