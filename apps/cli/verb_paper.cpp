// umov paper: the paper's figures and claims, remade.

#include "finishing.h"
#include "job_console.h"
#include "progress_bar.h"
#include "verbs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/paper/paper.h>

namespace umov::cli {
namespace {

struct PaperVerb {
  std::vector<std::string> only;
  std::string output = "out/paper";
};

void print_figure(const PaperFigure &figure, const Common &common) {
  if (common.quiet || common.json)
    return;
  std::size_t failed = 0;
  for (const PaperCheck &check : figure.checks)
    failed += check.holds() ? 0u : 1u;
  fmt::print("{:<18} {}{}\n", figure.id, figure.summary,
             failed > 0 ? fmt::format("  [{} of {} checks FAIL]", failed, figure.checks.size())
                        : "");
  std::fflush(stdout);
}

/// All figures with their checks, for programs.
void print_json(const std::vector<PaperFigure> &figures, const RunFolder &folder) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const PaperFigure &figure : figures) {
    Json checks = Json::array();
    for (const PaperCheck &check : figure.checks)
      checks.push_back({{"what", check.what},
                        {"found", check.found},
                        {"expected", check.expected},
                        {"tolerance", check.tolerance},
                        {"source", check.source},
                        {"holds", check.holds()}});
    list.push_back({{"id", figure.id},
                    {"title", figure.title},
                    {"summary", figure.summary},
                    {"checks", std::move(checks)}});
  }
  const Json out{{"folder", folder.path().string()}, {"figures", std::move(list)}};
  fmt::print("{}\n", out.dump(2, ' ', false, Json::error_handler_t::replace));
}

/// A number that is not what it should be is an error, and says which.
Result<void> judge(const std::vector<PaperFigure> &figures) {
  std::string bad;
  for (const PaperFigure &figure : figures)
    for (const PaperCheck &check : figure.checks)
      if (!check.holds())
        bad += fmt::format("\n  {}: {}: {:.8g}, expected {:.8g} within {:.1g} ({})", figure.id,
                           check.what, check.found, check.expected, check.tolerance, check.source);
  if (!bad.empty())
    return fail(ErrorCode::Physics, "numbers that differ from their independent values:" + bad);
  return {};
}

Result<void> make(const PaperVerb &o, const Common &common) {
  const auto started = std::chrono::system_clock::now();
  UMOV_ASSIGN(folder, RunFolder::open(o.output, common.force));
  Paper paper({.threads = static_cast<unsigned>(common.threads)});
  const std::vector<std::string> ids = o.only.empty() ? paper_figure_ids() : o.only;
  if (o.only.empty())
    note(common, fmt::format("{} figures and claims: about eight minutes of one core", ids.size()));
  std::vector<PaperFigure> figures;
  ProgressBar bar("figures", "", common.quiet);
  for (const std::string &id : ids) {
    if (interrupted())
      return fail(ErrorCode::Interrupted,
                  fmt::format("stopped by the user after {} of {} figures; nothing was written",
                              figures.size(), ids.size()));
    UMOV_ASSIGN(figure, paper.make(id));
    print_figure(figure, common);
    figures.push_back(std::move(figure));
    bar.update(figures.size(), ids.size());
  }
  ManifestInput manifest = manifest_of_command(common, started);
  const auto elapsed_s = [&] {
    return std::chrono::duration<double>(std::chrono::system_clock::now() - started).count();
  };
  UMOV_ASSIGN(files, paper_files(figures, {fmt::format("Made by umov {} in {:.0f} s on {} threads.",
                                                       version, elapsed_s(), manifest.threads)}));
  for (auto &[name, bytes] : files) {
    manifest.files.push_back(name);
    folder.add(name, std::move(bytes));
  }
  folder.add("manifest.json", make_manifest(manifest));
  UMOV_TRY(folder.commit());
  if (common.json)
    print_json(figures, folder);
  else if (!common.quiet)
    fmt::print("written to {} in {:.0f} s: index.html has it all\n",
               printable(folder.path().string()), elapsed_s());
  return judge(figures);
}

} // namespace

void add_paper(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand(
      "paper",
      "The paper's figures and claims remade: data, pictures and one page, each with its check");
  auto o = std::make_shared<PaperVerb>();
  auto common = std::make_shared<Common>();
  verb->add_option("--only", o->only, "Ids, separated by commas: fig16,claim_roll")->delimiter(',');
  verb->add_option("-o,--output", o->output, "Folder")->capture_default_str();
  verb->add_flag("--force", common->force, "Write into a folder that umov did not make");
  add_threads(*verb, *common);
  add_common(*verb, *common, true);
  verb->callback(
      stoppable(exit_with, common, [o, common](Diagnostics &) { return make(*o, *common); }));
}

} // namespace umov::cli
