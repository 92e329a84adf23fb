#include <umov/io/story_page.h>

#include "io/report/base64.h"
#include "io/report/page.h"
#include "io/report/plot_json.h"

#include <umov/core/embedded.h>

UMOV_EMBEDDED(story_page_template)
UMOV_EMBEDDED(story_page_js)

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
  return fill_plot_page(story_page_template(), data, story_page_js());
}

} // namespace umov
