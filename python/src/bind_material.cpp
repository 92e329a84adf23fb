// Materials and their Mueller BRDFs.

#include "arrays.h"
#include "bindings.h"
#include "errors.h"

#include <array>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <umov/io/scenario.h>
#include <umov/jobs/brdf.h>
#include <umov/jobs/material_tables.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;

/// [row, 4, 4] of the columns m00 to m33 of a table.
NewArray<double> matrices_of(const Table &table) {
  NewArray<double> out(table.rows() * 16);
  for (std::size_t k = 0; k < 16; ++k) {
    const std::array<char, 4> name{'m', static_cast<char>('0' + k / 4),
                                   static_cast<char>('0' + k % 4), 0};
    const auto &column = std::get<std::vector<double>>(table.find(name.data())->cells);
    for (std::size_t row = 0; row < column.size(); ++row)
      out.data[row * 16 + k] = column[row];
  }
  return out;
}

nb::ndarray<nb::numpy, double, nb::c_contig>
brdf(const Material &material, const Numbers &wavelength_nm, const Numbers &theta_i_deg,
     const Numbers &theta_o_deg, const Numbers &phi_deg, const Numbers &azimuth_deg) {
  jobs::BrdfRequest request{material, {}, false, ""};
  const std::size_t count = wavelength_nm.shape(0);
  Result<Table> table = Table();
  {
    const nb::gil_scoped_release free;
    for (std::size_t i = 0; i < count; ++i)
      request.rows.push_back({wavelength_nm.data()[i], theta_i_deg.data()[i], theta_o_deg.data()[i],
                              phi_deg.data()[i], azimuth_deg.data()[i]});
    table = jobs::brdf_table(request);
  }
  return matrices_of(take(std::move(table))).shaped({count, 4, 4});
}

} // namespace

void bind_material(nb::module_ &m) {
  nb::class_<Material>(m, "Material", "What a surface is made of.")
      .def_static(
          "read", [](const std::string &name) { return take(read_material(name)); }, "name"_a)
      .def_static(
          "parse",
          [](const std::string &text, const std::string &path) {
            return take(read_material_text(text, path));
          },
          "text"_a, "path"_a)
      .def_ro("name", &Material::name)
      .def_ro("description", &Material::description)
      .def_ro("source", &Material::source)
      .def_ro("assumed", &Material::assumed)
      .def_prop_ro("toml", &material_as_toml)
      .def_prop_ro("polarization", &describe_polarization)
      .def_prop_ro(
          "range_nm",
          [](const Material &material) {
            const WavelengthRange range = range_of(material);
            return nb::make_tuple(range.first_nm, range.last_nm);
          },
          nb::sig("def range_nm(self) -> tuple[float, float]"))
      .def(
          "index_table",
          [](const Material &material, const std::vector<double> &wavelengths_nm) {
            return take(jobs::index_table(material.index, wavelengths_nm));
          },
          "wavelengths_nm"_a);
  m.def("brdf", &brdf, "material"_a, "wavelength_nm"_a, "theta_i_deg"_a, "theta_o_deg"_a,
        "phi_deg"_a, "azimuth_deg"_a);
  m.def("material_list", [] { return take(jobs::material_list()); });
  m.def("material_names", &material_library);
}

} // namespace umov::python
