#pragma once
// What umov render is asked for.

#include "doubtful_elements.h"
#include "part_options.h"

#include <optional>
#include <string>
#include <umov/jobs/render.h>
#include <vector>

namespace umov::cli {

/// The options as they were given.
struct RenderOptions {
  jobs::RenderRequest request;
  std::string scene, output, time;
  std::optional<std::string> shade;
  std::vector<std::string> overrides;
  std::vector<double> sun, observer, up{0, 0, 1};
  std::optional<double> frames_per_s;
  std::optional<std::size_t> paths;
  std::size_t object = 1;
  DoubtfulElements elements;
  PartOptions part;
};

/// Adds all of them.
void add_render_options(CLI::App &verb, RenderOptions &options);

} // namespace umov::cli
