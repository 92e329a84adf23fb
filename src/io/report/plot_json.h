#pragma once
#include <nlohmann/json.hpp>
#include <umov/io/plot_page.h>

namespace umov {

/// What figure.js draws.
nlohmann::ordered_json figure_json(const PlotFigure &figure);

} // namespace umov
