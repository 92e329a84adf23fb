// Tables: columns without copies, and their way through pickle and into files.

#include "arrays.h"
#include "attend.h"
#include "bindings.h"
#include "errors.h"
#include "gil.h"

#include <algorithm>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <tuple>
#include <umov/io/table.h>
#include <umov/io/table_sink.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;

const Column &column_of(const Table &table, const std::string &name) {
  const Column *column = table.find(name);
  if (column == nullptr)
    throw nb::key_error(name.c_str());
  return *column;
}

/// Numbers as a read-only view of the table's memory; texts as a list.
nb::object values_of(const Column &column, nb::handle owner) {
  if (const auto *x = std::get_if<std::vector<double>>(&column.cells))
    return nb::cast(View<double>(x->data(), {x->size()}, owner));
  if (const auto *x = std::get_if<std::vector<std::int64_t>>(&column.cells))
    return nb::cast(View<std::int64_t>(x->data(), {x->size()}, owner));
  if (const auto *x = std::get_if<std::vector<std::string>>(&column.cells))
    return nb::cast(*x);
  const auto &bits = std::get<std::vector<bool>>(column.cells); // packed: there is nothing to view
  const NewArray<bool> out(bits.size());
  std::copy(bits.begin(), bits.end(), out.data);
  return nb::cast(out.shaped({bits.size()}));
}

/// Letters of a column of texts [row, width], UCS-4 as numpy has them; None for numbers, and for
/// texts that are more than ASCII. Ctrl-C is looked for on the way.
nb::object letters_of(const Column &column) {
  const auto *texts = std::get_if<std::vector<std::string>>(&column.cells);
  if (texts == nullptr)
    return nb::none();
  std::size_t width = 1;
  bool is_ascii = true;
  constexpr std::size_t at_once = 1u << 15;
  const auto look = [&](std::size_t part) {
    for (std::size_t i = part * at_once; i < std::min(texts->size(), (part + 1) * at_once); ++i) {
      width = std::max(width, (*texts)[i].size());
      for (const char c : (*texts)[i])
        if (static_cast<unsigned char>(c) > 127)
          is_ascii = false;
    }
  };
  const std::size_t parts = (texts->size() + at_once - 1) / at_once;
  in_parts(parts, look);
  if (!is_ascii)
    return nb::none();
  const NewArray<std::uint32_t> out(texts->size() * width);
  in_parts(parts, [&](std::size_t part) {
    for (std::size_t i = part * at_once; i < std::min(texts->size(), (part + 1) * at_once); ++i) {
      std::uint32_t *const to = out.data + i * width;
      const std::string &text = (*texts)[i];
      std::fill(std::copy(text.begin(), text.end(), to), to + width, 0);
    }
  });
  return nb::cast(out.shaped({texts->size(), width}));
}

void add_column(Table &table, const std::string &name, const std::string &unit,
                const std::string &description, const nb::object &values) {
  using Floats = nb::ndarray<const double, nb::ndim<1>, nb::c_contig>;
  using Wholes = nb::ndarray<const std::int64_t, nb::ndim<1>, nb::c_contig>;
  using Truths = nb::ndarray<const bool, nb::ndim<1>, nb::c_contig>;
  const auto put = [&](const auto &array, auto cells) {
    cells.assign(array.data(), array.data() + array.size());
    table.add(name, unit, description, std::move(cells));
  };
  if (Floats floats; nb::try_cast(values, floats, false))
    put(floats, std::vector<double>());
  else if (Wholes wholes; nb::try_cast(values, wholes, false))
    put(wholes, std::vector<std::int64_t>());
  else if (Truths truths; nb::try_cast(values, truths, false))
    put(truths, std::vector<bool>());
  else
    table.add(name, unit, description, nb::cast<std::vector<std::string>>(values));
}

template <class Member>
std::vector<std::string> texts_of(const Table &table, Member Column::*member) {
  std::vector<std::string> out;
  for (const Column &column : table.columns())
    out.push_back(column.*member);
  return out;
}

} // namespace

void bind_table(nb::module_ &m) {
  nb::class_<Table>(m, "Table", "Named columns with units.")
      .def(nb::init<>())
      .def_prop_ro("rows", &Table::rows)
      .def_prop_ro("names", [](const Table &t) { return texts_of(t, &Column::name); })
      .def_prop_ro("units", [](const Table &t) { return texts_of(t, &Column::unit); })
      .def_prop_ro("descriptions", [](const Table &t) { return texts_of(t, &Column::description); })
      .def_prop_ro("precisions",
                   [](const Table &t) {
                     std::vector<std::tuple<std::string, int, int>> out;
                     for (const Column &column : t.columns())
                       out.emplace_back(column.precision.error, column.precision.decimals,
                                        column.precision.significant);
                     return out;
                   })
      .def_prop_ro("notes", &Table::notes)
      .def(
          "column",
          [](nb::handle self, const std::string &name) {
            return values_of(column_of(nb::cast<const Table &>(self), name), self);
          },
          "name"_a,
          nb::sig("def column(self, name: str) -> numpy.typing.NDArray[typing.Any] | list[str]"))
      .def(
          "letters",
          [](const Table &table, const std::string &name) {
            return letters_of(column_of(table, name));
          },
          "name"_a,
          nb::sig("def letters(self, name: str) -> numpy.typing.NDArray[numpy.uint32] | None"))
      .def("add", &add_column, "name"_a, "unit"_a, "description"_a, "values"_a)
      .def(
          "set_precision",
          [](Table &t, const std::string &name, const std::string &error, int decimals,
             int significant) {
            t.set_precision(name, {error, decimals, significant});
          },
          "name"_a, "error"_a, "decimals"_a, "significant"_a)
      .def("note", &Table::note, "key"_a, "value"_a)
      .def("csv", [](const Table &t) { return to_csv(t); })
      .def("ecsv", [](const Table &t) { return to_ecsv(t); })
      .def(
          "write",
          [](const Table &t, const std::string &path) {
            const WithoutGil free;
            take(write_table(path, t));
          },
          "path"_a);
}

} // namespace umov::python
