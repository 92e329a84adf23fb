#pragma once
// The paper remade: "Real Time Polarization Light Curves for Space Debris and Satellites", figure
// by figure, and its claims put to the test. Everything here is the product's own engine.

#include <memory>
#include <string>
#include <umov/core/result.h>
#include <umov/io/plot_page.h>
#include <umov/io/story_page.h>
#include <umov/io/table.h>
#include <utility>
#include <vector>

namespace umov {

/// A number held against one from elsewhere.
struct PaperCheck {
  std::string what;
  double found = 0, expected = 0, tolerance = 0; ///< absolute
  std::string source;                            ///< of `expected`
  /// What was found is within the tolerance of what was expected.
  [[nodiscard]] bool holds() const;
};

/// How the paper fares.
enum class Verdict {
  Shown,  ///< an illustration
  Agrees, ///< umov finds the same
  Partly, ///< right under conditions that are named
  Differs ///< umov finds something else
};

/// A figure, table or claim of the paper, made anew.
struct PaperFigure {
  std::string id;    ///< "fig16", "table1", "claim_roll"
  std::string title; ///< "Figure 16: Q against phase angle"
  std::string claim; ///< what the paper shows or says, in our words
  Verdict verdict = Verdict::Shown;
  std::string summary;            ///< the verdict in one line, with its number
  std::vector<std::string> found; ///< paragraphs: what was measured, and how
  std::vector<PlotFigure> plots;
  std::vector<StoryPicture> pictures;
  std::vector<StoryTable> tables;                  ///< for the page
  std::vector<std::pair<std::string, Table>> data; ///< name of the file without suffix, its rows
  std::vector<PaperCheck> checks;
  std::size_t realizations = 0; ///< poses, epochs or pictures times bands that were computed
  double seconds = 0;           ///< for these, after set-up
};

/// How the paper is remade.
struct PaperOptions {
  unsigned threads = 0;
};

/// All ids, in the order of the paper, then the claims.
std::vector<std::string> paper_figure_ids();

/// What figures share: objects and engines, made when first asked for.
class PaperWorkshop;

/// Makes figures one after another.
class Paper {
public:
  /// Nothing is computed before it is asked for.
  explicit Paper(const PaperOptions &options);
  ~Paper();
  /// One figure. Usage, with the nearest name, if there is none of that id.
  Result<PaperFigure> make(const std::string &id);

private:
  std::unique_ptr<PaperWorkshop> workshop_;
};

/// Files of a set of figures by name: ECSV tables, SVG and PNG pictures, speed.ecsv, checks.ecsv
/// and index.html. `made_with` goes to the end of the page. Internal if this build has no plotting
/// script.
Result<std::vector<std::pair<std::string, std::string>>>
paper_files(const std::vector<PaperFigure> &figures, const std::vector<std::string> &made_with);

} // namespace umov
