#pragma once
// Private: the page of an answer about attitudes.

#include "jobs/contribution_words.h"
#include <string>

#include <umov/io/table.h>
#include <umov/jobs/invert.h>

namespace umov::jobs {

/// Data and fit against time with what is left over, where the body's axes point, how the
/// attitude's errors hang together, what the parts of the data contributed, and the summary's
/// lines; where nothing fits, data and fit alone. `fit`: as of fit_table. Empty where this build
/// makes none.
std::string inversion_page(const std::string &title, const Table &fit, const PoseAnswer &answer,
                           Verdict verdict, const Contributions &contributions,
                           const std::string &summary);

} // namespace umov::jobs
