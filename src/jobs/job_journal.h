#pragma once
// Private: what makes a job the same job, and what is told of its journal.

#include <string>
#include <umov/core/diagnostics.h>
#include <umov/core/journal.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/requests.h>
#include <vector>

namespace umov::jobs {

/// All that the rows of a job depend on: version and build, the lanes of this machine, scenario,
/// contents of its files, and `more`, what was asked besides. Threads and masks change no row.
std::string job_text(const Scenario &scenario, const std::vector<InputFile> &inputs,
                     const std::string &more);

/// What a signature of a library is made from: SHA-256 of its job_text; `device` as of
/// SignatureText.
std::string signature_job(const Scenario &scenario, const std::vector<InputFile> &inputs,
                          std::size_t cells, const std::string &device);

/// The journal that the options name; says how much of the job is done already, or why it begins
/// anew.
Result<Journal> open_journal(const JobOptions &options, const std::string &job,
                             const Monitor &monitor, Diagnostics &diagnostics);

/// `identity_of` the cards that are asked for and there; empty: the processor. Device where they
/// must be there and are not.
Result<std::string> cards_for(const DeviceOptions &device);

/// What rows depend on besides, as the identity of a job has it: who may light them. Cards and the
/// processor do not agree to the last digit; with Auto either may, so that neither goes on with its
/// rows. Device as cards_for.
Result<std::string> device_text(const DeviceOptions &device);

/// Usage for Auto: shards would be lit by cards and by the processor.
Result<void> check_device_of_shards(const DeviceOptions &device);

/// Who lit the rows of a part of the job that were kept, by this process and by those before it; of
/// a job without a journal `now`.
std::string lit_by(const Journal &journal, std::uint64_t part, const std::string &now);

/// The end of a job that was ended early: where it goes on.
Error with_way_on(Error stopped, Journal &journal);

} // namespace umov::jobs
