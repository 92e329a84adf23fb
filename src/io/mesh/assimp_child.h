#pragma once
// Private: Assimp in a process of its own. Its parsers were made for assets that one trusts: a
// broken file can end or hang the program that reads it, and here it can only end the child.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <umov/core/result.h>

namespace umov::mesh_io {

struct ChildLimits {
  unsigned seconds = 60; ///< of computing, and as many of waiting
  std::size_t memory = std::size_t{2} << 30;
  std::size_t answer = std::size_t{1} << 30; ///< bytes that it may send
};

/// Lets Assimp read a file and returns the scene as `pack_scene` packs it. `drops_root`: leave the
/// transformation of the root node out, with which Assimp turns some formats to +Y up. BadInput
/// with what Assimp says, or that it broke down; Interrupted once `cancel` became true.
Result<std::string> import_in_child(const std::filesystem::path &path, bool drops_root,
                                    const ChildLimits &limits,
                                    const std::atomic<bool> *cancel = nullptr);

} // namespace umov::mesh_io
