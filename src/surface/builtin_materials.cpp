// Table 1 of the paper, as printed.

#include <array>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/surface/material.h>

namespace umov {
namespace {

struct PaperRow {
  const char *name;
  std::array<std::complex<double>, 3> eta; ///< 425, 550, 650 nm
  double r_sub;                            ///< the same in the three bands
};

/// The paper's values stay as they are although two are not physical: amorphous silicon has k = 0
/// (it absorbs in the blue) and Mylar n = 1.10 at 425 nm (PET has about 1.66).
constexpr std::array<PaperRow, 6> table_1{{
    {"paper_au", {{{1.62, 1.94}, {0.359, 2.69}, {0.170, 3.14}}}, 0},
    {"paper_al", {{{0.556, 5.146}, {1.015, 6.627}, {1.558, 7.712}}}, 0},
    {"paper_bk7", {{{1.527, 0}, {1.518, 0}, {1.514, 0}}}, 0},
    {"paper_asi", {{{5.15, 0}, {4.77, 0}, {4.46, 0}}}, 0.1},
    {"paper_spectralon", {{{1, 0}, {1, 0}, {1, 0}}}, 1},
    {"paper_mylar", {{{1.10, 0}, {1.5, 0}, {1.6, 0}}}, 0},
}};
const std::vector<double> table_1_nm{425, 550, 650};

IndexTable paper_index(const PaperRow &row) {
  IndexTable out = tabulated_index(row.name, table_1_nm, {row.eta.begin(), row.eta.end()});
  out.reference = "Table 1 of the paper";
  out.holds_ends = true;
  return out;
}

Result<const PaperRow *> row_of(const std::string &name, const char *what) {
  for (const PaperRow &row : table_1)
    if (name == row.name)
      return &row;
  const auto near = nearest_name(name, builtin_material_names());
  return fail(ErrorCode::BadInput,
              fmt::format("unknown {} \"{}\".{} Known: umov material list.", what, name,
                          near ? fmt::format(" Did you mean \"{}\"?", *near) : ""));
}

} // namespace

std::vector<std::string> builtin_material_names() {
  std::vector<std::string> names;
  for (const PaperRow &row : table_1)
    names.emplace_back(row.name);
  return names;
}

Result<IndexTable> builtin_index(const std::string &name) {
  UMOV_ASSIGN(row, row_of(name, "index"));
  return paper_index(*row);
}

Result<Material> builtin_material(const std::string &name) {
  UMOV_ASSIGN(row, row_of(name, "material"));
  Material out;
  out.name = row->name;
  out.index = paper_index(*row);
  out.distribution = blinn_phong(200); // the paper names no exponent; a product decision
  if (row->r_sub > 0)
    out.body = BodyLobe{{{}, {row->r_sub}}, false};
  return out;
}

} // namespace umov
