#pragma once
// Parts of `umov material` that stand in files of their own.

#include "finishing.h"

#include <memory>
#include <umov/jobs/material_check.h>

namespace umov::cli {

/// `umov material check`.
void add_check(CLI::App &material, const Exit &exit_with);

/// `umov material import`.
void add_import(CLI::App &material, const Exit &exit_with);

/// `umov material check --explicit`: a ray-traced height field against the statistical model.
struct ExplicitOptions {
  bool is_wanted = false;
  jobs::RoughSurfaceRequest request;
};
std::shared_ptr<ExplicitOptions> add_explicit_options(CLI::App &verb);
Result<void> check_explicit(const ExplicitOptions &options, const std::string &output,
                            const Common &common);

/// `umov material plot`.
void add_plot(CLI::App &material, const Exit &exit_with);

} // namespace umov::cli
