#pragma once
// Private: what each file adds to the module.

#include <nanobind/nanobind.h>

namespace umov::python {

void bind_table(nanobind::module_ &m);
void bind_scenario(nanobind::module_ &m);
void bind_run(nanobind::module_ &m);
void bind_passes(nanobind::module_ &m);
void bind_light(nanobind::module_ &m);
void bind_material(nanobind::module_ &m);
void bind_orbit(nanobind::module_ &m);
void bind_picture(nanobind::module_ &m);
void bind_abundances(nanobind::module_ &m);
void bind_observe(nanobind::module_ &m);
void bind_invert(nanobind::module_ &m);
void bind_bands(nanobind::module_ &m);

} // namespace umov::python
