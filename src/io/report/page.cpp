#include "io/report/page.h"

#include <umov/core/embedded.h>
#include <umov/io/report.h>

UMOV_EMBEDDED(plot_page_figure_js)

namespace umov {

std::string fill_page(std::string_view page, std::span<const PageSlot> slots) {
  std::string out;
  while (true) {
    const std::size_t start = page.find("@@");
    const std::size_t end = start == page.npos ? page.npos : page.find("@@", start + 2);
    if (end == page.npos)
      return out.append(page);
    out.append(page.substr(0, start));
    const std::string_view name = page.substr(start + 2, end - start - 2);
    for (const PageSlot &slot : slots)
      if (slot.name == name)
        out += slot.text;
    page.remove_prefix(end + 2);
  }
}

std::string inert_json(const nlohmann::ordered_json &data) {
  const std::string json =
      data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      out += "\\u003c";
    else if (c == '>')
      out += "\\u003e";
    else if (c == '&')
      out += "\\u0026";
    else
      out += c;
  }
  return out;
}

Result<std::string> fill_plot_page(std::string_view page, const nlohmann::ordered_json &data,
                                   std::string_view script) {
  if (!has_report())
    return fail(ErrorCode::Internal,
                "this build has no plotting script: run tools/setup and build again");
  const PageSlot slots[] = {{"DATA", inert_json(data)},
                            {"PLOTLY_LICENCE", std::string(report_plotly_licence())},
                            {"PLOTLY", std::string(report_plotly())},
                            {"FIGURE", std::string(plot_page_figure_js())},
                            {"SCRIPT", std::string(script)}};
  return fill_page(page, slots);
}

} // namespace umov
