#pragma once
// Private: the form of a file of rows. Blocks of columns, each column at a multiple of 64 bytes;
// behind them a text in JSON that says where each stands; last its place, its length and the magic
// once more, so that a file that was cut off is known by its end.

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>
#include <umov/io/table.h>

namespace umov::scale {

inline constexpr std::string_view rows_magic{"UMOVROW1"};
inline constexpr std::size_t rows_alignment = 64, rows_tail = 24;

/// Names of the kinds of cells, in the order of `Cells`.
inline constexpr std::array<const char *, 4> cell_types{"float64", "int64", "text", "bool"};

} // namespace umov::scale
