#include <umov/light/stokes_table.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace umov {
namespace {

template <class T> void put(const std::vector<T> &column, std::string &out) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::uint64_t count = column.size();
  out.append(reinterpret_cast<const char *>(&count), sizeof count);
  out.append(reinterpret_cast<const char *>(column.data()), count * sizeof(T));
}

template <class T> bool take(std::string_view &bytes, std::vector<T> &column) {
  std::uint64_t count = 0;
  if (bytes.size() < sizeof count)
    return false;
  std::memcpy(&count, bytes.data(), sizeof count);
  bytes.remove_prefix(sizeof count);
  if (count > bytes.size() / sizeof(T))
    return false;
  column.resize(count);
  if (count > 0)
    std::memcpy(column.data(), bytes.data(), count * sizeof(T));
  bytes.remove_prefix(count * sizeof(T));
  return true;
}

/// The columns in their order in the bytes; `each` returns false to stop.
template <class Table, class Each> bool for_columns(Table &table, const Each &each) {
  return each(table.i) && each(table.q) && each(table.u) && each(table.v) && each(table.i_err) &&
         each(table.q_err) && each(table.u_err) && each(table.v_err) && each(table.is_dark) &&
         each(table.method) && each(table.indirect) && each(table.glint_share) &&
         each(table.material_i) && each(table.band_err);
}

bool is_consistent(const StokesTable &table) {
  const std::size_t rows = table.i.size(), poses = table.poses();
  for (const auto *column :
       {&table.q, &table.u, &table.v, &table.i_err, &table.q_err, &table.u_err, &table.v_err})
    if (column->size() != rows)
      return false;
  for (const auto *column : {&table.indirect, &table.band_err})
    if (!column->empty() && column->size() != rows)
      return false;
  // A product of what a file says may wrap.
  const bool is_square = poses == 0 ? rows == 0 : rows % poses == 0 && rows / poses == table.bands;
  return is_square && table.method.size() == poses &&
         (table.glint_share.empty() || table.glint_share.size() == poses) &&
         (rows == 0 ? table.material_i.empty() : table.material_i.size() % rows == 0) &&
         std::ranges::all_of(table.method, [](PoseMethod m) { return m <= PoseMethod::Rays; });
}

} // namespace

std::string to_bytes(const StokesTable &table) {
  std::string out;
  const std::uint64_t bands = table.bands;
  out.append(reinterpret_cast<const char *>(&bands), sizeof bands);
  for_columns(table, [&](const auto &column) {
    put(column, out);
    return true;
  });
  return out;
}

bool from_bytes(std::string_view bytes, StokesTable &table) {
  std::uint64_t bands = 0;
  if (bytes.size() < sizeof bands)
    return false;
  std::memcpy(&bands, bytes.data(), sizeof bands);
  bytes.remove_prefix(sizeof bands);
  table.bands = bands;
  return for_columns(table, [&](auto &column) { return take(bytes, column); }) && bytes.empty() &&
         is_consistent(table);
}

} // namespace umov
