// Materials and their Mueller BRDFs.

#include "arrays.h"
#include "attend.h"
#include "bindings.h"
#include "errors.h"
#include "options.h"

#include <array>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <umov/io/scenario.h>
#include <umov/jobs/brdf.h>
#include <umov/jobs/material_tables.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;

/// [row, 4, 4] of the columns m00 to m33 of a table; nothing once somebody stops it.
void put_matrices(const Table &table, const jobs::Monitor &monitor, double *out) {
  std::array<const double *, 16> column{};
  for (std::size_t k = 0; k < column.size(); ++k) {
    const std::array<char, 4> name{'m', static_cast<char>('0' + k / 4),
                                   static_cast<char>('0' + k % 4), 0};
    column[k] = std::get<std::vector<double>>(table.find(name.data())->cells).data();
  }
  for (std::size_t row = 0; row < table.rows() && !monitor.is_cancelled(); ++row)
    for (std::size_t k = 0; k < column.size(); ++k)
      out[row * column.size() + k] = column[k][row];
}

nb::ndarray<nb::numpy, double, nb::c_contig>
brdf(const Material &material, const Numbers &wavelength_nm, const Numbers &theta_i_deg,
     const Numbers &theta_o_deg, const Numbers &phi_deg, const Numbers &azimuth_deg,
     nb::handle watch) {
  const std::size_t count = wavelength_nm.shape(0);
  const NewArray<double> out(count * 16);
  const auto work = [&](const jobs::Monitor &monitor, Diagnostics &) -> Result<void> {
    jobs::BrdfRequest request{material, {}, false, ""};
    request.rows.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      request.rows.push_back({wavelength_nm.data()[i], theta_i_deg.data()[i], theta_o_deg.data()[i],
                              phi_deg.data()[i], azimuth_deg.data()[i]});
    UMOV_ASSIGN(table, jobs::brdf_table(request, monitor));
    put_matrices(table, monitor, out.data);
    return {};
  };
  constexpr std::size_t few = 1000; // done in a few milliseconds
  Attention attention(watch);
  Result<void> done;
  if (count < few) {
    const WithoutGil free;
    done = work({}, attention.diagnostics);
  } else {
    done = attend(attention, work);
  }
  attention.settle(was_interrupted(done));
  take(std::move(done));
  return out.shaped({count, 4, 4});
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
        "phi_deg"_a, "azimuth_deg"_a, "watch"_a.none());
  m.def("material_list", [] { return take(jobs::material_list()); });
  m.def("material_names", &material_library);
}

} // namespace umov::python
