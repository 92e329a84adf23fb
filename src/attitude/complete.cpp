// What a law needs from files and from the mesh.

#include <umov/attitude/attitude.h>

#include <algorithm>

namespace umov {

bool needs_mesh(const AttitudeLaw &law) {
  if (const auto *tumble = std::get_if<TumbleLaw>(&law))
    return tumble->from_mesh.has_value();
  if (const auto *libration = std::get_if<LibrationLaw>(&law))
    return needs_mesh(*libration->law);
  if (const auto *pieces = std::get_if<PiecewiseLaw>(&law))
    return std::any_of(pieces->pieces.begin(), pieces->pieces.end(),
                       [](const AttitudePiece &piece) { return needs_mesh(*piece.law); });
  return false;
}

Result<AttitudeLaw> completed(
    const AttitudeLaw &law, const Mesh &mesh,
    const std::function<Result<std::shared_ptr<const AttitudeTable>>(const std::string &)> &read,
    const std::atomic<bool> *cancel) {
  AttitudeLaw out = law;
  if (auto *tumble = std::get_if<TumbleLaw>(&out); tumble && tumble->from_mesh) {
    UMOV_ASSIGN(mass, mass_properties(mesh, *tumble->from_mesh, cancel));
    tumble->inertia = mass.inertia;
    tumble->from_mesh.reset();
  } else if (auto *table = std::get_if<TableLaw>(&out); table && !table->table) {
    UMOV_ASSIGN(attitudes, read(table->file));
    table->table = attitudes;
  } else if (auto *libration = std::get_if<LibrationLaw>(&out)) {
    UMOV_ASSIGN(base, completed(*libration->law, mesh, read, cancel));
    libration->law = std::make_shared<AttitudeLaw>(base);
  } else if (auto *pieces = std::get_if<PiecewiseLaw>(&out)) {
    for (AttitudePiece &piece : pieces->pieces) {
      UMOV_ASSIGN(one, completed(*piece.law, mesh, read, cancel));
      piece.law = std::make_shared<AttitudeLaw>(one);
    }
  }
  return out;
}

} // namespace umov
