#include <umov/io/story_page.h>

#include "io/report/base64.h"
#include "io/report/plot_json.h"

#include <umov/core/embedded.h>
#include <umov/io/report.h>

UMOV_EMBEDDED(report_plotly)
UMOV_EMBEDDED(report_plotly_licence)
UMOV_EMBEDDED(story_page_template)
UMOV_EMBEDDED(story_page_js)
UMOV_EMBEDDED(plot_page_figure_js)

namespace umov {
namespace {

using Json = nlohmann::ordered_json;

Json section_json(const StorySection &section) {
  Json out{{"id", section.id},           {"title", section.title}, {"verdict", section.verdict},
           {"summary", section.summary}, {"claim", section.claim}, {"found", section.found},
           {"files", section.files}};
  for (const char *list : {"plots", "pictures", "tables"})
    out[list] = Json::array();
  for (const PlotFigure &plot : section.plots)
    out["plots"].push_back(figure_json(plot));
  for (const StoryPicture &picture : section.pictures)
    out["pictures"].push_back(
        {{"caption", picture.caption}, {"src", "data:image/png;base64," + base64(picture.png)}});
  for (const StoryTable &table : section.tables)
    out["tables"].push_back(
        {{"caption", table.caption}, {"head", table.head}, {"rows", table.rows}});
  return out;
}

} // namespace

Result<std::string> make_story_page(const Story &story) {
  if (!has_report())
    return fail(ErrorCode::Internal,
                "this build has no plotting script: run tools/setup and build again");
  Json data{{"title", story.title},
            {"introduction", story.introduction},
            {"chapters", Json::array()},
            {"notes", story.notes}};
  for (const auto &[heading, sections] : story.chapters) {
    Json chapter{{"heading", heading}, {"sections", Json::array()}};
    for (const StorySection &section : sections)
      chapter["sections"].push_back(section_json(section));
    data["chapters"].push_back(std::move(chapter));
  }
  std::string page(story_page_template());
  fill_in(page, "{{data}}", inert_json(data));
  fill_in(page, "{{figure}}", plot_page_figure_js());
  fill_in(page, "{{script}}", story_page_js());
  fill_in(page, "{{licence}}", report_plotly_licence());
  fill_in(page, "{{plotly}}", report_plotly());
  return page;
}

} // namespace umov
