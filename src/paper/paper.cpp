#include <umov/paper/paper.h>

#include "paper/claims/claims.h"
#include "paper/figures/figures.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {
namespace {

constexpr FigureEntry entries[] = {
    {"fig1", make_fig1},
    {"fig2", make_fig2},
    {"fig3", make_fig3},
    {"fig4", make_fig4},
    {"fig5", make_fig5},
    {"fig6", make_fig6},
    {"fig7", make_fig7},
    {"fig8", make_fig8},
    {"fig9", make_fig9},
    {"fig10", make_fig10},
    {"fig11", make_fig11},
    {"fig12", make_fig12},
    {"fig13", make_fig13},
    {"table1", make_table1},
    {"fig14", make_fig14},
    {"fig15", make_fig15},
    {"fig16", make_fig16},
    {"fig17", make_fig17},
    {"fig18", make_fig18},
    {"fig19", make_fig19},
    {"fig20", make_fig20},
    {"fig21", make_fig21},
    {"fig22", make_fig22},
    {"fig23", make_fig23},
    {"fig24", make_fig24},
    {"claim_shape", make_claim_shape},
    {"claim_locus", make_claim_locus},
    {"claim_plane", make_claim_plane},
    {"claim_faint", make_claim_faint},
    {"claim_separation", make_claim_separation},
    {"claim_passes", make_claim_passes},
    {"claim_roll", make_claim_roll},
    {"claim_spectral", make_claim_spectral},
    {"claim_reflectivity", make_claim_reflectivity},
    {"claim_incidence", make_claim_incidence},
    {"claim_atmosphere", make_claim_atmosphere},
    {"claim_multiple", make_claim_multiple},
};

} // namespace

bool PaperCheck::holds() const { return std::abs(found - expected) <= tolerance; }

std::span<const FigureEntry> figure_entries() { return entries; }

std::vector<std::string> paper_figure_ids() {
  std::vector<std::string> out;
  for (const FigureEntry &entry : entries)
    out.emplace_back(entry.id);
  return out;
}

Paper::Paper(const PaperOptions &options) : workshop_(std::make_unique<PaperWorkshop>(options)) {}
Paper::~Paper() = default;

Result<PaperFigure> Paper::make(const std::string &id) {
  for (const FigureEntry &entry : entries)
    if (id == entry.id)
      return entry.make(*workshop_);
  const auto known = paper_figure_ids();
  const auto near = nearest_name(id, known);
  return fail(ErrorCode::Usage,
              fmt::format("unknown figure \"{}\"{} Known: {}.", id,
                          near ? fmt::format("; did you mean \"{}\"?", *near) : ".",
                          fmt::join(known, " ")));
}

} // namespace umov
