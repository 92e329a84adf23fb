#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <umov/io/plot_page.h>

namespace umov {

/// What figure.js draws.
nlohmann::ordered_json figure_json(const PlotFigure &figure);

/// JSON text that may stand in a script block: it does not close it.
std::string inert_json(const nlohmann::ordered_json &data);

/// Puts text in the place of the first `mark` of a page.
void fill_in(std::string &page, std::string_view mark, std::string_view text);

} // namespace umov
