#pragma once
// How pages are put together: templates with marks, data that stays inside its script block.

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <umov/core/embedded.h>
#include <umov/core/result.h>

// The drawing script, and its licence beside it.
UMOV_EMBEDDED(report_plotly)
UMOV_EMBEDDED(report_plotly_licence)

namespace umov {

/// Text for "@@NAME@@" in a template.
struct PageSlot {
  std::string_view name;
  std::string text;
};

/// Fills the marks in one pass over the template, so a text that looks like a mark stays text.
std::string fill_page(std::string_view page, std::span<const PageSlot> slots);

/// JSON that cannot end its <script> element nor start a comment: markup characters as \u escapes,
/// bytes that are not UTF-8 (an old file name) as replacement characters.
std::string inert_json(const nlohmann::ordered_json &data);

/// A page of plots: a template with the slots DATA, PLOTLY, PLOTLY_LICENCE, FIGURE (figure.js) and
/// SCRIPT. Internal if this build has no plotting script.
Result<std::string> fill_plot_page(std::string_view page, const nlohmann::ordered_json &data,
                                   std::string_view script);

} // namespace umov
