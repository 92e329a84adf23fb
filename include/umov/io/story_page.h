#pragma once
// A page that tells a story in sections: what was claimed, what was found, figures, checks. One
// HTML file that needs no network.

#include <string>
#include <umov/core/result.h>
#include <umov/io/plot_page.h>
#include <utility>
#include <vector>

namespace umov {

/// A picture with its caption.
struct StoryPicture {
  std::string caption, png; ///< bytes of the file
};
/// A small table of text.
struct StoryTable {
  std::string caption;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

/// One claim or figure of the story.
struct StorySection {
  std::string id, title;
  std::string verdict;            ///< "agrees", "partly", "differs" or "shown": colours its badge
  std::string summary;            ///< one line with a number
  std::string claim;              ///< what the source shows or says
  std::vector<std::string> found; ///< paragraphs
  std::vector<PlotFigure> plots;
  std::vector<StoryPicture> pictures;
  std::vector<StoryTable> tables;
  std::vector<std::string> files; ///< beside the page
};

/// The whole page.
struct Story {
  std::string title;
  std::vector<std::string> introduction;
  std::vector<std::pair<std::string, std::vector<StorySection>>> chapters; ///< heading, sections
  std::vector<std::string> notes;
};

/// The page: an overview with all verdicts, then the chapters. Same input, same bytes. Internal if
/// this build has no plotting script.
Result<std::string> make_story_page(const Story &story);

} // namespace umov
