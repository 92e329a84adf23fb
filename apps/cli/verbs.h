#pragma once
// One function per verb: adds its options to the command line and, when called, does the job.

#include <CLI/CLI.hpp>
#include <functional>

namespace umov::cli {

/// Receives the exit code of the verb that ran.
using Exit = std::function<void(int)>;

void add_run(CLI::App &app, const Exit &exit_with);
void add_signature(CLI::App &app, const Exit &exit_with);
void add_bands(CLI::App &app, const Exit &exit_with);
void add_bench(CLI::App &app, const Exit &exit_with);
void add_brdf(CLI::App &app, const Exit &exit_with);
void add_material(CLI::App &app, const Exit &exit_with);
void add_mesh(CLI::App &app, const Exit &exit_with);
void add_mesh_make(CLI::App &mesh, const Exit &exit_with);
void add_identify(CLI::App &app, const Exit &exit_with);
void add_instrument(CLI::App &app, const Exit &exit_with);
void add_invert(CLI::App &app, const Exit &exit_with);
void add_library(CLI::App &app, const Exit &exit_with);
void add_observe(CLI::App &app, const Exit &exit_with);
void add_calibrate(CLI::App &app, const Exit &exit_with);
void add_exposure(CLI::App &app, const Exit &exit_with);
void add_reduce(CLI::App &app, const Exit &exit_with);

void add_orbit(CLI::App &app, const Exit &exit_with);
void add_orbit_show(CLI::App &orbit, const Exit &exit_with);
void add_orbit_convert(CLI::App &orbit, const Exit &exit_with);
void add_paper(CLI::App &app, const Exit &exit_with);
void add_passes(CLI::App &app, const Exit &exit_with);
void add_period(CLI::App &app, const Exit &exit_with);
void add_render(CLI::App &app, const Exit &exit_with);
void add_scale(CLI::App &app, const Exit &exit_with);
void add_schema(CLI::App &app, const Exit &exit_with);
void add_completion(CLI::App &app, const Exit &exit_with);
void add_man(CLI::App &app, const Exit &exit_with);
void add_doctor(CLI::App &app, const Exit &exit_with);

} // namespace umov::cli
