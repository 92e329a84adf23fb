// umov._umov: the library's calls for the package umov, which gives them their Python manners.

#include "bindings.h"
#include "errors.h"
#include "gil.h"

#include <umov/core/version.h>

NB_MODULE(_umov, m) {
  m.doc() = "Calls of the C++ library for the package umov; not for use by itself.";
  m.attr("version") = umov::version;
  m.attr("source_revision") = umov::source_revision;
  m.attr("conventions_version") = umov::conventions_version;
  umov::python::watch_the_end();
  umov::python::translate_errors();
  umov::python::bind_table(m);
  umov::python::bind_scenario(m);
  umov::python::bind_run(m);
  umov::python::bind_passes(m);
  umov::python::bind_light(m);
  umov::python::bind_material(m);
  umov::python::bind_orbit(m);
  umov::python::bind_picture(m);
  umov::python::bind_abundances(m);
  umov::python::bind_observe(m);
  umov::python::bind_invert(m);
  umov::python::bind_bands(m);
}
